//! Watertight ray-triangle intersection (Woop, Benthin, Wald 2013, "Watertight Ray/Triangle
//! Intersection", JCGT 2(1)).
//!
//! A shear aligns the ray with the z axis. The test then evaluates three edge functions at the
//! origin. Two triangles that share an edge compute its edge function with the same magnitude and
//! opposite sign, so no ray passes between them. Triangles are two-sided.
//!
//! Deviations from the paper: the winding is not preserved, since there is no back-face culling.
//! Single precision, eight triangles at a time, only rejects misses (a difference of products keeps
//! its sign or rounds to zero); barycentric weights and distance of a hit are always computed in
//! double precision. The distance is clamped to the entry of the triangle's own box, so that the
//! closest hit does not depend on the traversal order.

use crate::lanes::{max, min};
use crate::slabs::inverses;
use juggler_math::{Ray, Vec3};

/// Upper bound of hit distances: larger ones are infinite in single precision and cannot be
/// compared.
pub(crate) const FARTHEST: f32 = f32::MAX;

/// Precision of a hit's distance and barycentric weights. Both variants decide hit or miss by the
/// same edge test.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TriangleTest {
    /// Double precision: watertight, and accurate for slender triangles.
    #[default]
    Watertight,
    /// Single precision: the distance to a slender triangle may be off by thousands of ulps, so
    /// rays that leave it may hit it again, and the closest of two hits within that error may
    /// depend on the query. Suitable for queries that only need a hit.
    Fast,
}

/// Intersects a ray with a two-sided triangle. Returns `(t, u, v)` with `t` in units of the
/// direction's length, between `t_min` and `t_max`, and the barycentric weights of `b` and `c`
/// (that of `a` is `1 - u - v`). A ray through an edge or a vertex hits at least one of the
/// adjacent triangles. Degenerate triangles are never hit.
pub fn intersect_triangle(ray: &Ray, a: Vec3, b: Vec3, c: Vec3) -> Option<(f32, f32, f32)> {
    let [x, y, z] = inverses(ray.direction).to_array();
    let signs = (0..3).fold(0, |signs, axis| signs | u32::from(ray.direction[axis].is_sign_negative()) << axis);
    let shear = Shear::new(ray, [x, y, z, 0.0], signs);
    let corners = [a, b, c].map(|corner| shear.axes.map(|axis| corner[axis]));
    let hit = shear.intersect(ray, corners)?;
    has_area([a, b, c]).then_some(hit)
}

/// Whether the vertices are finite and the area is not zero in double precision.
pub(crate) fn has_area([a, b, c]: [Vec3; 3]) -> bool {
    let normal = (b.as_dvec3() - a.as_dvec3()).cross(c.as_dvec3() - a.as_dvec3());
    a.is_finite() && b.is_finite() && c.is_finite() && normal != juggler_math::DVec3::ZERO
}

/// Precomputed ray data for triangle tests: the shear that aligns the ray with the z axis, and the
/// data for the entry into a box. Axes are permuted so that z is the direction's largest component.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shear {
    /// Object-space axes that become x, y and z.
    pub axes: [usize; 3],
    pub origin: [f32; 3],
    /// Shear of x and y, as multiples of z, and scale of z.
    pub factors: [f32; 3],
    pub inverse: [f32; 3],
    /// Per axis: 0 where the minimum is the near plane, 1 where the maximum is.
    pub side: [usize; 3],
}

/// A vertex in the sheared frame.
pub(crate) type Point = [f32; 3];

impl Shear {
    /// Constructs the shear. `inverse` is the reciprocal direction as [`inverses`] returns it;
    /// `signs` has a bit per axis, set for a negative direction.
    #[inline(always)]
    pub fn new(ray: &Ray, inverse: [f32; 4], signs: u32) -> Self {
        const NEXT: [usize; 3] = [1, 2, 0];
        const LAST: [usize; 3] = [2, 0, 1];
        let size = ray.direction.abs();
        let z = if size.x >= size.y && size.x >= size.z { 0 } else { 2 - usize::from(size.y >= size.z) };
        let (x, y) = (NEXT[z], LAST[z]);
        let (o, d) = (ray.origin, ray.direction);
        let (o, d) = ([o.x, o.y, o.z, d.x], [d.x, d.y, d.z, ray.t_min]);
        let depth = inverse[z];
        let side = |axis: usize| (signs >> axis) as usize & 1;
        Self {
            axes: [x, y, z],
            origin: [o[x], o[y], o[z]],
            factors: [d[x] * depth, d[y] * depth, depth],
            inverse: [inverse[x], inverse[y], depth],
            side: [side(x), side(y), side(z)],
        }
    }

