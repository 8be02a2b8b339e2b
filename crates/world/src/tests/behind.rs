//! Hits behind hits: all surfaces along a ray, one after another.

use super::{NO_LIGHTS, crowd, large_mesh, rays, world_of};
use crate::*;
use juggler_light::background::Solid;
use juggler_material::MaterialCompiler;
use juggler_math::testing::Random;
use juggler_math::{Motion, Transform};
use juggler_shape::{AnyShape, Mesh, MeshData, Shape};
use juggler_texture::TextureTable;
use std::sync::Arc;

/// Objects of every kind, each twice at the same place, in mixed order: shapes, meshes that are merged
/// and large ones, moving objects, a mesh whose corners move, and instances.
fn doubled(random: &mut Random) -> Vec<Object> {
    let mut objects = crowd(random, 2, Some(MaterialId(0)));
    objects.push(Object::new(large_mesh(), Transform::IDENTITY, MaterialId(1)));
    for content in [
        Content::Geometry(Arc::new(Geometry::new(crowd(random, 1, None), &BuildControl::default()).unwrap())),
        objects[0].content.clone(),
    ] {
        let keys = vec![random.transform(), random.transform()];
        objects.push(Object { content, motion: Motion::from_keys(keys).unwrap(), material: None, attributes: None });
    }
    let corners = |y: f32| MeshData {
        positions: vec![Vec3::new(-30.0, y, -30.0), Vec3::new(30.0, y, -30.0), Vec3::new(0.0, y, 40.0)],
        triangles: vec![[0, 1, 2], [0, 2, 1], [0, 1, 2]],
        ..MeshData::default()
    };
    let sheet = Mesh::from_keyframes(vec![corners(-1.0), corners(2.0)], None).unwrap();
    objects.push(Object::new(sheet.into(), Transform::IDENTITY, MaterialId(0)));
    let mut still: Mesh = corners(1.0).into();
    still.prepare().unwrap();
    objects.push(Object::new(still.into(), Transform::IDENTITY, MaterialId(0)));
    let copies: Vec<Object> = objects.iter().rev().cloned().collect();
    objects.extend(copies);
    objects
}

/// All hits along a ray, in order.
fn walk(world: &World, ray: &Ray) -> Vec<HitKey> {
    let mut hit = world.closest(&mut { *ray });
    let mut keys = Vec::new();
    while hit.is_some() {
        keys.push(hit.key());
        hit = world.closest_after(&mut { *ray }, &hit.key());
    }
    keys
}

#[test]
fn every_surface_along_a_ray_is_found_once_and_in_order() {
    let random = &mut Random::new(61);
    let objects = doubled(random);
    let world = world_of(objects.clone());
    let mut first = 0;
    let alone: Vec<(World, u32)> = objects
        .into_iter()
        .map(|object| {
            let shapes = object.shapes() as u32;
            first += shapes;
            (world_of(vec![object]), first - shapes)
        })
        .collect();
    let mut coincident = 0;
    for ray in (0..60).flat_map(|round| rays(random, round, 5)).collect::<Vec<_>>() {
        let found = walk(&world, &ray);
        assert!(found.windows(2).all(|pair| pair[0] < pair[1]), "{found:?}");
        let of_one = |(one, first): &(World, u32)| -> Vec<HitKey> {
            walk(one, &ray).into_iter().map(|key| HitKey { shape: key.shape + first, ..key }).collect()
        };
        let mut expected: Vec<HitKey> = alone.iter().flat_map(of_one).collect();
        expected.sort_by(|a, b| a.partial_cmp(b).unwrap());
        assert_eq!(found, expected);
        // Each object alone has the hits that follow by distance.
        for (one, _) in &alone {
            let (mut distances, mut from) = (Vec::new(), ray);
            loop {
                let mut probe = from;
                if !one.closest(&mut probe).is_some() {
                    break;
                }
                distances.push(probe.t_max);
                from.t_min = probe.t_max.next_up();
            }
            let mut walked: Vec<f32> = walk(one, &ray).iter().map(|key| key.t).collect();
            walked.dedup();
            assert_eq!(walked, distances);
        }
        coincident += found.windows(2).filter(|pair| pair[0].t == pair[1].t).count();
    }
    assert!(coincident > 500, "{coincident}");
}

