//! Generates the schema from the Rust types.

use super::{each_schema, read, shorten_numbers};
use crate::description::Description;
use schemars::generate::SchemaSettings;
use serde_json::{Map, Value, json};
use std::fs;
use std::path::Path;

fn generate() -> Value {
    let settings = SchemaSettings::draft2020_12();
    let mut root = settings.into_generator().into_root_schema_for::<Description>().to_value();
    allow_textures(&mut root);
    each_schema(&mut root, &mut close);
    shorten_numbers(&mut root);
    root
}

/// Allows an inline texture wherever the name of a texture is allowed.
fn allow_textures(root: &mut Value) {
    let definitions = root.get_mut("$defs").and_then(Value::as_object_mut);
    for (name, definition) in definitions.into_iter().flatten() {
        let branches = definition.get_mut("anyOf").and_then(Value::as_array_mut);
        if let Some(branches) = branches.filter(|_| crate::validate::names_textures(name)) {
            branches.push(json!({"$ref": "#/$defs/AnyTexture", "description": "Inline texture."}));
        }
    }
}

/// Disallows additional properties of an object.
fn close(schema: &mut Map<String, Value>) {
    let object = schema.get("type").is_some_and(|t| t == "object");
    if object && !schema.contains_key("additionalProperties") {
        schema.insert("additionalProperties".into(), false.into());
    }
}

#[test]
fn the_file_is_current() {
    let generated = generate();
    if std::env::var_os("JUGGLER_BLESS").is_some() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/schema/types.json");
        fs::write(path, format!("{generated:#}\n")).unwrap();
    }
    // Equal values are in equal order, which messages and documentation follow.
    let [file, types] = [read(), generated].map(|schema| schema.to_string());
    let command = "JUGGLER_BLESS=1 cargo test -p juggler-scene --lib schema::";
    assert!(file == types, "schema/types.json is out of date; to write it anew: {command}");
}
