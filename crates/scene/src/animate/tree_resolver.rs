//! Traversal of a tree that replaces expressions and value forms by their values.

use super::paths::Paths;
use super::survey::FormSummary;
use super::values::{self, Kind};
use super::{Programs, SceneSources, number, numbers};
use crate::document::{Members, Node, SourceSpan, Value};
use crate::path::PathRef;
use crate::report::Finding;
use crate::validate::{self, MAX_SUGGESTIONS};
use juggler_expression::{ExpressionError, Names, PointEvaluator, Program, Quantity};
use serde::de::DeserializeOwned;
use std::sync::Arc;

/// Maximum nesting depth of value forms.
pub const MAX_NESTING: usize = 16;
/// Maximum number of findings.
const MAX_FINDINGS: usize = 200;

/// State of the traversal.
pub(super) struct TreeResolver<'s> {
    /// Names that are defined so far.
    pub names: Names,
    /// Source JSON of the scene's variables.
    pub variables: Option<&'s Node>,
    pub paths: Paths<'s>,
    pub sources: SceneSources<'s>,
    programs: &'s Programs,
    evaluator: PointEvaluator,
    pub findings: Vec<Finding>,
    /// Value forms found so far; `None` if the walk is no survey.
    pub forms: Option<Vec<FormSummary>>,
    /// Number of nested value forms in progress.
    depth: usize,
}

impl<'s> TreeResolver<'s> {
    pub fn new(tree: &'s Node, sources: SceneSources<'s>, programs: &'s Programs, names: Names) -> Self {
        Self {
            names,
            variables: tree.get("variables"),
            paths: Paths::from_tree(tree),
            sources,
            programs,
            evaluator: PointEvaluator::default(),
            findings: Vec::new(),
            forms: None,
            depth: 0,
        }
    }

    /// Makes the walk a survey, which records value forms.
    pub fn surveying(self) -> Self {
        Self { forms: Some(Vec::new()), ..self }
    }
}

