//! JSON in which every value knows where it was written.

use super::members::Members;
use super::source::Place;
use crate::path::{Path, Step};
use serde_json::Number;
use std::sync::Arc;

/// One value and its place; values that were not read from a file have none.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Where it stands.
    pub place: Option<Place>,
    /// What stands there.
    pub value: Value,
}

/// One entry of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// Where the key stands.
    pub key_place: Option<Place>,
    /// What the key names.
    pub node: Node,
}

/// What a file of JSON can hold.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `null`
    Null,
    /// `true` or `false`
    Bool(bool),
    /// Any number that fits into 64 bits.
    Number(Number),
    /// Text.
    String(String),
    /// Values in order; shared, so that the trees of many frames are one but for what moves.
    Array(Arc<Vec<Node>>),
    /// Named values in the order of the file; shared likewise.
    Object(Arc<Members>),
    /// A mistake that has been reported: checks pass over it.
    Wrong,
}

impl Node {
    /// The entry of an object.
    pub fn get(&self, key: &str) -> Option<&Self> {
        match &self.value {
            Value::Object(members) => members.get(key).map(|member| &member.node),
            _ => None,
        }
    }

    /// The entries of an object; none for anything else.
    pub fn members(&self) -> impl Iterator<Item = (&String, &Member)> {
        match &self.value {
            Value::Object(members) => Some(members.iter()),
            _ => None,
        }
        .into_iter()
        .flatten()
    }

    /// The elements of an array; none for anything else.
    pub fn elements(&self) -> &[Self] {
        match &self.value {
            Value::Array(elements) => elements,
            _ => &[],
        }
    }

    /// The text of a string.
    pub fn as_str(&self) -> Option<&str> {
        match &self.value {
            Value::String(text) => Some(text),
            _ => None,
        }
    }

    /// "a number", "a string": what stands here, for messages.
    pub fn kind(&self) -> &'static str {
        match &self.value {
            Value::Null => "null",
            Value::Bool(_) => "true or false",
            Value::Number(_) => "a number",
            Value::String(_) => "a string",
            Value::Array(_) => "an array",
            Value::Object(_) => "an object",
            Value::Wrong => "a mistake",
        }
    }

    /// The place of what `path` names, or of the last value on the way that was written down (a key that was
    /// left out has no place of its own), and how many steps lead there.
    pub fn place_of(&self, path: &Path) -> (Option<Place>, usize) {
        let mut node = self;
        let mut place = self.place;
        for (depth, step) in path.steps().iter().enumerate() {
            let next = match step {
                Step::Key(key) => node.get(key),
                // What may be an array of one may be that one alone.
                Step::Index(0) if matches!(node.value, Value::Object(_)) => Some(node),
                Step::Index(index) => node.elements().get(*index),
            };
            let Some(next) = next else { return (place, depth) };
            node = next;
            place = node.place.or(place);
        }
        (place, path.steps().len())
    }

    /// The path of the innermost value or key that holds `place`.
    pub fn path_of(&self, place: Place) -> Path {
        let mut node = self;
        let mut path = Path::root();
        let holds = |outer: Option<Place>| outer.is_some_and(|outer| outer.contains(place));
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

    /// The plain JSON of it.
    pub fn to_json(&self) -> serde_json::Value {
        match &self.value {
            Value::Null | Value::Wrong => serde_json::Value::Null,
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
