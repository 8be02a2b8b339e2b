//! The watertight test of [`Shear::intersect`], eight at a time: one ray and eight triangles, or eight rays and
//! one triangle. Operation by operation the same as for one and one, so that every way gives the same bits.

use crate::lanes::{Bits, Lanes, bits};
use crate::triangle::{SAFE, Shear, edges, weigh_exactly};
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

/// Where lines and triangles meet, lane by lane; what lies in lanes whose bit is not set means nothing. The
/// distances are still to be [clamped](Shear::clamp).
pub(super) struct Meeting {
    pub mask: u32,
    pub t: [f32; 8],
    /// Weight of the second corner.
    pub u: [f32; 8],
    /// Weight of the third corner.
    pub v: [f32; 8],
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

    /// Tests the lanes in `among` against the triangle, or triangles, with these corners.
    #[inline(always)]
    pub fn meet(&self, simd: S, corners: [Corner<S>; 3], among: u32) -> Option<Meeting> {
        let points = [self.project(&corners[0]), self.project(&corners[1]), self.project(&corners[2])];
        let [a, b, c] = points;
        let [u, v, w] = edges([[a[0], a[1]], [b[0], b[1]], [c[0], c[1]]]);
        let zero = simd.splat(0.0);
        let least = simd.least(u, simd.least(v, w));
        let most = simd.most(u, simd.most(v, w));
        let mask = among & !bits(least.simd_lt(zero) & most.simd_gt(zero));
        if mask == 0 { None } else { self.measure(simd, points, [u, v, w], mask) }
    }

    /// Distances and weights of the lanes in `mask`, whose lines pass inside.
    #[inline(always)]
    fn measure(&self, simd: S, [a, b, c]: [Corner<S>; 3], edges: [f32x8<S>; 3], mask: u32) -> Option<Meeting> {
        let depth = self.factors[2];
        let [a, b, c] = [[a[0], a[1], depth * a[2]], [b[0], b[1], depth * b[2]], [c[0], c[1], depth * c[2]]];
        let end = simd.most(a[2], simd.most(b[2], c[2]));
        let determinant = edges[0] + edges[1] + edges[2];
        let inverse = simd.splat(1.0) / determinant;
        let [u, v, w] = [edges[0] * inverse, edges[1] * inverse, edges[2] * inverse];
        let t = u * a[2] + v * b[2] + w * c[2];
        let size = determinant.abs();
        let safe = size.simd_ge(SAFE.start) & size.simd_lt(SAFE.end);
        let zero = simd.splat(0.0);
        let on_edge = edges[0].simd_eq(zero) | edges[1].simd_eq(zero) | edges[2].simd_eq(zero);
        let ahead = bits(end.simd_ge(self.t_min));
        let exactly = mask & ahead & bits(on_edge | !safe);
        if exactly == 0 {
            let mask = mask & ahead & bits(t.simd_le(self.t_max));
            return (mask != 0).then(|| Meeting { mask, t: t.into(), u: v.into(), v: w.into() });
        }
        let mut meeting = Meeting { mask: mask & ahead, t: t.into(), u: v.into(), v: w.into() };
        meeting.correct(&[a, b, c].map(|point| point.map(Into::into)), exactly);
        meeting.mask &= bits(simd.load(&meeting.t).simd_le(self.t_max));
        (meeting.mask != 0).then_some(meeting)
    }
}

impl Meeting {
    /// Does the lanes in `mask` again in double precision.
    #[cold]
    fn correct(&mut self, points: &[[[f32; 8]; 3]; 3], mask: u32) {
        for lane in Bits(mask) {
            match weigh_exactly(points.map(|point| point.map(|numbers| numbers[lane]))) {
                Some(hit) => (self.t[lane], self.u[lane], self.v[lane]) = hit,
                None => self.mask &= !(1 << lane),
            }
        }
    }
}
