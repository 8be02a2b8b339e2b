//! Participating media and absorbing dielectrics.

use crate::closed_forms::integral;
use crate::probe::{Estimate, Scene, looking, measure, path, traced};
use juggler_math::{Transform, Vec3};
use std::f64::consts::PI;

const WALL: &str = r#"{"emissive": {"radiance": [1, 2, 3]}}"#;

/// A layer of this medium from y = 0 to y = `thickness`, 2,000 wide.
fn layer(thickness: f64, medium: &str) -> Scene {
    let shape = format!(r#"{{"cuboid": {{"min": [-1000, 0, -1000], "max": [1000, {thickness}, 1000]}}}}"#);
    Scene::new().with(&shape, Vec3::ZERO, &format!(r#"{{"boundary": {{"medium": {medium}}}}}"#))
}

/// A view of the origin from above, at an angle to the vertical of cosine `cos`.
fn down(cos: f32) -> juggler_camera::ShutterCamera {
    looking(Vec3::new((1.0 - cos * cos).sqrt(), cos, 0.0) * 5.0, Vec3::ZERO)
}

#[test]
fn clear_media_absorb() {
    for cos in [1.0f64, 0.5] {
        let scene = layer(0.6, r#"{"absorption": [0.5, 1, 0], "color": [1, 1, 0.25], "distance": 0.3}"#).with(
            r#"{"rectangle": {"size": [4000, 4000]}}"#,
            -Vec3::Y,
            WALL,
        );
        let colors = crate::probe::colors(&scene.world(), &down(cos as f32), &*path(""), 4);
        let distance = 0.6 / cos;
        colors[0].is((-0.5 * distance).exp());
        colors[1].is(2.0 * (-distance).exp());
        colors[2].is(3.0 * 0.25f64.powf(distance / 0.3));
    }
}

/// Unscattered transmittance of fog, with scattered light disabled.
#[test]
fn fog_attenuates_unscattered_light() {
    let scene = layer(0.6, r#"{"scattering": [0.5, 1, 2], "absorption": [0.2, 0, 0.1]}"#).with(
        r#"{"rectangle": {"size": [4000, 4000]}}"#,
        -Vec3::Y,
        WALL,
    );
    let colors = crate::probe::colors(&scene.world(), &down(1.0), &*path(r#""max_volume": 0"#), 256);
    for (color, (light, coefficient)) in colors.into_iter().zip([(1.0, 0.7f64), (2.0, 1.0), (3.0, 2.1)]) {
        color.is(light * (-coefficient * 0.6).exp());
    }
}

/// Single scattering of sunlight by a layer (Chandrasekhar 1950, section 48): p ω E μ₀ / (μ₀ + μ)
/// (1 - exp(-τ (1/μ₀ + 1/μ))).
#[test]
fn fog_scatters_once() {
    let (sun, view, depth) = (2.0 / 3.0, 0.8f64, 0.6 * 0.5);
    for g in [0.0f64, 0.6] {
        let medium = format!(r#"{{"scattering": 0.4, "absorption": 0.1, "anisotropy": {g}}}"#);
        let light = r#"{"directional": {"direction": [1, -2, 2], "intensity": 4}}"#;
        let measured = measure(&layer(0.6, &medium).lit(light).world(), &down(0.8), &*path(r#""max_depth": 2"#), 256);
        // Cosine of the angle between the incident and the scattered direction.
        let cos = 0.6 / 3.0 - 0.8 * 2.0 / 3.0;
        let phase = (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * cos).powf(1.5));
        let share = 1.0 - (-depth * (1.0 / sun + 1.0 / view)).exp();
        measured.is(phase * 0.8 * 4.0 * sun / (sun + view) * share);
    }
}

/// Single scattering of light from an emissive shape, which scattered rays can hit too, along a ray
/// through a sphere of fog.
#[test]
fn single_scattering_of_an_emitter_matches_quadrature() {
    let fog = r#"{"boundary": {"medium": {"scattering": 0.5}}}"#;
    let scene = Scene::new().with(r#"{"sphere": {"radius": 1}}"#, Vec3::ZERO, fog).with(
        r#"{"sphere": {"radius": 0.5}}"#,
        Vec3::Y * 3.0,
        r#"{"emissive": {"radiance": 10}}"#,
    );
    let measured = measure(&scene.world(), &looking(Vec3::Z * 5.0, Vec3::ZERO), &*path(r#""max_depth": 2"#), 256);
    measured.is(once(0.5, 4000));
}

/// Single scattering along the z axis through a sphere of radius 1: at each point, the light of a
/// sphere at (0, 3, 0), attenuated on the way in and out, integrated over rings of its solid angle.
fn once(coefficient: f64, steps: u32) -> f64 {
    let at = |share: f64| {
        let z = 1.0 - 2.0 * share;
        let squared = 9.0 + z * z;
        let sin_squared = 0.25 / squared;
        let cos_max = (1.0 - sin_squared).sqrt();
        // Average the transmittance out of the fog over the cone of directions to the light.
        let mut sum = 0.0;
        let (rings, turns) = (8, 16);
        let axis = juggler_math::DVec3::new(0.0, 3.0, -z).normalize();
        let (tangent, bitangent) = axis.any_orthonormal_pair();
        for i in 0..rings {
            for j in 0..turns {
                let cos = 1.0 - (1.0 - cos_max) * (f64::from(i) + 0.5) / f64::from(rings);
                let (sin_turn, cos_turn) = (f64::from(j) * 2.0 * PI / f64::from(turns)).sin_cos();
                let wi = axis * cos + (tangent * cos_turn + bitangent * sin_turn) * (1.0 - cos * cos).sqrt();
                let along = z * wi.z;
                let out = -along + (along * along + 1.0 - z * z).sqrt();
                sum += (-coefficient * out).exp() / f64::from(rings * turns);
            }
        }
        let solid_angle = 2.0 * PI * (1.0 - cos_max);
        10.0 * solid_angle * sum * (-coefficient * (1.0 - z)).exp()
    };
    let mean = (0..steps).map(|i| at((f64::from(i) + 0.5) / f64::from(steps))).sum::<f64>() / f64::from(steps);
    coefficient / (4.0 * PI) * 2.0 * mean
}

/// Fog of albedo 1, optically thick: a half space in uniform light reflects all of it. With
/// absorption, it reflects 1 - H(μ) √(1 - ω), with Chandrasekhar's H function.
#[test]
fn reflectance_of_thick_fog_matches_the_h_function() {
    let albedo = 0.8f64;
    let scene = layer(40.0, r#"{"scattering": 0.8, "absorption": 0.2}"#).in_light(1.0);
    let camera = looking(Vec3::new(0.6, 40.8, 0.0), Vec3::new(0.0, 40.0, 0.0));
    let measured: Estimate =
        measure(&scene.world(), &camera, &*path(r#""max_depth": 1000, "roulette_depth": 20"#), 256);
    measured.is(1.0 - chandrasekhar(0.8, albedo) * (1.0 - albedo).sqrt());
}

/// H(μ) of isotropic scattering, by iteration of 1 / H(μ) = √(1 - ω) + ω / 2 ∫ μ' H(μ') / (μ + μ')
/// dμ' (Chandrasekhar 1950, section 38).
fn chandrasekhar(cos: f64, albedo: f64) -> f64 {
    const PLACES: u32 = 400;
    let place = |i: u32| (f64::from(i) + 0.5) / f64::from(PLACES);
    let mut values = vec![1.0; PLACES as usize];
    let next = |values: &[f64], cos: f64| {
        let terms = (0..).zip(values).map(|(i, value)| place(i) * value / (cos + place(i)));
        1.0 / ((1.0 - albedo).sqrt() + 0.5 * albedo * terms.sum::<f64>() / f64::from(PLACES))
    };
    for _ in 0..200 {
        values = (0..PLACES).map(|i| next(&values, place(i))).collect();
    }
    next(&values, cos)
}

/// A floor in fog under the sun: attenuated on the way down and on the way up.
#[test]
fn floor_in_an_absorbing_medium_is_attenuated_twice() {
    let light = r#"{"directional": {"direction": [0, -1, 0], "intensity": 4}}"#;
    let scene = layer(0.6, r#"{"absorption": 0.5}"#).lit(light).with(
        r#"{"plane": {}}"#,
        Vec3::Y * 0.1,
        r#"{"diffuse": {"reflectance": 0.5}}"#,
    );
    let camera = looking(Vec3::new(3.0, 4.1, 0.0), Vec3::Y * 0.1);
    traced(scene, &camera, 4).is(0.5 / PI * 4.0 * (-0.25f64 - 0.25 / 0.8).exp());
    // In uniform light, each direction is attenuated over its own length.
    let scene = layer(0.6, r#"{"absorption": 0.5}"#).in_light(1.0).with(
        r#"{"plane": {}}"#,
        Vec3::Y * 0.1,
        r#"{"diffuse": {"reflectance": 0.5}}"#,
    );
    let arrives = integral(|cos| if cos == 0.0 { 0.0 } else { 2.0 * cos * (-0.25 / cos).exp() });
    traced(scene, &camera, 256).is(0.5 * arrives * (-0.25f64 / 0.8).exp());
}

/// Fog of higher priority hides a block of glass: light in the fog passes it unchanged.
#[test]
fn fog_of_higher_priority_hides_glass() {
    let fog = r#"{"boundary": {"priority": 1, "medium": {"scattering": 1}}}"#;
    let scene = || {
        Scene::new().with(r#"{"sphere": {"radius": 1}}"#, Vec3::ZERO, fog).with(
            r#"{"sphere": {"radius": 0.2}}"#,
            Vec3::Y * 0.6,
            r#"{"emissive": {"radiance": 10}}"#,
        )
    };
    let glass = r#"{"dielectric": {"ior": 1.5, "roughness": 0.3}}"#;
    let block = r#"{"cuboid": {"min": [-0.4, 0.1, -0.4], "max": [0.4, 0.3, 0.4]}}"#;
    let camera = looking(Vec3::Z * 5.0, Vec3::ZERO);
    let hidden = traced(scene().with(block, Vec3::ZERO, glass), &camera, 256);
    traced(scene(), &camera, 256).equals(hidden, "hidden glass");
}

/// Overlapping media: the one of higher priority applies.
#[test]
fn overlapping_media_use_the_higher_priority() {
    let boundary = |absorption: f64, priority: i32| {
        format!(r#"{{"boundary": {{"priority": {priority}, "medium": {{"absorption": {absorption}}}}}}}"#)
    };
    let block = |from: f64, to: f64| format!(r#"{{"cuboid": {{"min": [-9, {from}, -9], "max": [9, {to}, 9]}}}}"#);
    let scene = Scene::new()
        .with(&block(0.0, 1.0), Vec3::ZERO, &boundary(1.0, 0))
        .with(&block(0.5, 2.0), Vec3::ZERO, &boundary(0.25, 2))
        .with(&block(0.2, 1.8), Vec3::ZERO, &boundary(10.0, -1))
        .placed(r#"{"rectangle": {"size": [9, 9]}}"#, Transform::translation(-Vec3::Y), WALL);
    traced(scene, &down(1.0), 4).is((-0.5f64 - 0.25 * 1.5).exp());
}
