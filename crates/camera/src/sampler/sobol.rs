//! Owen-scrambled Sobol points (Sobol 1967; Owen 1995) by hashing (Burley, Practical Hash-based
//! Owen Scrambling, JCGT 2020). Each pair of dimensions uses Sobol's first two dimensions with its
//! own scrambling and shuffling of the sample indices, so any number of dimensions needs no table.
//!
//! ```json
//! {"sobol": {}}
//! ```

use super::{AnyPointSet, PointSet, SamplerDescription};
use juggler_math::{Vec2, hash};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Owen-scrambled Sobol points: a low-discrepancy sequence with low noise at any number of samples,
/// best at powers of two.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Sobol {}

impl SamplerDescription for Sobol {
    fn point_set(&self, _samples: u32) -> AnyPointSet {
        SobolPoints.into()
    }
}

/// Points of [`Sobol`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SobolPoints;

impl PointSet for SobolPoints {
    /// The index with its bits reversed, as shuffling needs it.
    #[inline]
    fn address(&self, index: u32) -> u32 {
        index.reverse_bits()
    }

    #[inline]
    fn point(&self, address: u32, _is_first: bool, seed: u32) -> Vec2 {
        point(address, seed)
    }

    #[inline]
    fn first_coordinate(&self, address: u32, _is_first: bool, seed: u32) -> f32 {
        first_coordinate(address, seed)
    }

    fn finer_point(&self, address: u32, part: u32, parts: u32, seed: u32) -> Option<Vec2> {
        let rows: &[u32] = match parts {
            4 => &ROWS_OF_4,
            8 => &ROWS_OF_8,
            _ => return None,
        };
        let index = shuffle_index(address, seed);
        let product = |row: &u32| (index & row).count_ones() & 1;
        let first = rows.iter().rev().fold(0, |bits, row| bits << 1 | product(row));
        Some(scrambled_point(index << rows.len() | (first ^ part), seed))
    }
}

/// Generator matrices, by columns that repeat, of the part 0 of each group of 4 or 8 consecutive
/// Sobol points, such that these parts are well distributed by themselves, too: (0, m, 2)-nets in
/// base 2 for groups of 4, (1, m, 2)-nets for groups of 8. No such matrix exists for groups of 2.
/// The matrices were found by search.
const COLUMNS_OF_4: [u32; 3] = [3, 1, 2];
const COLUMNS_OF_8: [u32; 5] = [3, 6, 4, 7, 2];
/// The same matrices by rows, by which a product is the parity of a few bits.
const ROWS_OF_4: [u32; 2] = rows(&COLUMNS_OF_4);
const ROWS_OF_8: [u32; 3] = rows(&COLUMNS_OF_8);

/// Rows of the matrix of 32 columns that `columns` repeat: bit `j` of row `i` is bit `i` of column `j`.
const fn rows<const ROWS: usize>(columns: &[u32]) -> [u32; ROWS] {
    let mut rows = [0; ROWS];
    let mut bit = 0;
    while bit < 32 {
        let mut row = 0;
        while row < ROWS {
            rows[row] |= (columns[bit % columns.len()] >> row & 1) << bit;
            row += 1;
        }
        bit += 1;
    }
    rows
}

/// First coordinate of [`point`].
#[inline]
fn first_coordinate(address: u32, seed: u32) -> f32 {
    hash::unit_f32(scrambled_first(shuffle_index(address, seed), seed).reverse_bits())
}

/// Index in the shuffled sequence of the sample whose index has the reversed bits `address`.
#[inline]
fn shuffle_index(address: u32, seed: u32) -> u32 {
    owen_scramble_reversed(address, seed).reverse_bits()
}

/// Scrambled first dimension, bits reversed. Sobol's first dimension is the bit-reversed index and
/// the scrambling works on reversed bits, so both reversals cancel.
#[inline]
fn scrambled_first(index: u32, seed: u32) -> u32 {
    owen_scramble_reversed(index, seed ^ 0x9c8f_2d35)
}

/// Point of the scrambled and shuffled sequence `seed` whose index has the reversed bits `address`.
#[inline]
pub fn point(address: u32, seed: u32) -> Vec2 {
    scrambled_point(shuffle_index(address, seed), seed)
}

