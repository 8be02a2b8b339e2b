//! Rays that start on a surface must not meet it again where they start, at any scale and in any place.

use super::*;
use crate::Hit;
use crate::surface::Surface;
use juggler_math::Transform;

/// Scaled evenly and unevenly, turned, and moved by up to some hundred times the size.
fn transforms(shape: &AnyShape, random: &mut Random) -> Vec<Transform> {
    let mut transforms = vec![Transform::IDENTITY];
    for scale in [1e-4, 1.0, 1e6] {
        for (stretch, far) in [(1.0, 0.0), (3.0, 5.0), (20.0, 300.0)] {
            let even = Transform::scale(Vec3::new(1.0, stretch, 1.0) * scale).unwrap();
            let offset = Transform::translation(random.unit_vector() * (far * scale * ball(shape).1));
            transforms.push(random.rotation().then(&even).then(&random.rotation()).then(&offset));
        }
    }
    transforms
}

/// A surface point in the world, met by a ray from near or far.
fn arrive(shape: &AnyShape, transform: &Transform, random: &mut Random) -> Option<(Hit, Surface)> {
    let away = [0.5, 3.0, 1e4][random.below(3)];
    let local = line(random, ball(shape), away);
    let aim = shape.sample(local.origin, random.vec2()).map_or(local.direction, |sample| sample.point - local.origin);
    let world = Ray::new(transform.point(local.origin), transform.vector(aim).normalize());
    let ray = transform.ray_to_local(&world);
    let hit = shape.intersect(&ray)?;
    Some((hit, shape.surface(&ray, &hit).to_world(transform)))
}

/// A direction to one side of a surface, not quite along it.
fn leave(random: &mut Random, normal: Vec3, side: f32) -> Vec3 {
    loop {
        let direction = random.unit_vector();
        let cosine = direction.dot(normal);
        if cosine.abs() > 1e-2 {
            return direction * (side * cosine.signum());
        }
    }
}

#[test]
fn follow_up_rays_are_free_of_their_surface() {
    let mut random = Random::new(14);
    for shape in shapes() {
        for transform in transforms(&shape, &mut random) {
            let (mut count, mut lost) = (0, 0);
            for _ in 0..60 {
                let Some((hit, surface)) = arrive(&shape, &transform, &mut random) else { continue };
                count += 1;
                for side in [1.0, -1.0] {
                    let direction = leave(&mut random, surface.normal, side);
                    let ray = transform.ray_to_local(&surface.spawn(direction, 0.0));
                    let Some(again) = shape.intersect(&ray) else {
                        lost += usize::from(side < 0.0 && is_solid(&shape) && shape.bounds().is_finite());
                        continue;
                    };
                    let fine = is_elsewhere(&shape, &ray, &hit, side, again);
                    assert!(fine, "{shape:?} {transform:?} {surface:?} {direction}: {again:?}");
                }
            }
            // Beside an edge, a step inwards may also lead out of the next face.
            assert!(count > 0 && lost <= 2, "{shape:?} {transform:?}: {count} hits, {lost} do not come out again");
        }
    }
}

/// Out of a solid one next comes in, inside it one next goes out. Flat shapes are not met again.
fn is_elsewhere(shape: &AnyShape, ray: &Ray, before: &Hit, side: f32, hit: Hit) -> bool {
    if is_flat(shape) || side > 0.0 && is_convex(shape) {
        return false;
    }
    if shape.triangles() > 0 {
        return hit.part != before.part;
    }
    // Met from the other side: not the same place again.
    shape.surface(ray, &hit).normal.dot(ray.direction) * side < 0.0
}

#[test]
fn offsets_stay_small_against_shape_and_place() {
    let mut random = Random::new(15);
    for shape in shapes() {
        for transform in transforms(&shape, &mut random) {
            let (center, radius) = ball(&shape);
            let place = transform.point(center).length() + transform.max_stretch() * (radius + center.length());
            for _ in 0..20 {
                let Some((_, surface)) = arrive(&shape, &transform, &mut random) else { continue };
                let start = surface.spawn(surface.normal, 0.0).origin;
                let moved = start.distance(surface.point);
                // Far away on a shape without end only its own place counts.
                let place = place.max(surface.point.length());
                assert!(start != surface.point && moved < 1e-5 * place, "{shape:?} {transform:?} {surface:?}: {moved}");
            }
        }
    }
}
