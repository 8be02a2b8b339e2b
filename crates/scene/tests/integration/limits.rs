//! Every numeric limit of the schema is an allowed value: a scene is checked for each minimum and
//! each maximum.

use juggler_scene::schema::Schema;
use juggler_scene::{Scene, SceneError};
use serde_json::{Value, json};

/// Limits that other fields narrow: the end of the field's path, and the narrower limit.
const NARROWED: &[(&str, &str)] = &[
    ("spot.cutoff_degrees", "no less than `beam_degrees`"),
    ("spot.beam_degrees", "no more than `cutoff_degrees`"),
    ("brick.mortar_width", "no more than the brick's edges"),
    ("render.size", "the pixels of both edges"),
];

/// A limit: the path of the field, and a scene with the limit as its value.
struct Case {
    path: String,
    scene: Value,
}

struct Walk<'s> {
    definitions: &'s Value,
    cases: Vec<Case>,
    /// Definitions above the current node, to stop at recursive materials.
    open: Vec<String>,
}

type Wrap<'w> = &'w dyn Fn(Value) -> Value;

impl Walk<'_> {
    /// Adds all limits below a node; `wrap` puts a value of the node into a scene.
    fn node(&mut self, node: &Value, path: &str, wrap: Wrap) {
        if let Some(name) = node["$ref"].as_str().and_then(|name| name.strip_prefix("#/$defs/")) {
            // Inline textures have the limits of named textures, which are tested.
            let is_inline = name == "AnyTexture" && path != "textures";
            if is_inline || self.open.iter().any(|open| open == name) {
                return;
            }
            self.open.push(name.into());
            let definition = self.definitions[name].clone();
            self.node(&definition, path, wrap);
            self.open.pop();
        }
        for choice in ["anyOf", "oneOf"] {
            node[choice].as_array().into_iter().flatten().for_each(|choice| self.node(choice, path, wrap));
        }
        for limit in ["minimum", "maximum"] {
            if let Some(number) = node.get(limit).filter(|number| number.is_number()) {
                self.cases.push(Case { path: path.into(), scene: wrap(number.clone()) });
            }
        }
        for (key, inner) in node["properties"].as_object().into_iter().flatten() {
            let mut members = self.least(node);
            members.as_object_mut().into_iter().for_each(|members| drop(members.remove(key)));
            self.node(inner, &format!("{path}.{key}"), &|value| {
                let mut object = members.clone();
                object[key] = value;
                wrap(object)
            });
        }
        if let Some(items) = node.get("items").filter(|items| items.is_object()) {
            let count = node["minItems"].as_u64().unwrap_or(1).max(1) as usize;
            self.node(items, path, &|value| wrap(Value::Array(vec![value; count])));
        }
    }

    /// A minimal value that fits a node.
    fn least(&self, node: &Value) -> Value {
        if let Some(name) = node["$ref"].as_str().and_then(|name| name.strip_prefix("#/$defs/")) {
            return self.least(&self.definitions[name]);
        }
        if let Some(default) = node.get("default").filter(|default| !default.is_null()) {
            return default.clone();
        }
        if let Some(choice) = ["anyOf", "oneOf"].iter().find_map(|choice| node[choice].get(0)) {
            return self.least(choice);
        }
        match node["type"].as_str() {
            Some("number" | "integer") => node.get("minimum").cloned().unwrap_or(json!(1)),
            Some("array") => {
                Value::Array(vec![self.least(&node["items"]); node["minItems"].as_u64().unwrap_or(0) as usize])
            }
            Some("object") => {
                let required = node["required"].as_array().into_iter().flatten().filter_map(Value::as_str);
                required.map(|key| (key.to_owned(), self.least(&node["properties"][key]))).collect()
            }
            Some("string") => node["enum"].get(0).cloned().unwrap_or(json!("x")),
            _ => node.get("const").cloned().unwrap_or(Value::Null),
        }
    }
}

fn cases() -> Vec<Case> {
    let schema = Schema::get().root();
    let mut walk = Walk { definitions: &schema["$defs"], cases: Vec::new(), open: Vec::new() };
    let scene = |key: &str, value: Value| {
        let mut scene = json!({"version": 1, "objects": [{"shape": "sphere"}]});
        scene[key] = value;
        scene
    };
    let named = |value: Value| json!({"x": value});
    let part = |name: &str| json!({"$ref": format!("#/$defs/{name}")});
    walk.node(&part("Render"), "render", &|value| scene("render", value));
    walk.node(&part("Animation"), "animation", &|value| scene("animation", value));
    walk.node(&part("Tone"), "tone", &|value| scene("tone", value));
    walk.node(&part("AnyCamera"), "camera", &|value| scene("camera", value));
    walk.node(&part("AnyBackground"), "background", &|value| scene("background", value));
    walk.node(&part("AnyTexture"), "textures", &|value| scene("textures", named(value)));
    walk.node(&part("AnyMaterial"), "materials", &|value| scene("materials", named(value)));
    walk.node(&part("AnyLight"), "lights", &|value| scene("lights", json!([value])));
    walk.node(&part("AnyShape"), "objects", &|value| scene("objects", json!([{"shape": value}])));
    walk.node(&part("Chain"), "objects.chain", &|value| scene("objects", json!([{"chain": value}])));
    walk.cases
}

/// Last key of a path, without array indices.
fn last_key(path: &str) -> &str {
    path.rsplit('.').next().and_then(|last| last.split('[').next()).unwrap_or_default()
}

