//! Lesson 2: a scene as JSON, seen by another camera than its own, into `from_above.png`.
//!
//! `cargo run --release --example 2_change_the_camera`

use juggler::prelude::*;

const SCENE: &str = r#"{
    "version": 1,
    "camera": {"perspective": {"eye": [0, 1, 6], "look_at": [0, 1, 0]}},
    "objects": [
        {"shape": {"plane": {}}},
        {"shape": {"sphere": {"radius": 1}}, "transform": [{"translate": [0, 1, 0]}]},
    ],
}"#;

fn main() -> Result<(), Error> {
    // A file is read by Scene::load("name.json").
    let mut scene = Scene::from_json(SCENE, "lesson.json")?;
    let above = Perspective { eye: vec3(0.0, 8.0, 2.0), look_at: vec3(0.0, 0.0, 0.0).into(), ..Default::default() };
    scene.description.camera = Some(above.into());
    juggler::render_to_file(&scene, &Settings::default(), "from_above.png")?;
    Ok(())
}