impl TreeResolver<'_> {
    /// Resolves a node; `None` if it has no expressions and value forms.
    pub fn node(&mut self, node: &Node, at: &PathRef<'_>) -> Option<Node> {
        let value = match &node.value {
            Value::String(text) => {
                let expression = text.strip_prefix('=')?;
                quantity_json(&self.quantity(expression, text, node.place, at), node)
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

    fn array(&mut self, elements: &Arc<Vec<Node>>, at: &PathRef<'_>) -> Option<Arc<Vec<Node>>> {
        let mut resolved = None;
        for (i, element) in elements.iter().enumerate() {
            if let Some(node) = self.node(element, &at.index(i)) {
                Arc::make_mut(resolved.get_or_insert_with(|| Arc::clone(elements)))[i] = node;
            }
        }
        resolved
    }

    /// Resolves the members of an object that is not a value form itself.
    pub fn object(&mut self, members: &Arc<Members>, at: &PathRef<'_>) -> Option<Arc<Members>> {
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

    /// Evaluates a value form after its content.
    pub fn form(&mut self, kind: &'static Kind, members: &Members, at: &PathRef<'_>) -> Node {
        let Some(member) = members.get(kind.name) else { return Node { place: None, value: Value::Invalid } };
        let wrong = Node { place: member.node.place, value: Value::Invalid };
        let inner = at.key(kind.name);
        if let Some(message) = self.form_error(kind, members) {
            self.report(Finding::error(message).at(&inner).on(member.key_place));
            return wrong;
        }
        self.depth += 1;
        let content = self.node(&member.node, &inner).unwrap_or_else(|| member.node.clone());
        let value = (kind.value)(self, &content, &inner);
        self.depth -= 1;
        value.unwrap_or(wrong)
    }

    fn form_error(&self, kind: &Kind, members: &Members) -> Option<String> {
        let name = kind.name;
        let others = members.keys().filter(|key| *key != name).map(String::as_str);
        if members.len() > 1 {
            let others = validate::list(others, "and");
            return Some(format!("unexpected {others} beside `{name}`: a value form is an object with a single key"));
        }
        let deep = self.depth >= MAX_NESTING;
        deep.then(|| format!("value forms such as `{name}` are nested deeper than the limit of {MAX_NESTING}"))
    }

    /// Deserializes the content of a value form by its definition in the schema. Returns `None`
    /// after an error; reports all findings.
    pub fn read<T: DeserializeOwned>(&mut self, definition: &str, content: &Node, at: &PathRef<'_>) -> Option<T> {
        let checked = validate::part(content, definition, at);
        let is_valid = checked.findings.is_empty();
        checked.findings.into_iter().for_each(|finding| self.report(finding));
        T::deserialize(&checked.json.filter(|_| is_valid)?).ok()
    }

    /// Evaluates an expression. `text` is its source string, with or without a leading `=`.
    pub fn quantity(&mut self, expression: &str, text: &str, place: Option<SourceSpan>, at: &PathRef<'_>) -> Quantity {
        if let Some(vector @ Quantity::Vector(_)) = self.names.get(expression.trim()) {
            return vector.clone();
        }
        let program = self.programs.compile(expression, &self.names);
        match program.and_then(|program| self.evaluator.value(&program, &self.names)) {
            Ok(value) => value.map_or(Quantity::Unknown, Quantity::Number),
            Err(error) => {
                let place = place.map(|place| self.error_span(place, text, expression, &error));
                let help = self.defined_below_help(expression, &error).or(error.help);
                self.report(Finding::error(error.message).at(at).on(place).maybe_help(help));
                Quantity::Unknown
            }
        }
    }

    /// Value of a compiled expression; `None` for an expression that is wrong or has no value.
    pub fn number(&mut self, program: &Program) -> Option<f64> {
        self.evaluator.value(program, &self.names).ok().flatten()
    }

    /// Help for an expression that uses a variable defined further down.
    fn defined_below_help(&self, expression: &str, error: &ExpressionError) -> Option<String> {
        let name = expression.get(error.at.clone())?.split('.').next()?;
        let later = self.variables?.get(name).is_some() && !self.names.contains(name);
        later.then(|| format!("`{name}` is defined further down: move it above its first use"))
    }

    /// Source location of an error inside a string, if the string has no escapes.
    fn error_span(&self, place: SourceSpan, text: &str, expression: &str, error: &ExpressionError) -> SourceSpan {
        let written = self
            .sources
            .texts
            .get(place.file)
            .and_then(|source| source.text.get(place.start as usize..place.end as usize));
        let literal = written.is_some_and(|written| written.len() == text.len() + 2);
        let before = 1 + text.len() - expression.len();
        let end = error.at.end.max(error.at.start + 1);
        if literal { place.part(before + error.at.start, before + end) } else { place }
    }

    /// Time of the frame in seconds.
    pub fn seconds(&self) -> f64 {
        match self.names.get("seconds") {
            Some(Quantity::Number(seconds)) => *seconds,
            _ => 0.0,
        }
    }

    /// Reports a finding.
    pub fn report(&mut self, finding: Finding) {
        if self.findings.len() < MAX_FINDINGS {
            self.findings.push(finding);
        }
        if self.findings.len() >= MAX_SUGGESTIONS {
            self.names.omit_suggestions();
        }
    }

    /// Reports an error at a value.
    pub fn report_error(&mut self, node: &Node, at: &PathRef<'_>, message: impl Into<String>) {
        self.report(Finding::error(message).at(at).on(node.place));
    }
}

/// JSON of a quantity, in place of `node`.
fn quantity_json(quantity: &Quantity, node: &Node) -> Value {
    match quantity {
        Quantity::Number(value) => number(*value),
        Quantity::Vector(values) => numbers(values.iter().copied(), node).value,
        Quantity::Unknown => Value::Invalid,
    }
}
