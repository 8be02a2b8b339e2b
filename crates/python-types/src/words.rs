//! Values, ranges and defaults in words, for documentation.

use crate::model::{Model, VALUE_FORM, choices, kinds, object, reference, words};
use crate::names;
use serde_json::Value;

/// Maximum length of a default in documentation, in bytes; longer ones are left out.
const MAX_DEFAULT: usize = 60;

/// Describes what a field accepts, without expressions and value forms, which the introduction of a
/// module explains.
pub fn value<'s>(model: &Model<'s>, schema: &'s Value) -> String {
    joined(&phrases(model, schema, false))
}

/// Default of a field as a Python expression; `None` if it has none or a long one. The defaults of
/// an object are those of its own fields.
pub fn default(schema: &Value) -> Option<String> {
    let is_kind = |default: &&Value| default.as_object().is_none_or(|members| members.len() == 1);
    let default = schema.get("default").filter(|default| !default.is_null()).filter(is_kind)?;
    let text = python(default);
    (text.len() <= MAX_DEFAULT).then_some(text)
}

/// Unit of a field.
pub fn unit(schema: &Value) -> Option<&str> {
    schema.get("x-unit").and_then(Value::as_str)
}

fn phrases<'s>(model: &Model<'s>, schema: &'s Value, many: bool) -> Vec<String> {
    let s = if many { "s" } else { "" };
    if let Some(name) = reference(schema) {
        return match name {
            VALUE_FORM | "Expression" => Vec::new(),
            "Color" => vec![format!("color{s}")],
            name if names::family(name).is_some() => vec![format!("{}{s}", noun(names::family(name).unwrap_or(name)))],
            name => named(model, name, many),
        };
    }
    let fixed = words(schema);
    if !fixed.is_empty() && kinds(schema).next().is_none() {
        return fixed.iter().map(|word| format!("\"{word}\"")).collect();
    }
    let mut alternatives = Vec::new();
    for branch in choices(schema) {
        let is_choice = branch.get("anyOf").is_some() || reference(branch).is_some();
        let more = if is_choice { phrases(model, branch, many) } else { plain(model, branch, many) };
        for one in more {
            if !alternatives.contains(&one) {
                alternatives.push(one);
            }
        }
    }
    alternatives
}

fn named<'s>(model: &Model<'s>, name: &'s str, many: bool) -> Vec<String> {
    let s = if many { "s" } else { "" };
    if let Some(class) = model.class_of(name) {
        return vec![if many { format!("`{}` objects", class.name) } else { format!("`{}`", class.name) }];
    }
    match model.definition(name) {
        Some(schema) if object(schema).is_some() || kinds(schema).next().is_some() => {
            vec![format!("{}{s}", noun(name))]
        }
        Some(_) if name == "TextureRef" || name == "MaterialRef" => {
            let noun = name.trim_end_matches("Ref").to_lowercase();
            vec![format!("{noun}{s}"), if many { "names of them".into() } else { "the name of one".into() }]
        }
        Some(_) if name.starts_with("Input_") => {
            let value = if name.ends_with("_Color") { "color" } else { "number" };
            vec![value.into(), "texture".into(), "the name of one".into(), "`InputProduct`".into()]
        }
        Some(schema) => phrases(model, schema, many),
        None => Vec::new(),
    }
}

/// Describes a schema that is no choice.
fn plain<'s>(model: &Model<'s>, schema: &'s Value, many: bool) -> Vec<String> {
    let s = if many { "s" } else { "" };
    let text = match schema.get("type").and_then(Value::as_str) {
        Some("number") => format!("number{s}{}", range(schema)),
        Some("integer") => format!("whole number{s}{}", range(schema)),
        Some("boolean") => return vec!["True".into(), "False".into()],
        Some("string") if schema.get("pattern").is_some() => return Vec::new(),
        Some("string") => format!("string{s}"),
        Some("array") => array(model, schema, many),
        Some("object") => {
            let Some(others) = schema.get("additionalProperties").filter(|others| others.is_object()) else {
                return vec![format!("dict{s}")];
            };
            format!("dict{s} from names to {}", joined(&phrases(model, others, true)))
        }
        _ => return Vec::new(),
    };
    vec![text]
}

fn array<'s>(model: &Model<'s>, schema: &'s Value, many: bool) -> String {
    if schema.get("prefixItems").is_some() {
        return if many { "`(time, value)` or `(time, value, ease)`" } else { "tuple" }.into();
    }
    let items = schema.get("items").map(|items| joined(&phrases(model, items, true)));
    let items = items.filter(|items| !items.is_empty()).unwrap_or_else(|| "values".into());
    let bound = |key: &str| schema.get(key).and_then(Value::as_u64);
    match (bound("minItems"), bound("maxItems")) {
        (Some(least), Some(most)) if least == most && many => format!("groups of {least} {items}"),
        (Some(least), Some(most)) if least == most => format!("{least} {items}"),
        (Some(least), Some(most)) if !many => format!("{least} to {most} {items}"),
        _ if many => format!("lists of {items}"),
        _ => format!("list of {items}"),
    }
}

/// Limits of a number.
fn range(schema: &Value) -> String {
    let bound = |key: &str| schema.get(key).filter(|bound| bound.is_number()).map(ToString::to_string);
    if let (Some(least), Some(most)) = (bound("minimum"), bound("maximum")) {
        return format!(" from {least} to {most}");
    }
    let signs = [("exclusiveMinimum", "above"), ("minimum", "from"), ("exclusiveMaximum", "below"), ("maximum", "to")];
    let limits = signs.iter().filter_map(|(key, sign)| Some(format!(" {sign} {}", bound(key)?)));
    limits.collect()
}

/// JSON as a Python expression; a kind without settings is its name.
fn python(value: &Value) -> String {
    let list = |items: &[Value]| items.iter().map(python).collect::<Vec<_>>().join(", ");
    match value {
        Value::Null => "None".into(),
        Value::Bool(true) => "True".into(),
        Value::Bool(false) => "False".into(),
        Value::Number(_) | Value::String(_) => value.to_string(),
        Value::Array(items) if items.is_empty() => "[]".into(),
        Value::Array(items) => format!("({}{})", list(items), if items.len() == 1 { "," } else { "" }),
        Value::Object(members) => {
            if let (1, Some((name, Value::Object(content)))) = (members.len(), members.iter().next())
                && content.is_empty()
            {
                return format!("\"{name}\"");
            }
            let members: Vec<String> =
                members.iter().map(|(key, value)| format!("\"{key}\": {}", python(value))).collect();
            format!("{{{}}}", members.join(", "))
        }
    }
}

/// Name in CamelCase as words: `TransformStep` becomes "transform step".
fn noun(name: &str) -> String {
    let mut words = String::new();
    for character in name.chars() {
        if character.is_uppercase() && !words.is_empty() {
            words.push(' ');
        }
        words.extend(character.to_lowercase());
    }
    words
}

/// Lists alternatives as "a, b or c".
fn joined(alternatives: &[String]) -> String {
    match alternatives.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => alternatives.concat(),
    }
}
