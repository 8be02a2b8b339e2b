//! Contents of a [`Geometry`]: shapes and instances of other geometries, each with its transform.

use super::{Geometry, InstanceAttributes};
use juggler_material::MaterialId;
use juggler_math::{Aabb, Motion};
use juggler_shape::{AnyShape, Mesh};
use std::sync::Arc;

/// A shape or an instance of a geometry.
#[derive(Clone, Debug)]
pub struct Object {
    /// The shape, or the geometry that is instantiated.
    pub content: Content,
    /// Transform from object space to the space of the containing geometry.
    pub motion: Motion,
    /// Material; `None` inherits that of the enclosing instance, which is black if no instance has
    /// one.
    pub material: Option<MaterialId>,
    /// Attributes of the instance that the object is, or is inside of.
    pub attributes: Option<InstanceAttributes>,
}

/// Content of an object.
#[derive(Clone, Debug)]
pub enum Content {
    /// A shape, prepared for intersection.
    Shape(Arc<AnyShape>),
    /// A geometry, stored once for all of its instances.
    Geometry(Arc<Geometry>),
}

impl Content {
    /// Returns the shape; `None` for an instance.
    pub fn as_shape(&self) -> Option<&Arc<AnyShape>> {
        match self {
            Self::Shape(shape) => Some(shape),
            Self::Geometry(_) => None,
        }
    }

    /// Bounding box of the bounded parts of an object of this content and `motion` over the shutter
    /// interval; empty if nothing is bounded.
    pub(super) fn bounds(&self, motion: &Motion) -> Aabb {
        let bounds = match self {
            Self::Shape(shape) => motion.aabb(&shape.bounds()),
            Self::Geometry(geometry) => motion.aabb(&geometry.bounds()),
        };
        if bounds.is_finite() { bounds } else { Aabb::EMPTY }
    }

    /// Whether an object of this content, whose [`Content::bounds`] are `bounds`, has a finite extent.
    pub(super) fn is_bounded_by(&self, bounds: &Aabb) -> bool {
        match self {
            Self::Shape(_) => !bounds.is_empty(),
            Self::Geometry(geometry) => geometry.is_bounded() && bounds.is_empty() == geometry.bounds().is_empty(),
        }
    }

    /// Whether any mesh has attributes or a second set of surface coordinates.
    pub(super) fn has_mesh_attributes(&self) -> bool {
        match self {
            Self::Shape(shape) => shape.mesh().is_some_and(Mesh::has_attributes),
            Self::Geometry(geometry) => geometry.has_mesh_attributes,
        }
    }
}

impl Content {
    /// Whether any object of a geometry has attributes as an instance.
    pub(super) fn has_instance_attributes(&self) -> bool {
        match self {
            Self::Shape(_) => false,
            Self::Geometry(geometry) => geometry.has_instance_attributes(),
        }
    }
}

impl Object {
    /// Creates an object from a prepared shape.
    pub fn new(shape: AnyShape, motion: impl Into<Motion>, material: MaterialId) -> Self {
        Self {
            content: Content::Shape(Arc::new(shape)),
            motion: motion.into(),
            material: Some(material),
            attributes: None,
        }
    }

    /// Whether the object has a finite extent.
    pub fn is_bounded(&self) -> bool {
        self.is_bounded_by(&self.bounds())
    }

    /// Whether the object, whose [`Object::bounds`] are `bounds`, has a finite extent.
    pub(super) fn is_bounded_by(&self, bounds: &Aabb) -> bool {
        self.content.is_bounded_by(bounds)
    }

    /// Bounding box of the bounded parts over the shutter interval, in the space of the containing
    /// geometry; empty if nothing is bounded.
    pub fn bounds(&self) -> Aabb {
        self.content.bounds(&self.motion)
    }

    /// Whether the object, or anything in it, moves while the shutter is open.
    pub fn moves(&self) -> bool {
        self.motion.moves()
            || match &self.content {
                Content::Shape(shape) => shape.mesh().is_some_and(Mesh::moves),
                Content::Geometry(geometry) => geometry.moves(),
            }
    }

    /// Number of shapes, counting the contents of every instance.
    pub fn shapes(&self) -> u64 {
        match &self.content {
            Content::Shape(_) => 1,
            Content::Geometry(geometry) => geometry.totals().shapes,
        }
    }
}
