//! Lesson 2: renders a JSON scene from its own camera to `lesson.png`, and from another camera to
//! `from_above.png`. The world and its acceleration structures are built once.
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
    // `Scene::load("name.json")` reads a file.
    let scene = Scene::from_json(SCENE, "lesson.json")?;
    let picture = Picture::new(&scene, &Settings::default())?;
    picture.render_in_memory(None, &Control::default())?.save("lesson.png")?;
    let above = Perspective::new([0.0, 8.0, 2.0], [0.0; 3]);
    let from_above = picture.with_view(View { camera: above.into(), ..picture.view() })?;
    from_above.render_in_memory(None, &Control::default())?.save("from_above.png")?;
    Ok(())
}
