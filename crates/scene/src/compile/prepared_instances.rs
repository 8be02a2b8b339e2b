//! Instances of an object that are checked and ready to be placed. Transforms are computed one after
//! another, since a scene may have millions.

use crate::description::Instances;
use juggler_math::{Motion, Transform};
use juggler_shape::MeshData;
use juggler_world::InstanceAttributes;
use std::sync::Arc;

/// Instances of an object.
pub struct PreparedInstances<'s> {
    /// The instances, whose transforms are valid.
    still: &'s Instances,
    /// Transforms at even times; empty if nothing moves.
    keys: Vec<Vec<Transform>>,
    /// Colors, with a triangle for each instance.
    colors: Option<Arc<MeshData>>,
}

impl<'s> PreparedInstances<'s> {
    /// Valid instances, with their transforms at even times if they move.
    pub fn new(still: &'s Instances, keys: Vec<Vec<Transform>>) -> Self {
        Self { still, keys, colors: still.color_arrays().map(Arc::new) }
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

    /// Attributes of an instance; `None` without colors.
    pub fn attributes(&self, index: usize) -> Option<InstanceAttributes> {
        let triangle = u32::try_from(index).ok()?;
        self.colors.as_ref().map(|arrays| InstanceAttributes { arrays: Arc::clone(arrays), triangle })
    }
}
