//! The first half of [`Shear::intersect`], eight at a time: one ray and eight triangles, or eight rays and one
//! triangle. Operation by operation the same as for one and one; the few lanes that may hit are then settled in
//! double precision.

use crate::lanes::{Lanes, bits};
use crate::triangle::{Shear, edges};
use fearless_simd::f32x8;
use fearless_simd::prelude::*;

/// Eight rays in the frames that their shears make, or one ray eight times.
#[derive(Clone, Copy)]
pub(super) struct Lines<S: Simd> {
    pub origin: [f32x8<S>; 3],
    pub factors: [f32x8<S>; 3],
    pub t_min: f32x8<S>,
    pub t_max: f32x8<S>,
}

/// Eight numbers on each axis.
pub(super) type Corner<S> = [f32x8<S>; 3];

// No closures over vectors in what follows: they would not be made for the vector unit.

#[inline(always)]
pub(super) fn splat<S: Lanes>(simd: S, [x, y, z]: [f32; 3]) -> Corner<S> {
    [simd.splat(x), simd.splat(y), simd.splat(z)]
}

impl<S: Lanes> Lines<S> {
    /// One ray, eight times. Made for each leaf anew: broadcasts from memory cost less than spilled vectors.
    #[inline(always)]
    pub fn of_one(simd: S, shear: &Shear, t_min: f32, t_max: f32) -> Self {
        Self {
            origin: splat(simd, shear.origin),
            factors: splat(simd, shear.factors),
            t_min: simd.splat(t_min),
            t_max: simd.splat(t_max),
        }
    }

    #[inline(always)]
    fn project(&self, corner: &Corner<S>) -> Corner<S> {
        let (x, y, z) = (corner[0] - self.origin[0], corner[1] - self.origin[1], corner[2] - self.origin[2]);
        [x - self.factors[0] * z, y - self.factors[1] * z, z]
    }

    /// Lanes in `among` that may hit (bit per lane): whose line passes no two edges on different sides, and passes within
    /// its range between the least and the largest depth of the corners.
    #[inline(always)]
    pub fn candidates(&self, simd: S, corners: [Corner<S>; 3], among: u32) -> u32 {
        let (a, b, c) = (self.project(&corners[0]), self.project(&corners[1]), self.project(&corners[2]));
        let [u, v, w] = edges([[a[0], a[1]], [b[0], b[1]], [c[0], c[1]]]);
        let zero = simd.splat(0.0);
        let outside = simd.least(u, simd.least(v, w)).simd_lt(zero) & simd.most(u, simd.most(v, w)).simd_gt(zero);
        let inside = among & !bits(outside);
        if inside == 0 {
            return 0;
        }
        let (a, b, c) = (a[2] * self.factors[2], b[2] * self.factors[2], c[2] * self.factors[2]);
        let start = simd.least(a, simd.least(b, c)).simd_le(self.t_max);
        let end = simd.most(a, simd.most(b, c)).simd_ge(self.t_min);
        inside & bits(start & end)
    }
}
