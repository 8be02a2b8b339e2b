//! Irradiance of a floor by lights with closed forms; 256 estimates of 64 samples each unless
//! stated otherwise.

use crate::closed_forms::{polygon, rectangle};
use crate::probe::{Scene, at_origin, camera, json, looking, measure, path, traced};
use juggler_math::{Transform, Vec3};
use std::f64::consts::PI;

/// Radiance of the floor per irradiance: albedo 0.5 over π.
const SHOWN: f64 = 0.5 / PI;

const EMITTER: &str = r#"{"emissive": {"radiance": 3}}"#;

/// Turned upside down, then moved.
fn down(at: Vec3) -> Transform {
    Transform::rotation(Vec3::X, std::f32::consts::PI).unwrap().then(&Transform::translation(at))
}

#[test]
fn sphere_emitter_matches_the_closed_form() {
    for (center, radius) in [(Vec3::new(0.0, 3.0, 0.0), 1.0), (Vec3::new(-2.0, 2.5, -1.0), 0.8)] {
        let scene = Scene::floor().with(&format!(r#"{{"sphere": {{"radius": {radius}}}}}"#), center, EMITTER);
        let distance = f64::from(center.length());
        let sine = radius / distance;
        traced(scene, &at_origin(), 64).is(SHOWN * 3.0 * PI * sine * sine * f64::from(center.y) / distance);
    }
}

#[test]
fn disk_emitter_matches_the_closed_form() {
    let scene = Scene::floor().placed(r#"{"disk": {"radius": 1.5}}"#, down(Vec3::Y * 2.0), EMITTER);
    traced(scene, &at_origin(), 64).is(SHOWN * 3.0 * PI * 2.25 / (2.25 + 4.0));
}

#[test]
fn rectangle_emitters_match_the_closed_form() {
    let size = r#"{"rectangle": {"size": [2, 3]}}"#;
    let center = Vec3::new(0.3, 1.2, -0.5);
    let above = Scene::floor().placed(size, down(center), EMITTER);
    traced(above, &at_origin(), 64).is(SHOWN * 3.0 * rectangle(center, [Vec3::X * 2.0, Vec3::Z * 3.0]));
    // Stand the rectangle on the floor, its front towards +x.
    let center = Vec3::new(-1.0, 1.0, 0.4);
    let upright = Transform::rotation(Vec3::Z, -std::f32::consts::FRAC_PI_2).unwrap();
    let beside = Scene::floor().placed(size, upright.then(&Transform::translation(center)), EMITTER);
    traced(beside, &at_origin(), 256).is(SHOWN * 3.0 * rectangle(center, [Vec3::Y * 2.0, Vec3::Z * 3.0]));
}

#[test]
fn triangle_emitter_matches_the_closed_form() {
    let corners = [Vec3::new(-1.0, 1.0, 0.5), Vec3::new(0.8, 2.0, 1.0), Vec3::new(0.3, 1.5, -1.4)];
    for corners in [corners, [corners[0], corners[2], corners[1]]] {
        let vertices = corners.map(json).join(", ");
        let shape = format!(r#"{{"triangle": {{"vertices": [{vertices}]}}}}"#);
        let scene = Scene::floor().with(&shape, Vec3::ZERO, EMITTER);
        let faces_down = (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(-corners[0]) > 0.0;
        if faces_down {
            traced(scene, &at_origin(), 64).is(SHOWN * 3.0 * polygon(&corners, Vec3::Y));
        } else {
            assert_eq!(traced(scene, &at_origin(), 16).mean, 0.0);
        }
    }
}

/// The form factor of two parallel unit squares at a distance of 1 is 0.19982, that of two that
/// share an edge at a right angle 0.20004 (Howell, C-11 and C-14).
#[test]
fn squares_of_a_box_match_published_form_factors() {
    let square = r#"{"rectangle": {"size": [1, 1]}}"#;
    let show = r#"{"diffuse": {"reflectance": 1}}"#;
    let emitter = r#"{"emissive": {"radiance": 1}}"#;
    // A camera at half height, whose picture is the floor.
    let floor = camera(
        r#"{"perspective": {"eye": [0, 0.5, 0], "look_at": [0, 0, 0], "up": [0, 0, -1], "vertical_fov_degrees": 90}}"#,
    );
    let opposed = Scene::new().with(square, Vec3::ZERO, show).placed(square, down(Vec3::Y), emitter);
    // Pixels show different points, so their spread does not measure the error, which is far
    // smaller.
    let mean = measure(&opposed.world(), &floor, &*path(""), 256).mean;
    assert!((mean - 0.199_825).abs() < 2e-4, "{mean}");
    let upright = Transform::rotation(Vec3::Z, -std::f32::consts::FRAC_PI_2).unwrap();
    let upright = upright.then(&Transform::translation(Vec3::new(-0.5, 0.5, 0.0)));
    let right = Scene::new().with(square, Vec3::ZERO, show).placed(square, upright, emitter);
    let mean = measure(&right.world(), &floor, &*path(""), 1024).mean;
    assert!((mean - 0.200_044).abs() < 4e-4, "{mean}");
}

#[test]
fn a_point_falls_off_with_the_square() {
    for at in [Vec3::Y, Vec3::new(1.0, 2.0, -2.0), Vec3::new(0.0, 30.0, 40.0)] {
        let light = format!(r#"{{"point": {{"position": {}, "intensity": 5}}}}"#, json(at));
        let distance = f64::from(at.length());
        traced(Scene::floor().lit(&light), &at_origin(), 4).is(SHOWN * 5.0 * f64::from(at.y) / distance.powi(3));
    }
}

#[test]
fn a_spot_fades_between_its_angles() {
    // The origin lies 30 degrees off the axis: inside the beam, halfway to the cut-off, outside.
    for (beam, cutoff, share) in [(35.0, 40.0, 1.0), (20.0, 40.0, 0.5), (20.0, 29.0, 0.0)] {
        let light = format!(
            r#"{{"spot": {{"position": [0, 2, 0], "direction": [0.57735027, -1, 0], "intensity": 5,
            "beam_degrees": {beam}, "cutoff_degrees": {cutoff}}}}}"#
        );
        let measured = traced(Scene::floor().lit(&light), &at_origin(), 4);
        if share == 0.0 { assert_eq!(measured.mean, 0.0) } else { measured.is(SHOWN * 5.0 / 4.0 * share) }
    }
}

/// The irradiance of a sun above the horizon is `intensity` times the cosine of its center, whatever
/// the size of its disk.
#[test]
fn sun_of_any_angular_size_matches_the_closed_form() {
    for angle in [0.0f64, 0.53, 40.0, 80.0] {
        let light =
            format!(r#"{{"directional": {{"direction": [1, -2, 2], "intensity": 4, "angle_degrees": {angle}}}}}"#);
        traced(Scene::floor().lit(&light), &at_origin(), 64).is(SHOWN * 4.0 * 2.0 / 3.0);
    }
}

#[test]
fn lights_add_up() {
    let point = r#"{"point": {"position": [1, 2, 1], "intensity": 5}}"#;
    let sun = r#"{"directional": {"direction": [1, -1, 0], "intensity": 0.3}}"#;
    let (sphere, at) = (r#"{"sphere": {"radius": 0.5}}"#, Vec3::new(-1.0, 2.0, -1.0));
    let each = [
        Scene::floor().lit(point),
        Scene::floor().lit(sun),
        Scene::floor().with(sphere, at, EMITTER),
        Scene::floor().in_light(0.2),
    ];
    let sum: f64 = each.map(|scene| traced(scene, &at_origin(), 1024).mean).iter().sum();
    // The sphere hides a small part of the sky.
    let hidden = SHOWN * 0.2 * PI * 0.25 / 6.0 * 2.0 / 6f64.sqrt();
    let all = Scene::floor().lit(point).lit(sun).with(sphere, at, EMITTER).in_light(0.2);
    traced(all, &at_origin(), 1024).is(sum - hidden);
}

/// 1,024 tiles equal one rectangle.
#[test]
fn rectangle_of_1024_emitters_equals_one_rectangle() {
    let center = Vec3::new(0.3, 1.5, -0.2);
    let side = 2.0 / 32.0;
    let tile = format!(r#"{{"rectangle": {{"size": [{side}, {side}]}}}}"#);
    let mut tiles = Scene::floor();
    let place = |i: u16| (f32::from(i) + 0.5) * side - 1.0;
    for i in 0..32 * 32 {
        tiles = tiles.placed(&tile, down(center + Vec3::new(place(i % 32), 0.0, place(i / 32))), EMITTER);
    }
    traced(tiles, &at_origin(), 256).is(SHOWN * 3.0 * rectangle(center, [Vec3::X * 2.0, Vec3::Z * 2.0]));
}

/// An integrating sphere: diffuse interreflection makes the irradiance uniform after the first
/// bounce (Sumpner 1892).
#[test]
fn integrating_sphere_is_uniform() {
    let shell = r#"{"sphere": {"radius": 2}}"#;
    let wall = r#"{"diffuse": {"reflectance": 0.5}}"#;
    let light = r#"{"point": {"position": [0, 0, 0], "intensity": 12.566370614}}"#;
    let centered = Scene::new().with(shell, Vec3::ZERO, wall).lit(light);
    let camera = looking(Vec3::new(0.2, 0.3, 0.1), Vec3::new(0.0, 0.0, -2.0));
    // E = I / r² = π, of which 0.5 / π is visible; interreflection doubles it.
    traced(centered, &camera, 64).is(1.0);
    let light = r#"{"point": {"position": [0, 0, 1], "intensity": 12.566370614}}"#;
    let aside = Scene::new().with(shell, Vec3::ZERO, wall).lit(light);
    traced(aside, &camera, 256).is(SHOWN * 4.0 * PI / 9.0 + 0.5);
    let emissive = r#"{"emissive": {"radiance": 0.5, "sides": "both", "material": {"diffuse": {"reflectance": 0.5}}}}"#;
    traced(Scene::new().with(shell, Vec3::ZERO, emissive), &camera, 64).is(1.0);
}
