//! Generator of the format's reference: an introduction written by hand, then every part of the
//! schema as Markdown.

use super::{Schema, UNITS, variants};
use crate::compile::{MAX_EDGE, MAX_EMITTERS, MAX_NESTING, MAX_OBJECTS, MAX_PIXELS, MAX_SAMPLES, MAX_STORED};
use crate::validate::{family_noun, is_product, plural};
use crate::{animate, compile, document};
use juggler_expression::FUNCTIONS;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

mod cells;

use cells::Cells;

/// The introduction.
const INTRODUCTION: &str = include_str!("introduction.md");
/// The introduction's section about animation.
const ANIMATION: &str = include_str!("animation.md");

/// Generates the reference of the scene format in Markdown.
pub fn reference() -> String {
    let schema = Schema::get();
    let mut plan = Plan { schema, entries: Vec::new(), seen: BTreeSet::new() };
    plan.scene();
    let cells = Cells { schema, anchors: plan.anchors() };
    let mut text = INTRODUCTION
        .replace("ANIMATION\n", ANIMATION)
        .replace("FUNCTIONS", &functions())
        .replace("UNITS", units().trim_end())
        .replace("LIMITS", limits().trim_end());
    text.push_str("\n## Contents\n\n");
    for entry in plan.entries.iter().filter(|entry| entry.level == 2) {
        let _ = writeln!(text, "- [{}](#{})", entry.heading, anchor(&entry.heading));
    }
    for entry in &plan.entries {
        write_entry(&mut text, entry, &cells);
    }
    text
}

/// List of the functions of expressions with their usage.
fn functions() -> String {
    let functions: Vec<String> = FUNCTIONS.iter().map(|function| format!("`{}`", function.usage)).collect();
    let lines: Vec<String> = functions.chunks(6).map(|line| format!("  {}", line.join(", "))).collect();
    lines.join(",\n")
}

/// Table of the units.
fn units() -> String {
    let rows: String = UNITS.iter().map(|unit| format!("| {} | {} |\n", unit.name, unit.meaning)).collect();
    format!("| unit | measures |\n|---|---|\n{rows}")
}

/// Table of the size limits.
fn limits() -> String {
    let limits = [
        ("size of a scene file", format!("{} MiB", document::MAX_BYTES >> 20)),
        ("values in a scene file", document::MAX_VALUES.to_string()),
        ("nesting of arrays and objects", document::MAX_DEPTH.to_string()),
        ("scene files of a scene", document::MAX_FILES.to_string()),
        ("objects, counted once for each placement of their group", MAX_OBJECTS.to_string()),
        ("objects in memory (repeated large groups count once)", MAX_STORED.to_string()),
        ("emissive shapes, counted once for each placement of their group", MAX_EMITTERS.to_string()),
        ("light groups, `rest` included", juggler_camera::aov::LightGroup::MAX_COUNT.to_string()),
        ("nesting of groups", MAX_NESTING.to_string()),
        ("nesting of materials", juggler_material::MAX_NESTING.to_string()),
        ("nesting of textures", juggler_texture::MAX_NESTING.to_string()),
        ("nested texture lookups per lookup", juggler_texture::MAX_LOOKUPS.to_string()),
        ("bytes of an expression", juggler_expression::MAX_LENGTH.to_string()),
        ("nesting of an expression", juggler_expression::MAX_DEPTH.to_string()),
        ("keys of a track", animate::MAX_KEYS.to_string()),
        ("points of a path", animate::MAX_POINTS.to_string()),
        ("nesting of value forms", animate::MAX_NESTING.to_string()),
        ("width or height of a texture image, in pixels", compile::MAX_SIDE.to_string()),
        ("pixels of a texture image", compile::MAX_TEXELS.to_string()),
        ("width or height of an image, in pixels", MAX_EDGE.to_string()),
        ("pixels of an image", MAX_PIXELS.to_string()),
        ("samples per pixel", MAX_SAMPLES.to_string()),
    ];
    let rows: String = limits.iter().map(|(what, most)| format!("| {what} | {most} |\n")).collect();
    format!("Numbers must be finite as 32-bit floats.\n\n| limit | maximum |\n|---|---|\n{rows}")
}

/// A section of the reference.
struct Entry<'s> {
    level: usize,
    heading: String,
    /// Name of the definition that the section explains, if it has one.
    name: Option<&'s str>,
    description: &'s str,
    schema: &'s Value,
}

/// Order of the sections: each section is followed by those that it refers to.
struct Plan<'s> {
    schema: &'s Schema,
    entries: Vec<Entry<'s>>,
    seen: BTreeSet<&'s str>,
}

impl<'s> Plan<'s> {
    fn scene(&mut self) {
        let root = self.schema.root();
        self.entry(2, "The scene".into(), None, description(root), root);
        for (name, target) in self.leads_to(root) {
            self.section(name, target);
        }
    }

    /// Adds a section for a family or for a part of the scene.
    fn section(&mut self, name: &'s str, target: &'s Value) {
        if !self.seen.insert(name) {
            return;
        }
        let noun = family_noun(name);
        let mut inner = self.leads_to(target);
        if is_table(target) {
            self.entry(2, capital(&noun), Some(name), description(target), target);
        } else if is_family(self.schema, target) {
            self.entry(2, capital(&plural(&noun)), Some(name), description(target), target);
            inner = self.kinds(&noun, target);
        }
        let mut sections = Vec::new();
        for (name, target) in inner {
            self.part(&noun, name, target, &mut sections);
        }
        for (name, target) in sections {
            self.section(name, target);
        }
    }

