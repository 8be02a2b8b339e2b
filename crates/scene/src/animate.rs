//! Animation: a tree with expressions becomes, for one frame, a tree with numbers. The rest of the program
//! only ever sees still scenes.

use crate::document::{Member, Members, Node, Place, Sources, Value};
use crate::expression::{self, ExpressionError, FUNCTIONS, Names};
use crate::path::Trail;
use crate::report::Finding;
use crate::suggest;
use std::sync::Arc;

/// Parts of a scene in which a text that begins with `=` is just a text, or comes before all numbers.
const PLAIN: [&str; 4] = ["title", "description", "animation", "variables"];
/// Names that every expression may use.
const GIVEN: [&str; 4] = ["frame", "frames", "seconds", "pi"];

/// The tree at a frame (which may lie between two), with every mistake in an expression. What holds no expression
/// is shared with `tree`.
pub fn resolve(tree: &Node, sources: &Sources, frame: f64) -> (Node, Vec<Finding>) {
    let mut walk = Walk { names: given(tree, frame), variables: tree.get("variables"), sources, findings: Vec::new() };
    walk.variables();
    let mut resolved = tree.clone();
    if let Value::Object(members) = &mut resolved.value {
        let members = Arc::make_mut(members);
        for (key, member) in members.iter_mut().filter(|(key, _)| !PLAIN.contains(&key.as_str())) {
            if let Some(node) = walk.node(&member.node, &Trail::Root.key(key)) {
                member.node = node;
            }
        }
        members.shift_remove("variables");
    }
    (resolved, walk.findings)
}

/// Whether anything of a scene may change from frame to frame. Sometimes it says so although nothing does.
pub fn depends_on_time(tree: &Node) -> bool {
    match &tree.value {
        Value::String(text) => ["frame", "seconds"].iter().any(|name| text.contains(name)),
        Value::Array(elements) => elements.iter().any(depends_on_time),
        Value::Object(members) => members.values().any(|member| depends_on_time(&member.node)),
        _ => false,
    }
}

/// What expressions may use in any scene.
fn given(tree: &Node, frame: f64) -> Names {
    let number = |key: &str, default: f64| {
        let node = tree.get("animation").and_then(|animation| animation.get(key));
        match node.map(|node| &node.value) {
            Some(Value::Number(number)) => number.as_f64().filter(|v| *v > 0.0).unwrap_or(default),
            _ => default,
        }
    };
    let frames = number("frames", 1.0);
    let seconds = frame / number("frames_per_second", 30.0);
    let values = [frame, frames, seconds, std::f64::consts::PI];
    GIVEN.iter().map(|name| (*name).to_owned()).zip(values).collect()
}

struct Walk<'s> {
    /// What can be used so far.
    names: Names,
    variables: Option<&'s Node>,
    sources: &'s Sources,
    findings: Vec<Finding>,
}

impl Walk<'_> {
    fn variables(&mut self) {
        let Some(variables) = self.variables else { return };
        let at = Trail::Root.key("variables");
        if !matches!(variables.value, Value::Object(_)) {
            let message = format!("expected an object of named numbers, found {}", variables.kind());
            self.findings.push(Finding::error(message).at(&at).on(variables.place));
        }
        for (name, member) in variables.members() {
            // After a mistake the name still exists, so that it is reported once only.
            let value = self.variable(name, member, &at.key(name)).unwrap_or(1.0);
            self.names.insert(name.clone(), value);
        }
    }

    fn variable(&mut self, name: &str, member: &Member, at: &Trail<'_>) -> Option<f64> {
        if let Some(message) = unusable(name) {
            self.findings.push(Finding::error(message).at(at).on(member.key_place));
            return None;
        }
        match &member.node.value {
            Value::Number(number) => number.as_f64(),
            Value::String(text) => self.evaluate(text, member.node.place, at),
            _ => {
                let message = format!("expected a number or an expression, found {}", member.node.kind());
                self.findings.push(Finding::error(message).at(at).on(member.node.place));
                None
            }
        }
    }

    /// The node with numbers for expressions; nothing when it has none and can stay as it is.
    fn node(&mut self, node: &Node, at: &Trail<'_>) -> Option<Node> {
        let value = match &node.value {
            // After a mistake any number will do: this one passes most limits.
            Value::String(text) if text.starts_with('=') => number(self.evaluate(text, node.place, at).unwrap_or(1.0)),
            Value::Array(elements) => Value::Array(self.array(elements, at)?),
            Value::Object(members) => Value::Object(self.object(members, at)?),
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

    fn object(&mut self, members: &Arc<Members>, at: &Trail<'_>) -> Option<Arc<Members>> {
        let mut resolved = None;
        for (i, (key, member)) in members.iter().enumerate() {
            if let Some(node) = self.node(&member.node, &at.key(key)) {
                Arc::make_mut(resolved.get_or_insert_with(|| Arc::clone(members)))[i].node = node;
            }
        }
        resolved
    }

    fn evaluate(&mut self, text: &str, place: Option<Place>, at: &Trail<'_>) -> Option<f64> {
        let expression = text.strip_prefix('=').unwrap_or(text);
        match expression::evaluate(expression, &self.names) {
            Ok(value) => Some(value),
            Err(error) => {
                let place = place.map(|place| self.inside(place, text, expression, &error));
                let help = self.too_early(expression, &error).or(error.help);
                self.findings.push(Finding::error(error.message).at(at).on(place).maybe_help(help));
                None
            }
        }
    }

    /// What to do when an expression uses a variable that is only defined below.
    fn too_early(&self, expression: &str, error: &ExpressionError) -> Option<String> {
        let name = expression.get(error.at.clone())?;
        let later = self.variables?.get(name).is_some() && !self.names.contains_key(name);
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
}

/// A whole number stays one, so that it can count things.
fn number(value: f64) -> Value {
    if value == value.trunc() && value.abs() < 9.0e15 {
        return Value::Number((value as i64).into());
    }
    serde_json::Number::from_f64(value).map_or(Value::Null, Value::Number)
}

/// Why no variable can have this name.
fn unusable(name: &str) -> Option<String> {
    let mut characters = name.chars();
    let begins = characters.next().is_some_and(|c| c.is_ascii_alphabetic() || c == '_');
    if !begins || !characters.all(|c| c.is_ascii_alphanumeric() || c == '_') {
        return Some(format!("`{name}` cannot name a variable: names are made of letters, digits and _"));
    }
    if GIVEN.contains(&name) || FUNCTIONS.iter().any(|function| function.name == name) {
        return Some(format!("`{name}` already means something in expressions"));
    }
    None
}

/// Suggests `=` for a text where a number should be: `"2*pi"` probably misses it.
pub fn looks_like_expression(text: &str) -> bool {
    let names: Names = GIVEN.iter().map(|name| ((*name).to_owned(), 1.0)).collect();
    suggest::closest(text, ["inf", "nan"]).is_none() && expression::evaluate(text, &names).is_ok()
}
