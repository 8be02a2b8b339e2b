//! The walk that puts values in place of expressions and value forms.

use super::paths::Paths;
use super::survey::Track;
use super::values::{self, Kind};
use super::{Programs, number, numbers};
use crate::document::{Members, Node, Place, Sources, Value};
use crate::path::Trail;
use crate::report::Finding;
use crate::validate;
use juggler_expression::{ExpressionError, Names, PointEvaluator, Program, Quantity};
use serde::de::DeserializeOwned;
use std::sync::Arc;

/// Most value forms within each other.
pub const MAX_NESTING: usize = 16;
/// Most mistakes that are collected.
const MAX_FINDINGS: usize = 200;

/// What is known on the way through a tree.
pub(super) struct Walk<'s> {
    /// What expressions can use so far.
    pub names: Names,
    /// The scene's variables, as they were written.
    pub variables: Option<&'s Node>,
    pub paths: Paths<'s>,
    sources: &'s Sources,
    programs: &'s Programs,
    evaluator: PointEvaluator,
    pub findings: Vec<Finding>,
    /// The value forms met so far, where somebody asks for them.
    pub tracks: Option<Vec<Track>>,
    /// Value forms that are being resolved, each inside the one before.
    depth: usize,
}

impl<'s> Walk<'s> {
    pub fn new(tree: &'s Node, sources: &'s Sources, programs: &'s Programs, names: Names) -> Self {
        Self {
            names,
            variables: tree.get("variables"),
            paths: Paths::of(tree),
            sources,
            programs,
            evaluator: PointEvaluator::default(),
            findings: Vec::new(),
            tracks: None,
            depth: 0,
        }
    }

    /// The same, writing down the value forms that it meets.
    pub fn surveying(self) -> Self {
        Self { tracks: Some(Vec::new()), ..self }
    }
}

