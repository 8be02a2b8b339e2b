//! Validation of a tree against the schema. It reports all errors at once, each with its path,
//! position and probable meaning.
//!
//! The walk also builds the plain JSON from which the types are deserialized: the bare name of a
//! kind becomes the kind with defaults, and integers written as `8.0` become integers. Invalid
//! values are left out, so that the rest can still be checked.

use crate::document::{Node, Value as NodeValue};
use crate::path::{Path, PathRef, Step};
use crate::report::Finding;
use crate::schema::Schema;
use crate::suggest::did_you_mean;
use other_programs::Written;
use rule::{Rule, RuleId};

mod choice;
mod declared_names;
mod family;
mod inline;
mod names;
mod other_programs;
mod plain;
mod rewritten;
mod rule;
mod scalar;
mod structure;
mod wording;

pub(crate) use declared_names::DeclaredNames;
pub(crate) use names::NameScope;
pub use names::NamedFamily;
pub use other_programs::page as names_page;
pub(crate) use plain::Plain;
#[cfg(test)]
pub(crate) use wording::names_textures;
pub(crate) use wording::{is_product, list, noun as family_noun, plural};

/// Maximum number of warnings.
const MAX_WARNINGS: usize = 20;
/// Maximum number of errors; a file of numbers in place of objects has one for each.
const MAX_FINDINGS: usize = 200;
/// Maximum number of errors with suggestions of names, which take the time to look at all names.
pub(crate) const MAX_SUGGESTIONS: usize = 50;

/// Result of a validation.
#[derive(Debug, Default)]
pub struct Validated {
    /// The scene as plain JSON without its invalid parts; `None` if almost nothing is valid.
    pub json: Option<Plain>,
    /// Inline textures by name. The inline textures of a whole scene are part of `json`, and `Null`
    /// here.
    pub textures: Vec<(String, Plain)>,
    /// All errors.
    pub findings: Vec<Finding>,
    /// Warnings about content that is allowed but probably not intended.
    pub warnings: Vec<Finding>,
}

impl Validated {
    /// Errors, then warnings.
    pub fn all(mut self) -> Vec<Finding> {
        self.findings.append(&mut self.warnings);
        self.findings
    }
}

/// Validates a scene whose expressions are evaluated.
pub fn validate(tree: &Node) -> Validated {
    let mut validator = Validator::new(NameScope::Tree(tree));
    let mut json = Rule::root().and_then(|scene| validator.value(tree, &PathRef::Root, scene));
    let textures = match &mut json {
        Some(Plain::Object(scene)) => validator.add_textures(scene),
        _ => Vec::new(),
    };
    Validated { json, textures, findings: validator.findings, warnings: validator.warnings }
}

/// Validates an item of a scene, or a list of items, whose expressions are evaluated. `belongs` is
/// its path in the scene, and `at` its path in messages. After `earlier` errors in other items,
/// suggestions end.
pub(crate) fn item(node: &Node, belongs: &Path, at: &PathRef<'_>, known: NameScope<'_>, earlier: usize) -> Validated {
    let Some(rule) = rule_of(belongs) else { return Validated::default() };
    let mut validator = Validator { suggestions: earlier, ..Validator::new(known) };
    let json = validator.value(node, at, rule);
    let textures = std::mem::take(&mut validator.textures);
    Validated { json, textures, findings: validator.findings, warnings: validator.warnings }
}

/// Rule of an item or of a list of items by its path.
fn rule_of(path: &Path) -> Option<&'static Rule> {
    let scene = Rule::root()?;
    let (Step::Key(section), rest) = path.steps().split_first()? else { return None };
    let section = (section.as_str(), scene.field(section)?.get());
    let objects = || scene.field("objects").map(RuleId::get);
    match (section, rest) {
        ((_, rule), []) => Some(rule),
        (("groups", _), [_]) => objects(),
        (("groups" | "objects", _), _) => objects()?.items.map(RuleId::get),
        ((_, rule), _) => rule.items.or(rule.additional).map(RuleId::get),
    }
}

/// Validates a value at the path `at` against the definition of this name.
pub(crate) fn part(node: &Node, definition: &str, at: &PathRef<'_>) -> Validated {
    match Rule::named(definition) {
        Some(rule) => by_rule(node, rule, at),
        None => Validated::default(),
    }
}

fn by_rule(node: &Node, rule: &'static Rule, at: &PathRef<'_>) -> Validated {
    validated_by(Validator::new(NameScope::Tree(node)), node, rule, at)
}