#[test]
fn schema_limits_are_inclusive() {
    let cases = cases();
    let mut refused = Vec::new();
    for Case { path, scene } in &cases {
        if NARROWED.iter().any(|(end, _)| path.ends_with(end)) {
            continue;
        }
        let text = serde_json::to_string(scene).unwrap();
        let problems = match Scene::from_json(text.clone(), "limits.json") {
            Ok(scene) => scene.check(),
            Err(SceneError::Problems(problems)) => problems,
            Err(error) => panic!("{error}"),
        };
        let field = path.rsplit('.').next().unwrap_or_default();
        // Ignore errors of other fields, such as missing files and collinear vertices.
        let about =
            |message: &str| message.contains("must be") || message.contains("limit") || message.contains("between");
        let problems =
            problems.list().iter().filter(|problem| last_key(&problem.path) == field && about(&problem.message));
        refused.extend(problems.map(|problem| format!("{path}: {} in {text}", problem.message)));
    }
    assert!(cases.len() > 150, "only {} limits were found", cases.len());
    assert!(refused.is_empty(), "{}", refused.join("\n"));
}

#[test]
fn whole_numbers_keep_all_their_digits() {
    let scene = r#"{"version": 1, "render": {"seed": 18446744073709551615}, "objects": [{"shape": "sphere"}]}"#;
    assert_eq!(Scene::from_json(scene, "seed.json").unwrap().description.render.seed, u64::MAX);
}

#[test]
fn a_message_names_the_limit_that_was_exceeded() {
    let message_of = |more: &str| {
        let text = format!(r#"{{"version": 1, {more}, "objects": [{{"shape": "sphere", "material": "m"}}]}}"#);
        match Scene::from_json(text, "wrong.json") {
            Ok(scene) => scene.check().to_string(),
            Err(error) => error.to_string(),
        }
    };
    let medium = |field: &str| {
        message_of(&format!(r#""materials": {{"m": {{"dielectric": {{"medium": {{"{field}": [1e30, 0, 0]}}}}}}}}"#))
    };
    for field in ["absorption", "scattering"] {
        let message = medium(field);
        assert!(message.contains(&format!("`{field}` must be between 0 and 1e12, it is 1e30")), "{message}");
    }
    let plain = r#""materials": {"m": {"phong": {}}}"#;
    let message = message_of(&format!(r#"{plain}, "background": {{"solid": {{"color": [3.4e38, 0, 0]}}}}"#));
    assert!(message.contains("`color` must be between 0 and 1e30, it is 3.4e38"), "{message}");
    let message =
        message_of(&format!(r#"{plain}, "lights": [{{"point": {{"color": [1e20, 0, 0], "intensity": 1e20}}}}]"#));
    assert!(message.contains("`color` times `intensity` must not exceed 1e30"), "{message}");
    let message = message_of(r#""materials": {"m": {"emissive": {"radiance": [3e38, 1, 1]}}}"#);
    assert!(message.contains("`radiance` must be between 0 and 1e30, it is 3e38"), "{message}");
}

/// `check` reports everything that `render` rejects, with its place, at all scales of a scene.
#[test]
fn a_scene_that_passes_the_check_has_a_camera() {
    let (mut passed, mut refused) = (0, 0);
    for exponent in -38..39 {
        let scene = format!(
            r#"{{"version": 1, "objects": [{{"shape": "plane"}},
                {{"shape": "sphere", "transform": [{{"scale": 1e{exponent}}}, {{"translate": [-1e{exponent}, 2, 3]}}]}},
                {{"shape": "sphere", "transform": [{{"scale": 1e{exponent}}}, {{"translate": [2e{exponent}, 0, 0]}}]}}]}}"#
        );
        let Ok(scene) = Scene::from_json(scene, "large.json") else { continue };
        let problems = scene.check();
        match scene.compile() {
            Ok(compiled) => {
                assert_eq!(problems.errors(), 0, "1e{exponent}");
                let camera = compiled.shutter_camera(juggler_math::UVec2::new(64, 36));
                assert!(camera.is_ok(), "1e{exponent}: {:?}", camera.err());
                passed += 1;
            }
            Err(_) => {
                assert!(problems.errors() > 0, "1e{exponent}");
                assert!(problems.list().iter().all(|problem| problem.path.starts_with("objects[2]")), "{problems}");
                refused += 1;
            }
        }
    }
    // The camera is computed in double precision, so that only the largest scale is out of reach.
    assert!(passed > 70 && refused > 0, "{passed} {refused}");
}

/// Suggestions take the time to look at all names, so only the first 50 of many errors have one.
#[test]
fn many_misspelled_names_get_few_suggestions() {
    let objects: Vec<String> = (0..4000).map(|i| format!(r#"{{"shape": "sphere", "material": "mta{i}"}}"#)).collect();
    let materials: Vec<String> = (0..4000).map(|i| format!(r#""mat{i}": {{"diffuse": {{}}}}"#)).collect();
    let names =
        format!(r#"{{"version": 1, "materials": {{{}}}, "objects": [{}]}}"#, materials.join(", "), objects.join(", "));
    let variables: Vec<String> = (0..4000).map(|i| format!(r#""a{i}": "b{i} + 1""#)).collect();
    let variables = format!(r#"{{"version": 1, "objects": [], "variables": {{{}}}}}"#, variables.join(", "));
    for scene in [names, variables] {
        let Err(SceneError::Problems(problems)) = Scene::from_json(scene, "scene.json") else { panic!("problems") };
        let helps: Vec<bool> = problems.list().iter().map(|problem| problem.help.is_some()).collect();
        assert!(helps.len() >= 200, "{}", helps.len());
        assert_eq!(helps.iter().filter(|help| **help).count(), 50);
    }
}
