//! Eight single-precision SIMD lanes on any vector unit.
//!
//! The kernels are generic over the token of `fearless_simd` and compiled for every level of the
//! target (SSE2 to AVX-512, NEON, wasm, scalar); `dispatch!` at the entry of a query selects the
//! level of the tree. Results are the same bits at every level: they come from operations that
//! round the same way everywhere, and multiply-add, which may be fused or not, only occurs in
//! conservative tests that allow for its rounding.
//!
//! This module defines minimum and maximum with a NaN operand, which the library leaves open.

use fearless_simd::f32x8;
use fearless_simd::prelude::*;

/// SIMD operations that the kernels need beside the operators.
pub(crate) trait Lanes: Simd {
    /// Minimum of two numbers; the second if one is NaN.
    #[inline(always)]
    fn least(self, a: f32x8<Self>, b: f32x8<Self>) -> f32x8<Self> {
        if HAS_ORDER { a.min(b) } else { a.simd_lt(b).select(a, b) }
    }

    /// Maximum of two numbers; the second if one is NaN.
    #[inline(always)]
    fn most(self, a: f32x8<Self>, b: f32x8<Self>) -> f32x8<Self> {
        if HAS_ORDER { a.max(b) } else { a.simd_gt(b).select(a, b) }
    }

    /// Broadcasts a number to all lanes.
    #[inline(always)]
    fn splat(self, number: f32) -> f32x8<Self> {
        f32x8::splat(self, number)
    }

    /// Loads eight numbers.
    #[inline(always)]
    fn load(self, numbers: &[f32; 8]) -> f32x8<Self> {
        (*numbers).simd_into(self)
    }
}

impl<S: Simd> Lanes for S {}

/// Whether `min` and `max` return the second operand if one is NaN, as the instructions of x86 do
/// (checked by a test).
const HAS_ORDER: bool = cfg!(any(target_arch = "x86", target_arch = "x86_64"));

/// Prefetches five cache lines, enough for a node or a block of triangles.
#[inline(always)]
pub(crate) fn prefetch(start: *const u8) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        for line in 0..5 {
            #[expect(unsafe_code, reason = "rays in flight gain 1.3 to 2.5 times beyond the cache; no safe prefetch")]
            // SAFETY: a hint, which reads and faults nowhere, whatever the address.
            unsafe {
                _mm_prefetch::<_MM_HINT_T0>(start.wrapping_add(line * 64).cast());
            }
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = start;
}

/// Bit mask of the lanes; the first lane is the lowest bit.
#[inline(always)]
pub(crate) fn bits<S: Simd>(mask: fearless_simd::mask32x8<S>) -> u32 {
    mask.to_bitmask() as u32
}

/// Iterator over the set bits of a lane mask, lowest first.
pub(crate) struct Bits(pub u32);

impl Iterator for Bits {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        let lane = self.0.trailing_zeros() as usize;
        self.0 &= self.0.wrapping_sub(1);
        (lane < 8).then_some(lane)
    }
}

/// Maximum of two numbers; the second if one is NaN.
#[inline(always)]
pub(crate) fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// Minimum of two numbers; the second if one is NaN.
#[inline(always)]
pub(crate) fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fearless_simd::dispatch;

    const KINDS: [f32; 8] = [f32::NEG_INFINITY, -1.0, -0.0, 0.0, 1e-40, 2.0, f32::INFINITY, f32::NAN];

    #[inline(always)]
    fn compare<S: Lanes>(simd: S, other: &[f32; 8]) {
        let (a, b) = (simd.load(&KINDS), simd.load(other));
        let (least, most): ([f32; 8], [f32; 8]) = (simd.least(a, b).into(), simd.most(a, b).into());
        for i in 0..8 {
            assert_eq!(least[i].to_bits(), min(KINDS[i], other[i]).to_bits(), "{simd:?}: {} {}", KINDS[i], other[i]);
            assert_eq!(most[i].to_bits(), max(KINDS[i], other[i]).to_bits(), "{simd:?}: {} {}", KINDS[i], other[i]);
            assert_eq!(bits(a.simd_lt(b)) >> i & 1 == 1, KINDS[i] < other[i]);
            assert_eq!(bits(a.simd_le(b)) >> i & 1 == 1, KINDS[i] <= other[i]);
        }
    }

    #[test]
    fn lanes_equal_scalars_at_every_simd_level() {
        for level in crate::simd_levels() {
            for shift in 0..8 {
                let other: [f32; 8] = std::array::from_fn(|i| KINDS[(i + shift) % 8]);
                dispatch!(level, simd => compare(simd, &other));
            }
        }
    }
}
