//! What the format promises, by example.

#![expect(clippy::unwrap_used, reason = "a test")]

use juggler_scene::{Scene, SceneError};

const SKELETON: &str = r##"{
  "version": 1, // comments and trailing commas are welcome
  "render": {"size": [640, 360], "samples": 16, "integrator": {"classic": {}}},
  "cameras": {"main": {"perspective": {"eye": [0, 2, 6], "look_at": [0, 1, 0], "vertical_fov_degrees": 40}}},
  "textures": {},
  "materials": {"red": {"phong": {"diffuse": "#c02020", "shininess": 20}}},
  "lights": [{"point": {"position": [4, 6, 4], "color": [1, 1, 1], "intensity": 60}}],
  "groups": {"pair": [{"shape": {"sphere": {}}}, {"shape": {"sphere": {}}, "material": {"phong": {}}}]},
  "objects": [
    {"shape": {"sphere": {"radius": 1}}, "transform": [{"translate": [0, 1, 0]}], "material": "red"},
    {"group": "pair", "transform": [{"scale": 2}, {"rotate": {"axis": [0, 1, 0], "degrees": "=90/3"}}]},
  ],
}"##;

fn scene(text: &str) -> Scene {
    Scene::from_json(text, "test.json").unwrap()
}

#[test]
fn the_skeleton_compiles() -> Result<(), SceneError> {
    let compiled = scene(SKELETON).compile()?;
    assert_eq!(compiled.world.geometry().shapes, 3);
    assert_eq!(compiled.cameras.len(), 1);
    Ok(())
}
