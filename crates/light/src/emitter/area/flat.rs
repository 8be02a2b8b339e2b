//! Sampling of distant rectangles and triangles uniformly by area, in single precision. At a small
//! solid angle this is nearly uniform by solid angle, and several times as fast.

use super::AreaSample;
use juggler_math::{DVec3, Vec2, Vec3, warp};

/// Minimum ratio of the squared distance to the area of a surface that counts as distant.
const DISTANT_RATIO: f64 = 3.0;

/// Rectangle or triangle, given by two edges from a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flat {
    corner: Vec3,
    edges: [Vec3; 2],
    normal: Vec3,
    center: Vec3,
    area: f32,
    /// Minimum squared distance to the center at which the surface counts as distant.
    min_squared_distance: f32,
    is_triangle: bool,
}

impl Flat {
    /// Creates a rectangle, or a triangle with the same edges.
    pub fn new(corner: DVec3, edges: [DVec3; 2], is_triangle: bool) -> Self {
        let cross = edges[0].cross(edges[1]);
        let (corner_weight, area) = if is_triangle { (1.0 / 3.0, 0.5 * cross.length()) } else { (0.5, cross.length()) };
        // Treat a slender surface as a square of its length.
        let size = edges[0].length_squared().max(edges[1].length_squared()).max(area);
        Self {
            corner: corner.as_vec3(),
            edges: edges.map(|edge| edge.as_vec3()),
            normal: cross.normalize_or_zero().as_vec3(),
            center: (corner + (edges[0] + edges[1]) * corner_weight).as_vec3(),
            area: area as f32,
            min_squared_distance: (DISTANT_RATIO * size) as f32,
            is_triangle,
        }
    }

    /// Whether the surface is distant enough from `from` for sampling by area.
    #[inline]
    pub fn is_distant(&self, from: Vec3) -> bool {
        let squared = (self.center - from).length_squared();
        squared >= self.min_squared_distance && squared < 1e30 && self.min_squared_distance > 1e-30
    }

    /// Samples a point uniformly by area.
    #[inline]
    pub fn sample(&self, from: Vec3, u: Vec2) -> Option<AreaSample> {
        let uv = if self.is_triangle { warp::uniform_triangle(u).truncate() } else { u };
        let point = self.corner + self.edges[0] * uv.x + self.edges[1] * uv.y;
        let to_point = point - from;
        let squared = to_point.length_squared();
        let distance = squared.sqrt();
        let wi = to_point * (1.0 / distance);
        let pdf = squared / (wi.dot(self.normal).abs() * self.area);
        let usable = pdf > 0.0 && pdf < f32::INFINITY;
        usable.then_some(AreaSample { point, normal: self.normal, uv, wi, distance, pdf })
    }

    /// Density per steradian with which [`Flat::sample`] samples the direction to `point`.
    #[inline]
    pub fn pdf(&self, from: Vec3, point: Vec3) -> f32 {
        let to_point = point - from;
        let squared = to_point.length_squared();
        let pdf = squared * squared.sqrt() / (to_point.dot(self.normal).abs() * self.area);
        if pdf < f32::INFINITY { pdf } else { 0.0 }
    }
}
