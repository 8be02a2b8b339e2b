//! Shapes: solids and surfaces, each in its own object space.

use crate::surface::Surface;
use juggler_math::{Aabb, BuildControl, Cancelled, Ray, Vec2, Vec3};

mod arithmetic;
pub mod attribute;
mod check;
#[cfg(test)]
mod contract;
mod derivatives;
mod reproject;
mod solid_angle;
pub mod surface;
#[cfg(any(test, feature = "testing"))]
pub mod testing;
mod triangle_geometry;

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

pub use arithmetic::clamp_to_f32_range;
pub use derivatives::SurfaceDerivatives;
pub use mesh::{InstanceValues, MeshData, MeshPoint, MorphArrays, MorphTarget};
pub use sphere::{intersect_sphere, longitude_latitude, sphere_interval, sphere_surface};

/// Intersection of a ray with a shape: 16 bytes, all that traversal carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray, in units of the length of its direction.
    pub t: f32,
    /// Parameters from which the shape finds the surface again: the barycentrics of a triangle's
    /// second and third corner.
    pub uv: Vec2,
    /// Index of the triangle or face.
    pub primitive: u32,
}

/// Point sampled on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeSample {
    /// The point, object space.
    pub point: Vec3,
    /// Unit normal at the point, object space.
    pub normal: Vec3,
    /// Density per steradian, seen from the reference point.
    pub pdf: f32,
}

/// Point of a shape's surface where a ray hits it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point, object space.
    pub point: Vec3,
    /// Unit normal of the surface there, object space.
    pub normal: Vec3,
    /// Index of the triangle or face, as in [`Hit`].
    pub primitive: u32,
}

/// Shape whose solid angle has a closed form, in object space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SolidAngleShape {
    /// A sphere around the origin.
    Sphere {
        /// Radius.
        radius: f32,
    },
    /// A disk around the origin, in the plane y = 0.
    Disk {
        /// Radius.
        radius: f32,
    },
    /// A rectangle around the origin, in the plane y = 0.
    Rectangle {
        /// Edge lengths along x and z.
        size: [f32; 2],
    },
    /// A triangle.
    Triangle {
        /// Corners.
        vertices: [Vec3; 3],
    },
}

/// Error of an invalid shape: the field at fault and the values that are allowed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct InvalidShape {
    /// Path of the field inside the shape, as in the scene file: `radius`, `vertices[3]`.
    pub field: String,
    /// Message to people: the mistake, and the values that are allowed.
    pub message: String,
}

impl From<Cancelled> for InvalidShape {
    fn from(cancelled: Cancelled) -> Self {
        Self { field: String::new(), message: cancelled.to_string() }
    }
}

/// A solid or surface in object space. The direction of a ray need not be a unit vector: distances
/// are in units of its length.
pub trait Shape: Send + Sync {
    /// Validates the description and derives the data that intersection needs, such as a mesh's
    /// hierarchy. Called once before anything else.
    fn prepare(&mut self) -> Result<(), InvalidShape>;
    /// [`Shape::prepare`], which ends early if `control` is cancelled, with an error, and reports its
    /// progress to it. Shapes that are prepared at once do not look at it.
    fn prepare_with_control(&mut self, _control: &BuildControl) -> Result<(), InvalidShape> {
        self.prepare()
    }
    /// Bounding box; [`Aabb::INFINITE`] for an unbounded shape.
    fn bounds(&self) -> Aabb;
    /// The nearest hit in the ray's range.
    fn intersect(&self, ray: &Ray) -> Option<Hit>;
    /// Whether the ray hits anything in its range.
    fn occludes(&self, ray: &Ray) -> bool {
        self.intersect(ray).is_some()
    }
    /// The surface at a hit that [`Shape::intersect`] returned for this ray.
    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface;
    /// Derivatives of position by surface coordinates at a hit, object space; `None` where they do
    /// not span the surface. `local` is the point, as [`Surface::local`] has it, `time` that of the
    /// ray.
    fn derivatives(&self, local: Vec3, hit: &Hit, time: f32) -> Option<SurfaceDerivatives>;
    /// Area of the whole surface; infinite for an unbounded shape, which cannot be a light.
    fn area(&self) -> f32;
    /// Samples a point on the surface, seen from `from`, by `u` in the unit square; `None` if the
    /// point is seen edge-on or the shape is unbounded. A shape that is not convex may occlude the
    /// point itself.
    fn sample(&self, from: Vec3, u: Vec2) -> Option<ShapeSample>;
    /// Density per steradian, seen from `from`, of [`Shape::sample`] at this point of the surface;
    /// 0 for a point that it never samples from there.
    fn pdf(&self, from: Vec3, at: &SurfacePoint) -> f32;
    /// The shape as one whose points lights can sample by solid angle; `None` if there is no closed
    /// form.
    fn solid_angle_shape(&self) -> Option<SolidAngleShape> {
        None
    }
    /// The shape as a sphere around the origin.
    fn sphere(&self) -> Option<&Sphere> {
        None
    }
    /// The shape as a mesh.
    fn mesh(&self) -> Option<&Mesh> {
        None
    }
    /// The shape as a mesh that can be changed.
    fn mesh_mut(&mut self) -> Option<&mut Mesh> {
        None
    }
    /// Whether the shape is the whole plane y = 0.
    fn is_plane(&self) -> bool {
        false
    }
    /// Number of triangles; 0 for exact shapes.
    fn triangles(&self) -> usize {
        0
    }
    /// Bytes on the heap, without a hierarchy.
    fn heap_bytes(&self) -> usize {
        0
    }
    /// Bytes of the shape's hierarchy.
    fn bvh_bytes(&self) -> usize {
        0
    }
}

juggler_math::closed_set! {
    /// Shape of any kind. In JSON: `{"sphere": {"radius": 1}}`.
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
