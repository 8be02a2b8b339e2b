//! Every number of the scene format at extreme values: the JSON Schema is walked, and each number becomes a scene with a
//! hole in its place.

use crate::targets::is_affordable;
use juggler::scene::{Scene, schema_json};
use juggler::{Picture, Settings};
use juggler_math::testing::Random;
use serde_json::{Map, Value, json};

/// What stands in the place of the number.
const HOLE: &str = "@";
/// The field whose values in time are walked, too.
const MOVING: &str = "sphere.radius";
/// Deepest nesting of definitions within one another.
const DEEPEST: usize = 14;

/// Numbers that a field is given.
const EXTREMES: [&str; 22] = [
    "0",
    "-0.0",
    "-1",
    "1e-45",
    "1e-38",
    "1e-30",
    "1e-10",
    "0.5",
    "1",
    "1000",
    "65537",
    "4294967295",
    "1e10",
    "1e18",
    "1e24",
    "1e30",
    "3e38",
    "-1e30",
    "-3e38",
    "1e39",
    "1e308",
    "18446744073709551615",
];

/// A number of the format.
#[derive(Clone, Debug)]
pub struct Field {
    /// Where it stands: `objects.0.shape.sphere.radius`.
    pub path: String,
    /// A scene with [`HOLE`] in its place.
    scene: Value,
}

/// All numbers of the format.
pub fn fields() -> Vec<Field> {
    let schema: Value = serde_json::from_str(&schema_json()).unwrap_or_default();
    let walk = Walk { definitions: schema.get("$defs").cloned().unwrap_or_default() };
    let found = walk.holes(&schema, &mut Vec::new(), "");
    found.into_iter().map(|(path, scene)| Field { path, scene: complete(scene) }).collect()
}

/// A scene of a case: some field at some extreme. The number of fields decides nothing but which one.
pub fn case(fields: &[Field], number: u64) -> (String, String) {
    let mut random = Random::new(number);
    let Some(field) = fields.get(random.below(fields.len())) else { return Default::default() };
    let extreme = EXTREMES.get(random.below(EXTREMES.len())).copied().unwrap_or("0");
    let mut scene = field.scene.clone();
    if random.below(2) == 0
        && let Some(render) = scene.as_object_mut().map(|scene| scene.entry("render").or_insert_with(|| json!({})))
        && let Some(render) = render.as_object_mut()
    {
        render.entry("integrator").or_insert_with(|| json!({"path": {"max_depth": 4}}));
    }
    (field.path.clone(), scene.to_string().replace(&format!("\"{HOLE}\""), extreme))
}

/// Checks a scene and renders 8 × 8 pixels of it, if it is right and affordable. Whether it was rendered; an error where one
/// of the promises is broken: what is rendered was checked, what was checked is rendered, and all pixels are finite.
pub fn render(text: &str) -> Result<bool, String> {
    let Ok(scene) = Scene::from_json(text, "field.json") else { return Ok(false) };
    let settings = Settings { size: Some([8, 8]), samples: Some(1), ..Settings::default() };
    if scene.check().errors() > 0 || !is_affordable(&scene, &settings) {
        return Ok(false);
    }
    let picture = Picture::new(&scene, &settings).map_err(|error| format!("checked, but not rendered: {error}"))?;
    let image = picture.image(&Default::default()).map_err(|error| format!("not rendered: {error}"))?;
    match image.pixels().iter().find(|pixel| !pixel.is_finite()) {
        Some(pixel) => Err(format!("a pixel is not finite: {pixel:?}")),
        None => Ok(true),
    }
}

/// The definitions of the schema.
struct Walk {
    definitions: Value,
}

