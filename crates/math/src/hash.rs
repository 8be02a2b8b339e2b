//! Hashes for counter-based random numbers: each number is a pure function of its index.

/// Bijective 32-bit mixer in which each input bit affects every output bit (constants of
/// `lowbias32` from Chris Wellons' hash-prospector, 2018).
#[inline]
pub const fn mix(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x7feb_352d);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

/// Hash of an ordered pair.
#[inline]
pub const fn combine(a: u32, b: u32) -> u32 {
    mix(a ^ mix(b.wrapping_add(0x9e37_79b9)).wrapping_add(a << 6))
}

/// Maps the upper 24 bits to a float in [0, 1).
#[inline]
pub fn unit_f32(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / 16_777_216.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Random, chi_squared};

    /// Checks that each input bit flips each output bit with probability 1/2.
    fn avalanche(f: impl Fn(u32) -> u32) {
        const TRIALS: u32 = 20_000;
        let mut random = Random::new(61);
        let inputs: Vec<u32> = (0..TRIALS).map(|_| random.bits()).collect();
        for input in 0..32 {
            let mut flips = [0u32; 32];
            for &x in &inputs {
                let changed = f(x) ^ f(x ^ (1 << input));
                (0..32).for_each(|output| flips[output] += changed >> output & 1);
            }
            for (output, count) in flips.into_iter().enumerate() {
                let share = f64::from(count) / f64::from(TRIALS);
                assert!((share - 0.5).abs() < 0.025, "bit {input} flips bit {output} in {share} of all cases");
            }
        }
    }

    #[test]
    fn every_input_bit_reaches_every_output_bit() {
        avalanche(mix);
        avalanche(|x| combine(x, 77));
        avalanche(|x| combine(77, x));
    }

    #[test]
    fn pairs_are_ordered_and_a_grid_of_small_numbers_does_not_collide_more_than_chance() {
        assert_ne!(combine(1, 2), combine(2, 1));
        let mut hashes: Vec<u32> = (0..512 * 512).map(|i| combine(i / 512, i % 512)).collect();
        hashes.sort_unstable();
        hashes.dedup();
        // A random function has n²/2^33 = 8 expected collisions among 262,144 numbers.
        assert!(512 * 512 - hashes.len() < 25, "{}", 512 * 512 - hashes.len());
    }

    #[test]
    fn floats_of_counted_hashes_are_uniform_and_below_one() {
        let mut observed = [0.0; 64];
        for i in 0..64_000 {
            observed[(unit_f32(combine(5, i)) * 64.0) as usize] += 1.0;
        }
        chi_squared(&observed, &[1000.0; 64], 1e-3).unwrap();
        assert_eq!((unit_f32(0), unit_f32(u32::MAX)), (0.0, 1f32.next_down()));
    }

    #[test]
    fn hashes_never_change() {
        assert_eq!((mix(0), mix(1), mix(u32::MAX)), (0, 1_753_845_952, 1_734_902_346));
        assert_eq!((combine(0, 0), combine(1, 2)), (2_926_543_089, 3_200_910_787));
    }
}
