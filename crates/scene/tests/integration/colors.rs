//! Colors by names of CSS.

use juggler_scene::{Scene, SceneError};

fn scene(textures: &str, color: &str) -> Result<Scene, String> {
    let text = format!(
        r#"{{"version": 1, {textures} "background": "SkyBlue",
            "materials": {{"a": {{"diffuse": {{"reflectance": "{color}"}}}}}},
            "objects": [{{"shape": "sphere", "material": "a"}}]}}"#
    );
    match Scene::from_json(text, "colors.json") {
        Err(SceneError::Problems(problems)) => Err(problems.to_string()),
        other => Ok(other.unwrap()),
    }
}

#[test]
fn names_of_css_are_colors() {
    let named = scene("", "tomato").unwrap().to_value();
    let hex = scene("", "#ff6347").unwrap().to_value();
    assert_eq!(named["materials"], hex["materials"]);
    assert_eq!(named["background"], scene("", "#ff6347").unwrap().to_value()["background"]);
}

/// A texture hides the color of its name.
#[test]
fn textures_hide_colors_of_their_name() {
    let textures = r#""textures": {"tan": {"checker": {}}},"#;
    let hidden = scene(textures, "tan").unwrap().to_value();
    assert_eq!(hidden["materials"]["a"]["diffuse"]["reflectance"], "tan");
    let color = scene(textures, "red").unwrap().to_value();
    let red = &color["materials"]["a"]["diffuse"]["reflectance"];
    assert_eq!([0, 1, 2].map(|channel| red[channel].as_f64()), [1.0, 0.0, 0.0].map(Some));
}

#[test]
fn colors_can_be_interpolated_by_name() {
    let text = r#"{"version": 1, "animation": {"frames": 3, "frames_per_second": 1},
        "background": {"solid": {"color": {"animate": {"keys": [[0, "black"], [2, "white"]]}}}}}"#;
    let scene = Scene::from_json(text, "keys.json").unwrap().at_frame(1.0).unwrap();
    assert_eq!(scene.compile().unwrap().world.background().mean_radiance(), juggler_math::Rgb::splat(0.5));
}

#[test]
fn other_words_are_errors_that_suggest_colors() {
    let text = r#"{"version": 1, "background": {"solid": {"color": "tomatoe"}}}"#;
    let Err(SceneError::Problems(problems)) = Scene::from_json(text, "wrong.json") else { panic!("the scene is read") };
    let said = problems.to_string();
    assert!(said.contains("`tomatoe` is not a color") && said.contains("did you mean `tomato`?"), "{said}");
}

/// A number that is the name of a variable is meant as an expression.
#[test]
fn names_of_variables_are_helped_to_expressions() {
    let text = r#"{"version": 1, "variables": {"r": 2}, "objects": [{"shape": {"sphere": {"radius": "r"}}}]}"#;
    let Err(SceneError::Problems(problems)) = Scene::from_json(text, "wrong.json") else { panic!("the scene is read") };
    assert!(problems.to_string().contains("\"=r\""), "{problems}");
}
