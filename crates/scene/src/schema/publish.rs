//! The published schema, for editors and other programs.

use super::{Schema, UNIT_KEYWORD, each_schema};
use serde_json::{Map, Value, json};

/// Definitions whose numbers are read before expressions, or that declare their own expressions.
const PLAIN: [&str; 3] = ["Animation", "Variable", "Component"];
/// Fields of a scene that cannot be a value form, such as those whose keys are names.
const NAMED: [&str; 12] = [
    "$schema",
    "version",
    "title",
    "description",
    "include",
    "animation",
    "variables",
    "paths",
    "cameras",
    "textures",
    "materials",
    "groups",
];
/// Reference to the family of value forms.
const FORM: &str = "#/$defs/ValueForm";

/// Generates the published schema. Unlike [`Schema`], it allows expressions for numbers and arrays,
/// value forms for any value, and bare names for kinds, and it omits null.
pub fn published() -> Value {
    let schema = Schema::get();
    let mut root = schema.root().clone();
    let plain: Vec<(String, Value)> = definitions(&mut root, |definitions| {
        PLAIN.iter().filter_map(|name| Some(((*name).to_owned(), definitions.shift_remove(*name)?))).collect()
    });
    each_schema(&mut root, &mut |members| {
        drop_null(members);
        allow_names(schema, members);
        allow_expression(members);
    });
    allow_forms(&mut root);
    definitions(&mut root, |definitions| {
        definitions.extend(plain);
        definitions.insert("Expression".into(), expression());
    });
    if let Some(root) = root.as_object_mut() {
        let version = json!({"description": "Version of the format.", "const": 1});
        let schema_address = json!({"description": "Location of this schema, for editors; rendering ignores it.",
            "type": "string"});
        let include = json!({"description": "Paths of other scene files, relative to this one.",
            "anyOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}}]});
        if let Some(properties) = root.get_mut("properties").and_then(Value::as_object_mut) {
            properties.insert("$schema".into(), schema_address);
            properties.insert("version".into(), version);
            properties.insert("include".into(), include);
        }
    }
    root
}

/// The published schema as the text of a JSON file.
pub fn schema_json() -> String {
    let mut text = serde_json::to_string_pretty(&published()).unwrap_or_default();
    text.push('\n');
    text
}

fn definitions<T: Default>(root: &mut Value, change: impl FnOnce(&mut Map<String, Value>) -> T) -> T {
    root.get_mut("$defs").and_then(Value::as_object_mut).map(change).unwrap_or_default()
}

fn expression() -> Value {
    json!({
        "description": "Number as an expression, such as `=2*pi*frame/frames`.",
        "type": "string",
        "pattern": "^=",
        "maxLength": juggler_expression::MAX_LENGTH + 1,
    })
}

/// Removes null from types, since optional members can be omitted.
fn drop_null(schema: &mut Map<String, Value>) {
    if let Some(Value::Array(types)) = schema.get_mut("type") {
        types.retain(|t| t != "null");
        if let [one] = types.as_slice() {
            let one = one.clone();
            schema.insert("type".into(), one);
        }
    }
    if schema.get("default").is_some_and(Value::is_null) {
        schema.shift_remove("default");
    }
    let Some(Value::Array(branches)) = schema.get_mut("anyOf") else { return };
    branches.retain(|branch| branch.get("type").is_none_or(|t| t != "null"));
    if let [one] = branches.as_slice() {
        let one = one.as_object().cloned().unwrap_or_default();
        schema.shift_remove("anyOf");
        schema.extend(one);
    }
}

/// Allows the bare name of kinds whose fields all have defaults.
fn allow_names(schema: &Schema, members: &mut Map<String, Value>) {
    let family = Value::Object(members.clone());
    let names: Vec<&str> =
        schema.kinds(&family).filter(|(_, content)| schema.is_all_default(content)).map(|(name, _)| name).collect();
    if let Some(Value::Array(variants)) = members.get_mut("oneOf").filter(|_| !names.is_empty()) {
        variants.push(json!({"description": "Name of a kind, with all settings at their defaults.", "type": "string", "enum": names}));
    }
}

/// Allows an expression in place of a number or an array of numbers.
fn allow_expression(members: &mut Map<String, Value>) {
    let kind = members.get("type").and_then(Value::as_str);
    // The walk is innermost first, so elements that are numbers have become choices.
    let numbers = || members.get("items").is_some_and(|items| items.get("anyOf").is_some_and(has_expression));
    if matches!(kind, Some("number" | "integer")) || kind == Some("array") && numbers() {
        alternative(members, "#/$defs/Expression");
    }
}

fn has_expression(branches: &Value) -> bool {
    branches
        .as_array()
        .into_iter()
        .flatten()
        .any(|branch| branch.get("$ref").is_some_and(|to| to == "#/$defs/Expression"))
}

/// Allows a value form for every field, every element and every definition except those of value
/// forms.
fn allow_forms(root: &mut Value) {
    let Some(root) = root.as_object_mut() else { return };
    if let Some(Value::Object(fields)) = root.get_mut("properties") {
        for (name, field) in fields {
            allow_forms_inside(field);
            if !NAMED.contains(&name.as_str()) {
                allow_form(field);
            }
        }
    }
    let Some(Value::Object(definitions)) = root.get_mut("$defs") else { return };
    for (name, definition) in definitions.iter_mut() {
        allow_forms_inside(definition);
        if name != "ValueForm" {
            allow_form(definition);
        }
    }
}

/// Allows a value form for everything inside a schema, but not for the schema itself.
fn allow_forms_inside(schema: &mut Value) {
    let Some(members) = schema.as_object_mut() else { return };
    for (key, inner) in members.iter_mut() {
        match (key.as_str(), inner) {
            ("properties", Value::Object(fields)) => fields.values_mut().for_each(allow_form_within),
            ("oneOf" | "anyOf" | "prefixItems", Value::Array(list)) => list.iter_mut().for_each(allow_forms_inside),
            ("items" | "additionalProperties", inner) => allow_form_within(inner),
            _ => {}
        }
    }
}

fn allow_form_within(schema: &mut Value) {
    allow_forms_inside(schema);
    allow_form(schema);
}

fn allow_form(schema: &mut Value) {
    // The target of a reference allows value forms itself.
    if let Some(members) = schema.as_object_mut().filter(|members| !members.contains_key("$ref")) {
        alternative(members, FORM);
    }
}

/// Turns a schema into a choice between itself and another definition.
fn alternative(members: &mut Map<String, Value>, definition: &str) {
    let reference = json!({"$ref": definition});
    if let Some(Value::Array(branches)) = members.get_mut("anyOf") {
        if !branches.contains(&reference) {
            branches.push(reference);
        }
        return;
    }
    let outside = ["description", "default", UNIT_KEYWORD];
    let (kept, own): (Map<String, Value>, Map<String, Value>) =
        std::mem::take(members).into_iter().partition(|(key, _)| outside.contains(&key.as_str()));
    *members = kept;
    members.insert("anyOf".into(), json!([own, reference]));
}