/// Entries of a world of cuboids with these heights and materials whose order decides what is seen.
fn ambiguous(cuboids: &[([f32; 2], &str)]) -> Vec<(Ambiguity, u32, u32)> {
    let mut compiler = MaterialCompiler::new(TextureTable::default(), []);
    let mut objects = Vec::new();
    for ([low, high], material) in cuboids {
        let shape = format!(r#"{{"cuboid": {{"min": [-1, {low}, -1], "max": [1, {high}, 1]}}}}"#);
        let mut shape: AnyShape = serde_json::from_str(&shape).unwrap();
        shape.prepare().unwrap();
        let material = compiler.compile(&serde_json::from_str(material).unwrap()).unwrap();
        objects.push(Object::new(shape, Transform::IDENTITY, material));
    }
    let entries = (0..objects.len() as u32).collect();
    let world = World::new(
        objects,
        compiler.finish().unwrap(),
        NO_LIGHTS,
        AnyBackground::Solid(Solid::default()),
        &BuildControl::default(),
    )
    .unwrap();
    world.with_labels(Labels { entries, ..Labels::default() }).ambiguities().into_iter().collect()
}

#[test]
fn only_objects_that_share_a_visible_surface_or_an_overlap_are_ambiguous() {
    let (white, red) = (r#"{"diffuse": {"reflectance": 0.8}}"#, r#"{"diffuse": {"reflectance": [0.8, 0.1, 0.1]}}"#);
    let glass = |priority: i32| format!(r#"{{"dielectric": {{"ior": 1.5, "priority": {priority}}}}}"#);
    let (low, high) = (glass(0), glass(1));
    // One stands on the other, apart from it, and in it with the sides at one place.
    assert!(ambiguous(&[([0.0, 1.0], white), ([1.0, 2.0], white)]).is_empty());
    assert!(ambiguous(&[([0.0, 1.0], white), ([1.5, 2.0], red)]).is_empty());
    assert_eq!(ambiguous(&[([0.0, 1.0], white), ([0.5, 2.0], red)]), [(Ambiguity::Surfaces, 0, 1)]);
    assert!(ambiguous(&[([0.0, 1.0], white), ([0.5, 2.0], white)]).is_empty());
    // A surface that is partly open or transmits light, on another one.
    let half = r#"{"mask": {"opacity": 0.5, "material": {"diffuse": {"reflectance": [1, 0, 0]}}}}"#;
    let pane = r#"{"dielectric": {"thin": true, "reflection_tint": [0.5, 0, 0]}}"#;
    let open = r#"{"mask": {"opacity": 0, "material": {"diffuse": {"reflectance": [1, 0, 0]}}}}"#;
    for material in [half, pane] {
        assert_eq!(ambiguous(&[([0.0, 1.0], white), ([0.5, 2.0], material)]), [(Ambiguity::Surfaces, 0, 1)]);
    }
    assert!(ambiguous(&[([0.0, 1.0], white), ([0.5, 2.0], open)]).is_empty());
    // Solids that touch, are alike or differ in priority are none.
    assert!(ambiguous(&[([0.0, 1.0], &low), ([1.0, 2.0], &low)]).is_empty());
    assert!(ambiguous(&[([0.0, 1.0], &low), ([0.5, 2.0], &high)]).is_empty());
    assert!(ambiguous(&[([0.0, 1.0], &low), ([0.5, 2.0], &low)]).is_empty());
    let flint = r#"{"dielectric": {"ior": 1.7}}"#;
    assert!(ambiguous(&[([0.0, 1.0], &low), ([1.0, 2.0], flint)]).is_empty());
    assert_eq!(ambiguous(&[([0.0, 1.0], &low), ([0.5, 2.0], flint)]), [(Ambiguity::Solids, 0, 1)]);
    assert_eq!(ambiguous(&[([0.5, 2.0], flint), ([0.0, 1.0], &low)]), [(Ambiguity::Solids, 0, 1)]);
}
