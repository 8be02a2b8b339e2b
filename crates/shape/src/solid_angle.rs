//! Points picked evenly by area, and their density as the place that asks sees it.

use super::{SurfacePoint, SurfaceSample};
use juggler_math::Vec3;

/// Density per steradian seen from `from` of a point that is picked evenly among `area`: `distance² / (area cos)`
/// (PBR 4th ed., section 4.2.3).
pub fn density(from: Vec3, point: Vec3, normal: Vec3, area: f32) -> f32 {
    // In f64: squares of small distances do not vanish, those of large ones do not overflow.
    let way = point.as_dvec3() - from.as_dvec3();
    let squared = way.length_squared();
    let cosine = (way.dot(normal.as_dvec3()) / squared.sqrt()).abs();
    (squared / (f64::from(area) * cosine)) as f32
}

/// A point picked evenly among `area`, if `from` does not see it edge-on.
pub fn area_sample(from: Vec3, point: Vec3, normal: Vec3, area: f32) -> Option<SurfaceSample> {
    let pdf = density(from, point, normal, area);
    (pdf > 0.0 && pdf < f32::INFINITY).then_some(SurfaceSample { point, normal, pdf })
}

/// Density per steradian, seen from `from`, of a point that is picked evenly among `area`; 0 where
/// it is seen edge-on.
pub fn area_pdf(from: Vec3, at: &SurfacePoint, area: f32) -> f32 {
    let pdf = density(from, at.point, at.normal, area);
    if pdf < f32::INFINITY { pdf } else { 0.0 }
}

/// Picks one of several parts by weight: its index, and `u` stretched to the unit interval again.
/// `cumulative` holds running sums of weights, its last entry their total.
pub fn pick(cumulative: &[f64], u: f32) -> Option<(usize, f32)> {
    let total = *cumulative.last()?;
    let target = f64::from(u) * total;
    let index = cumulative.partition_point(|&sum| sum <= target).min(cumulative.len() - 1);
    let below = if index == 0 { 0.0 } else { *cumulative.get(index - 1)? };
    let weight = cumulative.get(index)? - below;
    (weight > 0.0).then(|| (index, (((target - below) / weight) as f32).clamp(0.0, 1.0 - f32::EPSILON)))
}
