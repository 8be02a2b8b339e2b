//! Variables: named numbers and vectors, evaluated in order.

use super::tree_resolver::TreeResolver;
use super::{PREDEFINED_NAMES, values};
use crate::document::{Member, Node, Value};
use crate::path::PathRef;
use crate::report::Finding;
use juggler_expression::{COMPONENTS, FUNCTIONS, Quantity};

impl TreeResolver<'_> {
    /// Evaluates the scene's variables and defines their names.
    pub fn variables(&mut self) {
        let Some(variables) = self.variables else { return };
        let at = PathRef::Root.key("variables");
        if !matches!(variables.value, Value::Object(_)) {
            self.report_error(
                variables,
                &at,
                format!("expected an object of named numbers, found {}", variables.kind()),
            );
        }
        for (name, member) in variables.members() {
            let quantity = self.variable(name, member, &at.key(name));
            if !PREDEFINED_NAMES.contains(&name.as_str()) {
                self.names.insert(name.as_str(), quantity);
            }
        }
    }

    fn variable(&mut self, name: &str, member: &Member, at: &PathRef<'_>) -> Quantity {
        if let Some(message) = name_error(name) {
            self.report(Finding::error(message).at(at).on(member.key_place));
            return Quantity::Unknown;
        }
        let node = &member.node;
        match &node.value {
            Value::Number(_) | Value::String(_) => self.number_or_text(node, at),
            Value::Array(elements) => self.vector(node, elements, at),
            Value::Object(members) => match values::kind_in(members) {
                Some(kind) => {
                    let value = self.form(kind, members, at);
                    self.quantity_from_form(&value, at)
                }
                None => self.invalid_variable(node, at),
            },
            _ => self.invalid_variable(node, at),
        }
    }

    /// Evaluates a number, or an expression with or without a leading `=`.
    fn number_or_text(&mut self, node: &Node, at: &PathRef<'_>) -> Quantity {
        match &node.value {
            Value::Number(number) => number.as_f64().map_or(Quantity::Unknown, Quantity::Number),
            Value::String(text) => self.quantity(text.strip_prefix('=').unwrap_or(text), text, node.place, at),
            _ => self.invalid_variable(node, at),
        }
    }

    fn vector(&mut self, node: &Node, elements: &[Node], at: &PathRef<'_>) -> Quantity {
        if elements.is_empty() || elements.len() > COMPONENTS.len() {
            let most = COMPONENTS.len();
            let message = format!("a variable is an array of 1 to {most} numbers, this one has {}", elements.len());
            self.report_error(node, at, message);
            return Quantity::Unknown;
        }
        let mut numbers = Vec::with_capacity(elements.len());
        for (i, element) in elements.iter().enumerate() {
            match self.component(element, &at.index(i)) {
                Quantity::Number(number) => numbers.push(number),
                Quantity::Vector(_) => {
                    self.report_error(element, &at.index(i), "expected a single number, found several");
                }
                Quantity::Unknown => {}
            }
        }
        if numbers.len() == elements.len() { Quantity::Vector(numbers) } else { Quantity::Unknown }
    }

    fn component(&mut self, element: &Node, at: &PathRef<'_>) -> Quantity {
        match &element.value {
            Value::Object(members) if let Some(kind) = values::kind_in(members) => {
                let value = self.form(kind, members, at);
                self.quantity_from_form(&value, at)
            }
            _ => self.number_or_text(element, at),
        }
    }

    /// Converts the value of a value form to the quantity of a variable.
    fn quantity_from_form(&mut self, node: &Node, at: &PathRef<'_>) -> Quantity {
        match &node.value {
            Value::Invalid => Quantity::Unknown,
            Value::Number(_) => self.number_or_text(node, at),
            Value::Array(elements) if elements.iter().all(|element| matches!(element.value, Value::Number(_))) => {
                self.vector(node, elements, at)
            }
            _ => self.invalid_variable(node, at),
        }
    }

    fn invalid_variable(&mut self, node: &Node, at: &PathRef<'_>) -> Quantity {
        let message =
            format!("expected a number, an expression or up to {} of them, found {}", COMPONENTS.len(), node.kind());
        self.report_error(node, at, message);
        Quantity::Unknown
    }
}

/// Error message if no variable can have this name.
fn name_error(name: &str) -> Option<String> {
    let mut characters = name.chars();
    let begins = characters.next().is_some_and(|c| c.is_ascii_alphabetic() || c == '_');
    if !begins || !characters.all(|c| c.is_ascii_alphanumeric() || c == '_') {
        return Some(format!("`{name}` is not a valid name of a variable: names consist of letters, digits and _"));
    }
    if PREDEFINED_NAMES.contains(&name) || FUNCTIONS.iter().any(|function| function.name == name) {
        return Some(format!("`{name}` is predefined in expressions: choose another name"));
    }
    None
}