/// Point `index` of the scrambled sequence `seed`.
#[inline]
fn scrambled_point(index: u32, seed: u32) -> Vec2 {
    let x = scrambled_first(index, seed);
    let y = owen_scramble_reversed(second_dimension(index), hash::mix(seed));
    // Reverse both in one operation, which also swaps them.
    let both = (u64::from(y) << 32 | u64::from(x)).reverse_bits();
    Vec2::new(hash::unit_f32((both >> 32) as u32), hash::unit_f32(both as u32))
}

/// Sobol's second dimension, bits reversed: its matrix is Pascal's triangle modulo 2, whose entry
/// (i, j) is 1 just when the bits of j are among those of i (Lucas 1878), so five masked shifts
/// multiply by it.
#[inline]
fn second_dimension(mut index: u32) -> u32 {
    index ^= index >> 16;
    index ^= (index & 0xff00_ff00) >> 8;
    index ^= (index & 0xf0f0_f0f0) >> 4;
    index ^= (index & 0xcccc_cccc) >> 2;
    index ^ (index & 0xaaaa_aaaa) >> 1
}

/// Permutation in which each bit depends only on lower bits; on reversed bits this is an Owen
/// scrambling (Laine and Karras 2011; constants of Nathan Vegdahl, 2021).
#[inline]
fn owen_scramble_reversed(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

#[cfg(any(test, feature = "testing"))]
impl Sobol {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self {}]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn second_dimension_equals_the_generator_matrix() {
        for index in (0..100_000).chain([u32::MAX, 0x8000_0000, 0x1234_5678]) {
            let (mut column, mut rest, mut expected) = (0x8000_0000u32, index, 0u32);
            while rest != 0 {
                if rest & 1 == 1 {
                    expected ^= column;
                }
                column ^= column >> 1;
                rest >>= 1;
            }
            assert_eq!(second_dimension(index).reverse_bits(), expected, "index {index}");
        }
    }

    /// Whether each interval of 2^-a × 2^-b with a + b = m - t holds 2^t of the 2^m points.
    fn is_net(points: &[Vec2], t: u32) -> bool {
        let m = points.len().ilog2();
        (0..=m.saturating_sub(t)).all(|a| {
            let size = [1u32 << a, 1 << (m.saturating_sub(t) - a)];
            let mut counts = vec![0; points.len()];
            for point in points {
                let [x, y] = [point.x * size[0] as f32, point.y * size[1] as f32].map(|cell| cell as u32);
                counts[(y * size[0] + x) as usize] += 1;
            }
            let cells = (size[0] * size[1]) as usize;
            counts[..cells].iter().all(|count| *count == points.len() / cells)
        })
    }

    #[test]
    fn parts_of_a_finer_set_are_well_distributed_alone_and_together() {
        let finer =
            |index, part, parts, seed| SobolPoints.finer_point(SobolPoints.address(index), part, parts, seed).unwrap();
        for (parts, t) in [(4, 0), (8, 1)] {
            for (seed, m, block) in (0..4).flat_map(|seed| (0..9).flat_map(move |m| (0..2).map(move |b| (seed, m, b))))
            {
                let samples = block << m..(block + 1) << m;
                let part = |part| samples.clone().map(move |i| finer(i, part, parts, seed)).collect::<Vec<_>>();
                let all: Vec<Vec<Vec2>> = (0..parts).map(part).collect();
                assert!(is_net(&all[0], t), "{parts} parts, 2^{m} points of part 0, seed {seed}");
                assert!(is_net(&all.concat(), 0), "all {parts} parts of 2^{m} points, seed {seed}");
            }
        }
        assert_eq!(SobolPoints.finer_point(0, 0, 2, 1), None);
    }

    #[test]
    fn sobol_integrates_better_than_chance() {
        // ∫∫ x y over the unit square is 1/4; 1024 independent points have an error of about 0.007.
        let mean = (0..1024_u32).map(|i| point(i.reverse_bits(), 99)).map(|p| p.x * p.y).sum::<f32>() / 1024.0;
        assert!((mean - 0.25).abs() < 5e-4, "{mean}");
    }
}
