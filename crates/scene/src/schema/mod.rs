//! The JSON Schema of the scene format, generated from the Rust types.
//!
//! There are two forms: the [`Schema`] for [`crate::validate`], where expressions are already
//! evaluated to numbers, and the [`published`] schema for editors, which also allows strings
//! `"=..."` for numbers and bare names for kinds.
//!
//! Programs read the first from a file that a test generates, since the code that generates it would
//! be 7 % of a program.

use crate::document::{FileId, parse};
use serde_json::{Map, Value};
use std::sync::LazyLock;

#[cfg(test)]
mod generate;
mod numbers;
mod publish;
mod reference;
mod units;

pub use numbers::{drop_nulls, shorten_numbers};
pub use publish::{published, schema_json};
pub use reference::reference;
pub use units::{KEYWORD as UNIT_KEYWORD, UNITS, Unit};

/// Schema of the format, without additional properties.
#[derive(Debug)]
pub struct Schema {
    root: Value,
}

/// What `generate` makes of the types.
const FILE: &str = include_str!("types.json");

/// The schema, read on first use. A test reads the file, too.
static SCHEMA: LazyLock<Schema> = LazyLock::new(|| Schema { root: read() });

fn read() -> Value {
    parse(FILE, FileId::MAIN).map_or(Value::Null, |(tree, _)| tree.to_json())
}

impl Schema {
    /// Returns the schema of the format.
    pub fn get() -> &'static Self {
        &SCHEMA
    }

    /// The schema of a whole scene.
    pub fn root(&self) -> &Value {
        &self.root
    }

    /// The definitions with their names.
    pub fn definitions(&self) -> impl Iterator<Item = (&String, &Value)> {
        self.root.get("$defs").and_then(Value::as_object).into_iter().flatten()
    }

    /// Resolves a reference. Returns the definition with its name, or `schema` itself if it is no
    /// reference.
    pub fn follow<'s>(&'s self, schema: &'s Value) -> (Option<&'s str>, &'s Value) {
        let name = schema.get("$ref").and_then(Value::as_str).and_then(|path| path.strip_prefix("#/$defs/"));
        let target = name.and_then(|name| self.root.get("$defs")?.get(name));
        match target {
            Some(target) => (name, target),
            None => (None, schema),
        }
    }

    /// The kinds of a family with their schemas, which are the variants of an externally tagged
    /// enum.
    pub fn kinds<'s>(&'s self, family: &'s Value) -> impl Iterator<Item = (&'s str, &'s Value)> {
        variants(family).filter_map(|variant| {
            let properties = variant.get("properties")?.as_object()?;
            let (name, content) = properties.iter().next()?;
            Some((name.as_str(), content))
        })
    }

    /// Whether all fields of a kind have defaults, so that its bare name suffices.
    pub fn is_all_default(&self, content: &Value) -> bool {
        let content = self.follow(content).1;
        let object = content.get("type").and_then(Value::as_str) == Some("object");
        object && content.get("required").and_then(Value::as_array).is_none_or(Vec::is_empty)
    }
}

/// The members of `oneOf`, except those that only declare required keys.
pub fn variants(schema: &Value) -> impl Iterator<Item = &Value> {
    let variants = schema.get("oneOf").and_then(Value::as_array).into_iter().flatten();
    variants.filter(|variant| variant.get("type").is_some() || variant.get("const").is_some())
}

/// The keys of which exactly one is required, from a `oneOf` of `required`.
pub fn exactly_one(schema: &Value) -> Vec<&str> {
    let groups = schema.get("oneOf").and_then(Value::as_array).into_iter().flatten();
    let keys = groups.filter(|group| group.get("type").is_none()).filter_map(|group| group.get("required")?.as_array());
    keys.flatten().filter_map(Value::as_str).collect()
}

/// Calls `change` for a schema and all schemas inside it, innermost first.
fn each_schema(schema: &mut Value, change: &mut impl FnMut(&mut Map<String, Value>)) {
    let Some(members) = schema.as_object_mut() else { return };
    for (key, inner) in members.iter_mut() {
        match (key.as_str(), inner) {
            ("$defs" | "properties", Value::Object(named)) => named.values_mut().for_each(|s| each_schema(s, change)),
            ("oneOf" | "anyOf" | "prefixItems", Value::Array(list)) => {
                list.iter_mut().for_each(|s| each_schema(s, change));
            }
            ("items" | "additionalProperties", inner) => each_schema(inner, change),
            _ => {}
        }
    }
    change(members);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Value forms are recognized by their key alone, so no field or kind may have the same name.
    #[test]
    fn no_field_or_kind_has_the_name_of_a_value_form() {
        let schema = Schema::get();
        let forms: Vec<&str> = crate::animate::forms().collect();
        for (name, definition) in schema.definitions().filter(|(name, _)| *name != "ValueForm") {
            let fields = definition.get("properties").and_then(Value::as_object).into_iter().flat_map(|p| p.keys());
            let mut names = fields.map(String::as_str).chain(schema.kinds(definition).map(|(kind, _)| kind));
            assert!(!names.any(|key| forms.contains(&key)), "{name}");
        }
        let family = schema.root().get("$defs").and_then(|d| d.get("ValueForm")).unwrap();
        assert_eq!(schema.kinds(family).map(|(kind, _)| kind).collect::<Vec<_>>(), forms);
    }

    /// A number at the end comes from two types of one name; it would change with the order of the
    /// types.
    #[test]
    fn no_name_of_a_definition_ends_with_a_number() {
        let mut names = Schema::get().definitions().map(|(name, _)| name);
        let numbered = names.find(|name| name.ends_with(|last: char| last.is_ascii_digit()));
        assert!(numbered.is_none(), "{numbered:?} needs `#[schemars(rename = \"...\")]`");
    }

    #[test]
    fn families_list_their_kinds_and_every_object_is_closed() {
        let schema = Schema::get();
        let definition = |name: &str| schema.root().get("$defs").and_then(|d| d.get(name)).unwrap();
        let shapes: Vec<_> = schema.kinds(definition("AnyShape")).map(|(name, _)| name).collect();
        assert!(shapes.contains(&"sphere") && shapes.contains(&"mesh"), "{shapes:?}");
        let (_, sphere) = schema.kinds(definition("AnyShape")).find(|(name, _)| *name == "sphere").unwrap();
        assert!(schema.is_all_default(sphere));
        assert_eq!(schema.kinds(definition("Object")).count(), 0);
        assert_eq!(exactly_one(definition("Object")), ["shape", "group", "objects", "chain", "limb", "model"]);
        for (name, schema) in schema.definitions().filter(|(_, s)| s.get("type").is_some_and(|t| t == "object")) {
            assert!(schema.get("additionalProperties").is_some(), "{name}");
        }
    }
}
