//! Very large, very small and very distant spheres; coordinates at the limits of floats.

use super::*;
use crate::{Plane, Sphere, SurfacePoint, Tube, intersect_sphere, sphere_surface};
use juggler_math::Vec2;

/// Seen from just above a sphere of a million units, distances must grow smoothly towards the
/// horizon: arithmetic in `f32` has steps of hundreds of units there.
#[test]
fn a_huge_sphere_shows_no_bands_from_close_by() {
    let (radius, height) = (1e6f32, 2.0f32);
    let sphere = Sphere { radius };
    let origin = Vec3::new(0.0, radius + height, 0.0);
    let horizon = (2.0 * f64::from(radius * height)).sqrt();
    let steps = 20_000;
    let mut before = 0.0;
    for i in 1..steps {
        // Sample distances over ground uniformly, up to just before the horizon.
        let ground = 0.999 * horizon * f64::from(i) / f64::from(steps);
        let (x, drop) = (ground, f64::from(height) + ground * ground / (2.0 * f64::from(radius)));
        let ray = Ray::new(origin, DVec3::new(x, -drop, 0.0).normalize().as_vec3());
        let hit = sphere.intersect(&ray).unwrap_or_else(|| panic!("no hit at {ground}"));
        let expected = x.hypot(drop);
        // Rounding of the direction moves the point, more so at grazing angles.
        let sensitivity = 1.0 / (1.0 - ground / horizon);
        assert!(
            (f64::from(hit.t) - expected).abs() < 4e-7 * expected * expected * sensitivity / f64::from(height),
            "{ground}: {} {expected}",
            hit.t
        );
        assert!(f64::from(hit.t) > before - 1e-5 * expected * sensitivity, "{ground}");
        before = f64::from(hit.t);
    }
    let outwards = (0..1000).map(|i| Vec3::new(i as f32, 1.0, 0.0));
    assert!(outwards.clone().all(|direction| sphere.intersect(&Ray::new(origin, direction)).is_none()));
    let inside = Vec3::new(0.0, radius - height, 0.0);
    assert!(outwards.clone().all(|direction| sphere.intersect(&Ray::new(inside, direction)).is_some()));
    assert!(outwards.clone().all(|direction| sphere.intersect(&Ray::new(inside, -direction)).is_some()));
}

/// From a million radii away, the silhouette is sharp and points are accurate.
#[test]
fn a_far_sphere_keeps_its_silhouette() {
    let mut random = Random::new(16);
    let center = Vec3::new(3e5, -2e5, 5e5);
    for _ in 0..5_000 {
        let direction = center - random.unit_vector().cross(center.normalize()) * random.range(0.0, 1.5);
        let ray = Ray::new(Vec3::new(-3e5, 3e5, -4e5), direction.as_dvec3().normalize().as_vec3());
        let ray = Ray { direction: (direction - ray.origin).normalize(), ..ray };
        // Distance of the center from the line along the rounded direction, in f64.
        let (to, along) = ((center - ray.origin).as_dvec3(), ray.direction.as_dvec3());
        let foot = to - along * (to.dot(along) / along.length_squared());
        let miss = foot.length();
        let hit = intersect_sphere(center, 1.0, &ray);
        if (miss - 1.0).abs() > 1e-6 {
            assert_eq!(hit.is_some(), miss < 1.0, "{miss}");
        }
        let Some(hit) = hit else { continue };
        let surface = sphere_surface(center, 1.0, &ray, &hit);
        let expected = -foot - along.normalize() * (1.0 - miss * miss).max(0.0).sqrt();
        assert!(
            miss > 0.9999 || (surface.normal.as_dvec3() - expected).length() < 1e-6,
            "{} {expected}",
            surface.normal
        );
        assert!((surface.local.length() - 1.0).abs() < 1e-6);
    }
}

/// Intersections in world space and in object space use the same arithmetic.
#[test]
fn spheres_in_world_space_agree_with_those_in_object_space() {
    let mut random = Random::new(17);
    let mut hits = 0;
    for _ in 0..5_000 {
        let (center, sphere) = (random.point(8.0).floor(), Sphere { radius: random.range(0.5, 4.0) });
        let local = Ray::new(random.point(4.0), random.unit_vector());
        // Multiples of a quarter keep the sum exact.
        let origin = (local.origin * 4.0).round() * 0.25;
        let (local, world) = (Ray { origin, ..local }, Ray { origin: origin + center, ..local });
        let hit = sphere.intersect(&local);
        assert_eq!(hit, intersect_sphere(center, sphere.radius, &world));
        hits += usize::from(hit.is_some());
    }
    assert!(hits > 1_000);
}

