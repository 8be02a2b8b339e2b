//! Compares ray queries with brute force over all objects.

use super::instance::Instance;
use super::*;
use juggler_light::background::Solid;
use juggler_material::{Checkerboard, MaterialCompiler, MaterialRef, MaterialResolver};
use juggler_math::testing::Random;
use juggler_math::{BuildControl, Transform, Vec3};
use juggler_shape::{AnyShape, Mesh, MeshData, Plane, Sphere};
use juggler_texture::TextureTable;
use std::sync::Arc;

mod attributes;
mod behind;
mod coplanar;
mod few_spheres;
mod moving;
mod points;

const NO_LIGHTS: [SceneLight; 0] = [];

/// `times` copies of every kind of shape, rotated, sheared and translated.
fn crowd(random: &mut Random, times: usize, material: Option<MaterialId>) -> Vec<Object> {
    let mut objects = Vec::new();
    for _ in 0..times {
        for mut shape in AnyShape::examples() {
            shape.prepare().unwrap();
            let extent = shape.bounds().extent().max_element();
            if extent.is_finite() && extent > 50.0 {
                continue;
            }
            let place = Transform::translation(random.point(20.0));
            let transform = random.transform().then(&place);
            objects.push(Object {
                content: Content::Shape(Arc::new(shape)),
                motion: transform.into(),
                material,
                attributes: None,
            });
        }
    }
    objects
}

/// A world without lights.
fn world(objects: Vec<Object>, materials: MaterialTable, color: Rgb) -> World {
    World::new(objects, materials, NO_LIGHTS, Solid { color }.into(), &BuildControl::new()).unwrap()
}

/// A geometry of objects.
fn geometry(objects: Vec<Object>) -> Arc<Geometry> {
    Arc::new(Geometry::new(objects, &BuildControl::new()).unwrap())
}

/// A world whose objects have the materials 0, 1 and 2.
fn world_of(objects: Vec<Object>) -> World {
    let mut compiler = MaterialCompiler::new(TextureTable::default(), []);
    let materials = [0, 1, 2].map(|_| compiler.material("material", &MaterialRef::default()).unwrap());
    assert_eq!(materials, [0, 1, 2].map(MaterialId));
    world(objects, compiler.finish().unwrap(), Rgb::BLACK)
}

/// Three levels: a crowd with a ground plane, reflected, sheared and rotated instances of it, and
/// instances of those.
fn nested(random: &mut Random) -> World {
    let mirror = Transform::scale(Vec3::new(-0.5, 0.7, 0.4)).unwrap();
    let mut instances = |geometry: &Arc<Geometry>, count: usize, material: Option<MaterialId>| -> Vec<Object> {
        let one = |i: usize| {
            let place = random.transform().then(&Transform::translation(random.point(15.0)));
            let transform = if i.is_multiple_of(2) { mirror.then(&place) } else { place };
            Object {
                content: Content::Geometry(Arc::clone(geometry)),
                motion: transform.into(),
                material: material.filter(|_| i.is_multiple_of(3)),
                attributes: None,
            }
        };
        (0..count).map(one).collect()
    };
    let mut random = Random::new(18);
    let inner = geometry(crowd(&mut random, 1, None));
    let mut objects = instances(&inner, 3, Some(MaterialId(1)));
    objects.extend(crowd(&mut random, 1, Some(MaterialId(2))));
    objects.extend(instances(&inner, 2, None));
    let middle = geometry(objects);
    let mut objects = instances(&middle, 3, None);
    objects.extend(crowd(&mut random, 1, Some(MaterialId(0))));
    objects.extend(instances(&inner, 4, Some(MaterialId(0))));
    let plane = Object::new(Plane::default().into(), Transform::translation(Vec3::Y * -30.0), MaterialId(0));
    let ground = Arc::new(
        Geometry::new(vec![plane.clone(), instances(&inner, 1, None).remove(0)], &BuildControl::new()).unwrap(),
    );
    objects.extend(instances(&ground, 1, Some(MaterialId(1))));
    objects.push(plane);
    world_of(objects)
}

/// Nested instances that are all bounded, so that they are in the hierarchy, among other objects.
fn grove(random: &mut Random) -> World {
    let bounded = |mut objects: Vec<Object>| {
        objects.retain(Object::is_bounded);
        objects
    };
    let mut content = geometry(bounded(crowd(random, 1, None)));
    for material in [1, 2] {
        let mut objects = bounded(crowd(random, 1, Some(MaterialId(0))));
        for _ in 0..6 {
            let transform = random.transform().then(&Transform::translation(random.point(25.0)));
            let material = Some(MaterialId(material));
            objects.insert(
                objects.len() / 2,
                Object {
                    content: Content::Geometry(Arc::clone(&content)),
                    motion: transform.into(),
                    material,
                    attributes: None,
                },
            );
        }
        content = geometry(objects);
    }
    world_of(vec![Object {
        content: Content::Geometry(content),
        motion: random.transform().into(),
        material: None,
        attributes: None,
    }])
}

