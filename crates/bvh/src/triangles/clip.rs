//! Boxes of parts of triangles.

use super::build::{Mesh, margin_of};
use crate::build::{Divide, Extent, extent};
use juggler_math::{Aabb, DVec3, Vec3};

impl Divide for Mesh<'_> {
    /// The box of a part is as much larger than the part as that of a whole triangle than the triangle, and for the
    /// same reason: what the triangle's test finds lies that near to a point of the triangle, which lies in some part.
    fn divide(&self, item: u32, bounds: Extent, axis: usize, at: f32) -> [Extent; 2] {
        let Ok(corners) = self.corners(item as usize) else { return [bounds, Extent::EMPTY] };
        let margin = DVec3::splat(f64::from(margin_of(corners)));
        let parts = parts(corners.map(Vec3::as_dvec3), axis, f64::from(at));
        parts.map(|(low, high)| {
            // One step further than to the nearest, for rounding.
            let low = (low - margin).as_vec3().to_array().map(f32::next_down);
            let high = (high + margin).as_vec3().to_array().map(f32::next_up);
            extent(Extent::raw(&Aabb { min: low.into(), max: high.into() })).intersection(bounds)
        })
    }
}

/// Least and largest coordinates of what lies below and above a plane, with what lies in it; infinite where nothing does.
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
