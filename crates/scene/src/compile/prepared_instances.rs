//! Instances of an object that are checked and ready to be placed. Transforms are computed one after
//! another, since a scene may have millions.

use crate::description::Instances;
use juggler_math::{Motion, Transform};
use juggler_world::{AttributeList, InstanceAttributes};
use std::sync::Arc;

/// Instances of an object.
pub struct PreparedInstances<'s> {
    /// The instances, whose transforms are valid.
    still: &'s Instances,
    /// Transforms at even times; empty if nothing moves.
    keys: Vec<Vec<Transform>>,
    /// Attributes of the instances; `None` if they have none.
    attributes: Option<Arc<AttributeList>>,
}

impl<'s> PreparedInstances<'s> {
    /// Valid instances, with their transforms at even times if they move.
    pub fn new(still: &'s Instances, keys: Vec<Vec<Transform>>) -> Self {
        let list = |arrays| Arc::new(AttributeList { arrays, outer: None });
        Self { still, keys, attributes: still.attribute_arrays().map(list) }
    }

    /// Number of instances.
    pub fn count(&self) -> usize {
        self.still.count()
    }

    /// Motion of an instance to the object's space.
    pub fn motion(&self, index: usize) -> Motion {
        let keys = self.keys.iter().filter_map(|list| list.get(index).copied()).collect();
        let still = || self.still.transform(index).unwrap_or(Transform::IDENTITY).into();
        Motion::from_keys(keys).unwrap_or_else(still)
    }

    /// Attributes of the instances inside of an instance with `outer` attributes; `None` if they have
    /// none of their own.
    pub fn attributes(&self, outer: Option<&InstanceAttributes>) -> Option<Arc<AttributeList>> {
        let own = self.attributes.as_ref()?;
        Some(match outer {
            None => Arc::clone(own),
            Some(outer) => Arc::new(AttributeList { arrays: own.arrays.clone(), outer: Some(outer.clone()) }),
        })
    }
}
