//! What a level is made of: shapes and instances of other levels, each in its place.

use super::Level;
use crate::material::MaterialId;
use crate::shape::AnyShape;
use juggler_math::{Aabb, Transform};
use std::sync::Arc;

/// A shape or a shared level in its place.
#[derive(Clone, Debug)]
pub struct Object {
    /// What it is.
    pub content: Content,
    /// Its own space → that of the level that holds it.
    pub transform: Transform,
    /// What it is made of; `None`: whatever the instance is made of that holds it, black where nothing says.
    pub material: Option<MaterialId>,
}

/// What an object is.
#[derive(Clone, Debug)]
pub enum Content {
    /// A prepared shape.
    Shape(Arc<AnyShape>),
    /// Objects that are stored once, however often they are placed.
    Level(Arc<Level>),
}

impl Content {
    /// The shape, if it is one.
    pub fn as_shape(&self) -> Option<&Arc<AnyShape>> {
        match self {
            Self::Shape(shape) => Some(shape),
            Self::Level(_) => None,
        }
    }
}

impl Object {
    /// A prepared shape.
    pub fn new(shape: AnyShape, transform: Transform, material: MaterialId) -> Self {
        Self { content: Content::Shape(Arc::new(shape)), transform, material: Some(material) }
    }

    /// Whether it has an end.
    pub fn is_bounded(&self) -> bool {
        match &self.content {
            Content::Shape(_) => !self.bounds().is_empty(),
            Content::Level(level) => level.is_bounded() && self.bounds().is_empty() == level.bounds().is_empty(),
        }
    }

    /// A box around all of it that has an end, in the space of the level that holds it; empty when nothing has.
    pub fn bounds(&self) -> Aabb {
        let bounds = match &self.content {
            Content::Shape(shape) => self.transform.aabb(&shape.bounds()),
            Content::Level(level) => self.transform.aabb(&level.bounds()),
        };
        if bounds.is_finite() { bounds } else { Aabb::EMPTY }
    }

    /// How many shapes it stands for.
    pub fn shapes(&self) -> u64 {
        match &self.content {
            Content::Shape(_) => 1,
            Content::Level(level) => level.totals().shapes,
        }
    }
}
