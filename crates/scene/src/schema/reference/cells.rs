//! Cells of the reference's tables: the allowed values and the default of a field.

use super::{description, one_line};
use crate::schema::{Schema, Unit, variants};
use crate::validate::{family_noun, is_product, plural};
use serde_json::Value;
use std::collections::BTreeMap;

/// Maximum length of a default in a table, in bytes; longer ones are left out.
const MAX_DEFAULT: usize = 60;

/// Formatter of table cells.
pub struct Cells<'s> {
    /// Schema of the format.
    pub schema: &'s Schema,
    /// Anchors of the definitions' sections, by name of the definition.
    pub anchors: BTreeMap<String, String>,
}

impl Cells<'_> {
    /// Describes the allowed values of a field with their range, and with their unit if the
    /// field's description does not state it.
    pub fn value(&self, schema: &Value) -> String {
        let value = self.words(schema, false);
        match Unit::of(schema) {
            Some(unit) if !unit.is_stated_in(&one_line(description(schema))) => format!("{value}, {}", unit.name),
            _ => value,
        }
    }

    /// Describes a value, in the plural if `many`.
    fn words(&self, schema: &Value, many: bool) -> String {
        let (name, target) = self.schema.follow(schema);
        if let Some(text) = name.and_then(|name| self.named(name, many)) {
            return text;
        }
        if let Some(branches) = target.get("anyOf").and_then(Value::as_array) {
            return self.alternatives(branches, many);
        }
        let types: Vec<&str> = match target.get("type") {
            Some(Value::Array(several)) => several.iter().filter_map(Value::as_str).collect(),
            one => one.and_then(Value::as_str).into_iter().collect(),
        };
        let s = if many { "s" } else { "" };
        match types.iter().find(|t| **t != "null").copied() {
            Some("number") => format!("number{s}{}", range(target)),
            Some("integer") => format!("whole number{s}{}", range(target)),
            Some("boolean") => "`true` or `false`".into(),
            Some("array") => self.array(target, many),
            Some("object") => match target.get("additionalProperties").filter(|others| others.is_object()) {
                Some(others) => format!("object{s} of named {}", self.words(others, true)),
                None => format!("object{s}"),
            },
            _ => format!("string{s}"),
        }
    }

    /// Describes a definition that has its own section or a special wording.
    fn named(&self, name: &str, many: bool) -> Option<String> {
        let noun = |noun: &str| if many { plural(noun) } else { noun.to_owned() };
        Some(match name {
            "Color" => format!("[{}](#colors)", noun("color")),
            "GroupName" => "name of a group".into(),
            "CameraName" => "name of a camera".into(),
            "PathName" => "name of a [path](#path)".into(),
            "Key" => if many { "`[time, value]` or `[time, value, ease]`" } else { "a key" }.into(),
            "Visible" => "`true`, `false` or number".into(),
            "Variable" => {
                format!("{}, [expressions](#expressions), [value forms](#value-forms), arrays of them", noun("number"))
            }
            name => format!("[{}](#{})", noun(&family_noun(name)), self.anchors.get(name)?),
        })
    }

    /// Describes alternative forms, such as a material or its name.
    fn alternatives(&self, branches: &[Value], many: bool) -> String {
        let is = |branch: &Value, t: &str| branch.get("type").is_some_and(|found| found == t);
        let named = |branch: &Value| matches!(self.schema.follow(branch).0, Some("AnyMaterial" | "AnyTexture"));
        let product = |branch: &Value| self.schema.follow(branch).0.is_some_and(is_product);
        let is_named = branches.iter().any(named);
        let (texts, others): (Vec<&Value>, Vec<&Value>) = branches
            .iter()
            .filter(|branch| !is(branch, "null") && !product(branch))
            .partition(|branch| is(branch, "string"));
        let mut words: Vec<String> = others.into_iter().map(|branch| self.words(branch, many)).collect();
        if !texts.is_empty() {
            words.push(if is_named { "its name".into() } else { "string".into() });
        }
        words.join(" or ")
    }

    fn array(&self, schema: &Value, many: bool) -> String {
        let array = if many { "arrays" } else { "array" };
        let items = schema.get("items").map_or_else(|| "values".into(), |items| self.words(items, true));
        let bound = |key: &str| schema.get(key).and_then(Value::as_u64);
        match (bound("minItems"), bound("maxItems")) {
            (Some(least), Some(most)) if least == most => format!("{array} of {least} {items}"),
            (Some(least), Some(most)) => format!("{array} of {least} to {most} {items}"),
            (Some(least), None) => format!("{array} of {least} or more {items}"),
            _ => format!("{array} of {items}"),
        }
    }

    /// Formats the default of a field; empty if there is none or if it is too long.
    pub fn default(&self, field: &Value) -> String {
        let Some(default) = field.get("default").filter(|default| !default.is_null()) else { return String::new() };
        let text = self.short(field, default).to_string();
        if text.len() > MAX_DEFAULT { String::new() } else { format!("`{}`", spaced(&text)) }
    }

    /// Shortens a default: a kind to its name, an object to the members that differ from their
    /// defaults.
    fn short(&self, schema: &Value, value: &Value) -> Value {
        let target = self.schema.follow(schema).1;
        if let Some(branches) = target.get("anyOf").and_then(Value::as_array) {
            let inline = branches.iter().find(|branch| value.is_object() && self.schema.follow(branch).0.is_some());
            return inline.map_or_else(|| value.clone(), |branch| self.short(branch, value));
        }
        let Value::Object(members) = value else { return value.clone() };
        if let Some((kind, inner)) = members.iter().next().filter(|_| variants(target).next().is_some()) {
            let content = self.schema.kinds(target).find(|(name, _)| name == kind).map(|(_, content)| content);
            let inner = content.map_or_else(|| inner.clone(), |content| self.short(content, inner));
            let bare = inner.as_object().is_some_and(serde_json::Map::is_empty);
            return if bare {
                kind.as_str().into()
            } else {
                Value::Object([(kind.clone(), inner)].into_iter().collect())
            };
        }
        let fields = target.get("properties").and_then(Value::as_object);
        let own = |key: &str| fields.and_then(|fields| fields.get(key)?.get("default"));
        let said = members.iter().filter(|(key, value)| !value.is_null() && own(key) != Some(*value));
        Value::Object(said.map(|(key, value)| (key.clone(), value.clone())).collect())
    }
}