impl Walk {
    /// Values of a node with one hole each, and where it is.
    fn holes<'s>(&'s self, node: &'s Value, within: &mut Vec<&'s str>, path: &str) -> Vec<(String, Value)> {
        if let Some(name) = node.get("$ref").and_then(Value::as_str).and_then(|name| name.strip_prefix("#/$defs/")) {
            let seen = within.contains(&name) || within.len() > DEEPEST;
            // Every number may be an expression or move in time: what those hold is walked at one place.
            let elsewhere = name == "Expression" || name == "ValueForm" && !path.ends_with(MOVING);
            let Some(definition) = self.definitions.get(name).filter(|_| !seen && !elsewhere) else {
                return Vec::new();
            };
            within.push(name);
            let found = self.holes(definition, within, path);
            within.pop();
            return found;
        }
        let mut found = Vec::new();
        for variants in ["anyOf", "oneOf"].iter().filter_map(|key| node.get(key)?.as_array()) {
            variants.iter().for_each(|variant| found.extend(self.holes(variant, within, path)));
        }
        if is_of(node, "number") || is_of(node, "integer") {
            found.push((path.to_owned(), json!(HOLE)));
        }
        if let Some(items) = node.get("items") {
            found.extend(self.in_items(node, items, within, path));
        }
        if is_of(node, "object") {
            found.extend(self.in_members(node, within, path));
        }
        found
    }

    fn in_items<'s>(
        &'s self,
        node: &'s Value,
        items: &'s Value,
        within: &mut Vec<&'s str>,
        path: &str,
    ) -> Vec<(String, Value)> {
        let count = node.get("minItems").and_then(Value::as_u64).unwrap_or(1).max(1) as usize;
        let mut found = Vec::new();
        for at in 0..if self.is_number(items) { count } else { 1 } {
            for (path, hole) in self.holes(items, within, &format!("{path}.{at}")) {
                let mut values = vec![self.least(items, 0); count];
                values.iter_mut().skip(at).take(1).for_each(|value| *value = hole.clone());
                found.push((path, Value::Array(values)));
            }
        }
        found
    }

    fn in_members<'s>(&'s self, node: &'s Value, within: &mut Vec<&'s str>, path: &str) -> Vec<(String, Value)> {
        let members = node.get("properties").and_then(Value::as_object).into_iter().flatten();
        let named = node.get("additionalProperties").filter(|schema| schema.is_object()).map(|schema| ("a", schema));
        let mut found = Vec::new();
        for (name, schema) in members.map(|(name, schema)| (name.as_str(), schema)).chain(named) {
            let place = if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
            for (path, hole) in self.holes(schema, within, &place) {
                let mut whole = self.required(node, 0);
                whole.insert(name.to_owned(), hole);
                found.push((path, Value::Object(whole)));
            }
        }
        found
    }

    fn required(&self, node: &Value, depth: usize) -> Map<String, Value> {
        let names = node.get("required").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str);
        let value = |name: &str| {
            self.least(node.get("properties").and_then(|all| all.get(name)).unwrap_or(&Value::Null), depth + 1)
        };
        names.map(|name| (name.to_owned(), value(name))).collect()
    }

    fn is_number(&self, node: &Value) -> bool {
        self.least(node, 0).is_number()
    }

    /// The simplest value of a node.
    fn least(&self, node: &Value, depth: usize) -> Value {
        if let Some(value) = node.get("default").or_else(|| node.get("const")).filter(|_| depth < DEEPEST) {
            return value.clone();
        }
        if depth >= DEEPEST {
            return Value::Null;
        }
        if let Some(name) = node.get("$ref").and_then(Value::as_str).and_then(|name| name.strip_prefix("#/$defs/")) {
            return self.definitions.get(name).map_or(Value::Null, |node| self.least(node, depth + 1));
        }
        let first = |key: &str| node.get(key)?.as_array()?.first();
        if let Some(value) = first("enum") {
            return value.clone();
        }
        if let Some(variant) = first("anyOf").or_else(|| first("oneOf")) {
            return self.least(variant, depth + 1);
        }
        match () {
            () if is_of(node, "number") || is_of(node, "integer") => json!(1),
            () if is_of(node, "array") => {
                let count = node.get("minItems").and_then(Value::as_u64).unwrap_or(0) as usize;
                Value::Array(vec![node.get("items").map_or(json!(1), |items| self.least(items, depth + 1)); count])
            }
            () if is_of(node, "string") => json!("a"),
            () if is_of(node, "boolean") => json!(true),
            () if is_of(node, "object") => Value::Object(self.required(node, depth)),
            () => Value::Null,
        }
    }
}

fn is_of(node: &Value, kind: &str) -> bool {
    match node.get("type") {
        Some(Value::String(name)) => name == kind,
        Some(Value::Array(names)) => names.iter().any(|name| name == kind),
        _ => false,
    }
}

/// A scene in which the hole is looked at: what is named is used.
fn complete(scene: Value) -> Value {
    let mut scene = scene;
    let has = |scene: &Value, key: &str| scene.get(key).is_some();
    let Some(members) = scene.as_object().cloned() else { return scene };
    scene["version"] = json!(1);
    for place in ["/objects/0", "/groups/a/0"] {
        scene.pointer_mut(place).and_then(Value::as_object_mut).into_iter().for_each(show);
    }
    if members.contains_key("textures") {
        scene["materials"] = json!({"a": {"phong": {"diffuse": "a"}}});
    }
    if !has(&scene, "objects") {
        scene["objects"] = match () {
            () if has(&scene, "groups") => json!([{"group": "a"}]),
            () if has(&scene, "materials") => json!([{"shape": "sphere", "material": "a"}, {"shape": "plane"}]),
            () => json!([{"shape": "sphere"}, {"shape": "plane"}]),
        };
    }
    scene
}

/// Gives an object something to be seen by, if it has nothing.
fn show(object: &mut Map<String, Value>) {
    if !["shape", "group", "objects", "chain", "limb"].iter().any(|key| object.contains_key(*key)) {
        object.insert("shape".to_owned(), json!("sphere"));
    }
}
