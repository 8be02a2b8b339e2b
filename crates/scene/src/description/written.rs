//! Parts of a scene that stay as they were written, for expressions to be worked out at every frame.

use crate::document::{Node, Value};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::sync::Arc;

/// `variables` or `paths`, as they were written.
#[derive(Clone, Debug, Default)]
pub struct Written(Option<Arc<Node>>);

impl Written {
    /// A part of a scene's document.
    pub fn new(node: Option<&Node>) -> Self {
        Self(node.cloned().map(Arc::new))
    }

    /// As JSON with places.
    pub fn node(&self) -> Option<&Node> {
        self.0.as_deref()
    }

    /// Whether nothing was written.
    pub fn is_empty(&self) -> bool {
        self.node().is_none_or(|node| matches!(&node.value, Value::Object(members) if members.is_empty()))
    }

    /// Whether both are the very same text in memory.
    pub fn is_same(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        }
    }
}

/// Where it was written does not count.
impl PartialEq for Written {
    fn eq(&self, other: &Self) -> bool {
        let json = |written: &Self| written.node().map(Node::to_json);
        self.is_same(other) || json(self) == json(other)
    }
}

impl Serialize for Written {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.node().map(Node::to_json).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Written {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let json = serde_json::Value::deserialize(deserializer)?;
        Ok(Self(Some(Arc::new(json.into()))))
    }
}
