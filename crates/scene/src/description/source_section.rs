//! Sections of a scene that are kept as source JSON, whose expressions are evaluated at every
//! frame.

use crate::document::{Node, Value};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::sync::Arc;

/// Source JSON of `variables` or `paths`, with unevaluated expressions.
#[derive(Clone, Debug, Default)]
pub struct SourceSection(Option<Arc<Node>>);

impl SourceSection {
    /// Creates the section from a node of the scene's document.
    pub fn new(node: Option<&Node>) -> Self {
        Self(node.cloned().map(Arc::new))
    }

    /// JSON with source locations.
    pub fn node(&self) -> Option<&Node> {
        self.0.as_deref()
    }

    /// Whether the section is missing or empty.
    pub fn is_empty(&self) -> bool {
        self.node().is_none_or(|node| matches!(&node.value, Value::Object(members) if members.is_empty()))
    }

    /// Whether both share the same memory.
    pub fn is_same(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        }
    }
}

/// Equality ignores source locations.
impl PartialEq for SourceSection {
    fn eq(&self, other: &Self) -> bool {
        let json = |written: &Self| written.node().map(Node::to_json);
        self.is_same(other) || json(self) == json(other)
    }
}

impl Serialize for SourceSection {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.node().map(Node::to_json).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for SourceSection {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let json = serde_json::Value::deserialize(deserializer)?;
        Ok(Self(Some(Arc::new(json.into()))))
    }
}