    #[inline(always)]
    pub fn project(&self, vertex: [f32; 3]) -> Point {
        let [x, y, z]: [f32; 3] = std::array::from_fn(|k| vertex[k] - self.origin[k]);
        [x - self.factors[0] * z, y - self.factors[1] * z, self.factors[2] * z]
    }

    /// [`intersect_triangle`] for this shear's ray and a triangle that [has an area](has_area);
    /// coordinates in the order of [`Shear::axes`].
    #[inline(always)]
    pub fn intersect(&self, ray: &Ray, corners: [Point; 3]) -> Option<(f32, f32, f32)> {
        let points = [self.project(corners[0]), self.project(corners[1]), self.project(corners[2])];
        let end = max(points[0][2], max(points[1][2], points[2][2]));
        let (t, u, v) = barycentric_hit(points)?;
        let (t_min, t_max) = (ray.t_min, ray.t_max);
        let t_clamped = self.clamp(t, corners);
        let t_max = min(t_max, FARTHEST);
        (t <= t_max && end >= t_min && t_min <= t_clamped && t_clamped <= t_max).then_some((t_clamped, u, v))
    }

    /// Clamps `t` to the entry of the ray's line into the triangle's box, computed as in the
    /// traversal.
    #[inline(always)]
    pub fn clamp(&self, t: f32, corners: [[f32; 3]; 3]) -> f32 {
        let mut enter = t;
        for axis in 0..3 {
            let near = Self::near(&corners, axis, self.side[axis]);
            enter = max((near - self.origin[axis]) * self.inverse[axis], enter);
        }
        enter
    }

    /// Minimum (side 0) or maximum (side 1) of the vertices along an axis. An array lookup in place
    /// of a branch, since direction signs are hard to predict.
    #[inline(always)]
    pub fn near([a, b, c]: &[[f32; 3]; 3], axis: usize, side: usize) -> f32 {
        [min(a[axis], min(b[axis], c[axis])), max(a[axis], max(b[axis], c[axis]))][side & 1]
    }
}

/// Distance and weights of the second and third vertex; `None` where the axis misses the triangle.
///
/// Products of single-precision numbers are exact in double precision, so the error is bounded by
/// that of the projected vertices, however slender the triangle is.
#[inline(always)]
fn barycentric_hit(points: [Point; 3]) -> Option<(f32, f32, f32)> {
    let [e, f, g] = edges(points.map(|[x, y, _]| [f64::from(x), f64::from(y)]));
    let determinant = e + f + g;
    // Select instead of branching: the signs of edge functions are hard to predict.
    let less = |a: f64, b: f64| if a < b { a } else { b };
    let more = |a: f64, b: f64| if a > b { a } else { b };
    let outside = (less(e, less(f, g)) < 0.0) & (more(e, more(f, g)) > 0.0);
    if outside | (determinant == 0.0) | !determinant.is_finite() {
        return None;
    }
    let inverse = 1.0 / determinant;
    let [u, v, w] = [e * inverse, f * inverse, g * inverse];
    let [a, b, c] = points.map(|p| f64::from(p[2]));
    Some(((u * a + v * b + w * c) as f32, v as f32, w as f32))
}

