//! White furnaces of rough spheres: materials without energy loss are invisible from outside and,
//! if they transmit light, from inside, where radiance is n² times as large. `JUGGLER_FURNACES=all`
//! runs the whole grid: `check.sh deep furnaces`.

use crate::probe::{Estimate, Scene, is_deep, path, read, square};
use juggler_camera::AnyCamera;
use juggler_math::Vec3;
use juggler_math::testing::family_wise_deviations;
use rayon::prelude::*;

/// Tolerance of a mean.
const NEAR: f64 = 0.002;
/// Pixels of a picture of a sphere of radius 1 at the origin, which fills it.
fn sphere(material: &str, is_within: bool, edge: u32, samples: u32) -> Vec<f64> {
    sphere_by(if is_within { WITHIN } else { OUTSIDE }, Scene::new(), material, edge, samples)
}

/// A camera that sees nothing but the sphere.
const OUTSIDE: &str = r#"{"orthographic": {"eye": [2, 1, 4], "look_at": [0, 0, 0], "height": 1.41}}"#;

/// A camera inside the sphere.
pub const WITHIN: &str =
    r#"{"perspective": {"eye": [0.3, 0.2, 0.1], "look_at": [0.5, -0.1, 1], "vertical_fov_degrees": 100}}"#;

/// Pixels of a picture of that sphere by `camera`; the material may name textures of the scene.
pub fn sphere_by(camera: &str, scene: Scene, material: &str, edge: u32, samples: u32) -> Vec<f64> {
    picture(camera, scene.with(r#"{"sphere": {"radius": 1}}"#, Vec3::ZERO, material), edge, samples)
}

/// Pixels of a picture of a scene in white light.
fn picture(camera: &str, scene: Scene, edge: u32, samples: u32) -> Vec<f64> {
    let world = scene.in_light(1.0).world();
    // Light may be trapped for long; Russian roulette would only add noise.
    let integrator = path(r#""max_depth": 1000"#);
    square(&world, &read::<AnyCamera>(camera), &*integrator, edge, samples)
}

/// Rough glass.
#[derive(Clone, Copy, Debug)]
struct Glass {
    ior: f64,
    roughness: f64,
    anisotropy: f64,
    is_within: bool,
}

impl Glass {
    fn pixels(self, edge: u32, samples: u32) -> Vec<f64> {
        let Self { ior, roughness, anisotropy, is_within } = self;
        let material =
            format!(r#"{{"dielectric": {{"ior": {ior}, "roughness": {roughness}, "anisotropy": {anisotropy}}}}}"#);
        let scale = if is_within { ior * ior } else { 1.0 };
        sphere(&material, is_within, edge, samples).into_iter().map(|value| value / scale).collect()
    }
}

fn glasses() -> Vec<Glass> {
    let few = [(2.4, 0.15, 0.0), (2.4, 0.3, 0.0), (1.5, 0.6, 0.7), (1.1, 1.0, 0.0)];
    let mut all = vec![];
    for is_within in [false, true] {
        let of = |(ior, roughness, anisotropy)| Glass { ior, roughness, anisotropy, is_within };
        if !is_deep() {
            all.extend(few.map(of));
            continue;
        }
        for ior in [1.1, 1.2, 1.33, 1.5, 1.7, 2.0, 2.4] {
            for roughness in [0.05, 0.15, 0.3, 0.5, 0.7, 0.85, 1.0] {
                all.extend([0.0, 0.5, -1.0].map(|anisotropy| of((ior, roughness, anisotropy))));
            }
        }
    }
    all
}

/// Checks that the mean and the brightest pixel of a white picture are near 1.
fn check(what: &str, pixels: &[f64], cases: usize) -> Result<(), String> {
    let (Estimate { mean, sigma }, most) = (Estimate::of(pixels), pixels.iter().copied().fold(0.0, f64::max));
    println!("{what}: mean {mean:.5} ± {sigma:.5}, brightest {most:.4}");
    let is_near = (mean - 1.0).abs() <= NEAR + family_wise_deviations(cases) * sigma && sigma < 0.5 * NEAR;
    if is_near && most <= 1.5 { Ok(()) } else { Err(format!("{what}: {mean} ± {sigma}, brightest {most}")) }
}

#[test]
fn rough_glass_vanishes() {
    let (all, edge, samples) = if is_deep() { (glasses(), 64, 512) } else { (glasses(), 32, 144) };
    let wrong: Vec<String> = all
        .par_iter()
        .filter_map(|glass| check(&format!("{glass:?}"), &glass.pixels(edge, samples), all.len()).err())
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Fireflies are rare and appear only in large pictures.
#[test]
fn rough_glass_has_no_bright_pixels() {
    let edge = if is_deep() { 256 } else { 32 };
    let glass = Glass { ior: 2.4, roughness: 0.15, anisotropy: 0.0, is_within: false };
    let cases = if is_deep() {
        vec![glass, Glass { roughness: 0.5, ..glass }, Glass { anisotropy: 1.0, ..glass }]
    } else {
        vec![glass]
    };
    for glass in &cases {
        check(&format!("{glass:?}"), &glass.pixels(edge, 256), cases.len()).unwrap();
    }
}

#[test]
fn rough_metal_vanishes() {
    let few = [(0.3, 0.0), (0.7, 0.6), (1.0, -1.0)];
    let grid = [0.05, 0.15, 0.3, 0.5, 0.7, 0.85, 1.0];
    let grid = grid.into_iter().flat_map(|roughness| [0.0, 0.3, 0.7, -1.0].map(|anisotropy| (roughness, anisotropy)));
    let all: Vec<(f64, f64)> = if is_deep() { grid.collect() } else { few.into() };
    for (roughness, anisotropy) in &all {
        let material =
            format!(r#"{{"conductor": {{"reflectance": 1, "roughness": {roughness}, "anisotropy": {anisotropy}}}}}"#);
        check(&material, &sphere(&material, false, 32, 256), all.len()).unwrap();
    }
}

/// Light that a tilted shading normal would send to the wrong side of the surface is not lost.
#[test]
fn glass_with_a_normal_map_vanishes_in_a_furnace() {
    let few = [(1.5, 0.5, 1.0, false), (1.5, 0.5, 0.3, true)];
    let grid = [1.2, 1.5, 2.0].into_iter().flat_map(|ior| [0.2, 0.5, 0.9].map(|roughness| (ior, roughness)));
    let grid = grid.flat_map(|(ior, roughness)| [0.1, 1.0, 3.0].map(|strength| (ior, roughness, strength)));
    let grid = grid.flat_map(|(ior, roughness, strength)| [false, true].map(|side| (ior, roughness, strength, side)));
    let all: Vec<(f64, f64, f64, bool)> = if is_deep() { grid.collect() } else { few.into() };
    let mut wrong = Vec::new();
    for (ior, roughness, strength, is_within) in &all {
        let glass = format!(r#"{{"dielectric": {{"ior": {ior}, "roughness": {roughness}}}}}"#);
        let fields = format!(r#""texture": [0.7, 0.45, 0.9], "strength": {strength}, "material": {glass}"#);
        let material = format!(r#"{{"normal_map": {{{fields}}}}}"#);
        let scale = if *is_within { ior * ior } else { 1.0 };
        // The densest and roughest glass needs this many samples for a standard error below half of
        // `NEAR`.
        let samples = if is_deep() { 512 } else { 256 };
        let pixels: Vec<f64> =
            sphere(&material, *is_within, 32, samples).into_iter().map(|value| value / scale).collect();
        wrong.extend(check(&format!("{material}, from within: {is_within}"), &pixels, all.len()).err());
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Total reflection about perturbed normals may steer light into orbits that no light leaves. Water
/// and patterned glass lose none, within the default limit of path segments.
#[test]
fn polished_glass_with_a_normal_map_vanishes_in_a_furnace() {
    let dielectric = |ior: f64| format!(r#"{{"dielectric": {{"ior": {ior}}}}}"#);
    let principled = r#"{"principled": {"base_color": [1, 1, 1], "transmission": 1, "roughness": 0}}"#;
    let glasses = [(dielectric(1.33), 1.33), (dielectric(1.5), 1.5), (principled.to_owned(), 1.5)];
    for (glass, ior) in &glasses {
        for (strength, is_within) in [(0.5, false), (1.0, false), (3.0, false), (1.0, true)] {
            let fields = format!(r#""texture": [0.7, 0.45, 0.9], "strength": {strength}, "material": {glass}"#);
            let material = format!(r#"{{"normal_map": {{{fields}}}}}"#);
            let (camera, scale) = if is_within { (WITHIN, ior * ior) } else { (OUTSIDE, 1.0) };
            let scene = Scene::new().with(r#"{"sphere": {"radius": 1}}"#, Vec3::ZERO, &material).in_light(1.0);
            let pixels = square(&scene.world(), &read::<AnyCamera>(camera), &*path(""), 16, 64);
            let mean = Estimate::of(&pixels).mean / scale;
            assert!((mean - 1.0).abs() <= NEAR, "{material}, from within: {is_within}: {mean}");
        }
    }
}

/// A mesh of a sphere of radius 1, with the normals of the sphere: they lean by up to 18 degrees.
fn coarse_sphere() -> String {
    const RINGS: usize = 8;
    const SEGMENTS: usize = 12;
    let angle = |step: usize, steps: usize| std::f64::consts::PI * step as f64 / steps as f64;
    let vertex = |ring: usize, segment: usize| {
        let ((sin, cos), (sin_around, cos_around)) =
            (angle(ring, RINGS).sin_cos(), angle(2 * segment, SEGMENTS).sin_cos());
        [sin * cos_around, cos, sin * sin_around]
    };
    let places =
        |rings: std::ops::Range<usize>| rings.flat_map(|ring| (0..SEGMENTS).map(move |segment| (ring, segment)));
    let vertices: Vec<[f64; 3]> = places(0..RINGS + 1).map(|(ring, segment)| vertex(ring, segment)).collect();
    let index = |ring: usize, segment: usize| ring * SEGMENTS + segment % SEGMENTS;
    let triangles: Vec<[usize; 3]> = places(0..RINGS)
        .flat_map(|(ring, segment)| {
            let [a, b] = [index(ring, segment), index(ring, segment + 1)];
            let [c, d] = [index(ring + 1, segment), index(ring + 1, segment + 1)];
            [[a, b, c], [b, d, c]]
        })
        .collect();
    serde_json::json!({"mesh": {"positions": vertices, "normals": vertices, "triangles": triangles}}).to_string()
}

/// Smooth normals of a mesh lose no light inside of glass, as maps do not.
#[test]
fn glass_meshes_with_smooth_normals_vanish_in_a_furnace() {
    let shape = coarse_sphere();
    let few = [(1.5, 0.0, false), (1.5, 0.2, false), (1.5, 0.2, true), (1.2, 0.5, true)];
    let more = [(2.0, 0.0, false), (2.0, 0.3, false), (2.0, 0.3, true), (1.5, 0.9, true)];
    let all: Vec<(f64, f64, bool)> = few.into_iter().chain(more.into_iter().filter(|_| is_deep())).collect();
    let mut wrong = Vec::new();
    for (ior, roughness, is_within) in &all {
        let material = format!(r#"{{"dielectric": {{"ior": {ior}, "roughness": {roughness}}}}}"#);
        let (camera, scale) = if *is_within { (WITHIN, ior * ior) } else { (OUTSIDE, 1.0) };
        let scene = Scene::new().with(&shape, Vec3::ZERO, &material);
        let pixels: Vec<f64> = picture(camera, scene, 32, 256).into_iter().map(|value| value / scale).collect();
        wrong.extend(check(&format!("{material}, from within: {is_within}"), &pixels, all.len()).err());
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Mixtures and layers of `principled` keep 99 % of the energy, also dense glass with metal from
/// inside, where light hits the metal about thirty times before it leaves.
#[test]
fn principled_glass_and_its_layers_vanish_in_a_furnace() {
    let outside = [
        r#""transmission": 0.4"#,
        r#""transmission": 0.4, "clearcoat": 1"#,
        r#""transmission": 1, "clearcoat": 1"#,
        r#""transmission": 1, "clearcoat": 1, "sheen_color": [1, 1, 1], "sheen_roughness": 0.5"#,
        r#""transmission": 0.5, "metallic": 0.5, "roughness": 0.2"#,
        r#""diffuse_transmission": 0.7, "medium": {"scattering": 1}"#,
    ];
    let within = [0.2, 1.0, 0.5].map(|roughness| {
        (format!(r#""transmission": 0.4, "metallic": 0.5, "ior": 2, "roughness": {roughness}"#), Some(2.0))
    });
    let all: Vec<(String, Option<f64>)> = outside
        .map(|numbers| (numbers.to_owned(), None))
        .into_iter()
        .chain(within.into_iter().skip(if is_deep() { 0 } else { 2 }))
        .collect();
    for (numbers, ior) in &all {
        let material = format!(r#"{{"principled": {{"base_color": [1, 1, 1], {numbers}}}}}"#);
        let scale = ior.map_or(1.0, |ior| ior * ior);
        let samples = if ior.is_some() { 256 } else { 144 };
        let pixels: Vec<f64> =
            sphere(&material, ior.is_some(), 32, samples).into_iter().map(|value| value / scale).collect();
        let Estimate { mean, sigma } = Estimate::of(&pixels);
        println!("{material}, from within: {}: {mean:.5} ± {sigma:.5}", ior.is_some());
        let allowed = family_wise_deviations(all.len()) * sigma;
        assert!(
            sigma < 0.002 && mean >= 0.99 - allowed && mean <= 1.0 + NEAR + allowed,
            "{material}: {mean} ± {sigma}"
        );
    }
}
