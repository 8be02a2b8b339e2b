//! Generator of the page `docs/names.md`.

use super::{ENTRIES, Entry, is_kind_of, noun, owners, wording};
use crate::validate::rule::Rule;
use std::fmt::Write;

/// Text above the tables.
const INTRODUCTION: &str = "# Names in other programs

Names in Blender, glTF, Mitsuba, pbrt, POV-Ray and three.js, and the corresponding names in [scene files](scene-format.md).
`juggler check` suggests the same replacements, with the values of the scene; `1 - x` stands for a value that is computed
from the value `x`. Case, hyphens and underscores are ignored. Names that are accepted, with a warning, are read as the
names here.

Kinds are written as keys: `{\"sphere\": {\"radius\": 1}}` instead of `{\"type\": \"sphere\", \"radius\": 1}`. Coordinates
are right-handed with y up, as in glTF and three.js; angles are in degrees; colors are linear RGB from 0 to 1, or sRGB as
`\"#rrggbb\"`.
";

/// Generates the page in Markdown, without words that are valid at their place.
pub fn page() -> String {
    let mut text = INTRODUCTION.to_owned();
    let mut section = "";
    let places = places();
    for entry in ENTRIES.iter() {
        let words = shown(entry, &places);
        if words.is_empty() {
            continue;
        }
        if section != entry.section {
            section = entry.section;
            let _ = write!(
                text,
                "\n## {section}\n\n| name | used as | in scene files | example | programs |\n|---|---|---|---|---|\n"
            );
        }
        let (place, target, example) = (place(entry), linked(entry), entry.example.sample());
        let (note, programs) = (note(entry), entry.programs);
        let _ = writeln!(text, "| {words} | {place} | {target} | `{example}`{note} | {programs} |");
    }
    text + &Rule::absent_names_section()
}

/// How an entry computes its values from a value `x`, and its note; empty for most.
fn note(entry: &Entry) -> String {
    let computations = entry.example.computations().map(|computation| format!("`{computation}`"));
    let computed = computations.collect::<Vec<_>>().join(", ");
    let parts: Vec<&str> = [&*computed, entry.note].into_iter().filter(|part| !part.is_empty()).collect();
    if parts.is_empty() { String::new() } else { format!(" ({})", parts.join("; ")) }
}

/// The words of an entry that are not valid at its place, in Markdown.
fn shown(entry: &Entry, places: &[Place]) -> String {
    let known = |word: &str| places.iter().any(|place| is_known(entry, place, word));
    let words = entry.words.iter().filter(|word| !known(word)).map(|word| format!("`{word}`"));
    words.collect::<Vec<_>>().join(", ")
}

/// A rule and its names in the table.
struct Place {
    rule: &'static Rule,
    /// Name of the family or of the list of words.
    noun: String,
    /// Most specific name of the object.
    object: String,
}

fn places() -> Vec<Place> {
    let place = |rule: &'static Rule| Place {
        rule,
        noun: rule.name.map(noun).unwrap_or_default(),
        object: owners(rule).into_iter().next().unwrap_or_default(),
    };
    Rule::all().iter().map(place).collect()
}

fn is_known(entry: &Entry, place: &Place, word: &str) -> bool {
    let Place { rule, noun, object } = place;
    if entry.is_kind {
        let own = entry.owner() != *noun || has(rule, entry.name());
        return entry.owners.contains(&noun.as_str()) && own && has(rule, word);
    }
    // A key of one kind may be unknown to another kind of the family.
    let own = |owner: &&str| object == owner || object.rsplit('.').next() == Some(*owner);
    entry.owners.iter().any(own) && rule.fields.iter().flatten().any(|(name, _)| *name == word)
}

fn has(family: &Rule, word: &str) -> bool {
    family.words.contains(&word) || family.kinds.iter().any(|(kind, _)| *kind == word)
}

/// Describes the place of an entry's words: `kind of shape`, `key of a light`.
fn place(entry: &Entry) -> String {
    let names: Vec<String> = entry.owners.iter().map(|owner| owner.replace(['_', '.'], " ")).collect();
    let names = names.join(", ");
    match (entry.is_kind, entry.owners.as_slice()) {
        (true, _) => format!("kind of {names}"),
        (false, ["scene"]) => "key of the scene".into(),
        (false, ["render" | "tone" | "animation" | "animate" | "rotate" | "look_at"]) => format!("key of `{names}`"),
        (false, _) => format!("key of {} {names}", wording::article(&names)),
    }
}

/// Describes the target, with a link to its section of the reference if it has one.
fn linked(entry: &Entry) -> String {
    match entry.target.as_slice() {
        [family, kind, ..] if is_kind_of(family, kind) => {
            let family = family.replace('_', "-");
            format!("[{}](scene-format.md#{family}-{kind})", entry.described())
        }
        [_, word] if entry.is_kind && entry.owners.contains(&entry.owner().as_str()) => format!("`\"{word}\"`"),
        [owner, _] if entry.owners.iter().any(|own| own == owner) => wording::list(entry.names(), "and"),
        [owner, _] if !["scene", "object"].contains(owner) && !is_object(owner) => wording::list(entry.names(), "and"),
        _ => entry.described(),
    }
}

/// Whether a definition is an object and not a family.
fn is_object(owner: &str) -> bool {
    Rule::all().iter().any(|rule| rule.kinds.is_empty() && rule.name.is_some_and(|name| noun(name) == owner))
}
