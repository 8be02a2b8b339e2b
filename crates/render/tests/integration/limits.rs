//! Limits of paths: depth, numbers of scattering events, and Russian roulette.

use crate::probe::{Estimate, Scene, at_origin, looking, measure, path, picture};
use crate::strategies;
use juggler_math::Vec3;
use std::f64::consts::PI;

/// The inside of a closed sphere that emits 0.25 and reflects 0.75: bounce n adds 0.25 · 0.75ⁿ.
fn furnace(options: &str) -> Estimate {
    let wall = r#"{"emissive": {"radiance": 0.25, "sides": "both", "material": {"diffuse": {"reflectance": 0.75}}}}"#;
    let scene = Scene::new().with(r#"{"sphere": {"radius": 1}}"#, Vec3::ZERO, wall);
    measure(&scene.world(), &looking(Vec3::X * 0.1, Vec3::new(0.0, 0.6, 0.8)), &*path(options), 64)
}

#[test]
fn max_depth_truncates_the_series_of_bounces() {
    for depth in [1, 2, 3, 5, 9] {
        let options = format!(r#""max_depth": {depth}, "roulette_depth": null"#);
        furnace(&options).is(1.0 - 0.75f64.powi(depth));
    }
}

/// `max_diffuse` limits the number of diffuse bounces; light samples at the last one still count.
#[test]
fn limits_of_bounce_kinds_truncate_the_series() {
    for most in [0, 1, 2, 4] {
        let options = format!(r#""max_diffuse": {most}, "roulette_depth": null"#);
        furnace(&options).is(1.0 - 0.75f64.powi(most + 1));
    }
    let rough = r#"{"conductor": {"reflectance": 1, "grazing": 1, "roughness": 0.5}}"#;
    let scene = Scene::new().with(r#"{"plane": {}}"#, Vec3::ZERO, rough).in_light(1.0);
    assert_eq!(measure(&scene.world(), &at_origin(), &*path(r#""max_glossy": 0, "max_diffuse": 0"#), 16).mean, 0.0);
    let mirror = r#"{"conductor": {"reflectance": 1}}"#;
    let scene = Scene::new().with(r#"{"plane": {}}"#, Vec3::ZERO, mirror).in_light(1.0).world();
    assert_eq!(measure(&scene, &at_origin(), &*path(r#""max_specular": 0"#), 16).mean, 0.0);
    measure(&scene, &at_origin(), &*path(r#""max_specular": 1"#), 16).is(1.0);
}

#[test]
fn roulette_changes_no_mean() {
    for scene in strategies::scenes() {
        let (name, scene, camera) = scene;
        let world = scene.world();
        let with = |roulette: &str| {
            measure(&world, &camera, &*path(&format!(r#""max_depth": 12, "roulette_depth": {roulette}"#)), 128)
        };
        let never = with("null");
        never.equals(with("1"), name);
        never.equals(with("3"), name);
    }
    for depth in ["1", "2", "5"] {
        furnace(&format!(r#""max_depth": 200, "roulette_depth": {depth}"#)).is(1.0);
    }
}

/// Inside dense glass, radiance is larger by the square of the index, which Russian roulette must
/// compensate.
#[test]
fn russian_roulette_behind_glass_is_unbiased() {
    let scene = Scene::new()
        .with(r#"{"plane": {}}"#, Vec3::ZERO, r#"{"diffuse": {"reflectance": 0.5}}"#)
        .with(
            r#"{"cuboid": {"min": [-99, 0.5, -99], "max": [99, 0.7, 99]}}"#,
            Vec3::ZERO,
            r#"{"dielectric": {"ior": 2.4}}"#,
        )
        .in_light(1.0)
        .world();
    let with = |roulette: &str| {
        measure(&scene, &at_origin(), &*path(&format!(r#""max_depth": 60, "roulette_depth": {roulette}"#)), 256)
    };
    with("null").equals(with("1"), "through a pane");
}

#[test]
fn seeds_give_other_noise_of_the_same_mean() {
    let scene = Scene::floor().with(r#"{"sphere": {"radius": 1}}"#, Vec3::Y * 3.0, r#"{"emissive": {"radiance": 3}}"#);
    let world = scene.world();
    let of = |seed: u64| picture(&world, &at_origin(), &*path(""), 64, seed);
    let (first, second) = (of(1), of(2));
    assert!(first.iter().zip(&second).filter(|(a, b)| a == b).count() < 16, "two seeds, one noise");
    assert_eq!(first, of(1));
    let mean =
        |pixels: &[juggler_math::Rgb]| Estimate::of(&pixels.iter().map(|pixel| f64::from(pixel.r)).collect::<Vec<_>>());
    mean(&first).equals(mean(&second), "two seeds");
    mean(&first).is(0.5 / PI * 3.0 * PI / 9.0);
}
