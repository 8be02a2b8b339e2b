//! Area lights: emissive shapes for paths, and equally bright under the integrator `classic`.

use juggler::integrator::IntegratorKind;
use juggler::{Picture, Settings};
use juggler_scene::Scene;

/// A white floor that fills the view, lit by these lights and objects.
fn floor(material: &str, lights: &str, objects: &str) -> Scene {
    let text = format!(
        r#"{{"version": 1, "render": {{"size": [16, 16], "samples": 64}},
            "camera": {{"perspective": {{"eye": [3, 4, 0], "look_at": [0, 0, 0], "vertical_fov_degrees": 20}}}},
            "lights": [{lights}], "background": [0, 0, 0],
            "objects": [{{"shape": {{"rectangle": {{"size": [9, 9]}}}}, "material": {material}}} {objects}]}}"#
    );
    Scene::from_json(text, "floor.json").unwrap()
}

fn picture(scene: &Scene, integrator: Option<IntegratorKind>) -> (f32, Vec<juggler::math::Rgb>) {
    let settings = Settings { integrator, ..Settings::default() };
    let image = juggler::render(scene, &settings).unwrap();
    let sum: f32 = image.pixels().iter().map(|pixel| pixel.g).sum();
    (sum / image.pixels().len() as f32, image.pixels().to_vec())
}

const DIFFUSE: &str = r#"{"diffuse": {"reflectance": [0.8, 0.8, 0.8]}}"#;
const PHONG: &str = r#"{"phong": {"diffuse": [0.8, 0.8, 0.8]}}"#;

#[test]
fn an_area_light_is_an_emissive_shape() {
    // Radiance of 12 W emitted from one side of 1.2 square units.
    let radiance = 12.0 / (std::f32::consts::PI * (1.5f32 * 0.8));
    let light = r#"{"area": {"shape": {"rectangle": {"size": [1.5, 0.8]}}, "position": [0, 2, 0.5], "power": 12}}"#;
    let shape = format!(
        r#", {{"shape": {{"rectangle": {{"size": [1.5, 0.8]}}}}, "transform": [{{"matrix": [1,0,0,0, 0,-1,0,2, 0,0,-1,0.5]}}],
            "material": {{"emissive": {{"radiance": [{radiance}, {radiance}, {radiance}]}}}}}}"#
    );
    let (mean, light) = picture(&floor(DIFFUSE, light, ""), None);
    let (_, shape) = picture(&floor(DIFFUSE, "", &shape), None);
    assert!(mean > 0.1 && light == shape, "{mean}");
}

#[test]
fn area_lights_are_equally_bright_in_the_classic_integrator() {
    for form in [
        r#""shape": {"rectangle": {"size": [1.5, 0.8]}}"#,
        r#""shape": {"disk": {"radius": 0.7}}"#,
        r#""shape": {"sphere": {"radius": 0.4}}"#,
    ] {
        let light = format!(r#"{{"area": {{{form}, "position": [-1, 2, 0.5], "look_at": [0, 0, 0], "power": 40}}}}"#);
        for material in [DIFFUSE, PHONG] {
            let scene = floor(material, &light, "");
            let [classic, direct] =
                [IntegratorKind::Classic, IntegratorKind::Direct].map(|kind| picture(&scene, Some(kind)).0);
            assert!(classic > 0.1 && (classic / direct - 1.0).abs() < 0.02, "{form} {material}: {classic} {direct}");
        }
    }
}

#[test]
fn a_picture_says_which_integrator_made_it() {
    let reason = |scene: &Scene, settings: &Settings| {
        let picture = Picture::new(scene, settings).unwrap();
        (picture.integrator().name(), picture.compiled().integrator.reason.to_string())
    };
    let scene = floor(DIFFUSE, "", "");
    let (name, why) = reason(&scene, &Settings::default());
    assert!(name == "path" && why.contains("`diffuse` at `objects[0].material`"), "{why}");
    let classic = Settings { integrator: Some(IntegratorKind::Classic), ..Settings::default() };
    assert_eq!(reason(&scene, &classic), ("classic", "set outside the scene".into()));
    // A maximum depth applies to the default integrator.
    let deep = Settings { max_depth: Some(3), ..Settings::default() };
    let (name, why) = reason(&floor(PHONG, "", ""), &deep);
    assert!(name == "classic" && why.contains("`classic` supports all lights"), "{why}");
    // Another view keeps the integrator.
    let picture = Picture::new(&scene, &Settings::default()).unwrap();
    let seen = picture.with_view(picture.view()).unwrap();
    assert_eq!((seen.integrator(), seen.fingerprint()), (picture.integrator(), picture.fingerprint()));
}
