//! The watertight ray-triangle test (Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection",
//! JCGT 2(1)).
//!
//! The triangle is sheared so that the ray becomes the z axis; what is left is on which side of three edges
//! the origin of the plane lies. Two triangles that share an edge compute the same number for it with
//! opposite sign, so no ray can pass between them. Both faces are hit.
//!
//! Deviations from the paper: the winding is not kept, for nothing is culled by it; single precision, eight triangles at
//! a time, only tells misses (a product difference rounds to zero or keeps its sign), weights and distance of hits are always summed
//! in double precision; and the distance is never before the entry of the triangle's own box, so that which hit is
//! closest cannot depend on the order in which boxes are visited.

use crate::lanes::{max, min};
use crate::slabs::inverses;
use juggler_math::{Ray, Vec3};

/// No hit is farther: a distance that is no number of single precision is none that could be compared.
pub(crate) const FARTHEST: f32 = f32::MAX;

/// How the distance and the weights of a hit are found. Whether a ray passes inside of a triangle is told the same way
/// by both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TriangleTest {
    /// In double precision: watertight, and exact however slender the triangle is.
    #[default]
    Watertight,
    /// In single precision: slender triangles may be off by thousands of ulp, so that rays that leave them may
    /// meet them again. For queries that want no more than a hit. Which of two hits within that error is the closest may
    /// depend on the call.
    Fast,
}

/// Where the ray meets the triangle between its `t_min` and `t_max`: `(t, u, v)` with the distance in units
/// of the direction and the barycentric weights of `b` and `c` (that of `a` is `1 - u - v`). Two-sided. A ray
/// that meets an edge or a corner hits at least one of the triangles there. Triangles without area are
/// never hit.
pub fn intersect_triangle(ray: &Ray, a: Vec3, b: Vec3, c: Vec3) -> Option<(f32, f32, f32)> {
    let [x, y, z] = inverses(ray.direction).to_array();
    let signs = (0..3).fold(0, |signs, axis| signs | u32::from(ray.direction[axis].is_sign_negative()) << axis);
    let shear = Shear::of(ray, [x, y, z, 0.0], signs);
    let corners = [a, b, c].map(|corner| shear.axes.map(|axis| corner[axis]));
    let hit = shear.intersect(ray, corners)?;
    has_area([a, b, c]).then_some(hit)
}

/// Whether the triangle is one: finite, and with an area that is not zero in double precision.
pub(crate) fn has_area([a, b, c]: [Vec3; 3]) -> bool {
    let normal = (b.as_dvec3() - a.as_dvec3()).cross(c.as_dvec3() - a.as_dvec3());
    a.is_finite() && b.is_finite() && c.is_finite() && normal != juggler_math::DVec3::ZERO
}

/// A ray made ready for triangles: the shear that makes it the z axis, and what it takes to say where it enters
/// a box. All by permuted axis: z is where the direction is largest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shear {
    /// The axes that become x, y and z.
    pub axes: [usize; 3],
    pub origin: [f32; 3],
    /// What to multiply z by and subtract from x and y, and what to multiply z by.
    pub factors: [f32; 3],
    pub inverse: [f32; 3],
    /// Where the minimum is the near plane 0, else 1.
    pub side: [usize; 3],
}

/// A vertex in the ray's frame.
pub(crate) type Point = [f32; 3];

impl Shear {
    /// `inverse` of the direction as [`inverses`] gives it, `signs` of the direction, a bit per axis.
    #[inline(always)]
    pub fn of(ray: &Ray, inverse: [f32; 4], signs: u32) -> Self {
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

    /// [`intersect_triangle`] for the ray that the shear was made of and a triangle that [has an area](has_area), its
    /// coordinates in the order of [`Shear::axes`].
    #[inline(always)]
    pub fn intersect(&self, ray: &Ray, corners: [Point; 3]) -> Option<(f32, f32, f32)> {
        let points = [self.project(corners[0]), self.project(corners[1]), self.project(corners[2])];
        let end = max(points[0][2], max(points[1][2], points[2][2]));
        let (t, u, v) = weigh(points)?;
        let (t_min, t_max) = (ray.t_min, ray.t_max);
        let t_clamped = self.clamp(t, corners);
        let t_max = min(t_max, FARTHEST);
        (t <= t_max && end >= t_min && t_min <= t_clamped && t_clamped <= t_max).then_some((t_clamped, u, v))
    }

    /// The distance, but not before the ray's line enters the box of the triangle as the traversal computes it.
    #[inline(always)]
    pub fn clamp(&self, t: f32, corners: [[f32; 3]; 3]) -> f32 {
        let mut enter = t;
        for axis in 0..3 {
            let near = Self::near(&corners, axis, self.side[axis]);
            enter = max((near - self.origin[axis]) * self.inverse[axis], enter);
        }
        enter
    }

    /// Least (side 0) or largest coordinate of the corners along an axis. Looked up, not chosen: the signs are
    /// hard to guess for the processor.
    #[inline(always)]
    pub fn near([a, b, c]: &[[f32; 3]; 3], axis: usize, side: usize) -> f32 {
        [min(a[axis], min(b[axis], c[axis])), max(a[axis], max(b[axis], c[axis]))][side & 1]
    }
}

/// Distance and weights of the second and third corner; `None` where the axis passes outside.
///
/// In double precision products are exact. So what is found lies on the triangle of the given points, and is off by
/// no more than their own rounding, however slender the triangle is.
#[inline(always)]
fn weigh(points: [Point; 3]) -> Option<(f32, f32, f32)> {
    let [e, f, g] = edges(points.map(|[x, y, _]| [f64::from(x), f64::from(y)]));
    let determinant = e + f + g;
    // Selections, for the signs of edges are hard to guess for the processor.
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

/// Twice the signed areas between the axis and each edge, in the order of the opposite corners.
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
    fn only_the_stretch_of_the_ray_counts() {
        let ray = Ray::new(Vec3::new(0.25, 0.25, 1.0), -Vec3::Z);
        assert!(intersect_triangle(&ray.up_to(1.0), A, B, C).is_some());
        assert!(intersect_triangle(&ray.up_to(0.99), A, B, C).is_none());
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
        // Edge-on: the plane holds the ray.
        assert_eq!(through(-Vec3::X, Vec3::X, -Vec3::Z), None);
        assert_eq!(intersect_triangle(&Ray::new(Vec3::Z, Vec3::ZERO), A, B, C), None);
    }

    /// The direction is so short that the distance in its units overflows.
    #[test]
    fn nothing_is_hit_at_infinity() {
        let ray = Ray::new(Vec3::new(0.25, 0.5, 2.0) * 1e20, -Vec3::Z * 1e-20);
        let [a, b, c] = [A, B, C].map(|corner| corner * 1e20);
        assert_eq!(intersect_triangle(&ray, a, b, c), None);
        assert!(intersect_triangle(&Ray { direction: -Vec3::Z * 1e-18, ..ray }, a, b, c).is_some());
    }

    #[test]
    fn size_does_not_matter() {
        for exponent in [-36, -30, -10, 10, 25, 30, 36] {
            let scale = 10f32.powi(exponent);
            let ray = Ray::new(Vec3::new(0.25, 0.5, 2.0) * scale, -Vec3::Z);
            let (t, u, v) = intersect_triangle(&ray, A * scale, B * scale, C * scale).unwrap();
            assert!((t / scale - 2.0).abs() < 1e-5, "{exponent}: {t}");
            assert!((u - 0.25).abs() < 1e-5 && (v - 0.5).abs() < 1e-5, "{exponent}: {u} {v}");
        }
    }
}
