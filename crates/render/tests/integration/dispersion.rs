//! Dispersion: refraction by wavelength, against closed forms.

use crate::closed_forms::fresnel;
use crate::probe::{Scene, colors, looking, path};
use juggler_material::medium::Wavelength;
use juggler_math::{Transform, Vec3};
use std::f32::consts::FRAC_PI_2;

/// Samples per pixel: the color of the wavelength is the noise.
const SAMPLES: u32 = 4096;

/// Mean over all wavelengths of their color times a value of the index of refraction.
fn mean(ior: f32, dispersion: f32, value: impl Fn(f64) -> f64) -> [f64; 3] {
    const STEPS: u32 = 20_000;
    let mut sum = [0.0; 3];
    for step in 0..STEPS {
        let (wavelength, weight) = Wavelength::sample((step as f32 + 0.5) / STEPS as f32);
        let value = value(f64::from(wavelength.ior(ior, dispersion))) / f64::from(STEPS);
        for (sum, channel) in sum.iter_mut().zip(weight.to_array()) {
            *sum += f64::from(channel) * value;
        }
    }
    sum
}

fn glass(ior: f32, dispersion: f32) -> String {
    format!(r#"{{"dielectric": {{"ior": {ior}, "dispersion": {dispersion}}}}}"#)
}

/// A rectangle of radiance 1 that faces +z.
fn wall(scene: Scene, center: Vec3, size: [f32; 2]) -> Scene {
    let upright = Transform::rotation(Vec3::X, FRAC_PI_2).unwrap();
    scene.placed(
        &format!(r#"{{"rectangle": {{"size": [{}, {}]}}}}"#, size[0], size[1]),
        upright.then(&Transform::translation(center)),
        r#"{"emissive": {"radiance": 1}}"#,
    )
}

fn pane(from: f32, to: f32, material: &str) -> Scene {
    let shape = format!(r#"{{"cuboid": {{"min": [-1000, -1000, {from}], "max": [1000, 1000, {to}]}}}}"#);
    Scene::new().with(&shape, Vec3::ZERO, material)
}

/// A wall in glass begins where light of a certain wavelength arrives: each channel sees the share
/// of its light that is refracted less.
#[test]
fn wavelengths_are_refracted_by_the_angles_of_their_indices() {
    let (ior, dispersion, sine) = (1.6, 1.0, 0.8f64);
    let cos = (1.0 - sine * sine).sqrt();
    // The point that light arrives at, at a depth of 0.5.
    let arrival = |ior: f64| 0.5 * (sine / ior) / (1.0 - (sine / ior).powi(2)).sqrt();
    for nanometers in [470.0, 540.0, 600.0] {
        let edge = arrival(f64::from(Wavelength { nanometers }.ior(ior, dispersion)));
        let center = Vec3::new(-edge as f32 - 10.0, 0.0, -0.5);
        let scene = wall(pane(-1.0, 0.0, &glass(ior, dispersion)), center, [20.0, 20.0]);
        let camera = looking(Vec3::new(sine as f32, 0.0, cos as f32) * 5.0, Vec3::ZERO);
        let seen = colors(&scene.world(), &camera, &*path(""), SAMPLES);
        let transmitted = |ior: f64| (1.0 - fresnel(cos, ior)) / (ior * ior);
        let expected = mean(ior, dispersion, |ior| if arrival(ior) > edge { transmitted(ior) } else { 0.0 });
        for (seen, expected) in seen.into_iter().zip(expected) {
            let allowed = 3.0 * seen.sigma + 0.002;
            assert!((seen.mean - expected).abs() < allowed, "{nanometers} nm: {seen:?}, not {expected}");
        }
        assert!(expected.iter().any(|channel| *channel > 0.05) && expected.iter().any(|channel| *channel < 0.35));
    }
}

/// The second surface of a pane refracts each wavelength back to its direction.
#[test]
fn panes_keep_the_direction_of_all_wavelengths() {
    let (ior, dispersion, sine) = (1.6, 2.0, 0.6f64);
    let cos = (1.0 - sine * sine).sqrt();
    let wo = Vec3::new(sine as f32, 0.0, cos as f32);
    let scene = wall(pane(0.0, 0.02, &glass(ior, dispersion)), wo * -500.0, [2.0, 2.0]);
    let seen = colors(&scene.world(), &looking(wo * 5.0, Vec3::ZERO), &*path(""), SAMPLES);
    let transmittance = |ior: f64| (1.0 - fresnel(cos, ior)) / (1.0 + fresnel(cos, ior));
    for (seen, expected) in seen.into_iter().zip(mean(ior, dispersion, transmittance)) {
        seen.is(expected);
    }
}

#[test]
fn dispersive_glass_in_uniform_light_is_invisible() {
    for material in [
        glass(1.5, 3.0),
        r#"{"dielectric": {"ior": 1.7, "dispersion": 0.7, "roughness": 0.4}}"#.to_owned(),
        r#"{"principled": {"base_color": 1, "transmission": 1, "roughness": 0.2, "dispersion": 1}}"#.to_owned(),
    ] {
        let scene = Scene::new().with(r#"{"sphere": {"radius": 1}}"#, Vec3::ZERO, &material).in_light(1.0);
        let camera = looking(Vec3::new(3.0, 2.0, 4.0), Vec3::new(0.3, 0.2, 0.1));
        for seen in colors(&scene.world(), &camera, &*path(r#""max_depth": 1000"#), SAMPLES) {
            assert!((seen.mean - 1.0).abs() < 3.0 * seen.sigma + 0.005, "{material}: {seen:?}");
        }
    }
}
