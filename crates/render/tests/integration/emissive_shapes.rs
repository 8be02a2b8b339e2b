//! Emissive shapes: sampled directly, textured, in groups, rotated, scaled, mirrored, moving, with
//! opacity, and mixed.

use crate::closed_forms::{integral, polygon};
use crate::probe::{Scene, at_origin, json, looking, measure, path, prepared, traced};
use juggler_math::{Motion, Transform, Vec3};
use juggler_world::{Content, Geometry, Object};
use std::f64::consts::PI;
use std::sync::Arc;

const SHOWN: f64 = 0.5 / PI;
const EMITTER: &str = r#"{"emissive": {"radiance": 3}}"#;
const SQUARE: &str = r#"{"rectangle": {"size": [2, 2]}}"#;

fn down(at: Vec3) -> Transform {
    Transform::rotation(Vec3::X, std::f32::consts::PI).unwrap().then(&Transform::translation(at))
}

/// Corners of a transformed square of side 2 in the xz plane.
fn corners(transform: &Transform) -> [Vec3; 4] {
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, z]| transform.point(Vec3::new(x, 0.0, z)))
}

#[test]
fn emitter_shows_its_radiance_on_its_emitting_sides() {
    let from = |eye: f32, sides: &str| {
        let emitter = format!(r#"{{"emissive": {{"radiance": 3, "scale": 2, "sides": "{sides}"}}}}"#);
        let scene = Scene::new().with(SQUARE, Vec3::ZERO, &emitter);
        measure(&scene.world(), &looking(Vec3::new(0.0, eye, 1.0), Vec3::ZERO), &*path(r#""max_depth": 1"#), 4).mean
    };
    assert_eq!([from(2.0, "front"), from(-2.0, "front"), from(2.0, "both"), from(-2.0, "both")], [6.0, 0.0, 6.0, 6.0]);
}

const TEXTURES: &str = r#"{"tiles": {"checker": {"size": 0.25, "even": 4, "odd": 1, "space": "local", "axes": "xz"}}}"#;

/// 64 tiles, every other one brighter.
#[test]
fn textured_emitter_matches_the_sum_of_its_tiles() {
    let emitter = r#"{"emissive": {"radiance": "tiles"}}"#;
    let place = down(Vec3::new(0.2, 1.0, -0.1));
    let scene = Scene::textured(TEXTURES)
        .with(r#"{"plane": {}}"#, Vec3::ZERO, r#"{"diffuse": {"reflectance": 0.5}}"#)
        .placed(SQUARE, place, emitter);
    let tile = |i: i16| {
        let (x, z) = (i % 8 - 4, i / 8 - 4);
        let corner = |dx: i16, dz: i16| place.point(Vec3::new(f32::from(x + dx), 0.0, f32::from(z + dz)) * 0.25);
        let light = if (x + z) % 2 == 0 { 4.0 } else { 1.0 };
        light * polygon(&[corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)], Vec3::Y)
    };
    traced(scene, &at_origin(), 256).is(SHOWN * (0..64).map(tile).sum::<f64>());
}

/// Instances in instances: rotated, scaled and, in every other case, mirrored, with its own
/// material and with an inherited one.
#[test]
fn nested_instances_of_an_emitter_match_the_closed_form() {
    for (mirror, inherits) in [(1.0, false), (-1.0, false), (1.0, true), (-1.0, true)] {
        let mut scene = Scene::floor();
        let emitter = scene.material(EMITTER);
        let inner = Transform::rotation(Vec3::X, std::f32::consts::PI - 0.3).unwrap();
        let scale = Transform::scale(Vec3::new(mirror * 0.7, 1.2, 0.5)).unwrap();
        let outer = scale.then(&Transform::translation(Vec3::new(0.4, 1.5, 0.3)));
        let mut square = Object::new(prepared(SQUARE), inner, emitter);
        let mut group = Object {
            content: Content::Geometry(geometry(Vec::new())),
            motion: outer.into(),
            material: None,
            attributes: None,
        };
        if inherits {
            (square.material, group.material) = (None, Some(emitter));
        }
        group.content = Content::Geometry(geometry(vec![square]));
        scene.objects.push(group);
        let expected = polygon(&corners(&inner.then(&outer)), Vec3::Y);
        traced(scene, &at_origin(), 256).is(SHOWN * 3.0 * expected);
    }
}

fn geometry(objects: Vec<Object>) -> Arc<Geometry> {
    Arc::new(Geometry::new(objects, &juggler_math::BuildControl::default()).unwrap())
}

/// A mesh as one emitter: the four sides of a pyramid whose top points down, all visible from a
/// point below.
#[test]
fn mesh_emitter_matches_the_closed_form() {
    let base = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, z]| Vec3::new(x, 2.0, z));
    let top = Vec3::new(0.1, 1.4, 0.2);
    let positions = [base[0], base[1], base[2], base[3], top].map(json).join(", ");
    for (triangles, mirror) in
        [("[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]", 1.0), ("[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]", -1.0)]
    {
        let mesh = format!(r#"{{"mesh": {{"positions": [{positions}], "triangles": [{triangles}]}}}}"#);
        let place = Transform::scale(Vec3::new(mirror, 1.0, 1.0)).unwrap();
        let scene = Scene::floor().placed(&mesh, place, EMITTER);
        // Its silhouette is that of its base.
        traced(scene, &at_origin(), 256).is(SHOWN * 3.0 * polygon(&base, Vec3::Y));
    }
}

/// Shapes that are sampled as a whole, from a point where their silhouette has a closed form.
#[test]
fn cuboid_and_ellipsoid_emitters_match_closed_forms() {
    let cuboid = r#"{"cuboid": {"min": [-1, 1, -1], "max": [1, 2, 1]}}"#;
    let scene = Scene::floor().with(cuboid, Vec3::ZERO, EMITTER);
    traced(scene, &at_origin(), 256).is(SHOWN * 3.0 * polygon(&corners(&down(Vec3::Y)), Vec3::Y));
    // Irradiance from an ellipsoid straight above with semi-axes a, c, a and center at height h: π
    // a² / (h² - c² + a²).
    let stretched = Transform::scale(Vec3::new(1.0, 0.5, 1.0)).unwrap();
    let place = stretched.then(&Transform::translation(Vec3::Y * 2.0));
    let scene = Scene::floor().placed(r#"{"sphere": {"radius": 1}}"#, place, EMITTER);
    traced(scene, &at_origin(), 256).is(SHOWN * 3.0 * PI / (4.0 - 0.25 + 1.0));
}

#[test]
fn moving_emitter_matches_the_integral_over_time() {
    let keys = [Vec3::new(-2.0, 2.0, 0.0), Vec3::new(2.0, 2.0, 1.0)].map(Transform::translation);
    let motion = Motion::from_keys(keys.to_vec()).unwrap();
    let scene = Scene::floor().placed(r#"{"sphere": {"radius": 0.5}}"#, motion, EMITTER);
    let of = |time: f64| {
        let squared = (4.0 * time - 2.0).powi(2) + 4.0 + time * time;
        PI * 0.25 / squared * 2.0 / squared.sqrt()
    };
    traced(scene, &at_origin(), 256).is(SHOWN * 3.0 * integral(of));
}

/// A black sheet with an opacity of 0.3 transmits 0.7 of the light.
#[test]
fn partly_opaque_sheet_attenuates_an_emitter() {
    let sheet = r#"{"mask": {"opacity": 0.3, "material": {"diffuse": {"reflectance": 0}}}}"#;
    let emitter = Scene::floor().placed(SQUARE, down(Vec3::Y * 2.0), EMITTER);
    let scene = emitter.with(r#"{"rectangle": {"size": [50, 50]}}"#, Vec3::Y, sheet);
    let below = looking(Vec3::new(0.3, 0.5, 0.2), Vec3::ZERO);
    traced(scene, &below, 256).is(SHOWN * 3.0 * 0.7 * polygon(&corners(&down(Vec3::Y * 2.0)), Vec3::Y));
    let light = r#"{"point": {"position": [0, 2, 0], "intensity": 5}}"#;
    let scene = Scene::floor().lit(light).with(r#"{"rectangle": {"size": [50, 50]}}"#, Vec3::Y, sheet);
    traced(scene, &below, 4).is(SHOWN * 5.0 / 4.0 * 0.7);
}

/// Emission is scaled by opacity and by the mixing weight, for light and BSDF sampling alike.
#[test]
fn opacity_and_mixing_weight_scale_emission() {
    let expected = SHOWN * 3.0 * polygon(&corners(&down(Vec3::Y)), Vec3::Y);
    let masked = format!(r#"{{"mask": {{"opacity": 0.4, "material": {EMITTER}}}}}"#);
    traced(Scene::floor().placed(SQUARE, down(Vec3::Y), &masked), &at_origin(), 512).is(0.4 * expected);
    let black = r#"{"diffuse": {"reflectance": 0}}"#;
    for (amount, a, b, share) in [(0.3, EMITTER, black, 0.7), (0.3, black, EMITTER, 0.3), (0.8, EMITTER, black, 0.2)] {
        let mixed = format!(r#"{{"mix": {{"amount": {amount}, "a": {a}, "b": {b}}}}}"#);
        traced(Scene::floor().placed(SQUARE, down(Vec3::Y), &mixed), &at_origin(), 1024).is(share * expected);
    }
}

/// A sheet that mixes an opaque and a partly transparent material: shadows have the mean
/// transmittance.
#[test]
fn shadows_of_mixed_materials_have_the_mean_transmittance() {
    let black = r#"{"diffuse": {"reflectance": 0}}"#;
    let light = r#"{"point": {"position": [0, 2, 0], "intensity": 5}}"#;
    let below = looking(Vec3::new(0.3, 0.5, 0.2), Vec3::ZERO);
    let mask = format!(r#"{{"mask": {{"opacity": 0.1, "material": {black}}}}}"#);
    for (a, b, share) in [(&*mask, black, 0.9 * 0.7), (black, &*mask, 0.9 * 0.3)] {
        let mixed = format!(r#"{{"mix": {{"amount": 0.3, "a": {a}, "b": {b}}}}}"#);
        let scene = Scene::floor().lit(light).with(r#"{"rectangle": {"size": [50, 50]}}"#, Vec3::Y, &mixed);
        traced(scene, &below, 1024).is(SHOWN * 5.0 / 4.0 * share);
    }
}

/// The `phong` material: its emission acts as an area light.
#[test]
fn phong_materials_match_closed_forms() {
    let emitter = r#"{"phong": {"diffuse": 0, "specular": 0, "emission": 3}}"#;
    let scene = Scene::floor().with(r#"{"sphere": {"radius": 0.5}}"#, Vec3::Y * 2.0, emitter);
    traced(scene, &at_origin(), 256).is(SHOWN * 3.0 * PI * 0.25 / 4.0);
    // Its diffuse term has no factor 1/π: intensity 1 at distance 1 makes a white surface white.
    let floor = r#"{"phong": {"diffuse": 0.5, "specular": 0}}"#;
    let scene = Scene::new().with(r#"{"plane": {}}"#, Vec3::ZERO, floor);
    traced(scene.lit(r#"{"point": {"position": [0, 2, 0], "intensity": 5}}"#), &at_origin(), 4).is(0.5 * 5.0 / 4.0);
}
