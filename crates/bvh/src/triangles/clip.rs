//! Bounds of clipped triangles for spatial splits.

use super::build::{TriangleList, margin_of};
use crate::build::{ItemSplitter, SimdBox, checked_box};
use juggler_math::{Aabb, DVec3, Vec3};

impl ItemSplitter for TriangleList<'_> {
    /// Bounds of the parts have the same margin as those of the whole triangle, for the same
    /// reason: a hit that the triangle test reports lies within this margin of a point of the
    /// triangle, and that point belongs to one of the parts.
    fn split(&self, item: u32, bounds: SimdBox, axis: usize, at: f32) -> [SimdBox; 2] {
        let Ok(corners) = self.corners(item as usize) else { return [bounds, SimdBox::EMPTY] };
        let margin = DVec3::splat(f64::from(margin_of(corners)));
        let parts = parts(corners.map(Vec3::as_dvec3), axis, f64::from(at));
        parts.map(|(low, high)| {
            // Round outward.
            let low = (low - margin).as_vec3().to_array().map(f32::next_down);
            let high = (high + margin).as_vec3().to_array().map(f32::next_up);
            checked_box(SimdBox::raw(&Aabb { min: low.into(), max: high.into() })).intersection(bounds)
        })
    }
}

/// Bounds of the parts below and above a plane, both including the plane itself; infinite where a
/// part is empty.
fn parts(corners: [DVec3; 3], axis: usize, at: f64) -> [(DVec3, DVec3); 2] {
    let mut parts = [(DVec3::INFINITY, DVec3::NEG_INFINITY); 2];
    let mut add = |side: usize, point: DVec3| parts[side] = (parts[side].0.min(point), parts[side].1.max(point));
    for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (corners[a], corners[b])) {
        if a[axis] <= at {
            add(0, a);
        }
        if a[axis] >= at {
            add(1, a);
        }
        if a[axis] < at && at < b[axis] || b[axis] < at && at < a[axis] {
            let crossing = a + (b - a) * ((at - a[axis]) / (b[axis] - a[axis]));
            [0, 1].into_iter().for_each(|side| add(side, crossing));
        }
    }
    parts
}
