//! Coarse meshes with smooth normals: light ends where the smooth surface turns away from it, not at
//! the edges of triangles (Hanika, Ray Tracing Gems II, chapter 4).

use crate::probe::{Scene, looking, measure, path};
use juggler_math::testing::{Random, family_wise_deviations};
use juggler_math::{Ray, Vec3};
use std::f64::consts::PI;

/// Sphere of 48 triangles, six around and from pole to pole five rings, with the normals of a sphere.
fn coarse_sphere() -> String {
    let (around, rings) = (6u32, 5u32);
    let mut points = vec![Vec3::Y, Vec3::NEG_Y];
    for ring in 1..rings {
        for i in 0..around {
            let (polar, turn) = (ring as f32 / rings as f32 * std::f32::consts::PI, i as f32 / around as f32);
            let (sin, cos) = (turn * std::f32::consts::TAU).sin_cos();
            points.push(Vec3::new(polar.sin() * cos, polar.cos(), polar.sin() * sin));
        }
    }
    let at = |ring: u32, i: u32| 2 + (ring - 1) * around + i % around;
    let mut triangles = vec![];
    for i in 0..around {
        triangles.push([0, at(1, i + 1), at(1, i)]);
        triangles.push([1, at(rings - 1, i), at(rings - 1, i + 1)]);
        for ring in 1..rings - 1 {
            triangles.push([at(ring, i), at(ring, i + 1), at(ring + 1, i)]);
            triangles.push([at(ring, i + 1), at(ring + 1, i + 1), at(ring + 1, i)]);
        }
    }
    let points: Vec<[f32; 3]> = points.iter().map(Vec3::to_array).collect();
    format!(r#"{{"mesh": {{"positions": {points:?}, "normals": {points:?}, "triangles": {triangles:?}}}}}"#)
}

fn white_sphere() -> Scene {
    Scene::new().with(&coarse_sphere(), Vec3::ZERO, r#"{"diffuse": {"reflectance": 1}}"#)
}

/// Points of the sphere that a camera in the direction of `eye` sees well.
fn targets(eye: Vec3, count: usize) -> Vec<Vec3> {
    let (mut random, across) = (Random::new(63), eye.cross(Vec3::Y).normalize());
    let up = across.cross(eye).normalize();
    (0..count).map(|_| across * random.range(-0.7, 0.7) + up * random.range(-0.5, 0.5)).collect()
}

/// Closed form: E / π times the cosine to the interpolated normal, up to the terminator.
#[test]
fn light_of_a_coarse_sphere_ends_where_the_smooth_one_turns_away() {
    let light = Vec3::new(1.0, 0.3, -0.1).normalize();
    let direction = crate::probe::json(-light);
    let world = white_sphere().lit(&format!(r#"{{"directional": {{"direction": {direction}}}}}"#)).world();
    let (eye, integrator, mut checked) = (Vec3::Z * 5.0, path(r#""max_depth": 2"#), 0);
    for target in targets(Vec3::Z, 150) {
        let mut ray = Ray::new(target + eye, Vec3::NEG_Z);
        let hit = world.closest(&mut ray);
        let normal = world.vertex(&ray, &hit).surface.shading_normal;
        let cos = f64::from(normal.dot(light));
        if cos.abs() < 0.03 {
            continue;
        }
        let seen = measure(&world, &looking(target + eye, target), &*integrator, 1).mean;
        let expected = cos.max(0.0) / PI;
        assert!((seen - expected).abs() < 0.002, "{target}, cosine {cos}: {seen}, expected {expected}");
        checked += i32::from(cos < 0.5);
    }
    assert!(checked > 30, "{checked}");
}

/// Directions below a triangle that are above the smooth surface keep their light.
#[test]
fn a_white_coarse_sphere_vanishes_in_a_furnace() {
    let world = white_sphere().in_light(1.0).world();
    let seen = targets(Vec3::Z, 40).into_iter().map(|target| {
        let camera = looking(target + Vec3::Z * 5.0, target);
        measure(&world, &camera, &*path(r#""max_depth": 1000, "roulette_depth": null"#), 16).mean
    });
    let mean = seen.sum::<f64>() / 40.0;
    assert!((mean - 1.0).abs() < 0.002, "{mean}");
}

/// Light samples and BSDF samples leave from the same point, also close to an emitter and where a
/// floor hides the smooth surface.
#[test]
fn sampling_options_agree_on_a_coarse_sphere() {
    let scene = || {
        let coarse_sphere =
            white_sphere().with(r#"{"plane": {}}"#, Vec3::NEG_Y * 0.97, r#"{"diffuse": {"reflectance": 0.5}}"#);
        coarse_sphere
            .with(r#"{"sphere": {"radius": 0.4}}"#, Vec3::new(1.3, 0.1, 0.6), r#"{"emissive": {"radiance": 4}}"#)
            .in_light(0.3)
    };
    let world = scene().world();
    let points = [Vec3::new(0.35, 0.1, 0.0), Vec3::new(0.6, -0.3, 0.0), Vec3::new(0.2, -0.85, 0.0)];
    for target in points {
        let camera = looking(target + Vec3::Z * 5.0, target);
        let seen = |sampling: &str, samples| {
            let options = format!(r#""max_depth": 8, "roulette_depth": null, "sampling": "{sampling}""#);
            measure(&world, &camera, &*path(&options), samples)
        };
        let [mis, light, bsdf] = [seen("mis", 128), seen("light", 256), seen("bsdf", 512)];
        println!("{target}: {mis:?} {light:?} {bsdf:?}");
        mis.equals_within(light, family_wise_deviations(6), &format!("{target}, light"));
        mis.equals_within(bsdf, family_wise_deviations(6), &format!("{target}, bsdf"));
    }
}
