//! Variables: named numbers and vectors, in order.

use super::walk::Walk;
use super::{GIVEN, values};
use crate::document::{Member, Node, Value};
use crate::path::Trail;
use crate::report::Finding;
use juggler_expression::{COMPONENTS, FUNCTIONS, Quantity};

impl Walk<'_> {
    /// Learns the scene's variables.
    pub fn variables(&mut self) {
        let Some(variables) = self.variables else { return };
        let at = Trail::Root.key("variables");
        if !matches!(variables.value, Value::Object(_)) {
            self.wrong(variables, &at, format!("expected an object of named numbers, found {}", variables.kind()));
        }
        for (name, member) in variables.members() {
            let quantity = self.variable(name, member, &at.key(name));
            if !GIVEN.contains(&name.as_str()) {
                self.names.insert(name.as_str(), quantity);
            }
        }
    }

    fn variable(&mut self, name: &str, member: &Member, at: &Trail<'_>) -> Quantity {
        if let Some(message) = unusable(name) {
            self.report(Finding::error(message).at(at).on(member.key_place));
            return Quantity::Unknown;
        }
        let node = &member.node;
        match &node.value {
            Value::Number(_) | Value::String(_) => self.number_or_text(node, at),
            Value::Array(elements) => self.vector(node, elements, at),
            Value::Object(members) => match values::kind_in(members) {
                Some(kind) => {
                    let given = self.form(kind, members, at);
                    self.given_by(&given, at)
                }
                None => self.no_variable(node, at),
            },
            _ => self.no_variable(node, at),
        }
    }

    /// A number, or an expression with or without a sign in front.
    fn number_or_text(&mut self, node: &Node, at: &Trail<'_>) -> Quantity {
        match &node.value {
            Value::Number(number) => number.as_f64().map_or(Quantity::Unknown, Quantity::Number),
            Value::String(text) => self.quantity(text.strip_prefix('=').unwrap_or(text), text, node.place, at),
            _ => self.no_variable(node, at),
        }
    }

    fn vector(&mut self, node: &Node, elements: &[Node], at: &Trail<'_>) -> Quantity {
        if elements.is_empty() || elements.len() > COMPONENTS.len() {
            let most = COMPONENTS.len();
            let message = format!("a variable is an array of 1 to {most} numbers, this one has {}", elements.len());
            self.wrong(node, at, message);
            return Quantity::Unknown;
        }
        let mut numbers = Vec::with_capacity(elements.len());
        for (i, element) in elements.iter().enumerate() {
            match self.component(element, &at.index(i)) {
                Quantity::Number(number) => numbers.push(number),
                Quantity::Vector(_) => {
                    self.wrong(element, &at.index(i), "expected one number here, found several");
                }
                Quantity::Unknown => {}
            }
        }
        if numbers.len() == elements.len() { Quantity::Vector(numbers) } else { Quantity::Unknown }
    }

    fn component(&mut self, element: &Node, at: &Trail<'_>) -> Quantity {
        match &element.value {
            Value::Object(members) if let Some(kind) = values::kind_in(members) => {
                let given = self.form(kind, members, at);
                self.given_by(&given, at)
            }
            _ => self.number_or_text(element, at),
        }
    }

    /// What a value form gave.
    fn given_by(&mut self, node: &Node, at: &Trail<'_>) -> Quantity {
        match &node.value {
            Value::Wrong => Quantity::Unknown,
            Value::Number(_) => self.number_or_text(node, at),
            Value::Array(elements) if elements.iter().all(|element| matches!(element.value, Value::Number(_))) => {
                self.vector(node, elements, at)
            }
            _ => self.no_variable(node, at),
        }
    }

    fn no_variable(&mut self, node: &Node, at: &Trail<'_>) -> Quantity {
        let message =
            format!("expected a number, an expression or up to {} of them, found {}", COMPONENTS.len(), node.kind());
        self.wrong(node, at, message);
        Quantity::Unknown
    }
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
