//! Contact regions against all surfaces that rays find near a solid.

use super::*;
use crate::{Object, World};
use juggler_light::AnyLight;
use juggler_light::background::{AnyBackground, Solid};
use juggler_material::MaterialCompiler;
use juggler_math::testing::Random;
use juggler_math::{Motion, Ray, Transform};
use juggler_shape::Mesh;
use juggler_texture::TextureTable;
use std::sync::Arc;

/// World of a glass sphere of radius 1 around (0, 1, 0) and another object.
fn sphere_and(other: Content, motion: Motion) -> World {
    let mut compiler = MaterialCompiler::new(TextureTable::default(), []);
    let mut material = |json: &str| compiler.compile(&serde_json::from_str(json).unwrap()).unwrap();
    let (glass, diffuse) = (material(r#"{"dielectric": {"ior": 1.5}}"#), material(r#"{"diffuse": {}}"#));
    let solid = Object::new(shape(r#"{"sphere": {"radius": 1}}"#), Transform::translation(Vec3::Y), glass);
    let objects = vec![solid, Object { content: other, motion, material: Some(diffuse), attributes: None }];
    let background = AnyBackground::Solid(Solid::default());
    World::new(
        objects,
        compiler.finish().unwrap(),
        Vec::<AnyLight>::new(),
        background,
        &juggler_math::BuildControl::default(),
    )
    .unwrap()
}

fn shape(json: &str) -> AnyShape {
    let mut shape: AnyShape = serde_json::from_str(json).unwrap();
    shape.prepare().unwrap();
    shape
}

fn content(json: &str) -> Content {
    Content::Shape(Arc::new(shape(json)))
}

/// Whether the point of the sphere in this direction from its center is apart from other surfaces.
fn is_apart(world: &World, direction: Vec3) -> bool {
    let mut ray = Ray::new(Vec3::Y + direction * 0.5, direction);
    let hit = world.closest(&mut ray);
    let vertex = world.vertex(&ray, &hit);
    world.contacts.is_apart(&vertex, 1e-5)
}

/// Fraction of the sphere that is apart from other surfaces.
fn fraction_apart(world: &World) -> f32 {
    let mut random = Random::new(1);
    (0..1000).filter(|_| is_apart(world, random.unit_vector())).count() as f32 / 1000.0
}

#[test]
fn a_sphere_on_a_floor_touches_it_at_the_bottom_alone() {
    let floor = Mesh::from_triangles(
        [[-9.0, 0.0, -9.0], [9.0, 0.0, -9.0], [9.0, 0.0, 9.0], [-9.0, 0.0, 9.0], [-9.0, 9.0, -9.0], [9.0, 9.0, -9.0]]
            .map(Into::into),
        [[0, 1, 2], [0, 2, 3], [0, 1, 5], [0, 5, 4]],
    );
    let mut floor: AnyShape = floor.into();
    floor.prepare().unwrap();
    let floors = [
        content(r#"{"plane": {}}"#),
        content(r#"{"rectangle": {"size": [9, 9]}}"#),
        content(r#"{"cuboid": {"min": [-1, -1, -1], "max": [1, 0, 1]}}"#),
        Content::Shape(Arc::new(floor)),
    ];
    for floor in floors {
        let world = sphere_and(floor, Transform::IDENTITY.into());
        assert!(!is_apart(&world, Vec3::NEG_Y));
        assert!(!is_apart(&world, Vec3::new(1e-3, -1.0, 0.0).normalize()));
        assert!(fraction_apart(&world) > 0.99);
    }
}

#[test]
fn a_solid_touches_planes_at_any_angle_and_whatever_moves() {
    let plane = |angle: f32, height: f32| {
        let turned = Transform::rotation(Vec3::Z, angle).unwrap().then(&Transform::translation(Vec3::Y * height));
        sphere_and(content(r#"{"plane": {}}"#), turned.into())
    };
    let normal = |angle: f32| Vec3::new(-angle.sin(), angle.cos(), 0.0);
    // The tilted plane touches the sphere where the sphere's normal is the plane's.
    let angle = 0.5_f32;
    assert!(!is_apart(&plane(angle, 1.0 - 1.0 / angle.cos()), -normal(angle)));
    // The plane through the center cuts the sphere along a circle, whose box is large.
    let cut = plane(0.0, 1.0);
    assert!(!is_apart(&cut, Vec3::X) && !is_apart(&cut, Vec3::Z) && is_apart(&cut, Vec3::Y));
    // A sphere that passes by touches the solid at some time.
    let from = |x: f32| Transform::translation(Vec3::new(x, 1.0, 0.0));
    let motion = Motion::from_keys(vec![from(4.0), from(2.0)]).unwrap();
    let world = sphere_and(content(r#"{"sphere": {"radius": 1}}"#), motion);
    assert!(!is_apart(&world, Vec3::X) && is_apart(&world, Vec3::NEG_X));
}

#[test]
fn contents_of_instances_count() {
    let plane = Object {
        content: content(r#"{"plane": {}}"#),
        motion: Transform::IDENTITY.into(),
        material: None,
        attributes: None,
    };
    let unbounded =
        Content::Geometry(Arc::new(Geometry::new(vec![plane], &juggler_math::BuildControl::default()).unwrap()));
    assert!(fraction_apart(&sphere_and(unbounded, Transform::IDENTITY.into())) == 0.0);
    let tile = Object {
        content: content(r#"{"rectangle": {"size": [1, 1]}}"#),
        motion: Transform::IDENTITY.into(),
        material: None,
        attributes: None,
    };
    let tiles = Content::Geometry(Arc::new(Geometry::new(vec![tile], &juggler_math::BuildControl::default()).unwrap()));
    let world = sphere_and(tiles, Transform::IDENTITY.into());
    assert!(!is_apart(&world, Vec3::NEG_Y) && is_apart(&world, Vec3::Y));
}

#[test]
fn many_triangles_merge_into_few_regions_that_contain_them() {
    let mut random = Random::new(3);
    let centers: Vec<Vec3> = (0..40).map(|_| Vec3::Y + random.unit_vector()).collect();
    let corners = centers.iter().flat_map(|center| [*center, *center + Vec3::X * 1e-3, *center + Vec3::Z * 1e-3]);
    let triangles: Vec<[u32; 3]> = (0..40).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mut mesh: AnyShape = Mesh::from_triangles(corners.collect::<Vec<_>>(), triangles).into();
    mesh.prepare().unwrap();
    let world = sphere_and(Content::Shape(Arc::new(mesh)), Transform::IDENTITY.into());
    assert!(centers.iter().all(|center| !is_apart(&world, *center - Vec3::Y)));
}