/// Whether a value has no other errors by a rule than those that `allowed` accepts.
fn is_valid(node: &Node, rule: &'static Rule, allowed: impl Fn(&Finding) -> bool) -> bool {
    // Suggestions would validate the examples that they suggest.
    let validator = Validator { suggestions: MAX_SUGGESTIONS, ..Validator::new(NameScope::Tree(node)) };
    validated_by(validator, node, rule, &PathRef::Root.key("example")).findings.iter().all(allowed)
}

fn validated_by(mut validator: Validator<'_>, node: &Node, rule: &'static Rule, at: &PathRef<'_>) -> Validated {
    let json = validator.value(node, at, rule);
    Validated { json, textures: Vec::new(), findings: validator.findings, warnings: validator.warnings }
}

/// Suggests a replacement for an unknown key of a scene.
pub(crate) fn suggest_scene_key(key: &str, value: &Node) -> Option<String> {
    let written = Written { value, siblings: None };
    Rule::root().and_then(|scene| structure::suggest_key(key, scene, written))
}

struct Validator<'t> {
    schema: &'static Schema,
    /// Names that references are looked up in.
    known: NameScope<'t>,
    findings: Vec<Finding>,
    /// Inline textures by name.
    textures: Vec<(String, Plain)>,
    warnings: Vec<Finding>,
    /// Number of errors that may have had a suggestion.
    suggestions: usize,
}

impl<'t> Validator<'t> {
    fn new(known: NameScope<'t>) -> Self {
        Self {
            schema: Schema::get(),
            known,
            findings: Vec::new(),
            textures: Vec::new(),
            warnings: Vec::new(),
            suggestions: 0,
        }
    }

    /// Computes the suggestion for an error, if it is one of the first [`MAX_SUGGESTIONS`].
    fn suggestion(&mut self, suggest: impl FnOnce() -> Option<String>) -> Option<String> {
        self.suggestions += 1;
        if self.suggestions <= MAX_SUGGESTIONS { suggest() } else { None }
    }
}

/// Whether a text may be the name of a variable.
fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_alphabetic()) && text.chars().all(|c| c.is_alphanumeric() || c == '_')
}

impl Validator<'_> {
    /// Validates a value. Returns its plain JSON; `None` if it is invalid and must be left out.
    fn value(&mut self, node: &Node, at: &PathRef<'_>, rule: &'static Rule) -> Option<Plain> {
        if self.findings.len() >= MAX_FINDINGS {
            return None;
        }
        if rule.allows_anything {
            return Some(Plain::Null);
        }
        if matches!(node.value, NodeValue::Invalid) {
            return None;
        }
        if !rule.alternatives.is_empty() {
            return self.choice(node, at, rule);
        }
        if rule.is_family() {
            return self.family(node, at, rule);
        }
        match &node.value {
            NodeValue::Null if rule.types.null => Some(Plain::Null),
            NodeValue::Number(number) if rule.allows_number() => self.number(node, at, number, rule),
            NodeValue::String(text) if rule.types.string => self.string(node, at, text, rule),
            NodeValue::Bool(value) if rule.types.boolean => Some(Plain::Bool(*value)),
            NodeValue::Array(elements) if rule.types.array => self.array(node, at, elements, rule),
            NodeValue::Object(members) if rule.types.object => self.object(node, at, members, rule),
            _ => self.mismatch(node, at, rule, &wording::allowed(self.schema, rule)),
        }
    }

    /// Reports a value of the wrong type.
    fn mismatch(&mut self, node: &Node, at: &PathRef<'_>, rule: &'static Rule, expected: &str) -> Option<Plain> {
        let found = || Finding::error(format!("expected {expected}, found {}", node.kind()));
        let rewritten = || rule.rewritten(node, at);
        let finding = match &node.value {
            NodeValue::Null if node.place.is_none() => {
                Finding::error(format!("expected {expected}, found a value that is not finite"))
            }
            NodeValue::String(text)
                if expected.contains("number") && crate::animate::looks_like_expression(text)
                    || expected.ends_with("number") && is_name(text) =>
            {
                let expression = || Some(format!("an expression begins with `=`: \"={text}\""));
                found().maybe_help(self.suggestion(|| rewritten().or_else(expression)))
            }
            NodeValue::Object(members) => {
                let form = members.keys().next().filter(|_| members.len() == 1);
                let form = || crate::animate::closest_form(form?).map(did_you_mean);
                found().maybe_help(self.suggestion(|| form().or_else(rewritten)))
            }
            _ => found().maybe_help(self.suggestion(rewritten)),
        };
        self.report(node, at, finding)
    }

    /// Reports an error about a value.
    fn report<T>(&mut self, node: &Node, at: &PathRef<'_>, finding: Finding) -> Option<T> {
        self.findings.push(finding.at(at).on(node.place));
        None
    }
}
