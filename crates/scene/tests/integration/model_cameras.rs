//! Cameras of models: `render.camera` selects them by their whole names or by the names of the file.

use crate::models::scene_with;
use juggler_scene::Scene;

const TWO: &str = r#"{"model": {"file": "still.toy"}}, {"objects": [{"model": {"file": "walk.toy"}}]}"#;

fn chosen(scene: &Scene) -> String {
    scene.compile().unwrap().cameras[0].0.clone()
}

fn with_camera(objects: &str, name: &str) -> Result<Scene, String> {
    let scene = scene_with(objects, &format!(r#", "render": {{"camera": "{name}"}}"#));
    let scene = scene.map_err(|error| error.to_string())?;
    match scene.check() {
        report if report.to_string().contains("no camera is called") => Err(report.to_string()),
        _ => Ok(scene),
    }
}

#[test]
fn names_select_cameras_of_models() {
    let one = r#"{"model": {"file": "walk.toy"}}"#;
    for (objects, name, expected) in
        [(TWO, "walk/Eye", "walk/Eye"), (TWO, "still/Eye", "still/Eye"), (one, "Eye", "walk/Eye")]
    {
        let scene = with_camera(objects, name).unwrap();
        assert_eq!(chosen(&scene), expected, "{name}");
        let again = scene_with(objects, "").unwrap().with_value("/render/camera", name.into()).unwrap();
        assert_eq!(chosen(&again), expected, "{name}");
    }
    assert_eq!(chosen(&scene_with(TWO, "").unwrap()), "still/Eye", "the first camera without a choice");
    assert_eq!(scene_with(TWO, "").unwrap().camera_names(), ["still/Eye", "walk/Eye"]);
}

#[test]
fn unknown_and_ambiguous_names_of_cameras_are_errors() {
    let unknown = with_camera(TWO, "walk/Eyes").unwrap_err();
    assert!(unknown.contains("no camera is called `walk/Eyes`") && unknown.contains("`walk/Eye`"), "{unknown}");
    assert!(with_camera(TWO, "Eye").is_err(), "two models have this camera");
}