impl Walk<'_> {
    /// The node with values for expressions and forms; nothing when it has none and can stay as it is.
    pub fn node(&mut self, node: &Node, at: &Trail<'_>) -> Option<Node> {
        let value = match &node.value {
            Value::String(text) => {
                let expression = text.strip_prefix('=')?;
                written(&self.quantity(expression, text, node.place, at), node)
            }
            Value::Array(elements) => Value::Array(self.array(elements, at)?),
            Value::Object(members) => match values::kind_in(members) {
                Some(kind) => return Some(self.form(kind, members, at)),
                None => Value::Object(self.object(members, at)?),
            },
            _ => return None,
        };
        Some(Node { place: node.place, value })
    }

    fn array(&mut self, elements: &Arc<Vec<Node>>, at: &Trail<'_>) -> Option<Arc<Vec<Node>>> {
        let mut resolved = None;
        for (i, element) in elements.iter().enumerate() {
            if let Some(node) = self.node(element, &at.index(i)) {
                Arc::make_mut(resolved.get_or_insert_with(|| Arc::clone(elements)))[i] = node;
            }
        }
        resolved
    }

    /// The same for the members of an object that is itself no value form.
    pub fn object(&mut self, members: &Arc<Members>, at: &Trail<'_>) -> Option<Arc<Members>> {
        let mut resolved = None;
        for (i, (key, member)) in members.iter().enumerate() {
            if let Some(node) = self.node(&member.node, &at.key(key)) {
                let resolved = Arc::make_mut(resolved.get_or_insert_with(|| Arc::clone(members)));
                if let Some(member) = resolved.at_mut(i) {
                    member.node = node;
                }
            }
        }
        resolved
    }

    /// The value of a form, whose content is resolved first.
    pub fn form(&mut self, kind: &'static Kind, members: &Members, at: &Trail<'_>) -> Node {
        let Some(member) = members.get(kind.name) else { return Node { place: None, value: Value::Wrong } };
        let wrong = Node { place: member.node.place, value: Value::Wrong };
        let inner = at.key(kind.name);
        if let Some(message) = self.refused(kind, members) {
            self.report(Finding::error(message).at(&inner).on(member.key_place));
            return wrong;
        }
        self.depth += 1;
        let content = self.node(&member.node, &inner).unwrap_or_else(|| member.node.clone());
        let value = (kind.value)(self, &content, &inner);
        self.depth -= 1;
        value.unwrap_or(wrong)
    }

    fn refused(&self, kind: &Kind, members: &Members) -> Option<String> {
        let name = kind.name;
        let others = members.keys().filter(|key| *key != name).map(String::as_str);
        if members.len() > 1 {
            let others = validate::list(others, "and");
            return Some(format!("`{name}` stands alone in its object, not beside {others}"));
        }
        let deep = self.depth >= MAX_NESTING;
        deep.then(|| format!("values such as `{name}` are nested deeper than the limit of {MAX_NESTING}"))
    }

    /// The types of a form's content, as far as it fits the schema's definition of that name; else all that is wrong
    /// with it is reported.
    pub fn read<T: DeserializeOwned>(&mut self, definition: &str, content: &Node, at: &Trail<'_>) -> Option<T> {
        let checked = validate::part(content, definition, at);
        let sound = checked.findings.is_empty();
        checked.findings.into_iter().for_each(|finding| self.report(finding));
        T::deserialize(&checked.json.filter(|_| sound)?).ok()
    }

    /// What an expression gives; `text` is how it is written, with or without a sign in front.
    pub fn quantity(&mut self, expression: &str, text: &str, place: Option<Place>, at: &Trail<'_>) -> Quantity {
        if let Some(vector @ Quantity::Vector(_)) = self.names.get(expression.trim()) {
            return vector.clone();
        }
        let program = self.programs.compile(expression, &self.names);
        match program.and_then(|program| self.evaluator.value(&program, &self.names)) {
            Ok(value) => value.map_or(Quantity::Unknown, Quantity::Number),
            Err(error) => {
                let place = place.map(|place| self.inside(place, text, expression, &error));
                let help = self.too_early(expression, &error).or(error.help);
                self.report(Finding::error(error.message).at(at).on(place).maybe_help(help));
                Quantity::Unknown
            }
        }
    }

    /// Value of a compiled expression; `None` for an expression that is wrong or has no value.
    pub fn number(&mut self, program: &Program) -> Option<f64> {
        self.evaluator.value(program, &self.names).ok().flatten()
    }

    /// What to do when an expression uses a variable that is only defined below.
    fn too_early(&self, expression: &str, error: &ExpressionError) -> Option<String> {
        let name = expression.get(error.at.clone())?.split('.').next()?;
        let later = self.variables?.get(name).is_some() && !self.names.contains(name);
        later.then(|| format!("`{name}` is defined further down: move it before what uses it"))
    }

    /// The part of a string at fault, when the string stands in the file as it is (no escapes in it).
    fn inside(&self, place: Place, text: &str, expression: &str, error: &ExpressionError) -> Place {
        let written =
            self.sources.get(place.file).and_then(|source| source.text.get(place.start as usize..place.end as usize));
        let literal = written.is_some_and(|written| written.len() == text.len() + 2);
        let before = 1 + text.len() - expression.len();
        let end = error.at.end.max(error.at.start + 1);
        if literal { place.part(before + error.at.start, before + end) } else { place }
    }

    /// The scene's time.
    pub fn seconds(&self) -> f64 {
        match self.names.get("seconds") {
            Some(Quantity::Number(seconds)) => *seconds,
            _ => 0.0,
        }
    }

    /// Something is wrong.
    pub fn report(&mut self, finding: Finding) {
        if self.findings.len() < MAX_FINDINGS {
            self.findings.push(finding);
        }
    }

    /// Something is wrong with this value.
    pub fn wrong(&mut self, node: &Node, at: &Trail<'_>, message: impl Into<String>) {
        self.report(Finding::error(message).at(at).on(node.place));
    }
}

/// A quantity as it would be written in place of `node`.
fn written(quantity: &Quantity, node: &Node) -> Value {
    match quantity {
        Quantity::Number(value) => number(*value),
        Quantity::Vector(values) => numbers(values.iter().copied(), node).value,
        Quantity::Unknown => Value::Wrong,
    }
}
