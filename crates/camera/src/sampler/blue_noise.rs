//! Sobol points whose error is distributed over the picture as blue noise (Ahmed and Wonka,
//! Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of
//! Pixels, 2020): the errors of neighboring pixels tend to have opposite signs.
//!
//! All pixels of a block share one scrambled sequence. In the order of a Z curve through the block,
//! each pixel takes as many of its points as the picture has samples per pixel, so the points of
//! neighboring pixels together are as well distributed as those of a single pixel. At each level of
//! the curve the four quadrants are randomly permuted, independently in each dimension.
//!
//! Deviations from the paper: blocks have 256 × 256 pixels, so that 32 bits index their points, and
//! samples are shuffled within a pixel by the same hash as in `sobol`. Samples beyond the planned
//! number are further points of the sequence: well distributed in the pixel, but not with those of
//! its neighbors.
//!
//! ```json
//! {"blue_noise": {}}
//! ```

use super::{AnyPointSet, PointSet, SamplerDescription, sobol};
use juggler_math::{UVec2, Vec2, hash};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Sobol points whose error is distributed over the picture as blue noise, which is less visible.
/// Use it for pictures of few samples, best with a power of two.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct BlueNoise {}

/// Levels of the Z curve: the edge of a block is 2^8 pixels.
const LEVELS: u32 = 8;
/// Edge length of a block in pixels.
pub const BLOCK_EDGE: u32 = 1 << LEVELS;
/// Bits of a pixel's index on the curve.
const MORTON_BITS: u32 = 2 * LEVELS;
/// Maximum bits of a sample's index within its pixel; with the bits of the pixel they fill the
/// index of a point.
const MAX_BITS: u32 = 32 - MORTON_BITS;

impl SamplerDescription for BlueNoise {
    fn point_set(&self, samples: u32) -> AnyPointSet {
        let bits = u32::BITS - samples.saturating_sub(1).leading_zeros();
        BlueNoisePoints { bits: bits.min(MAX_BITS) as u8, place: 0 }.into()
    }
}

/// Points of [`BlueNoise`]: Owen-scrambled Sobol points shared by the pixels of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlueNoisePoints {
    /// Binary logarithm of the planned samples per pixel, rounded up.
    bits: u8,
    /// Index of the pixel on the curve; 0 for a whole picture. Its name is part of the `Debug`
    /// text, which enters fingerprints of pictures.
    place: u16,
}

impl PointSet for BlueNoisePoints {
    #[inline]
    fn pixel_seed(&self, seed: u32, pixel: UVec2) -> u32 {
        let block = pixel / BLOCK_EDGE;
        hash::combine(hash::combine(seed, block.x), block.y)
    }

    #[inline]
    fn at_pixel(&self, pixel: UVec2) -> AnyPointSet {
        Self { place: morton_index(pixel), ..*self }.into()
    }

    #[inline]
    fn point(&self, index: u32, _is_first: bool, seed: u32) -> Vec2 {
        point(index, self.place, self.bits, seed)
    }
}

/// Index of a pixel along the curve of its block: the interleaved bits of both coordinates (Morton
/// 1966).
pub fn morton_index(pixel: UVec2) -> u16 {
    let spread = |x: u32| (0..LEVELS).fold(0, |bits, level| bits | (x >> level & 1) << (2 * level));
    (spread(pixel.x) | spread(pixel.y) << 1) as u16
}

/// Point `index` of the pixel at `place` on the curve, of 2^`bits` planned points, in the dimension
/// `seed`.
#[inline]
pub fn point(index: u32, place: u16, bits: u8, seed: u32) -> Vec2 {
    let bits = u32::from(bits).min(MAX_BITS);
    let (set, number) = (index >> bits, index & ((1 << bits) - 1));
    // Sets beyond the 32 bits of a point's index use sequences of their own.
    let room = MAX_BITS - bits;
    let (sequence, set) = (set >> room, u64::from(set) << (MORTON_BITS + bits));
    let seed = if sequence == 0 { seed } else { hash::combine(seed, sequence) };
    let index = set as u32 | permute_quadrants(place.into(), seed) << bits | number;
    sobol::point(index.reverse_bits(), seed)
}

/// Permutes the quadrants of each level, down to single pixels: each digit in base 4 by a
/// permutation that depends on the digits above it.
#[inline]
fn permute_quadrants(place: u32, seed: u32) -> u32 {
    (0..LEVELS).fold(0, |result, level| {
        let shift = 2 * level;
        // Prepend a one to the digits above; its position encodes the level.
        let above = (place | 1 << MORTON_BITS) >> (shift + 2);
        let random = hash::mix(seed ^ above.wrapping_mul(0x9e37_79b9));
        let permutation = PERMUTATIONS[((u64::from(random) * PERMUTATIONS.len() as u64) >> 32) as usize];
        let digit = u32::from(permutation) >> (2 * (place >> shift & 3)) & 3;
        result | digit << shift
    })
}