/// Rays at the limits of floats miss or hit finite points: no infinity, no NaN.
#[test]
fn rays_with_extreme_coordinates_give_finite_hits() {
    let extremes = [0.0, -0.0, 1e-45, 1e-38, -1e-20, 1.0, -1e20, 1e37, 3e38];
    let pick = |random: &mut Random| Vec3::from_array(std::array::from_fn(|_| extremes[random.below(extremes.len())]));
    let mut random = Random::new(18);
    let mut all = shapes();
    all.extend([
        Sphere { radius: 1e18 }.into(),
        Sphere { radius: 1e-18 }.into(),
        Tube { radius: 1e-18 }.into(),
        Plane {}.into(),
    ]);
    for shape in all.iter_mut() {
        shape.prepare().unwrap();
        for _ in 0..2_000 {
            let ray = Ray::new(pick(&mut random), pick(&mut random));
            if ray.direction == Vec3::ZERO {
                continue;
            }
            if let Some(hit) = shape.intersect(&ray) {
                let surface = shape.surface(&ray, &hit);
                let at = SurfacePoint { point: surface.point, normal: surface.normal, primitive: hit.primitive };
                assert!(shape.pdf(ray.origin, &at) >= 0.0, "{shape:?} {ray:?} {hit:?}");
                assert!(
                    hit.t.is_finite() && surface.point.is_finite() && surface.normal.is_finite(),
                    "{shape:?} {ray:?} {hit:?} {surface:?}"
                );
                assert!(
                    surface.uv.is_finite() && surface.position_error.is_finite(),
                    "{shape:?} {ray:?} {hit:?} {surface:?}"
                );
            }
            let _ = shape.sample(ray.origin, random.vec2());
        }
    }
}

/// Surface coordinates at known points.
#[test]
fn uv_coordinates_match_the_documentation() {
    let uv = |json: &str, from: [f32; 3], to: [f32; 3]| {
        let mut shape: AnyShape = serde_json::from_str(json).unwrap();
        shape.prepare().unwrap();
        let ray = Ray::new(from.into(), Vec3::from(to) - Vec3::from(from));
        shape.surface(&ray, &shape.intersect(&ray).unwrap()).uv
    };
    let known = [
        (r#"{"sphere": {}}"#, [9.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.5]),
        (r#"{"sphere": {}}"#, [0.0, 0.0, -9.0], [0.0, 0.0, 0.0], [0.25, 0.5]),
        (r#"{"sphere": {}}"#, [0.0, 9.0, 0.0], [0.0, 0.0, 0.0], [0.0, 1.0]),
        (r#"{"plane": {}}"#, [3.0, 9.0, 4.0], [3.0, 0.0, 4.0], [3.0, 4.0]),
        (r#"{"rectangle": {"size": [2, 4]}}"#, [1.0, 9.0, -2.0], [1.0, 0.0, -2.0], [1.0, 1.0]),
        (r#"{"disk": {"inner_radius": 0.5}}"#, [-0.75, 9.0, 0.0], [-0.75, 0.0, 0.0], [0.5, 0.5]),
        (r#"{"cylinder": {}}"#, [0.0, 0.5, 9.0], [0.0, 0.5, 0.0], [0.75, 0.75]),
        (r#"{"cylinder": {}}"#, [0.5, 9.0, 0.0], [0.5, 0.0, 0.0], [0.0, 0.5]),
        (r#"{"tube": {}}"#, [9.0, 7.0, 0.0], [0.0, 7.0, 0.0], [0.0, 7.0]),
        (r#"{"cuboid": {}}"#, [9.0, 0.25, 0.25], [0.0, 0.25, 0.25], [0.25, 0.75]),
        (r#"{"cuboid": {}}"#, [0.25, 9.0, 0.25], [0.25, 0.0, 0.25], [0.75, 0.25]),
        (
            r#"{"polygon": {"vertices": [[1, 1, 0], [3, 1, 0], [1, 4, 0]]}}"#,
            [1.5, 2.0, 9.0],
            [1.5, 2.0, 0.0],
            [0.5, 1.0],
        ),
        (
            r#"{"triangle": {"vertices": [[0, 0, 0], [4, 0, 0], [0, 4, 0]], "uvs": [[0, 0], [8, 0], [0, 2]]}}"#,
            [1.0, 2.0, 9.0],
            [1.0, 2.0, 0.0],
            [2.0, 1.0],
        ),
    ];
    for (json, from, to, expected) in known {
        let found = uv(json, from, to);
        assert!(found.distance(Vec2::from(expected)) < 1e-6, "{json} from {from:?}: {found}");
    }
}