/// The same shapes without instances, at a time: transforms are composed and materials inherited.
fn expanded_at(objects: &[Instance], parent: &Transform, inherited: Option<MaterialId>, time: f32) -> Vec<Object> {
    let expand = |instance: &Instance| {
        let (content, motion, material) = (&instance.content, &instance.motion, instance.material());
        let (place, material) = (motion.at(time).then(parent), material.or(inherited));
        match content {
            Content::Shape(_) => {
                vec![Object { content: content.clone(), motion: place.into(), material, attributes: None }]
            }
            Content::Geometry(geometry) => expanded_at(&geometry.objects, &place, material, time),
        }
    };
    objects.iter().flat_map(expand).collect()
}

/// Intersects every shape in turn, counting shape indices.
fn brute_force(objects: &[Instance], ray: &Ray, next: &mut u32, best: &mut WorldHit) {
    for instance in objects {
        match &instance.content {
            Content::Shape(_) => {
                let mut alone = WorldHit::NONE;
                instance.closest(&mut ray.with_t_max(best.hit.t.min(ray.t_max)), *next, &mut alone);
                if alone.hit.t < best.hit.t || (alone.hit.t == best.hit.t && alone.shape < best.shape) {
                    *best = alone;
                }
                *next += 1;
            }
            Content::Geometry(geometry) => {
                brute_force(&geometry.objects, &instance.ray_to_object(ray), next, best);
            }
        }
    }
}

fn nearest(world: &World, ray: &Ray) -> WorldHit {
    let (mut next, mut best) = (0, WorldHit::NONE);
    brute_force(&world.top.objects, ray, &mut next, &mut best);
    assert_eq!(u64::from(next), world.geometry_stats().shapes);
    best
}

/// Rays from one origin, coherent or in all directions, some of limited length.
fn rays(random: &mut Random, round: usize, count: usize) -> Vec<Ray> {
    let origin = random.point(40.0);
    let axis = random.unit_vector();
    let spread = if round.is_multiple_of(2) { 0.02 } else { 2.0 };
    (0..count)
        .map(|_| Ray::new(origin, (axis + random.unit_vector() * spread).normalize_or(axis)))
        .map(|ray| Ray { time: (ray.direction.x * 1e3).abs().fract(), ..ray })
        .map(|ray| if round.is_multiple_of(3) { ray.with_t_max(30.0) } else { ray })
        .collect()
}

fn equals_brute_force(world: &World, rounds: usize) {
    let mut random = Random::new(17);
    let mut hit_count = 0;
    for round in 0..rounds {
        // Sometimes use more rays than a group of packets, in an incomplete packet.
        let rays = rays(&mut random, round, if round % 6 == 4 { 43 } else { 8 });
        let expected: Vec<WorldHit> = rays.iter().map(|ray| nearest(world, ray)).collect();
        hit_count += expected.iter().filter(|hit| hit.is_some()).count();
        let mut hits = vec![WorldHit::NONE; rays.len()];
        world.closest_packet(&mut rays.clone(), &mut hits);
        assert_eq!(hits, expected, "packet, round {round}");
        world.closest_batch(&mut rays.clone(), &mut hits);
        assert_eq!(hits, expected, "batch, round {round}");
        let alone: Vec<WorldHit> = rays.iter().map(|ray| world.closest(&mut ray.clone())).collect();
        assert_eq!(alone, expected, "single, round {round}");
        let open: Vec<Rgb> = expected.iter().map(|h| if h.is_some() { Rgb::BLACK } else { Rgb::WHITE }).collect();
        let mut through = vec![Rgb::BLACK; rays.len()];
        world.transmittance_packet(&rays, ShadowMode::Filtered, &mut through);
        assert_eq!(through, open, "shadow packet, round {round}");
        world.transmittance_batch(&rays, ShadowMode::Filtered, &mut through);
        assert_eq!(through, open, "shadow batch, round {round}");
    }
    assert!(hit_count > rounds * 3 / 2, "only {hit_count} rays hit an object");
}

