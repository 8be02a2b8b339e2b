//! Up to eight rays side by side, to test all against one box.

use crate::lanes::{Lanes, bits, max};
use crate::node::WIDTH;
use crate::slabs::{WIDEN, cull_distance};
use fearless_simd::prelude::*;
use juggler_math::Ray;

/// Up to eight rays of one octant, coordinate by coordinate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayLanes {
    pub origin: [[f32; WIDTH]; 3],
    pub direction: [[f32; WIDTH]; 3],
    /// Of the directions, NaN where one overflows though the component is not zero.
    pub inverse: [[f32; WIDTH]; 3],
    pub t_min: [f32; WIDTH],
    /// In the sense of [`cull_distance`].
    t_max: [f32; WIDTH],
    /// Bit per axis: the directions' signs.
    pub signs: u32,
}

impl RayLanes {
    /// Lanes without a ray meet nothing.
    #[inline(always)]
    pub fn new<S: Lanes>(simd: S, rays: &[Ray]) -> Self {
        let mut lanes = Self {
            origin: [[0.0; WIDTH]; 3],
            direction: [[1.0; WIDTH]; 3],
            inverse: [[1.0; WIDTH]; 3],
            t_min: [f32::INFINITY; WIDTH],
            t_max: [f32::NEG_INFINITY; WIDTH],
            signs: 0,
        };
        for (lane, ray) in rays.iter().take(WIDTH).enumerate() {
            for axis in 0..3 {
                lanes.origin[axis][lane] = ray.origin[axis];
                lanes.direction[axis][lane] = ray.direction[axis];
            }
            lanes.t_min[lane] = ray.t_min;
            lanes.t_max[lane] = cull_distance(ray.t_max);
        }
        for axis in 0..3 {
            let direction = simd.load(&lanes.direction[axis]);
            let inverse = simd.splat(1.0) / direction;
            let overflows = inverse.abs().simd_gt(f32::MAX) & !direction.simd_eq(0.0);
            lanes.inverse[axis] = overflows.select(simd.splat(f32::NAN), inverse).into();
            lanes.signs |= u32::from(lanes.direction[axis][0].is_sign_negative()) << axis;
        }
        lanes
    }

    /// Tells how far the ray of a lane still goes.
    #[inline(always)]
    pub fn shorten(&mut self, lane: usize, t_max: f32) {
        self.t_max[lane & (WIDTH - 1)] = cull_distance(t_max);
    }

    /// The farthest that any ray goes, in the sense of [`cull_distance`].
    #[inline(always)]
    pub fn t_max(&self) -> f32 {
        self.t_max.iter().fold(f32::NEG_INFINITY, |a, &b| max(b, a))
    }

    /// Which rays meet the box in `slot` of the bounds (bit per lane).
    #[inline(always)]
    pub fn test<S: Lanes>(&self, simd: S, bounds: &[[[f32; WIDTH]; 2]; 3], slot: usize) -> u32 {
        let slot = slot & (WIDTH - 1);
        let mut enter = simd.load(&self.t_min);
        let mut leave = simd.splat(f32::MAX);
        for axis in 0..3 {
            let side = (self.signs >> axis) as usize & 1;
            let (near, far) = (bounds[axis][side][slot], bounds[axis][side ^ 1][slot]);
            let (origin, inverse) = (simd.load(&self.origin[axis]), simd.load(&self.inverse[axis]));
            // In this order, so that a NaN leaves the range as it is.
            enter = simd.most((simd.splat(near) - origin) * inverse, enter);
            leave = simd.least((simd.splat(far) - origin) * inverse, leave);
        }
        bits(enter.simd_le(simd.least(leave * WIDEN, simd.load(&self.t_max))))
    }
}
