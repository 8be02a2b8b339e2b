//! Rectangle emitter, sampled uniformly by solid angle (Ureña, Fajardo, King, An Area-Preserving
//! Parametrization for Spherical Rectangles, 2013).
//!
//! Deviation: the angles of the spherical rectangle come from arctangents, which stay accurate
//! where the shading point lies almost in the rectangle's plane.

use super::{AreaSample, Flat, area_sample, uniform_area_pdf};
use juggler_math::{Aabb, DVec3, Vec2, Vec3, portable};
use std::f64::consts::TAU;

/// Below this solid angle the rectangle is sampled by area: the mapping would lose precision, and
/// the densities hardly differ.
const MIN_SOLID_ANGLE: f64 = 1e-7;

/// Rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RectangleEmitter {
    pub(super) corner: DVec3,
    pub(super) edges: [DVec3; 2],
    lengths: [f64; 2],
    normal: DVec3,
    flat: Flat,
}

/// Rectangle as seen from a point: coordinates along its edges, with the origin at the projection
/// of the point onto the rectangle's plane.
#[derive(Clone, Copy, Debug)]
struct View {
    x: [f64; 2],
    y: [f64; 2],
    height: f64,
    /// Sum of the spherical rectangle's interior angles at the corners on `x[0]`.
    far_angles: f64,
    solid_angle: f64,
}

impl RectangleEmitter {
    /// Creates a rectangle in world space from a corner and its two edges, whose cross product
    /// points to the front. `None` if it is skewed by more than rounding, has no area, or is not
    /// finite.
    pub fn new(corner: Vec3, edges: [Vec3; 2]) -> Option<Self> {
        let edges = edges.map(Vec3::as_dvec3);
        let lengths = edges.map(DVec3::length);
        let cross = edges[0].cross(edges[1]);
        let skew = edges[0].dot(edges[1]).abs() / (lengths[0] * lengths[1]);
        let usable = corner.is_finite() && cross.length() < f64::INFINITY && skew < 1e-5;
        let normal = cross.normalize_or_zero();
        let corner = corner.as_dvec3();
        let flat = Flat::new(corner, edges, false);
        (usable && normal != DVec3::ZERO).then_some(Self { corner, edges, lengths, normal, flat })
    }

    fn view(&self, from: DVec3) -> View {
        let to_corner = self.corner - from;
        let start = [0, 1].map(|i| to_corner.dot(self.edges[i]) / self.lengths[i]);
        let (x, y) = ([start[0], start[0] + self.lengths[0]], [start[1], start[1] + self.lengths[1]]);
        let height = to_corner.dot(self.normal).abs();
        let angle = |x: f64, y: f64, sign: f64| {
            portable::atan2_f64(height * (x * x + y * y + height * height).sqrt(), sign * x * y)
        };
        let near_angles = angle(x[1], y[0], 1.0) + angle(x[1], y[1], -1.0);
        let far_angles = angle(x[0], y[1], 1.0) + angle(x[0], y[0], -1.0);
        View { x, y, height, far_angles, solid_angle: near_angles + far_angles - TAU }
    }

    pub(super) fn sample(&self, from: Vec3, u: Vec2) -> Option<AreaSample> {
        if self.flat.is_distant(from) {
            return self.flat.sample(from, u);
        }
        let from = from.as_dvec3();
        let view = self.view(from);
        let small = view.solid_angle < MIN_SOLID_ANGLE;
        let u = u.as_dvec2();
        let uv = if small {
            u
        } else {
            let point = view.point(u.x, u.y);
            let along_edge = |i: usize, v: f64, start: f64| ((v - start) / self.lengths[i]).clamp(0.0, 1.0);
            (along_edge(0, point.0, view.x[0]), along_edge(1, point.1, view.y[0])).into()
        };
        let point = self.corner + self.edges[0] * uv.x + self.edges[1] * uv.y;
        let area_pdf = || uniform_area_pdf(from, point, self.normal, self.area());
        let pdf = if small { area_pdf() } else { 1.0 / view.solid_angle };
        area_sample(from, point, self.normal, pdf).map(|sample| AreaSample { uv: uv.as_vec2(), ..sample })
    }

    pub(super) fn pdf(&self, from: Vec3, point: Vec3) -> f32 {
        if self.flat.is_distant(from) {
            return self.flat.pdf(from, point);
        }
        let from = from.as_dvec3();
        let solid_angle = self.view(from).solid_angle;
        if solid_angle >= MIN_SOLID_ANGLE {
            return (1.0 / solid_angle) as f32;
        }
        uniform_area_pdf(from, point.as_dvec3(), self.normal, self.area()) as f32
    }

    pub(super) fn area(&self) -> f64 {
        self.edges[0].cross(self.edges[1]).length()
    }

    pub(super) fn normal(&self) -> Vec3 {
        self.normal.as_vec3()
    }

    pub(super) fn bounds(&self) -> Aabb {
        let opposite = self.corner + self.edges[0] + self.edges[1];
        super::box_around([self.corner, self.corner + self.edges[0], self.corner + self.edges[1], opposite])
    }
}

impl View {
    /// Point for `u` and `v`, in the view's coordinates (section 4 of the paper, with its z axis
    /// reversed).
    fn point(&self, u: f64, v: f64) -> (f64, f64) {
        let height = self.height;
        let slope = |y: f64| y / (y * y + height * height).sqrt();
        let (low, high) = (-slope(self.y[0]), slope(self.y[1]));
        // Find the x that has the fraction u of the solid angle on its left.
        let angle = u * self.solid_angle + TAU - self.far_angles;
        let (sin, cos) = portable::sin_cos_f64(angle);
        let f = (cos * low - high) / sin;
        let c = (1.0 / (f * f + low * low).sqrt()).min(1.0);
        let c = if f > 0.0 { c } else { -c };
        let x = (c * height / (1.0 - c * c).max(f64::MIN_POSITIVE).sqrt()).clamp(self.x[0], self.x[1]);
        // Sample y on this line, uniformly in the sine of the elevation.
        let squared = x * x + height * height;
        let sine = |y: f64| y / (squared + y * y).sqrt();
        let (start, end) = (sine(self.y[0]), sine(self.y[1]));
        let s = start + v * (end - start);
        let y = s * (squared / (1.0 - s * s).max(f64::MIN_POSITIVE)).sqrt();
        (x, y.clamp(self.y[0], self.y[1]))
    }
}
