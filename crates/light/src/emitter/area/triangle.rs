//! A triangle that shines: even over its solid angle (Arvo, Stratified Sampling of Spherical Triangles, 1995; PBR 4th
//! ed., section 6.5.4). The solid angle itself is that of Van Oosterom and Strackee (1983).

use super::{AreaSample, Flat, area_density, seen};
use juggler_math::{Aabb, DVec3, Vec2, Vec3, fun, warp};
use std::f64::consts::PI;

/// Solid angles outside this range are sampled by area: too small for the map's digits, or the whole half space,
/// whose triangle has no corners.
const LEAST_SOLID_ANGLE: f64 = 1e-6;
const MOST_SOLID_ANGLE: f64 = 6.2;

/// A triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleEmitter {
    pub(super) corner: DVec3,
    pub(super) edges: [DVec3; 2],
    /// Cross product of the edges.
    cross: DVec3,
    flat: Flat,
}

impl TriangleEmitter {
    /// A triangle in world space, its corners counter-clockwise as the front is seen; `None` for one without area or
    /// that is not finite.
    pub fn new(corners: [Vec3; 3]) -> Option<Self> {
        let [corner, second, third] = corners.map(Vec3::as_dvec3);
        let edges = [second - corner, third - corner];
        let cross = edges[0].cross(edges[1]);
        let area = cross.length();
        let flat = Flat::new(corner, edges, true);
        (corner.is_finite() && area > 0.0 && area < f64::INFINITY).then_some(Self { corner, edges, cross, flat })
    }

    /// Directions to the corners, and the solid angle.
    fn view(&self, from: DVec3) -> ([DVec3; 3], f64) {
        let to_corner = self.corner - from;
        let ways = [to_corner, to_corner + self.edges[0], to_corner + self.edges[1]];
        let lengths = ways.map(DVec3::length);
        let [a, b, c] = [0, 1, 2].map(|i| ways[i] / lengths[i]);
        let volume = to_corner.dot(self.cross).abs() / (lengths[0] * lengths[1] * lengths[2]);
        ([a, b, c], 2.0 * fun::atan2_f64(volume, 1.0 + a.dot(b) + b.dot(c) + c.dot(a)))
    }

    pub(super) fn sample(&self, from: Vec3, u: Vec2) -> Option<AreaSample> {
        if self.flat.is_far(from) {
            return self.flat.sample(from, u);
        }
        let from = from.as_dvec3();
        let (corners, solid_angle) = self.view(from);
        let wide = (LEAST_SOLID_ANGLE..MOST_SOLID_ANGLE).contains(&solid_angle);
        let shares = if wide { self.shares(from, direction(corners, solid_angle, u)) } else { None };
        let (second, third) = shares.unwrap_or_else(|| {
            let even = warp::uniform_triangle(u);
            (f64::from(even.y), f64::from(even.z))
        });
        let point = self.corner + self.edges[0] * second + self.edges[1] * third;
        let normal = self.cross.normalize();
        let pdf = if wide { 1.0 / solid_angle } else { area_density(from, point, normal, self.area()) };
        let edges = Vec2::new(second as f32, third as f32);
        seen(from, point, normal, pdf).map(|sample| AreaSample { edges, ..sample })
    }

    /// Where the ray meets the triangle, in shares of the edges; moved to the border where rounding leads outside.
    fn shares(&self, from: DVec3, direction: DVec3) -> Option<(f64, f64)> {
        let determinant = direction.dot(self.cross);
        let off = (from - self.corner).cross(direction);
        let second = (-self.edges[1].dot(off) / determinant).max(0.0);
        let third = (self.edges[0].dot(off) / determinant).max(0.0);
        let sum = (second + third).max(1.0);
        (sum < f64::INFINITY).then(|| (second / sum, third / sum))
    }

    pub(super) fn pdf(&self, from: Vec3, point: Vec3) -> f32 {
        if self.flat.is_far(from) {
            return self.flat.pdf(from, point);
        }
        let from = from.as_dvec3();
        let solid_angle = self.view(from).1;
        if (LEAST_SOLID_ANGLE..MOST_SOLID_ANGLE).contains(&solid_angle) {
            return (1.0 / solid_angle) as f32;
        }
        area_density(from, point.as_dvec3(), self.cross.normalize(), self.area()) as f32
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

/// The part of `v` at right angles to a unit vector, with length 1.
fn beside(v: DVec3, unit: DVec3) -> DVec3 {
    (v - unit * v.dot(unit)).normalize_or_zero()
}

/// A direction in the spherical triangle with these corners: a new third corner, so that what remains has the share
/// `u.x` of the solid angle, then a place on the arc from the second corner to it.
fn direction([a, b, c]: [DVec3; 3], solid_angle: f64, u: Vec2) -> DVec3 {
    let (to_b, to_c) = (beside(b, a), beside(c, a));
    let (sin_a, cos_a) = (to_b.cross(to_c).length(), to_b.dot(to_c));
    let rest = PI + f64::from(u.x) * solid_angle - fun::atan2_f64(sin_a, cos_a);
    let (sin, cos) = fun::sin_cos_f64(rest);
    let k1 = cos + cos_a;
    let k2 = sin - sin_a * a.dot(b);
    let cos_side = ((k2 + (k2 * cos - k1 * sin) * cos_a) / ((k2 * sin + k1 * cos) * sin_a)).clamp(-1.0, 1.0);
    let cos_side = if cos_side.is_nan() { 1.0 } else { cos_side };
    let third = a * cos_side + to_c * (1.0 - cos_side * cos_side).sqrt();
    // 1 - cos, without the cancellation.
    let fall = f64::from(u.y) * 0.5 * (third - b).length_squared();
    b * (1.0 - fall) + beside(third, b) * (fall * (2.0 - fall)).max(0.0).sqrt()
}
