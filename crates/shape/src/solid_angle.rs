//! Uniform sampling by area, and its density by solid angle.

use super::{ShapeSample, SurfacePoint};
use juggler_math::Vec3;

/// Density per steradian, seen from `from`, of a point sampled uniformly on `area`:
/// `distance² / (area cos)` (PBR 4th ed., section 4.2.3).
pub fn solid_angle_density(from: Vec3, point: Vec3, normal: Vec3, area: f32) -> f32 {
    // In f64, squared distances neither underflow nor overflow.
    let offset = point.as_dvec3() - from.as_dvec3();
    let squared = offset.length_squared();
    let cosine = (offset.dot(normal.as_dvec3()) / squared.sqrt()).abs();
    (squared / (f64::from(area) * cosine)) as f32
}

/// Sample of a point that is uniform on `area`; `None` if `from` sees it edge-on.
pub fn area_sample(from: Vec3, point: Vec3, normal: Vec3, area: f32) -> Option<ShapeSample> {
    let pdf = solid_angle_density(from, point, normal, area);
    (pdf > 0.0 && pdf < f32::INFINITY).then_some(ShapeSample { point, normal, pdf })
}

/// Density per steradian, seen from `from`, of a point sampled uniformly on `area`; 0 if it is seen
/// edge-on.
pub fn area_pdf(from: Vec3, at: &SurfacePoint, area: f32) -> f32 {
    let pdf = solid_angle_density(from, at.point, at.normal, area);
    if pdf < f32::INFINITY { pdf } else { 0.0 }
}

/// Selects one of several parts by weight: its index, and `u` remapped to the unit interval; `None`
/// if there is none. `cumulative` holds running sums of weights, its last entry their total.
pub fn select_by_weight(cumulative: &[f64], u: f32) -> Option<(usize, f32)> {
    let total = *cumulative.last()?;
    let target = f64::from(u) * total;
    let index = cumulative.partition_point(|&sum| sum <= target).min(cumulative.len() - 1);
    let below = if index == 0 { 0.0 } else { *cumulative.get(index - 1)? };
    let weight = cumulative.get(index)? - below;
    (weight > 0.0).then(|| (index, (((target - below) / weight) as f32).clamp(0.0, 1.0 - f32::EPSILON)))
}
