//! Points on a mesh, sampled by area at a time while the shutter is open.
//!
//! The probability of a triangle of a moving mesh is proportional to its mean area, so it does not
//! depend on time. The density on the triangle follows from its area at the time.

use super::Mesh;
use super::prepared::PreparedMesh;
use crate::solid_angle::{area_pdf, area_sample, select_by_weight};
use crate::{ShapeSample, SurfacePoint};
use juggler_math::{Vec2, Vec3, warp};

impl Mesh {
    /// [`Shape::sample`](crate::Shape::sample) at a time, 0 to 1 over the shutter interval.
    pub fn sample_at(&self, from: Vec3, u: Vec2, time: f32) -> Option<ShapeSample> {
        let prepared = self.prepared.as_ref()?;
        let (index, rest) = select_by_weight(prepared.running_areas(), u.x)?;
        let at = warp::uniform_triangle(Vec2::new(rest, u.y)).truncate().as_dvec2();
        let (point, normal) = prepared.triangle_geometry(index, time)?.point(at);
        area_sample(from, point, normal, effective_area(prepared, index, time)?)
    }

    /// [`Shape::pdf`](crate::Shape::pdf) at a time, 0 to 1 over the shutter interval.
    pub fn pdf_at(&self, from: Vec3, at: &SurfacePoint, time: f32) -> f32 {
        let area = self.prepared.as_ref().and_then(|it| effective_area(it, at.primitive as usize, time));
        area.map_or(0.0, |area| area_pdf(from, at, area))
    }
}

/// Reciprocal of the density per area of the points that [`Mesh::sample_at`] picks on a triangle:
/// the total area, or for a moving mesh its ratio to the triangle's mean area times the triangle's
/// area at the time. `None` if the triangle is never picked.
fn effective_area(prepared: &PreparedMesh, triangle: usize, time: f32) -> Option<f32> {
    if prepared.bvh().is_some() {
        return Some(prepared.area());
    }
    let sums = prepared.running_areas();
    let below = triangle.checked_sub(1).map_or(Some(0.0), |before| sums.get(before).copied())?;
    let (weight, total) = (sums.get(triangle)? - below, sums.last()?);
    let area = prepared.triangle_geometry(triangle, time)?.area();
    (weight > 0.0).then(|| (total * area / weight) as f32)
}
