//! Shapes: solids and surfaces, each in its own object space.

use crate::surface::Surface;
use juggler_math::{Aabb, Ray, Vec2, Vec3};

mod arithmetic;
mod carried;
mod check;
#[cfg(test)]
mod contract;
mod derivatives;
mod facet;
mod solid_angle;
pub mod surface;
#[cfg(any(test, feature = "testing"))]
pub mod testing;

mod cuboid;
mod cylinder;
mod disk;
mod mesh;
mod plane;
mod polygon;
mod rectangle;
mod sphere;
mod triangle;
mod tube;

pub use arithmetic::within_floats;
pub use derivatives::Derivatives;
pub use mesh::{MeshData, Morph};
pub use sphere::{cross_sphere, intersect_sphere, longitude_latitude, sphere_surface};

/// What a ray found: 16 bytes, all that traversal carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray, in units of the ray's direction.
    pub t: f32,
    /// Whatever the shape needs to find the surface again (barycentrics of a triangle).
    pub uv: Vec2,
    /// Triangle or face.
    pub part: u32,
}

/// A point chosen on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceSample {
    /// The point, object space.
    pub point: Vec3,
    /// Unit normal there.
    pub normal: Vec3,
    /// Density per steradian seen from the place that asked.
    pub pdf: f32,
}

/// A point of a shape's surface, where a ray met it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point, object space.
    pub point: Vec3,
    /// Unit normal of the surface there, object space.
    pub normal: Vec3,
    /// Triangle or face, as in [`Hit`].
    pub part: u32,
}

/// Why a shape cannot be: the field at fault and what it should be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct InvalidShape {
    /// Path of the field inside the shape, as in the scene file: `radius`, `vertices[3]`.
    pub field: String,
    /// What is wrong, and what would be right.
    pub message: String,
}

/// A solid or surface in object space. A ray's direction need not be unit: distances are in its units.
pub trait Shape: Send + Sync {
    /// Checks numbers that only together make sense and derives what tracing needs (a mesh builds its
    /// hierarchy here). Called once before anything else.
    fn prepare(&mut self) -> Result<(), InvalidShape>;
    /// A box around everything; [`Aabb::INFINITE`] for a shape without end.
    fn bounds(&self) -> Aabb;
    /// The nearest hit in the ray's range.
    fn intersect(&self, ray: &Ray) -> Option<Hit>;
    /// Whether anything is hit in the ray's range.
    fn occludes(&self, ray: &Ray) -> bool {
        self.intersect(ray).is_some()
    }
    /// The surface at a hit that [`Shape::intersect`] gave for this ray.
    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface;
    /// How the surface runs along its coordinates at a hit, object space. `local` is the point, as [`Surface::local`] has
    /// it for materials that are textured, `time` that of the ray.
    fn derivatives(&self, local: Vec3, hit: &Hit, time: f32) -> Option<Derivatives>;
    /// Area of the whole surface; infinite for a shape without end, which cannot be a lamp.
    fn area(&self) -> f32;
    /// A point on the surface for `u` in the unit square; `None` when that one is seen edge-on or the shape has no
    /// end. A shape that is not convex may hide it behind itself: then it lights nothing.
    fn sample(&self, from: Vec3, u: Vec2) -> Option<SurfaceSample>;
    /// Density per steradian, seen from `from`, with which [`Shape::sample`] picks a point of this
    /// surface; 0 for a point that it never picks from there.
    fn pdf(&self, from: Vec3, at: &SurfacePoint) -> f32;
    /// How many triangles it is made of; 0 for exact shapes.
    fn triangles(&self) -> usize {
        0
    }
    /// Bytes on the heap, those of a hierarchy of its own not among them.
    fn heap_bytes(&self) -> usize {
        0
    }
    /// Bytes of a hierarchy of its own.
    fn bvh_bytes(&self) -> usize {
        0
    }
}

juggler_math::closed_set! {
    /// Every shape. In JSON: `{"sphere": {"radius": 1}}`.
    pub enum AnyShape: Shape {
        sphere::Sphere,
        plane::Plane,
        disk::Disk,
        rectangle::Rectangle,
        triangle::Triangle,
        polygon::Polygon,
        cuboid::Cuboid,
        cylinder::Cylinder,
        tube::Tube,
        mesh::Mesh,
    }
}
