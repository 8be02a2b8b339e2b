//! Ray queries while objects move.

use super::{crowd, equals_brute_force, expanded_at, grove, large_mesh, rays, world_of};
use crate::*;
use juggler_math::testing::Random;
use juggler_math::{Motion, Transform, Vec3};
use juggler_shape::{AnyShape, Cuboid, Sphere};
use std::sync::Arc;

/// A world of moving objects and moving instances of them, with translation, rotation and scaling.
fn in_motion(random: &mut Random) -> World {
    let mut moving = |mut objects: Vec<Object>| -> Vec<Object> {
        for object in objects.iter_mut().filter(|object| object.is_bounded()) {
            let start = object.motion.at(0.0);
            let keys = (0..5).scan(start, |at, _| {
                *at = at.then(&random.rotation()).then(&Transform::translation(random.point(4.0)));
                Some(*at)
            });
            let (keys, size) = (keys.collect(), object.bounds().extent().length());
            object.motion = Motion::from_keys(keys).unwrap().smoothed(size);
        }
        objects
    };
    let mut objects = moving(crowd(&mut Random::new(41), 2, Some(MaterialId(0))));
    let geometry =
        Arc::new(Geometry::new(moving(crowd(&mut Random::new(42), 1, None)), &BuildControl::default()).unwrap());
    let instance = Object {
        content: Content::Geometry(geometry),
        motion: Transform::IDENTITY.into(),
        material: None,
        attributes: None,
    };
    objects.extend(moving(vec![instance.clone(), instance.clone(), instance]));
    objects.extend(crowd(&mut Random::new(43), 1, Some(MaterialId(2))));
    objects.extend(moving(vec![Object::new(large_mesh(), Transform::IDENTITY, MaterialId(1))]));
    world_of(objects)
}

#[test]
fn moving_objects_equal_brute_force_at_every_time() {
    let world = in_motion(&mut Random::new(40));
    assert!(world.moves() && !grove(&mut Random::new(24)).moves());
    equals_brute_force(&world, 300);
}

/// A hit on a moving object has the position of a hit on the object frozen at the ray's time.
#[test]
fn rays_hit_moving_objects_where_they_are_at_the_time_of_the_ray() {
    let mut random = Random::new(44);
    let world = in_motion(&mut Random::new(40));
    for round in 0..60 {
        let time = random.f32();
        let frozen = expanded_at(&world.top.objects, &Transform::IDENTITY, None, time);
        let still = world_of(frozen);
        assert!(!still.moves());
        for mut ray in rays(&mut random, round, 8).into_iter().map(|ray| Ray { time, ..ray }) {
            let (mut again, far) = (ray, 1e-3);
            let (moving, standing) = (world.closest(&mut ray), still.closest(&mut again));
            if moving.is_some() && standing.is_some() && (moving.hit.t - standing.hit.t).abs() < far {
                let (a, b) = (world.vertex(&ray, &moving).surface, still.vertex(&again, &standing).surface);
                assert!(a.point.distance(b.point) < 0.01, "{a:?} {b:?}");
            } else {
                // Only at silhouette edges may one ray hit what the other misses.
                let edge = |world: &World, hit: &WorldHit, ray: &Ray| {
                    hit.is_some() && world.vertex(ray, hit).surface.normal.dot(ray.direction).abs() > 0.3
                };
                let both = edge(&world, &moving, &ray) && edge(&still, &standing, &again);
                assert!(!both, "{moving:?} {standing:?}");
            }
        }
    }
}

/// Objects that move far on curves have several entries in the hierarchy, with the same hits.
#[test]
fn objects_on_long_curves_equal_brute_force_in_all_segments_of_time() {
    let mut random = Random::new(45);
    let mut turning = |shape: AnyShape| {
        let mut shape = shape;
        shape.prepare().unwrap();
        let arm = Motion::from(Transform::translation(Vec3::X * 20.0 + random.point(20.0)));
        let start = 6.0 * random.f32();
        let keys = (0..65).map(|i| Transform::rotation(Vec3::Z, start + 0.2 * i as f32).unwrap()).collect();
        Object::new(shape, arm.then(&Motion::from_keys(keys).unwrap()).smoothed(0.5), MaterialId(0))
    };
    let cuboid = || Cuboid { min: Vec3::splat(-2.5), max: Vec3::splat(2.5) };
    let mut objects: Vec<Object> =
        (0..40).flat_map(|_| [turning(Sphere { radius: 3.5 }.into()), turning(cuboid().into())]).collect();
    let below = Arc::new(
        Geometry::new(vec![turning(Sphere { radius: 0.2 }.into()), turning(cuboid().into())], &BuildControl::default())
            .unwrap(),
    );
    let motion = turning(Sphere { radius: 1.0 }.into()).motion;
    objects.push(Object { content: Content::Geometry(below), motion, material: Some(MaterialId(1)), attributes: None });
    let world = world_of(objects);
    assert!(world.top.items.len() > 4 * world.top.objects.len(), "{}", world.top.items.len());
    equals_brute_force(&world, 300);
}
