//! Eight numbers side by side: the comparisons that end in a bit per lane.
//!
//! Sums and products of eight lanes are plain loops over `[f32; 8]`, which the compiler turns into vector
//! code. What it does not find is the instruction that gathers the signs of a comparison, and for lack of it
//! it takes the whole test apart (148 instead of 103 instructions; five ways to write it as a loop were
//! tried). So that one step comes from the crate `wide`.

use wide::f32x8;

/// Bit `i` is set where `a[i] <= b[i]`; not where one is NaN.
#[inline(always)]
pub(crate) fn less_or_equal(a: &[f32; 8], b: &[f32; 8]) -> u32 {
    f32x8::new(*a).simd_le(f32x8::new(*b)).to_bitmask()
}

/// Bit `i` is set where `a[i] < b[i]`; not where one is NaN.
#[inline(always)]
pub(crate) fn less(a: &[f32; 8], b: &[f32; 8]) -> u32 {
    f32x8::new(*a).simd_lt(f32x8::new(*b)).to_bitmask()
}

/// The inverses, NaN where one overflows though the number is not zero.
#[inline(always)]
pub(crate) fn inverse(numbers: &[f32; 8]) -> [f32; 8] {
    let numbers = f32x8::new(*numbers);
    let inverse = f32x8::ONE / numbers;
    let overflows = inverse.abs().simd_gt(f32x8::splat(f32::MAX)) & numbers.simd_ne(f32x8::ZERO);
    overflows.select(f32x8::splat(f32::NAN), inverse).to_array()
}

/// The smaller of two, the second when one is NaN.
#[inline(always)]
pub(crate) fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The larger of two, the second when one is NaN.
#[inline(always)]
pub(crate) fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_of_kinds_in_every_lane() {
        let kinds = [f32::NEG_INFINITY, -1.0, -0.0, 0.0, 1e-40, 2.0, f32::INFINITY, f32::NAN];
        for shift in 0..8 {
            let other: [f32; 8] = std::array::from_fn(|i| kinds[(i + shift) % 8]);
            for i in 0..8 {
                assert_eq!(less(&kinds, &other) >> i & 1 == 1, kinds[i] < other[i]);
                assert_eq!(less_or_equal(&kinds, &other) >> i & 1 == 1, kinds[i] <= other[i]);
            }
            assert_eq!((less(&kinds, &other) | less_or_equal(&kinds, &other)) >> 8, 0);
        }
    }
}
