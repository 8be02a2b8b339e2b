//! Single-precision part of [`Shear::intersect`] in eight lanes: one ray and eight triangles, or
//! eight rays and one triangle. The operations are those of the scalar test. The few remaining
//! candidates are then tested in double precision.

use crate::lanes::{Lanes, bits};
use crate::triangle::{Shear, edges};
use fearless_simd::prelude::*;
use fearless_simd::{f32x8, f64x4};

/// Eight rays in their sheared frames, or one ray in all lanes.
#[derive(Clone, Copy)]
pub(super) struct RayFrames<S: Simd> {
    pub origin: [f32x8<S>; 3],
    pub factors: [f32x8<S>; 3],
    pub t_min: f32x8<S>,
    pub t_max: f32x8<S>,
}

/// Eight points, coordinate by coordinate.
pub(super) type Corner<S> = [f32x8<S>; 3];

// Closures over vectors would not be compiled for the SIMD level, so there are none below.

#[inline(always)]
pub(super) fn splat<S: Lanes>(simd: S, [x, y, z]: [f32; 3]) -> Corner<S> {
    [simd.splat(x), simd.splat(y), simd.splat(z)]
}

impl<S: Lanes> RayFrames<S> {
    /// Broadcasts a ray. Recomputed in each leaf: broadcasts from memory are cheaper than spilled
    /// vectors.
    #[inline(always)]
    pub fn broadcast(simd: S, shear: &Shear, t_min: f32, t_max: f32) -> Self {
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

    /// Transforms the vertices to the rays' frames. Returns a bit mask of the lanes in `among` that
    /// may hit, and the vertices. A lane is a candidate if its edge functions do not differ in sign
    /// and its interval overlaps the range of the vertices' depths.
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

/// Double-precision part for the candidates: distances, and weights of the second and third vertex;
/// the distance is NaN for a miss. The operations are those of [`Shear::intersect`], four lanes at
/// a time, since the candidates mostly lie in one half.
#[inline(always)]
pub(super) fn intersect_double<S: Lanes>(simd: S, [a, b, c]: [Corner<S>; 3], candidates: u32) -> [[f32; 8]; 3] {
    let none = f64x4::splat(simd, f64::NAN);
    let ([a_low, a_high], [b_low, b_high], [c_low, c_high]) = (halves(a), halves(b), halves(c));
    let (mut low, mut high) = ([none; 3], [none; 3]);
    if candidates & 0x0f != 0 {
        low = intersect_double_half(simd, [a_low, b_low, c_low]);
    }
    if candidates & 0xf0 != 0 {
        high = intersect_double_half(simd, [a_high, b_high, c_high]);
    }
    let [t, u, v] = [low[0].narrow(high[0]), low[1].narrow(high[1]), low[2].narrow(high[2])];
    [t.into(), u.into(), v.into()]
}

/// Four points in double precision, coordinate by coordinate.
type Half<S> = [f64x4<S>; 3];

#[inline(always)]
fn halves<S: Lanes>([x, y, z]: Corner<S>) -> [Half<S>; 2] {
    let ((x_low, x_high), (y_low, y_high), (z_low, z_high)) = (x.widen(), y.widen(), z.widen());
    [[x_low, y_low, z_low], [x_high, y_high, z_high]]
}

#[inline(always)]
fn intersect_double_half<S: Lanes>(simd: S, [a, b, c]: [Half<S>; 3]) -> [f64x4<S>; 3] {
    let [e, f, g] = edges([[a[0], a[1]], [b[0], b[1]], [c[0], c[1]]]);
    let determinant = e + f + g;
    let zero = f64x4::splat(simd, 0.0);
    let misses = e.simd_lt(zero) | f.simd_lt(zero) | g.simd_lt(zero);
    let outside = misses & (e.simd_gt(zero) | f.simd_gt(zero) | g.simd_gt(zero));
    let has_area = determinant.abs().simd_lt(f64::INFINITY) & !determinant.simd_eq(zero);
    let inverse = f64x4::splat(simd, 1.0) / determinant;
    let (e, f, g) = (e * inverse, f * inverse, g * inverse);
    let t = e * a[2] + f * b[2] + g * c[2];
    [(has_area & !outside).select(t, f64x4::splat(simd, f64::NAN)), f, g]
}

/// [`intersect_double`] in single precision, for all lanes.
#[inline(always)]
pub(super) fn intersect_single<S: Lanes>(simd: S, [a, b, c]: [Corner<S>; 3]) -> [[f32; 8]; 3] {
    let [e, f, g] = edges([[a[0], a[1]], [b[0], b[1]], [c[0], c[1]]]);
    let determinant = e + f + g;
    let inverse = simd.splat(1.0) / determinant;
    let (e, f, g) = (e * inverse, f * inverse, g * inverse);
    let t = e * a[2] + f * b[2] + g * c[2];
    let is_hit = t.abs().simd_lt(f32::INFINITY) & !determinant.simd_eq(0.0);
    [is_hit.select(t, simd.splat(f32::NAN)).into(), f.into(), g.into()]
}