/// Describes the limits of a number, if there are any.
fn range(schema: &Value) -> String {
    let bound = |key: &str| schema.get(key).and_then(Value::as_f64);
    match (bound("minimum"), bound("maximum")) {
        (Some(least), Some(most)) if least == most => return format!(": {least}"),
        (Some(least), Some(most)) => return format!(" from {} to {}", shown(least), shown(most)),
        _ => {}
    }
    let signs = [("exclusiveMinimum", ">"), ("minimum", "≥"), ("exclusiveMaximum", "<"), ("maximum", "≤")];
    let limits = signs.iter().filter_map(|(key, sign)| Some(format!("{sign} {}", shown(bound(key)?))));
    let limits = limits.collect::<Vec<_>>().join(" and ");
    if limits.is_empty() { limits } else { format!(" {limits}") }
}

/// Formats a limit, with an exponent if it is very large or very small.
fn shown(bound: f64) -> String {
    let size = bound.abs();
    if size >= 1e16 || size > 0.0 && size < 1e-9 { format!("{bound:e}") } else { bound.to_string() }
}

/// Adds a space after commas and colons of compact JSON.
fn spaced(json: &str) -> String {
    let (mut text, mut in_string) = (String::new(), false);
    for character in json.chars() {
        text.push(character);
        in_string ^= character == '"';
        if !in_string && ",:".contains(character) {
            text.push(' ');
        }
    }
    text
}
