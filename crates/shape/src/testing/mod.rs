//! Properties of shapes that contract tests of this and other crates share.

mod distance;

pub use distance::distance;

use crate::AnyShape;
use juggler_math::Vec3;

/// Center and radius of a bounding sphere; of a sphere around the origin for an unbounded shape.
pub fn bounding_sphere(shape: &AnyShape) -> (Vec3, f32) {
    match shape {
        AnyShape::Plane(_) => (Vec3::ZERO, 1.0),
        AnyShape::Tube(tube) => (Vec3::ZERO, 1.5 * tube.radius),
        _ => (shape.bounds().center(), 0.5 * shape.bounds().extent().length()),
    }
}

/// Whether the shape encloses space, its normals pointing out of it.
pub fn is_solid(shape: &AnyShape) -> bool {
    match shape {
        AnyShape::Sphere(_) | AnyShape::Cuboid(_) | AnyShape::Tube(_) => true,
        AnyShape::Cylinder(cylinder) => cylinder.capped,
        // Among the examples, only closed meshes have normals.
        AnyShape::Mesh(mesh) => mesh.data().is_some_and(|data| !data.normals.is_empty()),
        _ => false,
    }
}

/// Whether a line crosses the shape at most once.
pub fn is_flat(shape: &AnyShape) -> bool {
    use AnyShape as Any;
    matches!(shape, Any::Plane(_) | Any::Disk(_) | Any::Rectangle(_) | Any::Triangle(_) | Any::Polygon(_))
}

/// Whether no front face of the shape occludes another from outside.
pub fn is_convex(shape: &AnyShape) -> bool {
    is_flat(shape) || is_solid(shape) && !matches!(shape, AnyShape::Mesh(_))
}
