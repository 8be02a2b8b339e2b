//! Every number of the scene format at extreme values: a walk over the JSON Schema yields, for each
//! number, a scene with a placeholder in its place.

use crate::targets::is_affordable;
use juggler::scene::{Scene, schema_json};
use juggler::{Picture, Settings};
use juggler_math::testing::Random;
use serde_json::{Map, Value, json};
use std::cell::RefCell;
use std::collections::BTreeMap;

/// Placeholder of the number.
const PLACEHOLDER: &str = "@";
/// Path suffix of the only number whose animation is walked too.
const ANIMATED_PATH: &str = "sphere.radius";
/// Maximum number of paths on which each member of a definition is visited.
const MAX_VISITS: u32 = 8;
/// The same for [`all_fields`].
const MAX_VISITS_OF_ALL: u32 = 2;
/// Maximum nesting depth of definitions.
const MAX_DEPTH: usize = 14;

/// Values for each number.
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

/// Values that many numbers of the format allow.
const COMMON_VALUES: [&str; 9] = ["1", "0.5", "2", "0.25", "3", "20", "45", "1.5", "1000"];

/// A field of the scene format.
#[derive(Clone, Debug)]
pub struct Field {
    /// Path in the scene, such as `objects.0.shape.sphere.radius`.
    pub path: String,
    /// A scene with [`PLACEHOLDER`] in place of the number.
    scene: Value,
}

/// Every number of every definition of the format, each on several paths.
pub fn fields() -> Vec<Field> {
    walk(false, MAX_VISITS)
}

/// Every field of every definition of the format: numbers, words and switches, each on a few paths.
/// Words and switches have their possible values after the placeholder.
pub fn all_fields() -> Vec<Field> {
    walk(true, MAX_VISITS_OF_ALL)
}

/// Fields that a walk over the schema finds.
fn walk(with_words: bool, max_visits: u32) -> Vec<Field> {
    let schema: Value = serde_json::from_str(&schema_json()).unwrap_or_default();
    let definitions = schema.get("$defs").cloned().unwrap_or_default();
    let walk = Walk { definitions, with_words, max_visits, visits: RefCell::default() };
    let found = walk.placeholders(&schema, &mut Vec::new(), "");
    found.into_iter().map(|(path, scene)| Field { path, scene: complete(scene) }).collect()
}

impl Field {
    /// Texts of scenes with different values of the field.
    pub fn variations(&self) -> Vec<String> {
        let text = self.scene.to_string();
        let Some((before, rest)) = text.split_once(&format!("\"{PLACEHOLDER}")) else { return Vec::new() };
        let mut is_escaped = false;
        let is_end = |c: char| {
            let was_escaped = std::mem::replace(&mut is_escaped, false);
            is_escaped = c == '\\' && !was_escaped;
            c == '"' && !was_escaped
        };
        let Some((values, after)) = rest.find(is_end).and_then(|end| rest.split_at_checked(end)) else {
            return Vec::new();
        };
        let values = values.replace("\\\"", "\"");
        let values: Vec<&str> = if values.is_empty() { COMMON_VALUES.to_vec() } else { values.split('|').collect() };
        values.iter().map(|value| format!("{before}{value}{}", after.trim_start_matches('"'))).collect()
    }
}

/// Path and scene text of a case: a random field with a random extreme value, seeded by `number`.
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
    (field.path.clone(), scene.to_string().replace(&format!("\"{PLACEHOLDER}\""), extreme))
}

/// Checks a scene and, if it is valid and affordable, renders 8 × 8 pixels. Returns whether it was
/// rendered.
///
/// # Errors
///
/// A description of a broken promise: a scene that passes the check must render, and all pixels
/// must be finite.
pub fn render(text: &str) -> Result<bool, String> {
    let Ok(scene) = Scene::from_json(text, "field.json") else { return Ok(false) };
    let settings = Settings { size: Some([8, 8]), samples: Some(1), ..Settings::default() };
    if scene.check().errors() > 0 || !is_affordable(&scene, &settings) {
        return Ok(false);
    }
    let picture = Picture::new(&scene, &settings).map_err(|error| format!("checked, but not rendered: {error}"))?;
    let image = picture.render_image(&Default::default()).map_err(|error| format!("not rendered: {error}"))?;
    match image.pixels().iter().find(|pixel| !pixel.is_finite()) {
        Some(pixel) => Err(format!("a pixel is not finite: {pixel:?}")),
        None => Ok(true),
    }
}

/// Walk over the definitions of the schema.
struct Walk {
    definitions: Value,
    /// Whether words and switches count as fields.
    with_words: bool,
    max_visits: u32,
    /// Number of paths to each member of each definition so far.
    visits: RefCell<BTreeMap<String, u32>>,
}

