//! Insertion of a camera into the text of a scene file, with all other text preserved.

use crate::document::{FileId, parse};
use crate::schema;
use jsonc_parser::ParseOptions;
use jsonc_parser::cst::{CstInputValue, CstRootNode};
use juggler_camera::AnyCamera;
use serde_json::{Value, json};

/// Formats a camera in its shortest form, without members at their defaults.
pub fn camera_json(camera: &AnyCamera) -> Value {
    let mut json = serde_json::to_value(camera).unwrap_or_default();
    schema::shorten_numbers(&mut json);
    schema::drop_nulls(&mut json);
    let plain = json!({
        "up": [0, 1, 0], "yaw_degrees": 0, "pitch_degrees": 0, "roll_degrees": 0,
        "move": {"right": 0, "up": 0, "forward": 0}
    });
    for members in
        json.as_object_mut().into_iter().flat_map(|kinds| kinds.values_mut()).filter_map(Value::as_object_mut)
    {
        members.retain(|key, value| plain.get(key) != Some(value));
    }
    json
}

/// Adds a camera to the `cameras` of a scene file's text, or replaces the camera of this name. A
/// single `camera` becomes the first of `cameras` under the name `camera`. Errors if the text is
/// not a scene.
pub fn with_camera(text: &str, name: &str, camera: &AnyCamera) -> Result<String, String> {
    let text = without_single(text)?;
    let root = CstRootNode::parse(&text, &ParseOptions::default()).map_err(|error| error.to_string())?;
    let scene = root.object_value().ok_or("the file contains no scene")?;
    let cameras = scene.object_value_or_create("cameras").ok_or("`cameras` is not an object")?;
    let value = input(&camera_json(camera));
    match cameras.get(name) {
        Some(known) => known.set_value(value),
        None => drop(cameras.append(name, value)),
    }
    Ok(root.to_string())
}

/// Rewrites `"camera": ...` as `"cameras": {"camera": ...}`.
fn without_single(text: &str) -> Result<String, String> {
    let (tree, _) = parse(text, FileId::MAIN).map_err(|error| error.message)?;
    let places =
        tree.members().find(|(key, _)| *key == "camera").map(|(_, camera)| (camera.key_place, camera.node.place));
    let Some((Some(key), Some(value))) = places else { return Ok(text.to_owned()) };
    let part = |from: u32, to: u32| text.get(from as usize..to as usize).unwrap_or_default();
    let (before, between) = (part(0, key.start), part(key.end, value.start));
    let (camera, after) = (part(value.start, value.end), text.get(value.end as usize..).unwrap_or_default());
    Ok(format!("{before}\"cameras\"{between}{{\"camera\": {camera}}}{after}"))
}

fn input(value: &Value) -> CstInputValue {
    match value {
        Value::Null => CstInputValue::Null,
        Value::Bool(value) => CstInputValue::Bool(*value),
        Value::Number(number) => CstInputValue::Number(number.to_string()),
        Value::String(text) => CstInputValue::String(text.clone()),
        Value::Array(elements) => CstInputValue::Array(elements.iter().map(input).collect()),
        Value::Object(members) => {
            CstInputValue::Object(members.iter().map(|(key, value)| (key.clone(), input(value))).collect())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;
    use juggler_camera::Perspective;
    use juggler_math::Vec3;

    fn camera() -> AnyCamera {
        Perspective { eye: Vec3::new(0.1, 2.0, 3.0), direction: Some(-Vec3::Z), ..Perspective::default() }.into()
    }

    fn kept(text: &str) -> (String, Scene) {
        let text = with_camera(text, "mine", &camera()).unwrap();
        let scene = Scene::from_json(text.clone(), "test.json").unwrap();
        assert_eq!(scene.description.cameras["mine"], camera(), "{text}");
        (text, scene)
    }

    #[test]
    fn comments_and_other_text_stay() {
        let text = "{\n  // of mine\n  \"version\": 1, /* here */\n  \"cameras\": {\n    \"a\": {\"perspective\": {}} // first\n  },\n  \"objects\": []\n}\n";
        let (new, scene) = kept(text);
        assert!(
            ["// of mine", "/* here */", "// first", "\"objects\": []"].iter().all(|part| new.contains(part)),
            "{new}"
        );
        assert_eq!(scene.description.cameras.len(), 2);
        assert_eq!(with_camera(&new, "mine", &camera()).unwrap(), new, "once more changes nothing");
    }

    #[test]
    fn a_single_camera_becomes_the_first_of_several() {
        let text =
            "{\"version\": 1,\n  \"camera\": {\"perspective\": {\"eye\": [1, 2, 3] /* stays */}},\n  \"objects\": []}";
        let (new, scene) = kept(text);
        assert!(new.contains("[1, 2, 3] /* stays */"), "{new}");
        assert_eq!(scene.description.cameras.keys().collect::<Vec<_>>(), ["camera", "mine"]);
    }

    #[test]
    fn cameras_are_added_to_valid_scenes_only() {
        kept("{\"version\": 1, \"objects\": []}");
        for text in ["", "[]", "{\"cameras\": 3}", "{"] {
            assert!(with_camera(text, "mine", &camera()).is_err(), "{text}");
        }
    }
}