    /// Adds the kinds of a family. Returns the definitions that they refer to.
    fn kinds(&mut self, noun: &str, family: &'s Value) -> Vec<(&'s str, &'s Value)> {
        let mut inner = Vec::new();
        for variant in variants(family) {
            let Some((kind, content)) =
                variant.get("properties").and_then(Value::as_object).and_then(|p| p.iter().next())
            else {
                continue;
            };
            let (name, target) = self.schema.follow(content);
            let text = [variant, content, target].map(description).into_iter().find(|text| !text.is_empty());
            self.entry(3, format!("{} `{kind}`", capital(noun)), name, text.unwrap_or_default(), target);
            inner.extend(self.leads_to(target));
        }
        inner
    }

    /// Adds a definition that only this section uses as its subsection; families are deferred to
    /// sections of their own.
    fn part(&mut self, noun: &str, name: &'s str, target: &'s Value, sections: &mut Vec<(&'s str, &'s Value)>) {
        // The introduction explains products of inputs.
        if is_product(name) {
            return;
        }
        if is_family(self.schema, target) {
            sections.push((name, target));
        } else if (is_table(target) || is_words(target)) && self.seen.insert(name) {
            let heading = format!("{}: {}", capital(noun), family_noun(name));
            self.entry(3, heading, Some(name), description(target), target);
            for (name, target) in self.leads_to(target) {
                self.part(noun, name, target, sections);
            }
        } else if !is_table(target) && !is_words(target) {
            for (name, target) in self.leads_to(target) {
                self.part(noun, name, target, sections);
            }
        }
    }

    fn entry(&mut self, level: usize, heading: String, name: Option<&'s str>, description: &'s str, schema: &'s Value) {
        self.entries.push(Entry { level, heading, name, description, schema });
    }

    /// The definitions that a schema refers to, including those inside unnamed parts.
    fn leads_to(&self, schema: &'s Value) -> Vec<(&'s str, &'s Value)> {
        let mut found = Vec::new();
        collect(self.schema, schema, &mut found);
        found
    }

    fn anchors(&self) -> BTreeMap<String, String> {
        let named = self.entries.iter().filter_map(|entry| Some((entry.name?.to_owned(), anchor(&entry.heading))));
        named.collect()
    }
}

fn collect<'s>(all: &'s Schema, schema: &'s Value, found: &mut Vec<(&'s str, &'s Value)>) {
    for (key, inner) in schema.as_object().into_iter().flatten() {
        match (key.as_str(), inner) {
            ("properties", Value::Object(named)) => named.values().for_each(|inner| reference_in(all, inner, found)),
            ("oneOf" | "anyOf", Value::Array(list)) => list.iter().for_each(|inner| reference_in(all, inner, found)),
            ("items" | "additionalProperties", inner) => reference_in(all, inner, found),
            _ => {}
        }
    }
}

fn reference_in<'s>(all: &'s Schema, schema: &'s Value, found: &mut Vec<(&'s str, &'s Value)>) {
    match all.follow(schema) {
        (Some(name), target) => found.push((name, target)),
        (None, inner) => collect(all, inner, found),
    }
}

fn write_entry(text: &mut String, entry: &Entry<'_>, cells: &Cells<'_>) {
    let _ = write!(text, "\n{} {}\n\n", "#".repeat(entry.level), entry.heading);
    if !entry.description.is_empty() {
        let _ = write!(text, "{}\n\n", entry.description);
    }
    if is_family(cells.schema, entry.schema) {
        let noun = entry.heading.trim_end_matches('s');
        for (kind, _) in cells.schema.kinds(entry.schema) {
            let _ = writeln!(text, "- [`{kind}`](#{})", anchor(&format!("{noun} {kind}")));
        }
    } else if is_words(entry.schema) {
        for variant in variants(entry.schema) {
            let word = variant.get("const").and_then(Value::as_str).unwrap_or_default();
            let _ = writeln!(text, "- `\"{word}\"`: {}", one_line(description(variant)));
        }
    } else if let Some(fields) = entry.schema.get("properties").and_then(Value::as_object) {
        let required: Vec<&str> = entry
            .schema
            .get("required")
            .and_then(Value::as_array)
            .into_iter()
            .flatten()
            .filter_map(Value::as_str)
            .collect();
        text.push_str("| field | value | default | meaning |\n|---|---|---|---|\n");
        for (name, field) in fields {
            let default = if required.contains(&name.as_str()) { "required".into() } else { cells.default(field) };
            let (value, meaning) = (cells.value(field), one_line(description(field)));
            let _ = writeln!(text, "| `{name}` | {value} | {default} | {} |", meaning.replace('|', "\\|"));
        }
    } else if entry.schema.get("type").is_some_and(|t| t == "object") {
        text.push_str("This kind has no settings.\n");
    } else {
        let _ = writeln!(text, "Value: {}.", cells.value(entry.schema));
    }
}

/// Whether a schema is an object with fixed settings (or none), which a table lists.
fn is_table(schema: &Value) -> bool {
    schema.get("type").is_some_and(|t| t == "object")
        && schema.get("additionalProperties").is_none_or(|o| !o.is_object())
}

fn is_family(all: &Schema, schema: &Value) -> bool {
    all.kinds(schema).next().is_some()
}

fn is_words(schema: &Value) -> bool {
    variants(schema).any(|variant| variant.get("const").is_some())
}

fn description(schema: &Value) -> &str {
    schema.get("description").and_then(Value::as_str).unwrap_or_default()
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn capital(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map_or_else(String::new, |first| first.to_uppercase().chain(characters).collect())
}

/// Link target of a heading, as GitHub generates it.
fn anchor(heading: &str) -> String {
    let kept = heading.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.flat_map(char::to_lowercase).collect::<String>().replace(' ', "-")
}
