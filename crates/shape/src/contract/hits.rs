//! Intersections of rays and shapes.

use super::*;
use crate::Hit;
use crate::testing::distance;

const EPSILON: f64 = f32::EPSILON as f64;

/// Rays at a shape from near, from far and from inside its bounding sphere, with directions of
/// several lengths.
fn rays(shape: &AnyShape, seed: u64) -> impl Iterator<Item = Ray> {
    let (shape, bounding_sphere, mut random) = (shape.clone(), bounding_sphere(shape), Random::new(seed));
    (0..600).map(move |i| {
        let ray = line(&mut random, bounding_sphere, [2.0, 0.0, 30.0, 1000.0][i % 4]);
        // Aim half of the rays, since random ones hardly hit thin shapes.
        let aim = shape.sample(ray.origin, random.vec2()).filter(|_| i % 2 == 0);
        let direction = aim.map_or(ray.direction, |sample| (sample.point - ray.origin).normalize());
        Ray { direction: direction * [1.0, 0.01, 300.0][i % 3], ..ray }
    })
}

fn for_every_hit(seed: u64, mut check: impl FnMut(&AnyShape, &Ray, Hit)) {
    for shape in shapes() {
        let mut count = 0;
        for ray in rays(&shape, seed) {
            if let Some(hit) = shape.intersect(&ray) {
                count += 1;
                check(&shape, &ray, hit);
            }
        }
        assert!(count > 0, "nothing hits {shape:?}");
    }
}

#[test]
fn hits_lie_on_the_surface_within_the_stated_error_and_the_bounds() {
    for_every_hit(1, |shape, ray, hit| {
        let surface = shape.surface(ray, &hit);
        let off = distance(shape, surface.point.as_dvec3());
        // Rounding may also move a point of a flat part beyond its rim.
        let (center, radius) = bounding_sphere(shape);
        let rim = EPSILON * f64::from(surface.point.length().max(center.length() + radius));
        assert!(off <= f64::from(surface.position_error) + rim, "{shape:?} {ray:?}: {off} {}", surface.position_error);
        assert!(shape.bounds().contains(surface.point), "{shape:?} {ray:?}: {}", surface.point);
        let traveled = f64::from(ray.origin.length() + ray.direction.length() * hit.t);
        // The triangle test of meshes rounds in f32; at a grazing angle, that is much along the
        // ray.
        let slant = f64::from(ray.direction.normalize().dot(surface.normal)).abs();
        let slack = if shape.triangles() > 0 { 4.0 * f64::from(surface.position_error) / slant } else { 0.0 };
        let difference = at(ray, hit.t).distance(surface.point.as_dvec3());
        assert!(difference <= 4.0 * EPSILON * traveled + slack, "{shape:?} {ray:?}: {difference}, slant {slant}");
    });
}

#[test]
fn t_min_and_t_max_are_exact_and_inclusive() {
    for_every_hit(2, |shape, ray, hit| {
        assert_eq!(shape.intersect(&ray.with_t_max(hit.t)), Some(hit), "{shape:?} {ray:?}");
        assert_eq!(shape.intersect(&ray.with_t_max(hit.t.next_down())), None, "{shape:?} {ray:?}");
        let from_hit = Ray { t_min: hit.t, ..*ray };
        assert_eq!(shape.intersect(&from_hit), Some(hit), "{shape:?} {ray:?}");
        if let Some(second) = shape.intersect(&Ray { t_min: hit.t.next_up(), ..*ray }) {
            assert!(second.t > hit.t);
            assert!(!is_flat(shape), "{shape:?} {ray:?}");
            let off = distance(shape, shape.surface(ray, &second).point.as_dvec3());
            assert!(off <= 1e-5 * f64::from(bounding_sphere(shape).1), "{shape:?} {ray:?}: {off}");
        }
    });
}

