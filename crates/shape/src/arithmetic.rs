//! Arithmetic shared by exact shapes, in `f64`: rays and shapes are given in `f32`, so products are
//! exact, and the result of a cancellation has more digits than an `f32`.

use super::Hit;
use crate::surface::Surface;
use juggler_math::{DVec3, Ray, Vec2, portable, robust};
use std::f32::consts::PI;

/// Origin and direction in double precision.
#[inline]
pub fn to_f64(ray: &Ray) -> (DVec3, DVec3) {
    (ray.origin.as_dvec3(), ray.direction.as_dvec3())
}

/// Both solutions of `a t² - 2 b t + c = 0`, the smaller first, for `a > 0` and a `discriminant`
/// `b² - a c` of at least 0. Avoids cancellation (Press et al., Numerical Recipes, section 5.6).
#[inline]
pub fn roots(a: f64, b: f64, c: f64, discriminant: f64) -> (f64, f64) {
    let [near, far] = root_fractions(a, b, c, discriminant);
    (near.0 / near.1, far.0 / far.1)
}

/// The [`roots`] as numerators and denominators: often one of the divisions is enough.
#[inline]
pub fn root_fractions(a: f64, b: f64, c: f64, discriminant: f64) -> [(f64, f64); 2] {
    let q = b + discriminant.sqrt().copysign(b);
    if q < 0.0 { [(q, a), (c, q)] } else { [(c, q), (q, a)] }
}

/// Distances at which a ray crosses the infinite cylinder around the y axis; `None` for a miss or a
/// ray along the axis.
#[inline]
pub fn intersect_infinite_cylinder(origin: DVec3, direction: DVec3, radius: f64) -> Option<(f64, f64)> {
    let a = direction.x * direction.x + direction.z * direction.z;
    let beside = origin.x * direction.z - origin.z * direction.x;
    let discriminant = a * radius * radius - beside * beside;
    if discriminant < 0.0 || a == 0.0 {
        return None;
    }
    let b = -(origin.x * direction.x + origin.z * direction.z);
    let c = origin.x * origin.x + origin.z * origin.z - radius * radius;
    Some(roots(a, b, c, discriminant))
}

/// First of two candidates, nearer one first, in the ray's range.
#[inline]
pub fn first_in_range(ray: &Ray, candidates: [(f64, u32); 2]) -> Option<Hit> {
    candidates.into_iter().find_map(|(t, primitive)| in_range(ray, t, primitive))
}

/// The ray for arithmetic in `f32`: its range ends before infinity, and is empty if the direction
/// is so short that its inverse overflows.
#[inline]
pub fn clamp_to_f32_range(ray: &Ray) -> Ray {
    let has_direction = ray.direction.abs().max_element() >= f32::MIN_POSITIVE;
    ray.with_t_max(if has_direction { ray.t_max.min(f32::MAX) } else { -1.0 })
}

/// Hit at `t`, rounded, if it is in the ray's range and finite.
#[inline(always)]
pub fn in_range(ray: &Ray, t: f64, primitive: u32) -> Option<Hit> {
    let t = t as f32;
    (t >= ray.t_min && t <= ray.t_max && t < f32::INFINITY).then_some(Hit { t, uv: Vec2::ZERO, primitive })
}

/// Surface at a point computed in `f64`, whose only error is the rounding to `f32`.
pub fn rounded_surface(point: DVec3, normal: DVec3, uv: Vec2) -> Surface {
    let (point, normal) = (point.as_vec3(), normal.as_vec3());
    Surface::new(point, robust::gamma(2) * point.abs().dot(normal.abs()), normal, uv)
}

/// Distance of hits from edges, relative to the size of a shape: larger than the offset of a ray
/// that leaves inwards, so that the ray cannot start beyond the adjacent face.
pub const EDGE_MARGIN: f32 = robust::gamma(32);

/// Clamps `value` to `low` and `high`, and to a distance of `margin` from both where there is room.
#[inline]
pub fn clamp_within(value: f32, low: f32, high: f32, margin: f32) -> f32 {
    let margin = margin.min(0.25 * (high - low));
    value.max(low + margin).min(high - margin)
}

/// Angle around the y axis as a fraction of a turn in [0, 1): 0 towards +x, a quarter towards -z
/// (counter-clockwise seen from above).
pub fn azimuth_turns(x: f32, z: f32) -> f32 {
    let fraction = portable::atan2(-z, x) / (2.0 * PI);
    if fraction < 0.0 { (fraction + 1.0).min(1.0 - f32::EPSILON) } else { fraction }
}
