//! Triangle emitter, sampled uniformly by solid angle (Arvo, Stratified Sampling of Spherical
//! Triangles, 1995; PBR 4th ed., section 6.5.4). The solid angle is computed after Van Oosterom and
//! Strackee (1983).

use super::{AreaSample, Flat, area_sample, uniform_area_pdf};
use juggler_math::{Aabb, DVec3, Vec2, Vec3, portable, warp};
use std::f64::consts::PI;

/// Solid angles outside this range are sampled by area: smaller ones exceed the mapping's
/// precision, and a triangle that fills the hemisphere has no corners.
const MIN_SOLID_ANGLE: f64 = 1e-6;
const MAX_SOLID_ANGLE: f64 = 6.2;

/// Triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleEmitter {
    pub(super) corner: DVec3,
    pub(super) edges: [DVec3; 2],
    /// Cross product of the edges.
    cross: DVec3,
    flat: Flat,
}

impl TriangleEmitter {
    /// Creates a triangle in world space, with the corners counterclockwise as seen from the front.
    /// `None` if it has no area or is not finite.
    pub fn new(corners: [Vec3; 3]) -> Option<Self> {
        let [corner, second, third] = corners.map(Vec3::as_dvec3);
        let edges = [second - corner, third - corner];
        let cross = edges[0].cross(edges[1]);
        let area = cross.length();
        let flat = Flat::new(corner, edges, true);
        (corner.is_finite() && area > 0.0 && area < f64::INFINITY).then_some(Self { corner, edges, cross, flat })
    }

    /// Unit directions to the corners, and the solid angle in steradians.
    fn view(&self, from: DVec3) -> ([DVec3; 3], f64) {
        let to_corner = self.corner - from;
        let to_corners = [to_corner, to_corner + self.edges[0], to_corner + self.edges[1]];
        let lengths = to_corners.map(DVec3::length);
        let [a, b, c] = [0, 1, 2].map(|i| to_corners[i] / lengths[i]);
        let volume = to_corner.dot(self.cross).abs() / (lengths[0] * lengths[1] * lengths[2]);
        ([a, b, c], 2.0 * portable::atan2_f64(volume, 1.0 + a.dot(b) + b.dot(c) + c.dot(a)))
    }

    pub(super) fn sample(&self, from: Vec3, u: Vec2) -> Option<AreaSample> {
        if self.flat.is_distant(from) {
            return self.flat.sample(from, u);
        }
        let from = from.as_dvec3();
        let (corners, solid_angle) = self.view(from);
        let wide = (MIN_SOLID_ANGLE..MAX_SOLID_ANGLE).contains(&solid_angle);
        let hit = if wide { self.intersect(from, direction(corners, solid_angle, u)) } else { None };
        let (second, third) = hit.unwrap_or_else(|| {
            let even = warp::uniform_triangle(u);
            (f64::from(even.y), f64::from(even.z))
        });
        let point = self.corner + self.edges[0] * second + self.edges[1] * third;
        let normal = self.cross.normalize();
        let pdf = if wide { 1.0 / solid_angle } else { uniform_area_pdf(from, point, normal, self.area()) };
        let uv = Vec2::new(second as f32, third as f32);
        area_sample(from, point, normal, pdf).map(|sample| AreaSample { uv, ..sample })
    }

    /// Intersection of the ray with the triangle in units of the edges, clamped to the triangle to
    /// absorb rounding.
    fn intersect(&self, from: DVec3, direction: DVec3) -> Option<(f64, f64)> {
        let determinant = direction.dot(self.cross);
        let off = (from - self.corner).cross(direction);
        let second = (-self.edges[1].dot(off) / determinant).max(0.0);
        let third = (self.edges[0].dot(off) / determinant).max(0.0);
        let sum = (second + third).max(1.0);
        (sum < f64::INFINITY).then(|| (second / sum, third / sum))
    }

    pub(super) fn pdf(&self, from: Vec3, point: Vec3) -> f32 {
        if self.flat.is_distant(from) {
            return self.flat.pdf(from, point);
        }
        let from = from.as_dvec3();
        let solid_angle = self.view(from).1;
        if (MIN_SOLID_ANGLE..MAX_SOLID_ANGLE).contains(&solid_angle) {
            return (1.0 / solid_angle) as f32;
        }
        uniform_area_pdf(from, point.as_dvec3(), self.cross.normalize(), self.area()) as f32
    }

    pub(super) fn area(&self) -> f64 {
        0.5 * self.cross.length()
    }

    pub(super) fn normal(&self) -> Vec3 {
        self.cross.normalize().as_vec3()
    }

    pub(super) fn bounds(&self) -> Aabb {
        super::box_around([self.corner, self.corner + self.edges[0], self.corner + self.edges[1]])
    }
}

/// Normalized component of `v` perpendicular to a unit vector.
fn perpendicular(v: DVec3, unit: DVec3) -> DVec3 {
    (v - unit * v.dot(unit)).normalize_or_zero()
}

/// Samples a direction in the spherical triangle with these corners: first a new third corner that
/// leaves the fraction `u.x` of the solid angle, then a point on the arc from the second corner to
/// it.
fn direction([a, b, c]: [DVec3; 3], solid_angle: f64, u: Vec2) -> DVec3 {
    let (to_b, to_c) = (perpendicular(b, a), perpendicular(c, a));
    let (sin_a, cos_a) = (to_b.cross(to_c).length(), to_b.dot(to_c));
    let rest = PI + f64::from(u.x) * solid_angle - portable::atan2_f64(sin_a, cos_a);
    let (sin, cos) = portable::sin_cos_f64(rest);
    let k1 = cos + cos_a;
    let k2 = sin - sin_a * a.dot(b);
    let cos_side = ((k2 + (k2 * cos - k1 * sin) * cos_a) / ((k2 * sin + k1 * cos) * sin_a)).clamp(-1.0, 1.0);
    let cos_side = if cos_side.is_nan() { 1.0 } else { cos_side };
    let third = a * cos_side + to_c * (1.0 - cos_side * cos_side).sqrt();
    // Compute 1 - cos without cancellation.
    let one_minus_cos = f64::from(u.y) * 0.5 * (third - b).length_squared();
    b * (1.0 - one_minus_cos) + perpendicular(third, b) * (one_minus_cos * (2.0 - one_minus_cos)).max(0.0).sqrt()
}
