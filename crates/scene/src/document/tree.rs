//! JSON values with their positions in the text.

use super::members::Members;
use super::source::SourceSpan;
use crate::path::{Path, Step};
use serde_json::Number;
use std::sync::Arc;

/// A value and its position. Values that were not read from a file have no position.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Range of the value in its text.
    pub place: Option<SourceSpan>,
    /// The value.
    pub value: Value,
}

/// A member of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// Range of the key in its text.
    pub key_place: Option<SourceSpan>,
    /// Value of the member.
    pub node: Node,
}

/// A JSON value.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `null`
    Null,
    /// `true` or `false`
    Bool(bool),
    /// Any number that fits into 64 bits.
    Number(Number),
    /// A string.
    String(String),
    /// Elements in order. Shared, so that the trees of many frames differ only in what moves.
    Array(Arc<Vec<Node>>),
    /// Members in the order of the file. Shared as arrays are.
    Object(Arc<Members>),
    /// An invalid value whose error has been reported; checks skip it.
    Invalid,
}

impl Node {
    /// Returns the value of an object's member.
    pub fn get(&self, key: &str) -> Option<&Self> {
        match &self.value {
            Value::Object(members) => members.get(key).map(|member| &member.node),
            _ => None,
        }
    }

    /// The members of an object; empty for all other values.
    pub fn members(&self) -> impl Iterator<Item = (&String, &Member)> {
        match &self.value {
            Value::Object(members) => Some(members.iter()),
            _ => None,
        }
        .into_iter()
        .flatten()
    }

    /// The elements of an array; empty for all other values.
    pub fn elements(&self) -> &[Self] {
        match &self.value {
            Value::Array(elements) => elements,
            _ => &[],
        }
    }

    /// Returns the text of a string.
    pub fn as_str(&self) -> Option<&str> {
        match &self.value {
            Value::String(text) => Some(text),
            _ => None,
        }
    }

    /// Name of the value's type for messages, such as "a number" or "a string".
    pub fn kind(&self) -> &'static str {
        match &self.value {
            Value::Null => "null",
            Value::Bool(_) => "true or false",
            Value::Number(_) => "a number",
            Value::String(_) => "a string",
            Value::Array(_) => "an array",
            Value::Object(_) => "an object",
            Value::Invalid => "an invalid value",
        }
    }

    /// Finds the value at `path`. Returns its position, or that of its innermost existing ancestor,
    /// and the number of steps that lead there.
    pub fn place_of(&self, path: &Path) -> (Option<SourceSpan>, usize) {
        let mut node = self;
        let mut place = self.place;
        for (depth, step) in path.steps().iter().enumerate() {
            let next = match step {
                Step::Key(key) => node.get(key),
                // Where an array is expected, a lone object stands for an array of one element.
                Step::Index(0) if matches!(node.value, Value::Object(_)) => Some(node),
                Step::Index(index) => node.elements().get(*index),
            };
            let Some(next) = next else { return (place, depth) };
            node = next;
            place = node.place.or(place);
        }
        (place, path.steps().len())
    }

    /// Path of the innermost value or key that contains `place`.
    pub fn path_of(&self, place: SourceSpan) -> Path {
        let mut node = self;
        let mut path = Path::root();
        let holds = |outer: Option<SourceSpan>| outer.is_some_and(|outer| outer.contains(place));
        loop {
            let inner = match &node.value {
                Value::Array(elements) => {
                    elements.iter().enumerate().find(|(_, e)| holds(e.place)).map(|(i, e)| (Step::Index(i), e))
                }
                Value::Object(members) => members
                    .iter()
                    .find(|(_, m)| holds(m.key_place) || holds(m.node.place))
                    .map(|(key, m)| (Step::Key(key.clone()), &m.node)),
                _ => None,
            };
            let Some((step, next)) = inner else { return path };
            path.push(step);
            node = next;
        }
    }

    /// Converts the value to JSON without positions.
    pub fn to_json(&self) -> serde_json::Value {
        match &self.value {
            Value::Null | Value::Invalid => serde_json::Value::Null,
            Value::Bool(value) => (*value).into(),
            Value::Number(number) => serde_json::Value::Number(number.clone()),
            Value::String(text) => text.as_str().into(),
            Value::Array(elements) => elements.iter().map(Self::to_json).collect(),
            Value::Object(members) => members.iter().map(|(key, m)| (key.clone(), m.node.to_json())).collect(),
        }
    }
}

impl From<serde_json::Value> for Node {
    fn from(json: serde_json::Value) -> Self {
        let value = match json {
            serde_json::Value::Null => Value::Null,
            serde_json::Value::Bool(value) => Value::Bool(value),
            serde_json::Value::Number(number) => Value::Number(number),
            serde_json::Value::String(text) => Value::String(text),
            serde_json::Value::Array(elements) => {
                Value::Array(Arc::new(elements.into_iter().map(Self::from).collect()))
            }
            serde_json::Value::Object(members) => {
                let member = |node| Member { key_place: None, node };
                Value::Object(Arc::new(members.into_iter().map(|(key, v)| (key, member(Self::from(v)))).collect()))
            }
        };
        Self { place: None, value }
    }
}
