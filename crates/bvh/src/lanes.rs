//! Eight numbers side by side, on whatever vector unit there is.
//!
//! The kernels are written once, over the token of `fearless_simd`, and made for every level that the target
//! knows (SSE2 to AVX-512, NEON, wasm, none); `dispatch!` at the door of a call picks the one that the tree
//! was given. They use only operations that round the same way everywhere (no fused multiplication), so that
//! every level gives the same bits.
//!
//! What the library leaves open is said here: the smaller and the larger of two numbers when one is NaN.

use fearless_simd::f32x8;
use fearless_simd::prelude::*;

/// What the kernels need beside the operators.
pub(crate) trait Lanes: Simd {
    /// The smaller of two, the second when one is NaN.
    #[inline(always)]
    fn least(self, a: f32x8<Self>, b: f32x8<Self>) -> f32x8<Self> {
        if HAS_ORDER { a.min(b) } else { a.simd_lt(b).select(a, b) }
    }

    /// The larger of two, the second when one is NaN.
    #[inline(always)]
    fn most(self, a: f32x8<Self>, b: f32x8<Self>) -> f32x8<Self> {
        if HAS_ORDER { a.max(b) } else { a.simd_gt(b).select(a, b) }
    }

    /// Eight times the same.
    #[inline(always)]
    fn splat(self, number: f32) -> f32x8<Self> {
        f32x8::splat(self, number)
    }

    /// Eight from memory.
    #[inline(always)]
    fn load(self, numbers: &[f32; 8]) -> f32x8<Self> {
        (*numbers).simd_into(self)
    }
}

impl<S: Simd> Lanes for S {}

/// x86's own instructions give the second number where two do not compare (a test holds them to it).
const HAS_ORDER: bool = cfg!(any(target_arch = "x86", target_arch = "x86_64"));

/// Asks for five cache lines to be brought into the cache: those of a node or of a block of triangles.
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

/// One bit per lane, the first the lowest.
#[inline(always)]
pub(crate) fn bits<S: Simd>(mask: fearless_simd::mask32x8<S>) -> u32 {
    mask.to_bitmask() as u32
}

/// The lanes of a mask's bits, lowest first.
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

/// The larger of two, the second when one is NaN.
#[inline(always)]
pub(crate) fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The smaller of two, the second when one is NaN.
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
    fn every_pair_of_kinds_in_every_lane_at_every_level() {
        for level in crate::simd_levels() {
            for shift in 0..8 {
                let other: [f32; 8] = std::array::from_fn(|i| KINDS[(i + shift) % 8]);
                dispatch!(level, simd => compare(simd, &other));
            }
        }
    }
}