impl Walk {
    /// Values of a schema node with one placeholder each, and the path of the placeholder.
    fn placeholders<'s>(&'s self, node: &'s Value, within: &mut Vec<&'s str>, path: &str) -> Vec<(String, Value)> {
        if let Some(name) = node.get("$ref").and_then(Value::as_str).and_then(|name| name.strip_prefix("#/$defs/")) {
            let seen = within.contains(&name) || within.len() > MAX_DEPTH;
            // Every number may be an expression or an animation: skip expressions, and walk
            // animations of one field only. A model needs a file, which tests of `scene` have.
            let elsewhere =
                matches!(name, "Expression" | "Model") || name == "ValueForm" && !path.ends_with(ANIMATED_PATH);
            let Some(definition) = self.definitions.get(name).filter(|_| !seen && !elsewhere) else {
                return Vec::new();
            };
            within.push(name);
            let found = self.placeholders(definition, within, path);
            within.pop();
            return found;
        }
        let mut found: Vec<(String, Value)> =
            self.words(node).map(|placeholder| (path.to_owned(), placeholder)).into_iter().collect();
        for variants in ["anyOf", "oneOf"].iter().filter_map(|key| node.get(key)?.as_array()) {
            variants.iter().for_each(|variant| found.extend(self.placeholders(variant, within, path)));
        }
        if is_of(node, "number") || is_of(node, "integer") {
            found.push((path.to_owned(), json!(PLACEHOLDER)));
        }
        if let Some(items) = node.get("items") {
            found.extend(self.in_items(node, items, within, path));
        }
        if is_of(node, "object") {
            found.extend(self.in_members(node, within, path));
        }
        found
    }

    /// Placeholder for a word or switch, with the values that may stand in its place.
    fn words(&self, node: &Value) -> Option<Value> {
        if !self.with_words {
            return None;
        }
        let variants = |key: &str| node.get(key).and_then(Value::as_array).into_iter().flatten();
        let constants = variants("oneOf").chain(variants("anyOf")).filter_map(|variant| variant.get("const"));
        let lists = variants("oneOf").filter_map(|variant| variant.get("enum")?.as_array()).flatten();
        let words: Vec<&str> = constants.chain(lists).chain(variants("enum")).filter_map(Value::as_str).collect();
        match words.as_slice() {
            [] if is_of(node, "boolean") => Some(json!(format!("{PLACEHOLDER}true|false"))),
            [] if is_of(node, "string") && node.get("const").is_none() => {
                Some(json!(format!("{PLACEHOLDER}\"a\"|\"b\"")))
            }
            [] | [_] => None,
            words => Some(json!(format!("{PLACEHOLDER}\"{}\"", words.join("\"|\"")))),
        }
    }

    /// Whether a member of a definition is to be visited once more. Without a limit, the paths are
    /// hundreds of thousands, nearly all of them to numbers of nested textures.
    fn visit(&self, within: &[&str], name: &str) -> bool {
        let mut visits = self.visits.borrow_mut();
        let count = visits.entry(format!("{}.{name}", within.last().unwrap_or(&""))).or_default();
        *count += 1;
        *count <= self.max_visits
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
            for (path, placeholder) in self.placeholders(items, within, &format!("{path}.{at}")) {
                let mut values = vec![self.minimal(items, 0); count];
                values.iter_mut().skip(at).take(1).for_each(|value| *value = placeholder.clone());
                found.push((path, Value::Array(values)));
            }
        }
        found
    }

    fn in_members<'s>(&'s self, node: &'s Value, within: &mut Vec<&'s str>, path: &str) -> Vec<(String, Value)> {
        let members = node.get("properties").and_then(Value::as_object).into_iter().flatten();
        let named = node.get("additionalProperties").filter(|schema| schema.is_object()).map(|schema| ("a", schema));
        let mut found = Vec::new();
        let members = members.map(|(name, schema)| (name.as_str(), schema)).chain(named);
        let members: Vec<(&str, &Value)> = members.filter(|(name, _)| self.visit(within, name)).collect();
        for (name, schema) in members {
            let place = if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
            for (path, placeholder) in self.placeholders(schema, within, &place) {
                let mut whole = self.required(node, 0);
                whole.insert(name.to_owned(), placeholder);
                found.push((path, Value::Object(whole)));
            }
        }
        found
    }

    fn required(&self, node: &Value, depth: usize) -> Map<String, Value> {
        let names = node.get("required").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str);
        let value = |name: &str| {
            self.minimal(node.get("properties").and_then(|all| all.get(name)).unwrap_or(&Value::Null), depth + 1)
        };
        names.map(|name| (name.to_owned(), value(name))).collect()
    }

    fn is_number(&self, node: &Value) -> bool {
        self.minimal(node, 0).is_number()
    }

    /// A minimal value that the schema node accepts.
    fn minimal(&self, node: &Value, depth: usize) -> Value {
        if let Some(value) = node.get("default").or_else(|| node.get("const")).filter(|_| depth < MAX_DEPTH) {
            return value.clone();
        }
        if depth >= MAX_DEPTH {
            return Value::Null;
        }
        if let Some(name) = node.get("$ref").and_then(Value::as_str).and_then(|name| name.strip_prefix("#/$defs/")) {
            return self.definitions.get(name).map_or(Value::Null, |node| self.minimal(node, depth + 1));
        }
        let first = |key: &str| node.get(key)?.as_array()?.first();
        if let Some(value) = first("enum") {
            return value.clone();
        }
        if let Some(variant) = first("anyOf").or_else(|| first("oneOf")) {
            return self.minimal(variant, depth + 1);
        }
        match () {
            () if is_of(node, "number") || is_of(node, "integer") => json!(1),
            () if is_of(node, "array") => {
                let count = node.get("minItems").and_then(Value::as_u64).unwrap_or(0) as usize;
                Value::Array(vec![node.get("items").map_or(json!(1), |items| self.minimal(items, depth + 1)); count])
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

/// Completes a scene so that the placeholder takes effect: everything named is used.
fn complete(scene: Value) -> Value {
    let mut scene = scene;
    let has = |scene: &Value, key: &str| scene.get(key).is_some();
    let Some(members) = scene.as_object().cloned() else { return scene };
    scene["version"] = json!(1);
    for place in ["/objects/0", "/groups/a/0"] {
        scene.pointer_mut(place).and_then(Value::as_object_mut).into_iter().for_each(add_shape);
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

/// Gives an object a shape if it has no geometry.
fn add_shape(object: &mut Map<String, Value>) {
    if !["shape", "group", "objects", "chain", "limb"].iter().any(|key| object.contains_key(*key)) {
        object.insert("shape".to_owned(), json!("sphere"));
    }
}
