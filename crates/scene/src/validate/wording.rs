//! Descriptions of a schema for messages: "a number", "3 numbers", "a shape".

use super::rule::Rule;
use crate::schema::{Schema, variants};
use serde_json::Value;

/// Whether a schema allows a JSON type.
pub fn allows(schema: &Value, json_type: &str) -> bool {
    match schema.get("type") {
        Some(Value::String(only)) => only == json_type,
        Some(Value::Array(several)) => several.iter().any(|t| t == json_type),
        _ => false,
    }
}

/// Whether a schema allows numbers.
pub fn allows_number(schema: &Value) -> bool {
    allows(schema, "number") || allows(schema, "integer")
}

/// Describes the values that a rule allows.
pub fn allowed(all: &Schema, rule: &Rule) -> String {
    in_words(all, rule.name, rule.schema)
}

fn expected(all: &Schema, schema: &Value) -> String {
    let (name, target) = all.follow(schema);
    in_words(all, name, target)
}

fn in_words(all: &Schema, name: Option<&str>, target: &Value) -> String {
    if let Some(branches) = target.get("anyOf").and_then(Value::as_array) {
        return choice(all, name, branches);
    }
    if variants(target).next().is_some() {
        let noun = noun(name.unwrap_or("kind"));
        return format!("{} {noun}", article(&noun));
    }
    if allows(target, "array") {
        return array(all, target);
    }
    let words = [
        ("integer", "a whole number"),
        ("number", "a number"),
        ("string", "a string"),
        ("boolean", "true or false"),
        ("object", "an object {...}"),
    ];
    words.iter().find(|(t, _)| allows(target, t)).map_or_else(|| "another value".into(), |(_, word)| (*word).into())
}

/// Describes a choice of forms; `name` is the definition that offers it.
fn choice(all: &Schema, name: Option<&str>, branches: &[Value]) -> String {
    match name {
        Some("Color") => "a color ([r, g, b], \"#rrggbb\", a name of CSS or one number)".into(),
        Some("MaterialRef") => "a material {...} or the name of one".into(),
        name => alternatives(all, branches, name),
    }
}

fn alternatives(all: &Schema, branches: &[Value], owner: Option<&str>) -> String {
    let mut words: Vec<String> = Vec::new();
    for branch in branches.iter().filter(|branch| !allows(branch, "null")) {
        let text = branch.get("type").is_some_and(|t| t == "string");
        let textures = owner.is_some_and(names_textures);
        words.push(match all.follow(branch).0 {
            _ if text && textures => "the name of a texture".into(),
            Some("AnyTexture") if textures => "a texture {...}".into(),
            // Messages name the usual forms; the reference explains products.
            Some(name) if is_product(name) => continue,
            _ => expected(all, branch),
        });
    }
    words.join(" or ")
}

/// Describes the elements of an array.
pub fn elements(all: &Schema, schema: &Value) -> &'static str {
    let items = schema.get("items").map(|items| all.follow(items).1);
    if items.is_some_and(allows_number) { "numbers" } else { "values" }
}

fn array(all: &Schema, schema: &Value) -> String {
    let what = elements(all, schema);
    let bound = |key| schema.get(key).and_then(Value::as_u64);
    match (bound("minItems"), bound("maxItems")) {
        (Some(least), Some(most)) if least == most => format!("an array of {least} {what}"),
        _ => "an array [...]".into(),
    }
}

/// The fixed words of an enum.
pub fn fixed(family: &Value) -> impl Iterator<Item = &str> {
    variants(family).flat_map(|variant| {
        let one = variant.get("const").and_then(Value::as_str);
        let several = variant.get("enum").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str);
        one.into_iter().chain(several)
    })
}

/// Name of a definition without its type parameter: `Input_Color` becomes `Input`.
pub fn family(name: &str) -> &str {
    name.split_once('_').map_or(name, |(generic, _)| generic)
}

/// Whether strings of a definition are names of textures.
pub fn names_textures(name: &str) -> bool {
    matches!(family(name), "Input" | "TextureRef")
}

/// Whether a definition is the product of a texture, a factor and an attribute.
pub fn is_product(name: &str) -> bool {
    family(name) == "InputProduct"
}

/// Name of a definition as a noun: `AnyShape` becomes "shape", `TransformStep` "transform step".
pub fn noun(name: &str) -> String {
    let name = family(name);
    let name = name.strip_prefix("Any").unwrap_or(name);
    let mut words = String::new();
    for character in name.chars() {
        if character.is_uppercase() && !words.is_empty() {
            words.push(' ');
        }
        words.extend(character.to_lowercase());
    }
    words
}

/// Plural of a noun; a noun that ends with an s, such as "axes", is one already.
pub fn plural(noun: &str) -> String {
    if noun.ends_with('s') { noun.to_owned() } else { format!("{noun}s") }
}

/// Indefinite article of a noun, "a" or "an".
pub fn article(noun: &str) -> &'static str {
    if noun.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" }
}

/// Formats names as "`a`, `b` and `c`", with `last` before the last one.
pub fn list<'n>(names: impl IntoIterator<Item = &'n str>, last: &str) -> String {
    let names: Vec<String> = names.into_iter().map(|name| format!("`{name}`")).collect();
    match names.split_last() {
        Some((only, [])) => only.clone(),
        Some((end, rest)) => format!("{} {last} {end}", rest.join(", ")),
        None => String::new(),
    }
}