#[test]
fn hierarchy_equals_brute_force_one_by_one_in_batches_and_in_packets() {
    equals_brute_force(&world_of(crowd(&mut Random::new(17), 6, Some(MaterialId(0)))), 300);
}

#[test]
fn instances_equal_brute_force() {
    equals_brute_force(&nested(&mut Random::new(19)), 300);
    equals_brute_force(&grove(&mut Random::new(27)), 300);
}

#[test]
fn every_vector_unit_equals_brute_force() {
    for simd in simd_levels() {
        let world = grove(&mut Random::new(24)).with_simd_level(simd);
        equals_brute_force(&world, 60);
    }
}

/// Three coincident copies of everything, in instances and without: all hits are ties.
#[test]
fn coincident_instances_hit_the_lowest_index() {
    let mut random = Random::new(25);
    let mut objects = crowd(&mut random, 2, Some(MaterialId(0)));
    objects.retain(Object::is_bounded);
    let geometry = geometry(objects);
    let instance = Object {
        content: Content::Geometry(geometry),
        motion: random.rotation().into(),
        material: None,
        attributes: None,
    };
    let mut objects = crowd(&mut random, 1, Some(MaterialId(1)));
    objects.extend(objects.clone());
    for place in [0, objects.len() / 2, objects.len()] {
        objects.insert(place, instance.clone());
    }
    let world = world_of(objects);
    equals_brute_force(&world, 200);
    let shapes = world.geometry_stats().shapes;
    let mut random = Random::new(26);
    let hits: Vec<WorldHit> =
        (0..200).flat_map(|i| rays(&mut random, i, 8)).map(|mut ray| world.closest(&mut ray)).collect();
    let last = hits.iter().filter(|hit| hit.is_some() && u64::from(hit.shape) >= shapes * 2 / 3).count();
    assert_eq!(last, 0, "of {}", hits.len());
}

/// A wavy square of 1,152 triangles.
fn large_mesh() -> AnyShape {
    const SIDE: u32 = 24;
    let corner = |i: u32| Vec2::new((i % (SIDE + 1)) as f32, (i / (SIDE + 1)) as f32) / SIDE as f32 - 0.5;
    let position = |at: Vec2| Vec3::new(20.0 * at.x, 60.0 * at.x * at.y, 20.0 * at.y);
    let square = |i: u32| {
        let first = i % SIDE + i / SIDE * (SIDE + 1);
        [[first, first + SIDE + 1, first + 1], [first + 1, first + SIDE + 1, first + SIDE + 2]]
    };
    let positions = (0..(SIDE + 1).pow(2)).map(corner).map(position).collect();
    let triangles = (0..SIDE * SIDE).flat_map(square).collect();
    let mut mesh = AnyShape::from(Mesh::from(MeshData { positions, triangles, ..MeshData::default() }));
    mesh.prepare().unwrap();
    mesh
}

/// A few large meshes are beside the hierarchy, many are in it; two coincident meshes tie
/// everywhere.
#[test]
fn large_meshes_equal_brute_force() {
    let mut random = Random::new(23);
    let mesh = large_mesh();
    for (count, beside) in [(2, 3), (3, 4), (6, 0)] {
        let mut objects = crowd(&mut random, 1, Some(MaterialId(0)));
        for _ in 0..count {
            objects.insert(objects.len() / 2, Object::new(mesh.clone(), random.transform(), MaterialId(1)));
        }
        objects.push(objects[objects.len() / 2].clone());
        let world = world_of(objects);
        assert_eq!(world.top.large_meshes.len(), beside);
        equals_brute_force(&world, 200);
    }
}

/// Indices and materials are equal, distances and surfaces up to the rounding of transforms.
#[test]
fn instanced_world_equals_the_expanded_world() {
    let mut random = Random::new(20);
    let world = nested(&mut random);
    let flat = world_of(expanded_at(&world.top.objects, &Transform::IDENTITY, None, 0.0));
    assert_eq!(
        (flat.geometry_stats().shapes, flat.geometry_stats().triangles),
        (world.geometry_stats().shapes, world.geometry_stats().triangles)
    );
    assert_eq!((flat.geometry_stats().instances, world.geometry_stats().instances), (0, 3 * 6 + 4 + 2));
    let (mut same, mut hit_count) = (0, 0);
    for round in 0..400 {
        for ray in rays(&mut random, round, 8) {
            let (hit, other) = (world.closest(&mut ray.clone()), flat.closest(&mut ray.clone()));
            hit_count += usize::from(hit.is_some());
            if !hit.is_some() || hit.shape != other.shape || hit.hit.primitive != other.hit.primitive {
                continue;
            }
            let (vertex, other) = (world.vertex(&ray, &hit), flat.vertex(&ray, &other));
            assert_eq!((vertex.material, vertex.shape), (other.material, other.shape));
            let distance = (vertex.surface.point - other.surface.point).length();
            assert!(distance <= 0.02, "{distance}, round {round}");
            assert!(vertex.surface.normal.dot(other.surface.normal) > 0.999, "round {round}");
            same += 1;
        }
    }
    assert!(hit_count > 1000 && same * 1000 >= hit_count * 999, "{same} of {hit_count} the same");
}

