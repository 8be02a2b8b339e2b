//! Surfaces that are absent for some rays: one-sided and unlit ones.

use crate::closed_forms::polygon;
use crate::probe::{Scene, at_origin, looking, measure, path, traced};
use juggler_math::{Transform, Vec3};
use std::f64::consts::PI;

const LIGHT: &str = r#"{"point": {"position": [0, 2, 0], "intensity": 5}}"#;
const SHEET: &str = r#"{"rectangle": {"size": [50, 50]}}"#;
/// Radiance of the floor below the light.
const LIT: f64 = 0.5 / PI * 5.0 / 4.0;

fn diffuse(sides: &str) -> String {
    format!(r#"{{"diffuse": {{"reflectance": 0.4, "sides": "{sides}"}}}}"#)
}

/// A horizontal sheet whose front faces up or down.
fn facing(up: bool, at: Vec3) -> Transform {
    let angle = if up { 0.0 } else { std::f32::consts::PI };
    Transform::rotation(Vec3::X, angle).unwrap().then(&Transform::translation(at))
}

/// Radiance of the floor under a sheet at a height of 1, seen from below the sheet.
fn floor_under(sheet: &str, up: bool) -> f64 {
    let scene = Scene::floor().lit(LIGHT).placed(SHEET, facing(up, Vec3::Y), sheet);
    let below = looking(Vec3::new(0.3, 0.5, 0.2), Vec3::ZERO);
    measure(&scene.world(), &below, &*path(r#""max_depth": 2"#), 4).mean
}

#[test]
fn shadow_rays_pass_through_the_back_of_a_surface_without_one() {
    let near = |value: f64, expected: f64| assert!((value - expected).abs() <= 1e-4, "{value} {expected}");
    near(floor_under(&diffuse("front"), true), LIT);
    near(floor_under(&diffuse("front"), false), 0.0);
    for up in [true, false] {
        near(floor_under(&diffuse("black_behind"), up), 0.0);
        near(floor_under(&diffuse("both"), up), 0.0);
        near(floor_under(r#"{"unlit": {"color": 7}}"#, up), LIT);
    }
}

/// Paths that scatter at the floor pass straight through the back of a ceiling, and hit its front.
#[test]
fn paths_pass_through_the_back_of_a_surface_without_one() {
    let sky = |sheet: &str, up: bool| {
        let scene = Scene::floor().in_light(2.0).placed(SHEET, facing(up, Vec3::Y * 0.01), sheet);
        measure(&scene.world(), &looking(Vec3::Y * 0.005, Vec3::ZERO), &*path(""), 64).mean
    };
    let open = sky(r#"{"unlit": {}}"#, true);
    assert!((open - 1.0).abs() < 1e-3, "{open}");
    assert!((sky(&diffuse("front"), true) - 1.0).abs() < 1e-3);
    assert!(sky(&diffuse("front"), false) < 0.01);
    assert!(sky(&diffuse("black_behind"), true) < 0.01);
}

#[test]
fn cameras_see_the_front_of_one_sided_surfaces_and_through_their_back() {
    let seen = |sheet: &str, up: bool, options: &str| {
        let scene = Scene::floor().lit(LIGHT).placed(SHEET, facing(up, Vec3::Y), sheet);
        measure(&scene.world(), &looking(Vec3::new(0.3, 5.0, 0.2), Vec3::ZERO), &*path(options), 4).mean
    };
    // From above, a sheet that faces down is absent; the light is above it, so the floor has light
    // only if shadow rays hit no front.
    assert_eq!(seen(&diffuse("front"), false, r#""max_depth": 2"#), 0.0);
    assert_eq!(seen(&diffuse("black_behind"), false, r#""max_depth": 2"#), 0.0);
    let top = seen(&diffuse("front"), true, r#""max_depth": 2"#);
    assert!((top - 0.4 / PI * 5.0).abs() < 0.05, "{top}");
    assert_eq!(seen(r#"{"unlit": {"color": 7}}"#, false, ""), 7.0);
}

/// A square that emits to its front: the light is that of the plain emitter of one side.
#[test]
fn one_sided_emitters_light_what_their_front_faces() {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let place = facing(false, Vec3::Y);
    let form = 0.5 / PI * 3.0 * polygon(&corners.map(|[x, z]| place.point(Vec3::new(x, 0.0, z))), Vec3::Y);
    let square = r#"{"rectangle": {"size": [2, 2]}}"#;
    for sides in ["front", "black_behind"] {
        let emitter =
            format!(r#"{{"principled": {{"emissive": 3, "base_color": 0, "specular": 0, "sides": "{sides}"}}}}"#);
        traced(Scene::floor().placed(square, place, &emitter), &at_origin(), 512).is(form);
        let dark = Scene::floor().placed(square, facing(true, Vec3::Y), &emitter);
        assert_eq!(traced(dark, &at_origin(), 16).mean, 0.0);
    }
}

/// Unlit surfaces in mirrors and behind glass, and as walls that light nothing.
#[test]
fn unlit_surfaces_are_seen_in_mirrors_and_light_nothing() {
    let poster = r#"{"unlit": {"color": 7}}"#;
    let mirror = r#"{"conductor": {"reflectance": 1, "roughness": 0}}"#;
    let scene = Scene::new().with(r#"{"plane": {}}"#, Vec3::ZERO, mirror).with(SHEET, Vec3::Y * 10.0, poster);
    let seen = measure(&scene.world(), &at_origin(), &*path(""), 4).mean;
    assert!((seen - 7.0).abs() < 1e-3, "{seen}");
    let glass = r#"{"dielectric": {"thin": true}}"#;
    let scene = Scene::new().with(SHEET, Vec3::Y, glass).with(SHEET, Vec3::ZERO, poster);
    traced(scene, &at_origin(), 256).is(7.0 * transmitted());
    let room = || Scene::floor().lit(LIGHT);
    let alone = traced(room(), &at_origin(), 16);
    let among = traced(room().with(SHEET, Vec3::Y * 1.5, poster).with(SHEET, Vec3::Y * 9.0, poster), &at_origin(), 16);
    assert!((among.mean - 7.0).abs() < 1e-6, "the camera looks at the poster");
    let inside = looking(Vec3::new(0.3, 0.4, 0.2), Vec3::ZERO);
    traced(room().with(SHEET, Vec3::Y * 1.5, poster), &inside, 16).equals(alone, "a poster above the floor");
}

/// Share of light that a pane of index 1.5 transmits in the direction of [`at_origin`], with
/// reflections between its faces: (1 - r) / (1 + r), the mean of both polarizations.
fn transmitted() -> f64 {
    let eye = Vec3::new(3.0, 2.0, 4.0).as_dvec3();
    let (cos, n) = (eye.y / eye.length(), 1.5f64);
    let behind = (1.0 - (1.0 - cos * cos) / (n * n)).sqrt();
    let (parallel, perpendicular) = ((n * cos - behind) / (n * cos + behind), (cos - n * behind) / (cos + n * behind));
    let r = (parallel * parallel + perpendicular * perpendicular) / 2.0;
    (1.0 - r) / (1.0 + r)
}
