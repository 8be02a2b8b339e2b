//! Glass panes, stacks of panes, and nested dielectrics.

use crate::closed_forms::{fresnel, integral, stack};
use crate::probe::{Estimate, Scene, at_origin, looking, measure, path, traced};
use juggler_math::{Transform, Vec3};

/// Radiance of a wall of radiance 1 at `z = -5` behind the scene, along a ray that meets the plane
/// `z = 0` at an angle of incidence of cosine `cos`.
fn through(mut scene: Scene, cos: f32) -> Estimate {
    let wall = Transform::rotation(Vec3::X, std::f32::consts::FRAC_PI_2).unwrap();
    scene = scene.placed(
        r#"{"rectangle": {"size": [4000, 4000]}}"#,
        wall.then(&Transform::translation(Vec3::Z * -5.0)),
        r#"{"emissive": {"radiance": 1}}"#,
    );
    let wo = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
    measure(&scene.world(), &looking(wo * 5.0, Vec3::ZERO), &*path(""), 1024)
}

/// A wide pane from z = `from` to z = `to`.
fn pane(scene: Scene, from: f32, to: f32, material: &str) -> Scene {
    let shape = format!(r#"{{"cuboid": {{"min": [-1000, -1000, {from}], "max": [1000, 1000, {to}]}}}}"#);
    scene.with(&shape, Vec3::ZERO, material)
}

/// Reflectance and transmittance of an interface.
fn interface(cos: f64, ior: f64) -> [f64; 2] {
    let share = fresnel(cos, ior);
    [share, 1.0 - share]
}

#[test]
fn transmittance_of_one_and_two_panes_matches_the_closed_form() {
    let glass = r#"{"dielectric": {"ior": 1.5}}"#;
    for cos in [1.0, 0.7, 0.25] {
        let share = fresnel(cos, 1.5);
        let one = pane(Scene::new(), 0.0, 0.1, glass);
        through(one, cos as f32).is((1.0 - share) / (1.0 + share));
        // Transmittance of n panes: (1 - R) / (1 + (2n - 1) R) (Stokes 1862).
        let two = pane(pane(Scene::new(), 0.0, 0.1, glass), 0.2, 0.4, glass);
        through(two, cos as f32).is((1.0 - share) / (1.0 + 3.0 * share));
        let thin = Scene::new().placed(
            r#"{"rectangle": {"size": [2000, 2000]}}"#,
            Transform::rotation(Vec3::X, std::f32::consts::FRAC_PI_2).unwrap(),
            r#"{"dielectric": {"ior": 1.5, "thin": true}}"#,
        );
        through(thin, cos as f32).is((1.0 - share) / (1.0 + share));
    }
}

#[test]
fn colored_glass_absorbs_along_the_refracted_path() {
    let glass = r#"{"dielectric": {"ior": 1.5, "medium": {"color": 0.5, "distance": 0.2}}}"#;
    for cos in [1.0f64, 0.6] {
        let share = fresnel(cos, 1.5);
        let distance = 0.3 / (1.0 - (1.0 - cos * cos) / 2.25).sqrt();
        let left = 0.5f64.powf(distance / 0.2);
        let expected = (1.0 - share).powi(2) * left / (1.0 - (share * left).powi(2));
        through(pane(Scene::new(), 0.0, 0.3, glass), cos as f32).is(expected);
    }
}

/// Water that overlaps its glass, and water that only touches it: the interface between them has
/// the indices 1.33 and 1.5, wherever the water's own surface lies inside the glass.
#[test]
fn water_in_glass_has_the_right_interfaces() {
    let cos = 0.8f64;
    // Cosine of the refraction angle in a medium of this index.
    let inside = |ior: f64| (1.0 - (1.0 - cos * cos) / (ior * ior)).sqrt();
    let [_, expected] =
        stack(&[interface(cos, 1.5), interface(inside(1.5), 1.33 / 1.5), interface(inside(1.33), 1.0 / 1.33)]);
    for (glass_priority, water_priority, from) in [(1, 0, 0.25), (0, -3, 0.2001), (0, 1, 0.3), (5, 4, 0.4)] {
        let glass = format!(r#"{{"dielectric": {{"ior": 1.5, "priority": {glass_priority}}}}}"#);
        let water = format!(r#"{{"dielectric": {{"ior": 1.33, "priority": {water_priority}}}}}"#);
        // If the water has the higher priority, the glass extends into it.
        let (glass_from, water_to) = (if water_priority > glass_priority { 0.2 } else { 0.15 }, from);
        let scene = pane(pane(Scene::new(), glass_from, 0.5, &glass), 0.0, water_to, &water);
        through(scene, cos as f32).is(expected);
    }
}

/// An emitting wall inside glass: its radiance decreases on the way into the air by the square of
/// the index.
#[test]
fn radiance_of_an_emitter_in_glass_scales_with_the_squared_index() {
    let upright = Transform::rotation(Vec3::X, std::f32::consts::FRAC_PI_2).unwrap();
    for (roughness, cos) in [(0.0, 1.0f32), (0.0, 0.6), (0.02, 0.9)] {
        let glass = format!(r#"{{"dielectric": {{"ior": 1.5, "roughness": {roughness}}}}}"#);
        let scene = pane(Scene::new(), -1.0, 0.0, &glass).placed(
            r#"{"rectangle": {"size": [900, 900]}}"#,
            upright.then(&Transform::translation(Vec3::Z * -0.5)),
            r#"{"emissive": {"radiance": 3}}"#,
        );
        let wo = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
        let seen = measure(&scene.world(), &looking(wo * 5.0, Vec3::ZERO), &*path(""), 256);
        seen.is(3.0 * (1.0 - fresnel(f64::from(cos), 1.5)) / 2.25);
    }
}

/// A layer of water inside a block of glass: from glass to water and back.
#[test]
fn nested_dielectrics_transmit_by_the_closed_form() {
    let scene = pane(Scene::new(), 0.0, 1.0, r#"{"dielectric": {"ior": 1.5}}"#);
    let scene = pane(scene, 0.4, 0.6, r#"{"dielectric": {"ior": 1.33, "priority": 1}}"#);
    let (outer, inner) = (interface(1.0, 1.5), interface(1.0, 1.33 / 1.5));
    let [_, expected] = stack(&[outer, inner, inner, outer]);
    through(scene, 1.0).is(expected);
}

/// A floor under a pane in uniform light: the hemispherical transmittance T comes through, and the
/// pane returns the fraction R of the light that the floor reflects.
#[test]
fn floor_below_a_pane_matches_the_closed_form() {
    let reflectance = |cos: f64| {
        let share = fresnel(cos.max(1e-9), 1.5);
        2.0 * share / (1.0 + share)
    };
    let all = integral(|cos| 2.0 * cos * reflectance(cos));
    let expected = 0.5 * (1.0 - all) / (1.0 - 0.5 * all);
    let block = r#"{"cuboid": {"min": [-1000, 0.5, -1000], "max": [1000, 0.7, 1000]}}"#;
    let below = looking(Vec3::new(0.3, 0.2, 0.1), Vec3::ZERO);
    let roof = Scene::floor().with(block, Vec3::ZERO, r#"{"dielectric": {"ior": 1.5}}"#);
    traced(roof.in_light(1.0), &below, 256).is(expected);
    let sheet = Scene::floor().with(r#"{"plane": {}}"#, Vec3::Y, r#"{"dielectric": {"ior": 1.5, "thin": true}}"#);
    traced(sheet.in_light(1.0), &below, 256).is(expected);
}

/// A small light behind a pane lights the floor only through refracted rays, so by BSDF sampling.
/// The closed form is that of a light straight above, which a pane of thickness t moves nearer by t
/// (1 - 1/n).
#[test]
fn caustic_of_a_pane_matches_the_closed_form() {
    let emitter = r#"{"sphere": {"radius": 0.2}}"#;
    let scene = Scene::new()
        .with(r#"{"plane": {}}"#, Vec3::ZERO, r#"{"diffuse": {"reflectance": 0.01}}"#)
        .with(emitter, Vec3::Y * 3.0, r#"{"emissive": {"radiance": 10}}"#)
        .with(
            r#"{"cuboid": {"min": [-1000, 1, -1000], "max": [1000, 1.6, 1000]}}"#,
            Vec3::ZERO,
            r#"{"dielectric": {"ior": 1.5}}"#,
        );
    let radiance = traced(scene, &looking(Vec3::new(0.3, 0.5, 0.2), Vec3::ZERO), 16_384);
    let seen = 0.2 / (3.0 - 0.2);
    let pane = fresnel(1.0, 1.5);
    // The pane returns a hundredth of the floor's light; off the axis the irradiance changes
    // little.
    let expected = 0.01 * 10.0 * seen * seen * (1.0 - pane) / (1.0 + pane);
    let off = radiance.mean / expected - 1.0;
    assert!(off.abs() < 0.02 + 3.0 * radiance.sigma / radiance.mean, "{radiance:?} {expected}");
}

/// A glass sphere on a white floor under a white sky is invisible, whatever light it focuses.
#[test]
fn glass_sphere_on_a_white_floor_vanishes() {
    let scene = Scene::new()
        .with(r#"{"plane": {}}"#, Vec3::ZERO, r#"{"diffuse": {"reflectance": 1}}"#)
        .with(r#"{"sphere": {"radius": 1}}"#, Vec3::new(0.2, 1.0, 0.0), r#"{"dielectric": {"ior": 1.5}}"#)
        .in_light(1.0);
    measure(&scene.world(), &at_origin(), &*path(r#""max_depth": 1000"#), 64).is(1.0);
}