/// A ray that leaves a surface inside two instances does not hit that surface again.
#[test]
fn rays_leave_nested_surfaces() {
    let mut random = Random::new(21);
    let world = nested(&mut random);
    let mut left = 0;
    for round in 0..200 {
        for ray in rays(&mut random, round, 8) {
            let hit = world.closest(&mut ray.clone());
            if !hit.is_some() {
                continue;
            }
            let surface = world.vertex(&ray, &hit).surface;
            // Leave along the normal, so that no other part of the same shape blocks the ray.
            let side = if surface.normal.dot(ray.direction) < 0.0 { surface.normal } else { -surface.normal };
            let again = world.closest(&mut surface.spawn_ray(side, 0.0).with_t_max(1e-3));
            assert!(
                again.shape != hit.shape || again.hit.primitive != hit.hit.primitive,
                "round {round}: {hit:?} {again:?}"
            );
            left += 1;
        }
    }
    assert!(left > 300, "{left}");
}

/// A billion spheres in the memory of three thousand objects.
#[test]
fn shared_geometry_is_stored_once() {
    let sphere = Arc::new({
        let mut sphere = AnyShape::from(Sphere { radius: 0.4 });
        sphere.prepare().unwrap();
        sphere
    });
    let mut content = Content::Shape(sphere);
    let mut step = 1.0;
    for _ in 0..3 {
        let place = |i: u16| Transform::translation(Vec3::new(f32::from(i % 32), 0.0, f32::from(i / 32)) * step);
        let object = |i| Object { content: content.clone(), motion: place(i).into(), material: None, attributes: None };
        content =
            Content::Geometry(Arc::new(Geometry::new((0..1024).map(object).collect(), &BuildControl::new()).unwrap()));
        step *= 32.0;
    }
    let world = world_of(vec![Object {
        content,
        motion: Transform::IDENTITY.into(),
        material: Some(MaterialId(0)),
        attributes: None,
    }]);
    let stats = world.geometry_stats();
    assert_eq!((stats.shapes, stats.instances), (1 << 30, 1 + 1024 + (1 << 20)));
    assert!(stats.geometry_bytes + stats.bvh_bytes < 1 << 21, "{stats:?}");
    let mut random = Random::new(22);
    for _ in 0..200 {
        let (x, z) = (random.below(1 << 15), random.below(1 << 15));
        let mut ray = Ray::new(Vec3::new(x as f32 + 0.25, 5.0, z as f32), -Vec3::Y);
        let vertex = world.vertex(&ray.clone(), &world.closest(&mut ray));
        // Columns and rows of the three levels, five bits each.
        let number =
            (0..3).map(|level| ((z >> (5 * level) & 31) << 5 | x >> (5 * level) & 31) << (10 * level)).sum::<usize>();
        assert_eq!((vertex.shape, vertex.material), (number as u32, MaterialId(0)));
        assert!((vertex.surface.normal.x - 0.625).abs() < 1e-3 * x.max(1) as f32 / 32.0, "{vertex:?}");
    }
}

#[test]
fn empty_world_has_only_its_background() {
    let world = world(Vec::new(), MaterialTable::default(), Rgb::WHITE);
    let mut ray = Ray::new(Vec3::ZERO, Vec3::Z);
    assert!(!world.closest(&mut ray).is_some());
    assert_eq!(world.background_radiance(&ray), Rgb::WHITE);
    assert!(world.bounds().is_empty());
}

/// A world of one object, plain or with a material that asks for surface coordinates.
pub fn world_with(shape: AnyShape, transform: Transform, textured: bool) -> World {
    let mut compiler = MaterialCompiler::new(TextureTable::default(), []);
    let recipe = if textured { MaterialRef::from(Checkerboard::default()) } else { MaterialRef::default() };
    let material = compiler.material("material", &recipe).unwrap();
    let objects = vec![Object::new(shape, transform, material)];
    world(objects, compiler.finish().unwrap(), Rgb::BLACK)
}