#[test]
fn occlusion_agrees_with_intersection() {
    for shape in shapes() {
        for ray in rays(&shape, 3) {
            let hit = shape.intersect(&ray);
            assert_eq!(shape.occludes(&ray), hit.is_some(), "{shape:?} {ray:?}");
            if let Some(hit) = hit {
                assert!(shape.occludes(&ray.with_t_max(hit.t)) && !shape.occludes(&ray.with_t_max(hit.t.next_down())));
            }
        }
    }
}

#[test]
fn distances_are_in_units_of_the_direction() {
    for_every_hit(4, |shape, ray, hit| {
        let longer = Ray { direction: ray.direction * 10.0, ..*ray };
        // Rounding changes the longer direction a little: tangent rays may miss.
        let Some(scaled) = shape.intersect(&longer) else { return };
        let surface = shape.surface(ray, &hit);
        let slant = ray.direction.normalize().dot(surface.normal).abs();
        if slant > 0.05 && scaled.primitive == hit.primitive {
            let size = (ray.origin.length() + bounding_sphere(shape).1) / ray.direction.length();
            assert!((scaled.t * 10.0 - hit.t).abs() <= 1e-5 * size, "{shape:?} {ray:?} {hit:?} {scaled:?}");
        }
    });
}

#[test]
fn convex_shapes_are_hit_twice_and_flat_shapes_once() {
    for shape in shapes() {
        for ray in rays(&shape, 5) {
            let hits = all_hits(&shape, &ray);
            let most = if is_flat(&shape) {
                1
            } else if is_solid(&shape) {
                2
            } else {
                1000
            };
            assert!(hits.len() <= most, "{shape:?} {ray:?} {hits:?}");
        }
    }
}

#[test]
fn normals_have_unit_length_and_are_perpendicular_to_the_surface() {
    for_every_hit(6, |shape, ray, hit| {
        let surface = shape.surface(ray, &hit);
        assert!((surface.normal.length() - 1.0).abs() < 1e-6 && (surface.shading_normal.length() - 1.0).abs() < 1e-6);
        assert!(surface.normal.dot(surface.shading_normal) >= 0.0, "{shape:?} {ray:?}");
        assert!(surface.uv.is_finite() && surface.local == surface.point);
        let direction = ray.direction.normalize();
        let aside = direction.any_orthonormal_vector() * (1e-2 * bounding_sphere(shape).1);
        let beside = Ray { origin: ray.origin + aside, ..*ray };
        let Some(other) = shape.intersect(&beside).filter(|other| other.primitive == hit.primitive) else { return };
        let other = shape.surface(&beside, &other);
        let chord = (other.point - surface.point).as_dvec3();
        // The chord between both points is orthogonal to the mean normal, exactly so on spheres and
        // planes.
        let mean = (surface.normal + other.normal).as_dvec3();
        let rounding = 8.0 * EPSILON * f64::from(surface.point.length() + bounding_sphere(shape).1);
        let tilt = chord.dot(mean).abs();
        assert!(tilt <= 1e-5 * chord.length() + rounding, "{shape:?} {ray:?}: {tilt}");
    });
}

/// Any line crosses a solid an even number of times from just outside, and an odd number of times
/// from just inside.
#[test]
fn normals_point_out_of_solids() {
    let mut random = Random::new(7);
    for shape in shapes().into_iter().filter(is_solid) {
        let mut wrong = 0;
        for ray in rays(&shape, 8) {
            let Some(hit) = shape.intersect(&ray) else { continue };
            let surface = shape.surface(&ray, &hit);
            for side in [1.0, -1.0] {
                let out = surface.spawn_ray(surface.normal * side, 0.0);
                let probe = Ray { direction: random.unit_vector(), ..out };
                let odd = all_hits(&shape, &probe).len() % 2 == 1;
                wrong += usize::from(odd != (side < 0.0));
            }
        }
        // A random line may also hit an edge of a mesh, where it crosses two triangles at once.
        assert!(wrong <= if shape.triangles() > 0 { 2 } else { 0 }, "{shape:?}: {wrong}");
    }
}
