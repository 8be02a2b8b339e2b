//! Properties of every shape, tested over the examples of all kinds; here, their common helpers.

use super::{AnyShape, Shape};
use crate::testing::{bounding_sphere, is_convex, is_flat, is_solid};
use juggler_math::testing::Random;
use juggler_math::{DVec3, Frame, Ray, Vec3, warp};

mod constructors;
mod derivatives;
mod descriptions;
mod extremes;
mod follow_up;
mod hits;
mod measures;

/// Chance of a false alarm of one statistical test.
const SIGNIFICANCE: f64 = 1e-6;

/// All examples, prepared.
fn shapes() -> Vec<AnyShape> {
    let mut shapes = AnyShape::examples();
    shapes.iter_mut().for_each(|shape| shape.prepare().unwrap());
    shapes
}

/// Random line through a sphere, all lines equally likely; it starts `away` radii before the
/// sphere's center.
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
