//! Inline textures, which are written in place of a texture's name.

use juggler_material::AnyMaterial;
use juggler_scene::{Problems, Scene, SceneError};
use juggler_texture::{AnyTexture, Input};

/// A scene with `diffuse` as the color of its only material.
fn scene(diffuse: &str, more: &str) -> String {
    format!(
        r#"{{"version": 1{more},
  "materials": {{"wall": {{"phong": {{"diffuse": {diffuse}}}}}}},
  "objects": [{{"shape": "sphere", "material": "wall"}}]}}"#
    )
}

fn problems(text: String) -> Problems {
    match Scene::from_json(text, "inline.json") {
        Ok(scene) => scene.check(),
        Err(SceneError::Problems(problems)) => problems,
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn inline_texture_becomes_a_named_texture() {
    let marble = r#"{"marble": {"scale": 2, "stone": [0.9, 0.8, 0.7]}}"#;
    let scene = Scene::from_json(scene(marble, ""), "inline.json").unwrap();
    let name = "/materials/wall/phong/diffuse";
    assert_eq!(scene.description.textures[name], serde_json::from_str::<AnyTexture>(marble).unwrap());
    let AnyMaterial::Phong(wall) = &*scene.description.materials["wall"] else { panic!("another material") };
    assert_eq!(wall.diffuse, Input::Texture(name.into()));
    assert_eq!(scene.compile().unwrap().warnings.list(), []);
    // The written scene names the texture and reads as the same scene.
    let again = Scene::from_json(scene.to_json(), "again.json").unwrap();
    assert_eq!(again.description, scene.description);
}

#[test]
fn inline_textures_nest_in_textures_and_materials() {
    let nested = r#"{"mix": {"a": {"noise": {}}, "b": {"checker": {"even": "tiles", "odd": {"wood": {}}}}, "amount": {"fbm": {}}}}"#;
    let tiles = r#", "textures": {"tiles": {"checker": {"odd": {"dots": {}}}}}"#;
    let text = scene(nested, tiles).replace(
        r#""material": "wall""#,
        r#""material": {"principled": {"roughness": {"wave": {}}, "base_color": {"brick": {}}}}"#,
    );
    let scene = Scene::from_json(text, "inline.json").unwrap();
    assert_eq!(scene.description.textures.len(), 9);
    assert!(scene.description.textures.contains_key("/objects/0/material/principled/roughness"));
    assert!(scene.description.textures.contains_key("/materials/wall/phong/diffuse/mix/b/checker/odd"));
    scene.compile().unwrap();
}

#[test]
fn errors_are_reported_at_their_place() {
    for (diffuse, path, message) in [
        (r#"{"noise": {"scale": 0}}"#, "materials.wall.phong.diffuse.noise.scale", "must not be 0"),
        (r#"{"noise": {"scael": 1}}"#, "materials.wall.phong.diffuse.noise.scael", "scael"),
        (r#"{"nose": {}}"#, "materials.wall.phong.diffuse", "unknown kind of texture `nose`"),
        (r#"{"image": {"file": "none.png"}}"#, "materials.wall.phong.diffuse.image.file", "file not found"),
        (
            r#"{"checker": {"even": "nobody"}}"#,
            "materials.wall.phong.diffuse.checker.even",
            "no texture is called `nobody`",
        ),
        (r#"{"mix": {"a": {"dots": {"radius": 7}}}}"#, "materials.wall.phong.diffuse.mix.a.dots.radius", "`radius`"),
    ] {
        let problems = problems(scene(diffuse, ""));
        let [problem] = problems.list() else { panic!("{diffuse}: {problems}") };
        assert!(problem.path.starts_with(path) && problem.message.contains(message), "{diffuse}: {problems}");
        assert!(problem.place.is_some_and(|place| problems.sources().get(place.file).is_some()), "{diffuse}");
        assert!(problems.to_string().contains("inline.json:2:"), "{problems}");
    }
    let taken = r#", "textures": {"/materials/wall/phong/diffuse": {"noise": {}}}"#;
    let problems = problems(scene(r#"{"dots": {}}"#, taken));
    assert!(
        problems.to_string().contains("the name `/materials/wall/phong/diffuse` of the inline texture"),
        "{problems}"
    );
}

#[test]
fn products_have_textures_inline_or_by_name() {
    for (diffuse, textures) in [
        (r#"{"texture": "tiles", "factor": [1, 0.5, 0.25]}"#, 1),
        (r##"{"texture": {"dots": {}}, "factor": "#ffffff", "attribute": "color"}"##, 2),
        (r#"{"texture": {"mix": {"a": {"texture": "tiles"}, "b": {"attribute": {}}}}}"#, 3),
        (r#"{"attribute": "color"}"#, 1),
        (r#"{"attribute": {"name": "color"}}"#, 2),
    ] {
        let text = scene(diffuse, r#", "textures": {"tiles": {"checker": {}}}"#);
        let scene = Scene::from_json(text, "inline.json").unwrap_or_else(|error| panic!("{diffuse}: {error}"));
        assert_eq!(scene.description.textures.len(), textures, "{diffuse}");
        assert_eq!(scene.compile().unwrap().warnings.list(), [], "{diffuse}");
        let again = Scene::from_json(scene.to_json(), "again.json").unwrap();
        assert_eq!(again.description, scene.description, "{diffuse}");
    }
}

#[test]
fn errors_in_products_are_reported_at_their_place() {
    for (diffuse, path, message) in [
        (r#"{"texture": "nobody", "factor": 0.5}"#, "diffuse.texture", "no texture is called `nobody`"),
        (r#"{"texture": {"noise": {"scale": 0}}}"#, "diffuse.texture.noise.scale", "must not be 0"),
        (r#"{"texture": {"noise": {}}, "factor": -1}"#, "diffuse", "`diffuse` must be"),
        (r#"{"factor": 0.5}"#, "diffuse", "needs a `texture` or an `attribute`"),
        (r#"{"texture": {"noise": {}}, "fakctor": 1}"#, "diffuse.fakctor", "did you mean `factor`"),
        (r#"{"texture": {"noise": {}}, "factor": true}"#, "diffuse.factor", "a color"),
        (r#"{"texture": 3}"#, "diffuse.texture", "the name of a texture"),
        (r#"{"attribute": ""}"#, "diffuse", "must not be empty"),
    ] {
        let problems = problems(scene(diffuse, ""));
        let [problem] = problems.list() else { panic!("{diffuse}: {problems}") };
        let path = format!("materials.wall.phong.{path}");
        assert!(problem.path == path && problems.to_string().contains(message), "{diffuse}: {problems}");
    }
}
