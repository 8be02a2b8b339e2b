//! Everything that can be seen, immutable while rendering.

use crate::background::AnyBackground;
use crate::light::AnyLight;
use crate::material::{MaterialId, MaterialTable};
use crate::shape::AnyShape;
use juggler_math::Transform;

/// A shape in its place.
#[derive(Clone, Debug)]
pub struct Object {
    /// The shape, already prepared.
    pub shape: AnyShape,
    /// Object space → world.
    pub transform: Transform,
    /// What it is made of.
    pub material: MaterialId,
}

/// Everything that can be seen.
pub struct World {
    objects: Vec<Object>,
    materials: MaterialTable,
    lights: Vec<AnyLight>,
    background: AnyBackground,
}

impl World {
    /// Builds the hierarchy over all bounded objects. Every `Object::material` must be in `materials`.
    pub fn new(
        objects: Vec<Object>,
        materials: MaterialTable,
        lights: Vec<AnyLight>,
        background: AnyBackground,
    ) -> Self {
        Self { objects, materials, lights, background }
    }
}
