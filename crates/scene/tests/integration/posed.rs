//! Value form `posed`: values that follow nodes of models. The node `Head` of the model `walk.toy` has
//! the scale 2 and moves along x by one unit a second at y = 2.

use crate::models::{LOADER, scene_with};
use juggler_light::AnyLight;
use juggler_math::Vec3;
use juggler_scene::{Bundle, Scene};
use std::fs;

const TIME: &str = r#", "render": {"shutter": [0, 1]}, "animation": {"frames": 30, "frames_per_second": 10}"#;

/// Scene with a unit sphere and these transform steps.
fn follower(steps: &str) -> Scene {
    scene_with(&format!(r#"{{"shape": "sphere", "transform": [{steps}]}}"#), TIME).unwrap()
}

/// Center of the sphere of a scene at a frame, with a closed shutter.
fn center(scene: &Scene, frame: f64) -> Vec3 {
    let mut scene = scene.at_frame(frame).unwrap().still();
    scene.description.render.shutter = [0.0; 2];
    let bounds = scene.compile().unwrap().bounds;
    (bounds.min + bounds.max) / 2.0
}

fn posed(settings: &str) -> String {
    format!(r#"{{"posed": {{"file": "walk.toy", "node": "Head", {settings}}}}}"#)
}

#[test]
fn points_vectors_and_matrices_follow_a_node() {
    let translated = |settings: &str| follower(&format!(r#"{{"translate": {}}}"#, posed(settings)));
    let point = translated(r#""point": [1, 0, 3]"#);
    assert!(point.depends_on_time());
    assert_eq!(center(&point, 0.0), Vec3::new(2.0, 2.0, 6.0));
    assert_eq!(center(&point, 5.0), Vec3::new(2.5, 2.0, 6.0));
    assert_eq!(center(&translated(r#""vector": [1, 0, 3]"#), 5.0), Vec3::new(2.0, 0.0, 6.0));
    let fixed = translated(r#""point": [0, 0, 0], "at": 0.25"#);
    assert!(!fixed.depends_on_time());
    assert_eq!(center(&fixed, 7.0), Vec3::new(0.25, 2.0, 0.0));
    let later = translated(r#""point": [0, 0, 0], "at": "=seconds + 1", "animation": "Walk""#);
    assert_eq!(center(&later, 5.0), Vec3::new(1.5, 2.0, 0.0));
    assert_eq!(center(&translated(r#""point": [0, 0, 0], "animation": "none""#), 5.0), Vec3::new(0.0, 2.0, 0.0));
    let matrix = follower(r#"{"translate": [1, 0, 0]}, {"matrix": {"posed": {"file": "walk.toy", "node": "Head"}}}"#);
    assert_eq!(center(&matrix, 5.0), Vec3::new(2.5, 2.0, 0.0));
    let bounds = matrix.still().compile().unwrap().bounds;
    assert_eq!(bounds.max - bounds.min, Vec3::splat(4.0));
}

#[test]
fn followers_move_while_the_shutter_is_open() {
    let point = follower(&format!(r#"{{"translate": {}}}"#, posed(r#""point": [0, 0, 0]"#)));
    let bounds = point.at_frame(5.0).unwrap().compile().unwrap().bounds;
    assert!((bounds.min.x + 0.5).abs() < 1e-5 && (bounds.max.x - 1.6).abs() < 1e-5, "{bounds:?}");
    let light = format!(r#", "lights": [{{"point": {{"position": {}}}}}]{TIME}"#, posed(r#""point": [0, 1, 0]"#));
    let light = scene_with(r#"{"shape": "sphere"}"#, &light).unwrap().at_frame(20.0).unwrap();
    let AnyLight::Point(point) = &*light.description.lights[0] else { panic!("not a point light") };
    assert_eq!(point.position, Vec3::new(2.0, 4.0, 0.0));
    assert!(light.compile().unwrap().world.lights()[0].moves());
}

#[test]
fn mistakes_are_reported_at_their_settings() {
    let message = |posed: &str| {
        let object = format!(r#"{{"shape": "sphere", "transform": [{{"translate": {{"posed": {posed}}}}}]}}"#);
        scene_with(&object, "").unwrap_err().to_string()
    };
    for (posed, expected) in [
        (r#"{"file": "walk.toy", "node": "Heap", "point": [0, 0, 0]}"#, ["no node Heap", "posed.node"]),
        (r#"{"file": "none.toy", "node": "Head", "point": [0, 0, 0]}"#, ["none.toy", "posed.file"]),
        (r#"{"file": "a.json", "node": "Head", "point": [0, 0, 0]}"#, ["no known format", "posed.file"]),
        (r#"{"file": "walk.toy", "node": "Head", "animation": "Run", "point": [0, 0, 0]}"#, ["no animation", "posed"]),
        (r#"{"file": "walk.toy", "node": "Head", "point": [0, 0, 0], "vector": [0, 0, 1]}"#, ["exclude", "posed"]),
        (r#"{"file": "walk.toy", "point": [0, 0, 0]}"#, ["`node`", "posed"]),
        (r#"{"file": "walk.toy", "node": "Head"}"#, ["3", "translate"]),
    ] {
        let message = message(posed);
        assert!(expected.iter().all(|text| message.contains(text)), "{posed}: {message}");
    }
    let plain = r#"{"version": 1, "objects": [{"shape": "sphere", "transform": {"translate":
        {"posed": {"file": "walk.toy", "node": "Head", "point": [0, 0, 0]}}}}]}"#;
    let bundle = Bundle::from_iter(
        [("a.json", plain), ("walk.toy", "toy\nclip\n")]
            .map(|(name, text)| (name.to_owned(), text.as_bytes().to_vec())),
    );
    assert!(Scene::from_bundle(bundle, "a.json").unwrap_err().to_string().contains("format"));
}

#[test]
fn saved_and_reloaded_scenes_find_the_models_that_they_follow() {
    let folder = tempfile::tempdir().unwrap();
    let (model, scene, inner) =
        (folder.path().join("walk.toy"), folder.path().join("scene.json"), folder.path().join("inner"));
    fs::write(&model, "toy\nclip\n").unwrap();
    let head = posed(r#""point": [0, 0, 0]"#);
    let text = format!(
        r#"{{"version": 1, "variables": {{"head": {head}}}, "objects": [
            {{"shape": "sphere", "transform": [{{"translate": "=head"}}]}},
            {{"shape": "sphere", "transform": [{{"translate": {head}}}]}}]}}"#
    );
    fs::write(&scene, text).unwrap();
    let loaded = LOADER.load(&scene).unwrap();
    assert!(loaded.depends_on_time() && loaded.paths().contains(&model), "{:?}", loaded.paths());
    fs::create_dir(&inner).unwrap();
    let saved = inner.join("a.json");
    let json = loaded.to_json_in(&inner);
    assert_eq!(json.matches("\"../walk.toy\"").count(), 2, "{json}");
    fs::write(&saved, json).unwrap();
    let centers = |scene: &Scene| center(scene, 6.0);
    assert_eq!(centers(&LOADER.load(&saved).unwrap()), centers(&loaded));
    let edited = loaded.with_value("/objects/0/transform/0/translate", serde_json::json!([9, 0, 0])).unwrap();
    assert!(edited.at_frame(6.0).is_ok());
    fs::write(&model, "toy\n").unwrap();
    assert_eq!(centers(&loaded.reload(&scene).unwrap()), Vec3::new(0.0, 2.0, 0.0));
    assert_eq!(loaded.survey().forms.iter().filter(|form| form.node.as_deref() == Some("walk.toy: Head")).count(), 2);
}
