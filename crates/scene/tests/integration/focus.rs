//! Cameras that frame all objects or focus on one of them.

use glam::{UVec2, Vec2};
use juggler_camera::AnyCamera;
use juggler_math::Vec3;
use juggler_scene::{Scene, SceneError};
use std::sync::Arc;

fn scene(camera: &str) -> Scene {
    let text = format!(
        r#"{{"version": 1, {camera} "objects": [
            {{"name": "floor", "shape": "plane"}},
            {{"name": "far", "shape": "sphere", "transform": {{"translate": [1, 2, -4]}}}},
            {{"name": "near", "shape": {{"sphere": {{"radius": 0.5}}}}, "transform": {{"translate": [0, 0, 3]}}}}]}}"#
    );
    Scene::from_json(text, "focus.json").unwrap()
}

fn lens(fields: &str) -> Scene {
    scene(&format!(r#""camera": {{"thin_lens": {{"eye": [0, 0, 8], "direction": [0, 0, -1], {fields}}}}},"#))
}

fn selected(scene: &Scene) -> AnyCamera {
    scene.compile().unwrap().cameras.remove(0).1
}

fn focus_distance(scene: &Scene) -> f32 {
    match selected(scene) {
        AnyCamera::ThinLens(lens) => lens.focus_distance,
        other => panic!("{other:?} is no thin lens"),
    }
}

fn problems(scene: &Scene) -> String {
    match scene.compile() {
        Err(SceneError::Problems(problems)) => problems.to_string(),
        Ok(_) => panic!("the scene is valid"),
        Err(error) => panic!("{error}"),
    }
}

/// The distance is measured along the view direction to the middle of the object.
#[test]
fn lenses_focus_on_objects_by_name() {
    assert_eq!(focus_distance(&lens(r#""focus_on": "far""#)), 12.0);
    assert_eq!(focus_distance(&lens(r#""focus_on": "near", "focus_distance": 99"#)), 5.0);
    let moving = lens(r#""focus_on": "near""#).with_value("/objects/2/transform/0/translate/2", "=3 - frame".into());
    let moving = moving.unwrap();
    assert_eq!(focus_distance(&moving.at_frame(2.0).unwrap()), 7.0);
}

#[test]
fn objects_out_of_focus_are_reported() {
    let missing = problems(&lens(r#""focus_on": "near_""#));
    assert!(
        missing.contains("the object `near_` does not exist") && missing.contains("did you mean `near`?"),
        "{missing}"
    );
    assert!(missing.contains("camera.thin_lens.focus_on"), "{missing}");
    assert!(problems(&lens(r#""focus_on": "floor""#)).contains("the object `floor` has no bounds to focus on"));
    let behind = scene(r#""camera": {"thin_lens": {"eye": [0, 0, 1], "direction": [0, 0, -1], "focus_on": "near"}},"#);
    assert!(problems(&behind).contains("the object `near` is not in front of the camera"));
}

/// A camera that focuses on another object after an edit, or a scene that has lost its camera, is
/// compiled as a new scene is.
#[test]
fn edits_of_cameras_give_the_cameras_of_a_new_scene() {
    let before = lens(r#""focus_distance": 3"#);
    let earlier = before.compile().unwrap();
    for (pointer, value) in [("/camera/thin_lens/focus_on", "far".into()), ("/camera", serde_json::Value::Null)] {
        let after = before.with_value(pointer, value).unwrap();
        let updated = after.compile_after(&before, &earlier).unwrap();
        assert_eq!(updated.cameras, after.compile().unwrap().cameras, "{pointer}");
    }
    // Other cameras need no new world.
    let after = before.with_value("/camera/thin_lens/focus_distance", 4.into()).unwrap();
    assert!(Arc::ptr_eq(&after.compile_after(&before, &earlier).unwrap().world, &earlier.world));
}

/// The default camera sees the objects and not the plane; their outlines are equally far from opposite
/// edges, and the nearer pair of edges is a tenth of the picture away.
#[test]
fn the_default_camera_frames_the_objects() {
    for size in [[640, 480], [200, 400]] {
        let size_text = format!(r#""render": {{"size": [{}, {}]}},"#, size[0], size[1]);
        let camera = selected(&scene(&size_text));
        let size = UVec2::from(size);
        let projection = camera.projection(size).unwrap();
        let film = juggler_camera::WorldToFilm::new(&projection).unwrap();
        let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        for (center, radius) in [(Vec3::new(1.0, 2.0, -4.0), 1.0), (Vec3::new(0.0, 0.0, 3.0), 0.5)] {
            for i in 0..4000_u32 {
                let (turn, height) = ((i % 100) as f32 * 0.063, (i / 100) as f32 / 19.5 - 1.0);
                let across = (1.0 - height * height).max(0.0).sqrt();
                let normal = Vec3::new(across * turn.cos(), height, across * turn.sin());
                let at = film.point(center + radius * normal).unwrap();
                let at = Vec2::new(at.x as f32, at.y as f32) / size.as_vec2();
                (low, high) = (low.min(at), high.max(at));
            }
        }
        assert!((low + high - 1.0).abs().max_element() < 0.03, "{low} {high}");
        assert!(((high - low).max_element() - 0.8).abs() < 0.03, "{low} {high}");
    }
}
