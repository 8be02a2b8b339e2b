//! Tree against schema: every mistake at once, each with its path, its place and what was probably meant.
//!
//! The walk also writes the plain JSON that the types are read from: a kind's name becomes the kind, whole numbers
//! written `8.0` become whole. What is wrong is left out, so that the rest can still be checked.

use crate::document::{Node, Value as Written};
use crate::path::{Path, Step, Trail};
use crate::report::Finding;
use crate::schema::Schema;
use crate::suggest::did_you_mean;
use rule::{Rule, RuleId};

mod choice;
mod family;
mod foreign;
mod given;
mod inline;
mod names;
mod plain;
mod rule;
mod scalar;
mod structure;
mod words;

pub use foreign::page as names_page;
pub(crate) use given::DeclaredNames;
pub use names::Family;
pub(crate) use names::NameScope;
pub(crate) use plain::Plain;
pub(crate) use words::{family as definition_family, list, noun as family_noun, plural};

/// Most warnings that are collected.
const MAX_WARNINGS: usize = 20;
/// Most mistakes that are collected; a file of numbers where objects should be makes one for each.
const MAX_FINDINGS: usize = 200;

/// What a walk brought.
#[derive(Debug, Default)]
pub struct Validated {
    /// The scene as plain JSON, without what is wrong; nothing when hardly anything is right.
    pub json: Option<Plain>,
    /// Inline textures by name. The inline textures of a whole scene are part of `json`, and `Null`
    /// here.
    pub textures: Vec<(String, Plain)>,
    /// All that is wrong.
    pub findings: Vec<Finding>,
    /// What is allowed and probably not meant.
    pub warnings: Vec<Finding>,
}

impl Validated {
    /// Mistakes, then warnings.
    pub fn all(mut self) -> Vec<Finding> {
        self.findings.append(&mut self.warnings);
        self.findings
    }
}

/// Checks a scene whose expressions are resolved.
pub fn validate(tree: &Node) -> Validated {
    let mut walk = Walk::new(NameScope::Tree(tree));
    let mut json = Rule::root().and_then(|scene| walk.value(tree, &Trail::Root, scene));
    let textures = match &mut json {
        Some(Plain::Object(scene)) => walk.add_textures(scene),
        _ => Vec::new(),
    };
    Validated { json, textures, findings: walk.findings, warnings: walk.warnings }
}

/// Checks one item of a scene, or one list of items, whose expressions are resolved. `belongs` is its path in the scene
/// and `at` where messages say that it stands.
pub(crate) fn item(node: &Node, belongs: &Path, at: &Trail<'_>, known: NameScope<'_>) -> Validated {
    let Some(rule) = rule_of(belongs) else { return Validated::default() };
    let mut walk = Walk::new(known);
    let json = walk.value(node, at, rule);
    let textures = std::mem::take(&mut walk.textures);
    Validated { json, textures, findings: walk.findings, warnings: walk.warnings }
}

/// What may stand at the path of an item or of a list of items.
fn rule_of(path: &Path) -> Option<&'static Rule> {
    let scene = Rule::root()?;
    let (Step::Key(section), rest) = path.steps().split_first()? else { return None };
    let section = (section.as_str(), scene.field(section)?.get());
    let objects = || scene.field("objects").map(RuleId::get);
    match (section, rest) {
        ((_, rule), []) => Some(rule),
        (("groups", _), [_]) => objects(),
        (("groups" | "objects", _), _) => objects()?.items.map(RuleId::get),
        ((_, rule), _) => rule.items.or(rule.others).map(RuleId::get),
    }
}

/// Checks a value that stands at `at` against the definition of this name.
pub(crate) fn part(node: &Node, definition: &str, at: &Trail<'_>) -> Validated {
    match Rule::named(definition) {
        Some(rule) => by_rule(node, rule, at),
        None => Validated::default(),
    }
}

fn by_rule(node: &Node, rule: &'static Rule, at: &Trail<'_>) -> Validated {
    let mut walk = Walk::new(NameScope::Tree(node));
    let json = walk.value(node, at, rule);
    Validated { json, textures: Vec::new(), findings: walk.findings, warnings: walk.warnings }
}

/// What an unknown key of a scene probably means.
pub(crate) fn meant_in_scene(key: &str) -> Option<String> {
    Rule::root().and_then(|scene| structure::meant(key, scene))
}

struct Walk<'t> {
    schema: &'static Schema,
    /// Where names are looked up.
    known: NameScope<'t>,
    findings: Vec<Finding>,
    /// Textures that are written in place, by the names that they get.
    textures: Vec<(String, Plain)>,
    warnings: Vec<Finding>,
}

impl<'t> Walk<'t> {
    fn new(known: NameScope<'t>) -> Self {
        Self { schema: Schema::get(), known, findings: Vec::new(), textures: Vec::new(), warnings: Vec::new() }
    }
}

impl Walk<'_> {
    /// The plain JSON of a value, or nothing when it is wrong and must be left out.
    fn value(&mut self, node: &Node, at: &Trail<'_>, rule: &'static Rule) -> Option<Plain> {
        if self.findings.len() >= MAX_FINDINGS {
            return None;
        }
        if rule.anything {
            return Some(Plain::Null);
        }
        if matches!(node.value, Written::Wrong) {
            return None;
        }
        if !rule.ways.is_empty() {
            return self.choice(node, at, rule);
        }
        if rule.is_family() {
            return self.family(node, at, rule);
        }
        match &node.value {
            Written::Null if rule.types.null => Some(Plain::Null),
            Written::Number(number) if rule.allows_number() => self.number(node, at, number, rule),
            Written::String(text) if rule.types.string => self.string(node, at, text, rule),
            Written::Bool(value) if rule.types.boolean => Some(Plain::Bool(*value)),
            Written::Array(elements) if rule.types.array => self.array(node, at, elements, rule),
            Written::Object(members) if rule.types.object => self.object(node, at, members, rule),
            _ => self.mismatch(node, at, &words::allowed(self.schema, rule)),
        }
    }

    /// The wrong type of value stands here.
    fn mismatch(&mut self, node: &Node, at: &Trail<'_>, expected: &str) -> Option<Plain> {
        let finding = match &node.value {
            Written::Null if node.place.is_none() => {
                Finding::error(format!("expected {expected}, found one that is not finite"))
            }
            Written::String(text) if expected.contains("number") && crate::animate::looks_like_expression(text) => {
                Finding::error(format!("expected {expected}, found a string"))
                    .help(format!("an expression begins with `=`: \"={text}\""))
            }
            Written::Object(members) => {
                let form = members.keys().next().filter(|_| members.len() == 1);
                let form = form.and_then(|key| crate::animate::nearest_form(key)).map(did_you_mean);
                Finding::error(format!("expected {expected}, found {}", node.kind())).maybe_help(form)
            }
            _ => Finding::error(format!("expected {expected}, found {}", node.kind())),
        };
        self.report(node, at, finding)
    }

    /// Something is wrong with this value.
    fn report<T>(&mut self, node: &Node, at: &Trail<'_>, finding: Finding) -> Option<T> {
        self.findings.push(finding.at(at).on(node.place));
        None
    }
}
