//! Contents of a [`Geometry`]: shapes and instances of other geometries, each with its transform.

use super::Geometry;
use juggler_material::MaterialId;
use juggler_math::{Aabb, Motion, Vec2};
use juggler_shape::surface::Surface;
use juggler_shape::{AnyShape, Mesh, MeshData, MeshPoint};
use std::ops::Range;
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
    /// Attributes of surfaces that have none of their own.
    pub attributes: Option<InstanceAttributes>,
}

/// Attributes of one instance: a triangle of arrays that all instances share. Its first and its
/// third corner hold the values at the surface coordinate v = 0 and v = 1.
#[derive(Clone, Debug)]
pub struct InstanceAttributes {
    /// Attributes of the vertices, and a triangle for each instance.
    pub arrays: Arc<MeshData>,
    /// Index of the triangle.
    pub triangle: u32,
}

impl InstanceAttributes {
    /// Point that has the instance's attributes at a surface.
    pub(super) fn point(&self, surface: &Surface) -> MeshPoint<'_> {
        attribute_point(&self.arrays, self.triangle, surface)
    }
}

/// Attributes of the objects of a geometry: runs of successive objects with successive triangles of
/// the same arrays.
#[derive(Clone, Debug, Default)]
pub(super) struct ObjectAttributes(Vec<AttributeRun>);

#[derive(Clone, Debug)]
struct AttributeRun {
    /// Indices of the objects.
    objects: Range<u32>,
    /// Attributes of the first object.
    first: InstanceAttributes,
}

impl AttributeRun {
    /// Index of an object's triangle.
    fn triangle(&self, object_index: u32) -> u32 {
        self.first.triangle.wrapping_add(object_index - self.objects.start)
    }
}

impl ObjectAttributes {
    pub fn new(objects: &[Object]) -> Self {
        let mut runs: Vec<AttributeRun> = Vec::new();
        for (object_index, object) in (0..).zip(objects) {
            let Some(attributes) = &object.attributes else { continue };
            let continues = |run: &&mut AttributeRun| {
                run.objects.end == object_index
                    && run.triangle(object_index) == attributes.triangle
                    && Arc::ptr_eq(&run.first.arrays, &attributes.arrays)
            };
            match runs.last_mut().filter(continues) {
                Some(run) => run.objects.end = object_index.saturating_add(1),
                None => runs.push(AttributeRun {
                    objects: object_index..object_index.saturating_add(1),
                    first: attributes.clone(),
                }),
            }
        }
        Self(runs)
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Memory in bytes, without the arrays.
    pub fn bytes(&self) -> usize {
        size_of_val(self.0.as_slice())
    }

    fn run(&self, object_index: u32) -> Option<&AttributeRun> {
        let after = self.0.partition_point(|run| run.objects.start <= object_index);
        self.0.get(after.checked_sub(1)?).filter(|run| run.objects.contains(&object_index))
    }

    /// Attributes of an object.
    pub fn of_object(&self, object_index: u32) -> Option<InstanceAttributes> {
        let run = self.run(object_index)?;
        Some(InstanceAttributes { triangle: run.triangle(object_index), ..run.first.clone() })
    }

    /// Point that has the attributes of an object at a surface.
    pub fn point(&self, object_index: u32, surface: &Surface) -> Option<MeshPoint<'_>> {
        let run = self.run(object_index)?;
        Some(attribute_point(&run.first.arrays, run.triangle(object_index), surface))
    }
}

fn attribute_point<'a>(arrays: &'a MeshData, triangle: u32, surface: &Surface) -> MeshPoint<'a> {
    MeshPoint::new(arrays, triangle, Vec2::new(0.0, surface.uv.y.clamp(0.0, 1.0)))
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
