//! What every shape must keep: tests over all examples of all kinds. Here: what they share.

use super::{AnyShape, Shape};
use juggler_math::testing::Random;
use juggler_math::{DVec3, Frame, Ray, Vec3, warp};

mod derivatives;
mod descriptions;
mod distance;
mod extremes;
mod follow_up;
mod hits;
mod measures;

pub use distance::distance;

/// Chance of a false alarm of one statistical test.
const SIGNIFICANCE: f64 = 1e-6;

/// All examples, ready to be hit.
fn shapes() -> Vec<AnyShape> {
    let mut shapes = AnyShape::examples();
    shapes.iter_mut().for_each(|shape| shape.prepare().unwrap());
    shapes
}

/// A ball around a shape, or around the interesting part of one without end.
pub fn ball(shape: &AnyShape) -> (Vec3, f32) {
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
        // Only the globes have normals.
        AnyShape::Mesh(mesh) => mesh.data().is_some_and(|data| !data.normals.is_empty()),
        _ => false,
    }
}

/// Whether a line crosses the shape at most once.
pub fn is_flat(shape: &AnyShape) -> bool {
    use AnyShape as Any;
    matches!(shape, Any::Plane(_) | Any::Disk(_) | Any::Rectangle(_) | Any::Triangle(_) | Any::Polygon(_))
}

/// Whether no part of the shape hides another from outside once back faces are left out.
pub fn is_convex(shape: &AnyShape) -> bool {
    is_flat(shape) || is_solid(shape) && !matches!(shape, AnyShape::Mesh(_))
}

/// A random line through the ball, all equally likely; it starts `away` radii before the ball's centre.
fn line(random: &mut Random, (center, radius): (Vec3, f32), away: f32) -> Ray {
    let frame = Frame::around(random.unit_vector());
    let across = warp::concentric_disk(random.vec2());
    let start = (frame.tangent * across.x + frame.bitangent * across.y) * radius - frame.normal * (away * radius);
    Ray::new(center + start, frame.normal)
}

/// All hits along a ray, each found from beyond the one before.
fn all_hits(shape: &AnyShape, ray: &Ray) -> Vec<super::Hit> {
    let mut ray = *ray;
    let next = || {
        let hit = shape.intersect(&ray)?;
        assert!(hit.t >= ray.t_min, "{shape:?}: {hit:?} before {ray:?}");
        ray.t_min = hit.t.next_up();
        Some(hit)
    };
    std::iter::from_fn(next).take(1000).collect()
}

fn at(ray: &Ray, t: f32) -> DVec3 {
    ray.origin.as_dvec3() + ray.direction.as_dvec3() * f64::from(t)
}
