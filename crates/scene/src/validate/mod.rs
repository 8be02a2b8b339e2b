//! Tree against schema: every mistake at once, each with its path, its place and what was probably meant.
//!
//! The walk also writes the plain JSON that the types are read from: a kind's name becomes the kind, whole numbers
//! written `8.0` become whole. What is wrong is left out, so that the rest can still be checked.

use crate::document::{Node, Value as Written};
use crate::path::Trail;
use crate::report::Finding;
use crate::schema::Schema;
use serde_json::Value;

mod choice;
mod family;
mod names;
mod scalar;
mod structure;
mod words;

pub use names::Family;
pub(crate) use words::{noun as family_noun, plural};

/// Most mistakes that are collected; a file of numbers where objects should be makes one for each.
const MAX_FINDINGS: usize = 200;

/// What a walk brought.
#[derive(Debug)]
pub struct Validated {
    /// The scene as plain JSON, without what is wrong; nothing when hardly anything is right.
    pub json: Option<Value>,
    /// All that is wrong.
    pub findings: Vec<Finding>,
}

/// Checks a scene whose expressions are resolved.
pub fn validate(tree: &Node) -> Validated {
    let schema = Schema::get();
    let mut walk = Walk { schema, tree, findings: Vec::new() };
    let json = walk.value(tree, &Trail::Root, schema.root());
    Validated { json, findings: walk.findings }
}

struct Walk<'t> {
    schema: &'static Schema,
    /// The whole scene, where names are looked up.
    tree: &'t Node,
    findings: Vec<Finding>,
}

impl Walk<'_> {
    /// The plain JSON of a value, or nothing when it is wrong and must be left out.
    fn value(&mut self, node: &Node, at: &Trail<'_>, schema: &'static Value) -> Option<Value> {
        if self.findings.len() >= MAX_FINDINGS {
            return None;
        }
        let (name, target) = self.schema.follow(schema);
        if let Some(branches) = target.get("anyOf").and_then(Value::as_array) {
            return self.choice(node, at, name, branches);
        }
        if crate::schema::variants(target).next().is_some() {
            return self.family(node, at, name.unwrap_or("kind"), target);
        }
        self.typed(node, at, name, target)
    }

    /// A value whose JSON type the schema fixes.
    fn typed(
        &mut self,
        node: &Node,
        at: &Trail<'_>,
        name: Option<&'static str>,
        schema: &'static Value,
    ) -> Option<Value> {
        match &node.value {
            Written::Null if words::allows(schema, "null") => Some(Value::Null),
            Written::Number(number) if words::allows_number(schema) => self.number(node, at, number, schema),
            Written::String(text) if words::allows(schema, "string") => self.string(node, at, text, name, schema),
            Written::Bool(value) if words::allows(schema, "boolean") => Some((*value).into()),
            Written::Array(elements) if words::allows(schema, "array") => self.array(node, at, elements, schema),
            Written::Object(members) if words::allows(schema, "object") => self.object(node, at, members, name, schema),
            _ => self.mismatch(node, at, &words::expected(self.schema, schema)),
        }
    }

    /// The wrong type of value stands here.
    fn mismatch(&mut self, node: &Node, at: &Trail<'_>, expected: &str) -> Option<Value> {
        let finding = match &node.value {
            Written::Null if node.place.is_none() => {
                Finding::error(format!("expected {expected}, found one that is not finite"))
            }
            Written::String(text) if expected.contains("number") && crate::animate::looks_like_expression(text) => {
                Finding::error(format!("expected {expected}, found a string"))
                    .help(format!("an expression begins with `=`: \"={text}\""))
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
