//! Rays that leave a surface must not hit it again at their origin, at any scale and position.

use super::*;
use crate::Hit;
use crate::surface::Surface;
use juggler_math::Transform;

/// Transforms with uniform and nonuniform scales, rotations, and translations by up to some hundred
/// times the size.
fn transforms(shape: &AnyShape, random: &mut Random) -> Vec<Transform> {
    let mut transforms = vec![Transform::IDENTITY];
    for scale in [1e-4, 1.0, 1e6] {
        for (scale_y, far) in [(1.0, 0.0), (3.0, 5.0), (20.0, 300.0)] {
            let even = Transform::scale(Vec3::new(1.0, scale_y, 1.0) * scale).unwrap();
            let offset = Transform::translation(random.unit_vector() * (far * scale * bounding_sphere(shape).1));
            transforms.push(random.rotation().then(&even).then(&random.rotation()).then(&offset));
        }
    }
    transforms
}

/// Surface in world space where a ray from near or far hits.
fn hit_surface(shape: &AnyShape, transform: &Transform, random: &mut Random) -> Option<(Hit, Surface)> {
    let away = [0.5, 3.0, 1e4][random.below(3)];
    let local = line(random, bounding_sphere(shape), away);
    let aim = shape.sample(local.origin, random.vec2()).map_or(local.direction, |sample| sample.point - local.origin);
    let world = Ray::new(transform.point(local.origin), transform.vector(aim).normalize());
    let ray = transform.ray_to_local(&world);
    let hit = shape.intersect(&ray)?;
    Some((hit, shape.surface(&ray, &hit).to_world(transform)))
}

/// Direction on one side of a surface, not grazing.
fn leaving_direction(random: &mut Random, normal: Vec3, side: f32) -> Vec3 {
    loop {
        let direction = random.unit_vector();
        let cosine = direction.dot(normal);
        if cosine.abs() > 1e-2 {
            return direction * (side * cosine.signum());
        }
    }
}

#[test]
fn spawned_rays_do_not_hit_their_own_surface() {
    let mut random = Random::new(14);
    for shape in shapes() {
        for transform in transforms(&shape, &mut random) {
            let (mut count, mut lost) = (0, 0);
            for _ in 0..60 {
                let Some((hit, surface)) = hit_surface(&shape, &transform, &mut random) else { continue };
                count += 1;
                for side in [1.0, -1.0] {
                    let direction = leaving_direction(&mut random, surface.normal, side);
                    let ray = transform.ray_to_local(&surface.spawn_ray(direction, 0.0));
                    let Some(again) = shape.intersect(&ray) else {
                        lost += usize::from(side < 0.0 && is_solid(&shape) && shape.bounds().is_finite());
                        continue;
                    };
                    let fine = is_another_point(&shape, &ray, &hit, side, again);
                    assert!(fine, "{shape:?} {transform:?} {surface:?} {direction}: {again:?}");
                }
            }
            // Near an edge, a step inwards may lead out of the adjacent face.
            assert!(count > 0 && lost <= 2, "{shape:?} {transform:?}: {count} hits, {lost} do not come out again");
        }
    }
}

/// Whether a ray that leaves hits another place: outside of a solid it next enters, inside it next
/// leaves. It does not hit flat shapes again.
fn is_another_point(shape: &AnyShape, ray: &Ray, before: &Hit, side: f32, hit: Hit) -> bool {
    if is_flat(shape) || side > 0.0 && is_convex(shape) {
        return false;
    }
    if shape.triangles() > 0 {
        return hit.primitive != before.primitive;
    }
    // A hit from the other side is another place.
    shape.surface(ray, &hit).normal.dot(ray.direction) * side < 0.0
}

#[test]
fn ray_origin_offsets_are_small_relative_to_shape_and_position() {
    let mut random = Random::new(15);
    for shape in shapes() {
        for transform in transforms(&shape, &mut random) {
            let (center, radius) = bounding_sphere(&shape);
            let place = transform.point(center).length() + transform.max_scale() * (radius + center.length());
            for _ in 0..20 {
                let Some((_, surface)) = hit_surface(&shape, &transform, &mut random) else { continue };
                let start = surface.spawn_ray(surface.normal, 0.0).origin;
                let moved = start.distance(surface.point);
                // Far away on an unbounded shape, only the distance of the point counts.
                let place = place.max(surface.point.length());
                assert!(start != surface.point && moved < 1e-5 * place, "{shape:?} {transform:?} {surface:?}: {moved}");
            }
        }
    }
}
