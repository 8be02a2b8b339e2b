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

    /// The corners in the frames of the lines, and the lanes in `among` that may hit (bit per lane): whose line
    /// passes no two edges on different sides, and passes within its range between the least and the largest
    /// depth of the corners.
    #[inline(always)]
    pub fn candidates(&self, simd: S, corners: &[Corner<S>; 3], among: u32) -> (u32, [Corner<S>; 3]) {
        let (mut a, mut b, mut c) = (self.project(&corners[0]), self.project(&corners[1]), self.project(&corners[2]));
        let [u, v, w] = edges([[a[0], a[1]], [b[0], b[1]], [c[0], c[1]]]);
        let zero = simd.splat(0.0);
        let outside = simd.least(u, simd.least(v, w)).simd_lt(zero) & simd.most(u, simd.most(v, w)).simd_gt(zero);
        let inside = among & !bits(outside);
        if inside == 0 {
            return (0, [a, b, c]);
        }
        (a[2], b[2], c[2]) = (a[2] * self.factors[2], b[2] * self.factors[2], c[2] * self.factors[2]);
        let start = simd.least(a[2], simd.least(b[2], c[2])).simd_le(self.t_max);
        let end = simd.most(a[2], simd.most(b[2], c[2])).simd_ge(self.t_min);
        (inside & bits(start & end), [a, b, c])
    }
}

/// The second half for all eight lanes: distances, and weights of the second and third corner; a distance that is
/// no number where the line passes outside. As [`weigh`](crate::triangle::weigh) does it.
#[inline(always)]
pub(super) fn settle<S: Lanes>([a, b, c]: [Corner<S>; 3]) -> [[f32; 8]; 3] {
    let [ax, ay, az]: [[f32; 8]; 3] = [a[0].into(), a[1].into(), a[2].into()];
    let [bx, by, bz]: [[f32; 8]; 3] = [b[0].into(), b[1].into(), b[2].into()];
    let [cx, cy, cz]: [[f32; 8]; 3] = [c[0].into(), c[1].into(), c[2].into()];
    let (mut t, mut u, mut v) = ([0.0; 8], [0.0; 8], [0.0; 8]);
    for lane in 0..8 {
        let double = |number: f32| f64::from(number);
        let [ax, ay, az] = [double(ax[lane]), double(ay[lane]), double(az[lane])];
        let [bx, by, bz] = [double(bx[lane]), double(by[lane]), double(bz[lane])];
        let [cx, cy, cz] = [double(cx[lane]), double(cy[lane]), double(cz[lane])];
        let [e, f, g] = edges([[ax, ay], [bx, by], [cx, cy]]);
        let determinant = e + f + g;
        let misses = (e < 0.0) | (f < 0.0) | (g < 0.0);
        let outside = misses & ((e > 0.0) | (f > 0.0) | (g > 0.0));
        let flat = (determinant == 0.0) | !determinant.is_finite();
        let inverse = 1.0 / determinant;
        let (e, f, g) = (e * inverse, f * inverse, g * inverse);
        let distance = (e * az + f * bz + g * cz) as f32;
        t[lane] = if outside | flat { f32::NAN } else { distance };
        (u[lane], v[lane]) = (f as f32, g as f32);
    }
    [t, u, v]
}

/// [`settle`] in single precision.
#[inline(always)]
pub(super) fn settle_fast<S: Lanes>(simd: S, [a, b, c]: [Corner<S>; 3]) -> [[f32; 8]; 3] {
    let [e, f, g] = edges([[a[0], a[1]], [b[0], b[1]], [c[0], c[1]]]);
    let determinant = e + f + g;
    let inverse = simd.splat(1.0) / determinant;
    let (e, f, g) = (e * inverse, f * inverse, g * inverse);
    let t = e * a[2] + f * b[2] + g * c[2];
    let is_hit = t.abs().simd_lt(f32::INFINITY) & !determinant.simd_eq(0.0);
    [is_hit.select(t, simd.splat(f32::NAN)).into(), f.into(), g.into()]
}
