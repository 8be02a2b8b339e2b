//! Rectangles and triangles from afar, where their solid angle is small: even over their area, in single precision,
//! which is several times as quick, and nearly as even over the solid angle.

use super::AreaSample;
use juggler_math::{DVec3, Vec2, Vec3, warp};

/// A surface is far from where the square of the distance to its centre is so many times its area.
const FAR: f64 = 3.0;

/// A flat surface with two edges from a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flat {
    corner: Vec3,
    edges: [Vec3; 2],
    normal: Vec3,
    center: Vec3,
    area: f32,
    /// The least squared distance that is far, of the centre.
    far: f32,
    is_triangle: bool,
}

impl Flat {
    /// A rectangle, or a triangle with the same edges.
    pub fn new(corner: DVec3, edges: [DVec3; 2], is_triangle: bool) -> Self {
        let cross = edges[0].cross(edges[1]);
        let (share, area) = if is_triangle { (1.0 / 3.0, 0.5 * cross.length()) } else { (0.5, cross.length()) };
        // Long and thin ones as squares of their length.
        let size = edges[0].length_squared().max(edges[1].length_squared()).max(area);
        Self {
            corner: corner.as_vec3(),
            edges: edges.map(|edge| edge.as_vec3()),
            normal: cross.normalize_or_zero().as_vec3(),
            center: (corner + (edges[0] + edges[1]) * share).as_vec3(),
            area: area as f32,
            far: (FAR * size) as f32,
            is_triangle,
        }
    }

    /// Whether this way is good enough.
    #[inline]
    pub fn is_far(&self, from: Vec3) -> bool {
        let squared = (self.center - from).length_squared();
        squared >= self.far && squared < 1e30 && self.far > 1e-30
    }

    /// A place, all equally likely.
    #[inline]
    pub fn sample(&self, from: Vec3, u: Vec2) -> Option<AreaSample> {
        let edges = if self.is_triangle { warp::uniform_triangle(u).truncate() } else { u };
        let point = self.corner + self.edges[0] * edges.x + self.edges[1] * edges.y;
        let way = point - from;
        let squared = way.length_squared();
        let distance = squared.sqrt();
        let wi = way * (1.0 / distance);
        let pdf = squared / (wi.dot(self.normal).abs() * self.area);
        let usable = pdf > 0.0 && pdf < f32::INFINITY;
        usable.then_some(AreaSample { point, normal: self.normal, edges, wi, distance, pdf })
    }

    /// Density per steradian with which [`Flat::sample`] picks the direction to `point`.
    #[inline]
    pub fn pdf(&self, from: Vec3, point: Vec3) -> f32 {
        let way = point - from;
        let squared = way.length_squared();
        let pdf = squared * squared.sqrt() / (way.dot(self.normal).abs() * self.area);
        if pdf < f32::INFINITY { pdf } else { 0.0 }
    }
}