/// All permutations of four elements, two bits each.
const PERMUTATIONS: [u8; 24] = {
    let (mut all, mut count, mut order) = ([0; 24], 0, 0);
    while order < 256 {
        let elements = [order & 3, order >> 2 & 3, order >> 4 & 3, order >> 6];
        if 1 << elements[0] | 1 << elements[1] | 1 << elements[2] | 1 << elements[3] == 0b1111 {
            all[count] = order as u8;
            count += 1;
        }
        order += 1;
    }
    all
};

#[cfg(any(test, feature = "testing"))]
impl BlueNoise {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self {}]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampler::Sampler;

    #[test]
    fn permutation_table_contains_all_permutations() {
        let mut known: Vec<[u8; 4]> = PERMUTATIONS.iter().map(|p| [0, 2, 4, 6].map(|shift| p >> shift & 3)).collect();
        known.iter().for_each(|order| {
            let mut sorted = *order;
            sorted.sort_unstable();
            assert_eq!(sorted, [0, 1, 2, 3]);
        });
        known.dedup();
        assert_eq!(known.len(), 24);
    }

    #[test]
    fn morton_indices_are_permuted_within_their_quadrants() {
        for seed in [0, 1, 0x1234_5678] {
            let mut is_used = vec![false; 1 << MORTON_BITS];
            for place in 0..1 << MORTON_BITS {
                let to = permute_quadrants(place, seed);
                assert!(!std::mem::replace(&mut is_used[to as usize], true));
                for shift in [2, 6, 10, 14] {
                    // Indices in the same quadrant of any level stay in the same quadrant.
                    assert_eq!(to >> shift, permute_quadrants(place >> shift << shift, seed) >> shift);
                }
            }
        }
        assert_eq!(morton_index(UVec2::new(3, 0)), 5);
        assert_eq!(morton_index(UVec2::new(0, 3)), 10);
        assert_eq!(morton_index(UVec2::new(255, 255)), u16::MAX);
    }

    #[test]
    fn quadrants_are_permuted_uniformly() {
        let mut counts = [0u32; 16];
        for seed in 0..8000 {
            let seed = hash::mix(seed);
            (0..4).for_each(|quarter| {
                counts[(quarter * 4 + (permute_quadrants(quarter << 14, seed) >> 14)) as usize] += 1;
            });
        }
        juggler_math::testing::chi_squared(&counts.map(f64::from), &[2000.0; 16], 1e-3).unwrap();
    }

    /// Points of all samples of a square of pixels.
    fn points(x: u32, y: u32, edge: u32, samples: u32) -> Vec<Vec2> {
        let picture = Sampler::new(BlueNoise {}.point_set(samples), 3);
        let pixels = (0..edge * edge).map(|i| UVec2::new(x + i % edge, y + i / edge));
        pixels
            .flat_map(|pixel| (0..samples).map(move |i| picture.pixel(pixel).sample(i).skipped(4).next_2d()))
            .collect()
    }

    #[test]
    fn points_of_a_block_of_pixels_fill_every_elementary_interval_once() {
        for (x, y, edge, samples) in [(12, 8, 1, 64), (6, 2, 2, 16), (4, 0, 4, 16), (8, 256, 8, 1), (0, 300, 4, 2)] {
            let (points, bits) = (points(x, y, edge, samples), (edge * edge * samples).ilog2());
            for columns in 0..=bits {
                let mut counts = vec![0; points.len()];
                let rows = bits - columns;
                for Vec2 { x, y } in &points {
                    let (column, row) = ((x * (1 << columns) as f32) as usize, (y * (1 << rows) as f32) as usize);
                    counts[column << rows | row] += 1;
                }
                assert!(
                    counts.iter().all(|count| *count == 1),
                    "{edge} pixels, {samples} samples, 2^{columns} columns"
                );
            }
        }
    }

    #[test]
    fn samples_beyond_the_planned_count_are_distinct_points() {
        let mut all: Vec<[u32; 2]> = Vec::new();
        for planned in [1, 3, 16, 1 << 16, u32::MAX] {
            let pixel = Sampler::new(BlueNoise {}.point_set(planned), 9).pixel(UVec2::new(77, 5000));
            for index in (0..40).chain([65_535, 65_536, 1 << 20, 1 << 31, u32::MAX]) {
                let point = pixel.sample(index).next_2d();
                assert!(point.cmpge(Vec2::ZERO).all() && point.cmplt(Vec2::ONE).all());
                all.push(point.to_array().map(f32::to_bits));
            }
            let last: std::collections::HashSet<_> = all.drain(..).collect();
            assert_eq!(last.len(), 45, "{planned} planned");
        }
    }

    #[test]
    fn sampler_stores_no_pixel() {
        assert_eq!(size_of::<Sampler>(), 20);
    }
}
