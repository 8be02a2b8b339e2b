//! What a level is made of: shapes and instances of other levels, each in its place.

use super::Level;
use juggler_material::MaterialId;
use juggler_math::{Aabb, Motion};
use juggler_shape::AnyShape;
use std::sync::Arc;

/// A shape or a shared level in its place.
#[derive(Clone, Debug)]
pub struct Object {
    /// What it is.
    pub content: Content,
    /// Its own space → that of the level that holds it.
    pub motion: Motion,
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
    pub fn new(shape: AnyShape, motion: impl Into<Motion>, material: MaterialId) -> Self {
        Self { content: Content::Shape(Arc::new(shape)), motion: motion.into(), material: Some(material) }
    }

    /// Whether it has an end.
    pub fn is_bounded(&self) -> bool {
        match &self.content {
            Content::Shape(_) => !self.bounds().is_empty(),
            Content::Level(level) => level.is_bounded() && self.bounds().is_empty() == level.bounds().is_empty(),
        }
    }

    /// A box around all of it that has an end, wherever it comes, in the space of the level that holds it; empty when
    /// nothing has.
    pub fn bounds(&self) -> Aabb {
        let bounds = match &self.content {
            Content::Shape(shape) => self.motion.aabb(&shape.bounds()),
            Content::Level(level) => self.motion.aabb(&level.bounds()),
        };
        if bounds.is_finite() { bounds } else { Aabb::EMPTY }
    }

    /// Whether it, or anything in it, moves while the shutter is open.
    pub fn moves(&self) -> bool {
        self.motion.moves()
            || match &self.content {
                Content::Shape(_) => false,
                Content::Level(level) => level.moves(),
            }
    }

    /// How many shapes it stands for.
    pub fn shapes(&self) -> u64 {
        match &self.content {
            Content::Shape(_) => 1,
            Content::Level(level) => level.totals().shapes,
        }
    }
}
