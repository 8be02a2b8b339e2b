//! Emitters as seen by cameras and in mirrors.

use crate::closed_forms::fresnel;
use crate::probe::{EDGE, Scene, camera, looking, measure, path, picture};
use juggler_math::{Transform, Vec3};
use std::f64::consts::PI;

/// A small disk far behind the focal plane appears as a uniform circle of confusion of radius
/// `R |d - f| / f`, with the same total light.
#[test]
fn defocused_disk_has_its_circle_of_confusion() {
    let (lens, focus, distance, radius) = (0.2f64, 4.0, 6.0, 0.02);
    let turned = Transform::rotation(Vec3::X, std::f32::consts::FRAC_PI_2).unwrap();
    let scene = Scene::new().placed(
        &format!(r#"{{"disk": {{"radius": {radius}}}}}"#),
        turned.then(&Transform::translation(Vec3::Z * -6.0)),
        r#"{"emissive": {"radiance": 100}}"#,
    );
    let half_height = 0.15f64;
    let camera = camera(&format!(
        r#"{{"thin_lens": {{"eye": [0, 0, 0], "look_at": [0, 0, -1], "lens_radius": {lens}, "focus_distance": {focus},
        "view_plane": {{"distance": {distance}, "width": {}, "height": {}}}}}}}"#,
        2.0 * half_height,
        2.0 * half_height
    ));
    let pixels = picture(&scene.world(), &camera, &*path(""), 4096, 1);
    let edge = 2.0 * half_height / f64::from(EDGE);
    let (mut total, mut moment) = (0.0, 0.0);
    for (i, pixel) in (0u32..).zip(&pixels) {
        let place = |i: u32| (f64::from(i) + 0.5) * edge - half_height;
        let (x, y) = (place(i % EDGE), place(i / EDGE));
        total += f64::from(pixel.r) * edge * edge;
        moment += f64::from(pixel.r) * edge * edge * (x * x + y * y);
    }
    let light = 100.0 * PI * radius * radius;
    assert!((total / light - 1.0).abs() < 0.01, "{total} {light}");
    // Mean squared radii of the circle of confusion, of the disk's own image, and of a pixel.
    let circle = lens * (distance - focus) / focus;
    let expected = circle * circle / 2.0 + radius * radius / 2.0 + edge * edge / 6.0;
    assert!((moment / total / expected - 1.0).abs() < 0.02, "{} {expected}", moment / total);
}

/// An emitter in a mirror has its radiance times the reflectance, in a curved mirror too.
#[test]
fn mirror_reflects_an_emitter_by_its_reflectance() {
    let emitter = r#"{"emissive": {"radiance": 3}}"#;
    let sheet = Transform::rotation(Vec3::Z, std::f32::consts::FRAC_PI_2).unwrap();
    let sheet = sheet.then(&Transform::translation(Vec3::X * 5.0));
    let view = looking(Vec3::new(-3.0, 4.0, 0.0), Vec3::ZERO);
    let seen = |material: &str, bent: bool| {
        let (shape, at) =
            if bent { (r#"{"sphere": {"radius": 2}}"#, Vec3::Y * -2.0) } else { (r#"{"plane": {}}"#, Vec3::ZERO) };
        let scene =
            Scene::new().with(shape, at, material).placed(r#"{"rectangle": {"size": [50, 50]}}"#, sheet, emitter);
        measure(&scene.world(), &view, &*path(""), 64)
    };
    for bent in [false, true] {
        seen(r#"{"conductor": {"reflectance": 0.7, "grazing": 0.7}}"#, bent).is(2.1);
        seen(r#"{"phong": {"diffuse": 0, "specular": 0, "reflection": 0.4}}"#, bent).is(1.2);
        // The tint of 0 absorbs the transmitted light.
        seen(r#"{"dielectric": {"ior": 1.5, "transmission_tint": 0}}"#, bent).is(3.0 * fresnel(0.8, 1.5));
    }
    // Fresnel reflectance for a complex index similar to copper's.
    let (eta, k, cos) = (0.5f64, 3.0f64, 0.8f64);
    let sin2 = 1.0 - cos * cos;
    let part = eta * eta - k * k - sin2;
    let root = (part * part + 4.0 * eta * eta * k * k).sqrt();
    let a = (0.5 * (root + part)).sqrt();
    let across = (root + cos * cos - 2.0 * a * cos) / (root + cos * cos + 2.0 * a * cos);
    let along = across * (cos * cos * root + sin2 * sin2 - 2.0 * a * cos * sin2)
        / (cos * cos * root + sin2 * sin2 + 2.0 * a * cos * sin2);
    seen(r#"{"conductor": {"eta": 0.5, "k": 3}}"#, false).is(1.5 * (across + along));
}

/// Two parallel mirrors attenuate at each reflection.
#[test]
fn parallel_mirrors_attenuate_at_each_reflection() {
    let mirror = r#"{"conductor": {"reflectance": 0.9, "grazing": 0.9}}"#;
    let wall = Transform::rotation(Vec3::X, std::f32::consts::FRAC_PI_2).unwrap();
    let at = |z: f32| wall.then(&Transform::translation(Vec3::Z * z));
    let scene = Scene::new()
        .placed(r#"{"plane": {}}"#, at(0.0), mirror)
        .placed(r#"{"plane": {}}"#, at(2.0), mirror)
        .with(r#"{"plane": {}}"#, Vec3::Y * 20.25, r#"{"emissive": {"radiance": 1, "sides": "both"}}"#);
    // The ray rises half as fast as it travels across: 20.25 up are 40.5 across, which from z = 1
    // are 20 reflections, one every 2 units.
    let view = looking(Vec3::new(0.0, 0.0, 1.0), Vec3::new(0.0, 0.5, 0.0));
    measure(&scene.world(), &view, &*path(r#""roulette_depth": null"#), 4).is(0.9f64.powi(20));
}