/// Edge functions at the origin (twice the signed areas), in the order of the opposite vertices.
#[inline(always)]
pub(crate) fn edges<T: Copy + std::ops::Mul<Output = T> + std::ops::Sub<Output = T>>([a, b, c]: [[T; 2]; 3]) -> [T; 3] {
    [c[0] * b[1] - c[1] * b[0], a[0] * c[1] - a[1] * c[0], b[0] * a[1] - b[1] * a[0]]
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: Vec3 = Vec3::ZERO;
    const B: Vec3 = Vec3::X;
    const C: Vec3 = Vec3::Y;

    #[test]
    fn known_hit_from_both_sides_and_with_any_length_of_direction() {
        for length in [1.0, 0.125, 1000.0] {
            let ray = Ray::new(Vec3::new(0.25, 0.5, 2.0), -Vec3::Z * length);
            assert_eq!(intersect_triangle(&ray, A, B, C), Some((2.0 / length, 0.25, 0.5)));
            assert_eq!(intersect_triangle(&ray, A, C, B), Some((2.0 / length, 0.5, 0.25)));
        }
        let below = Ray::new(Vec3::new(0.25, 0.5, -2.0), Vec3::Z);
        assert_eq!(intersect_triangle(&below, A, B, C), Some((2.0, 0.25, 0.5)));
    }

    #[test]
    fn hits_lie_in_the_interval_of_the_ray() {
        let ray = Ray::new(Vec3::new(0.25, 0.25, 1.0), -Vec3::Z);
        assert!(intersect_triangle(&ray.with_t_max(1.0), A, B, C).is_some());
        assert!(intersect_triangle(&ray.with_t_max(0.99), A, B, C).is_none());
        assert!(intersect_triangle(&Ray { t_min: 1.01, ..ray }, A, B, C).is_none());
        assert!(intersect_triangle(&Ray { direction: Vec3::Z, ..ray }, A, B, C).is_none());
    }

    #[test]
    fn edges_and_corners_are_hit() {
        let points = [A, B, C, Vec3::new(0.5, 0.0, 0.0), Vec3::new(0.5, 0.5, 0.0), Vec3::new(0.0, 0.5, 0.0)];
        for point in points {
            let ray = Ray::new(point + Vec3::Z, -Vec3::Z);
            let (t, u, v) = intersect_triangle(&ray, A, B, C).unwrap();
            assert_eq!((t, Vec3::new(u, v, 0.0)), (1.0, point));
        }
    }

    #[test]
    fn triangles_without_area_are_never_hit() {
        let ray = Ray::new(Vec3::Z, -Vec3::Z);
        let through = |a, b, c| intersect_triangle(&ray, a, b, c);
        assert_eq!(through(-Vec3::X, Vec3::ZERO, Vec3::X), None);
        assert_eq!(through(Vec3::ZERO, Vec3::ZERO, Vec3::X), None);
        assert_eq!(through(Vec3::ZERO, Vec3::ZERO, Vec3::ZERO), None);
        assert_eq!(through(Vec3::NAN, Vec3::X, Vec3::Y), None);
        assert_eq!(through(Vec3::INFINITY, Vec3::X, Vec3::Y), None);
        // Edge-on: the ray lies in the triangle's plane.
        assert_eq!(through(-Vec3::X, Vec3::X, -Vec3::Z), None);
        assert_eq!(intersect_triangle(&Ray::new(Vec3::Z, Vec3::ZERO), A, B, C), None);
    }

    /// The direction is so short that `t` overflows.
    #[test]
    fn nothing_is_hit_at_infinity() {
        let ray = Ray::new(Vec3::new(0.25, 0.5, 2.0) * 1e20, -Vec3::Z * 1e-20);
        let [a, b, c] = [A, B, C].map(|corner| corner * 1e20);
        assert_eq!(intersect_triangle(&ray, a, b, c), None);
        assert!(intersect_triangle(&Ray { direction: -Vec3::Z * 1e-18, ..ray }, a, b, c).is_some());
    }

    #[test]
    fn hits_do_not_depend_on_scale() {
        for exponent in [-36, -30, -10, 10, 25, 30, 36] {
            let scale = 10f32.powi(exponent);
            let ray = Ray::new(Vec3::new(0.25, 0.5, 2.0) * scale, -Vec3::Z);
            let (t, u, v) = intersect_triangle(&ray, A * scale, B * scale, C * scale).unwrap();
            assert!((t / scale - 2.0).abs() < 1e-5, "{exponent}: {t}");
            assert!((u - 0.25).abs() < 1e-5 && (v - 0.5).abs() < 1e-5, "{exponent}: {u} {v}");
        }
    }
}
