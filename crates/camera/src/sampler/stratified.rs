//! Stratified sampling: one random point in each cell of a grid (Cook 1986), as in the Juggler.
//!
//! ```json
//! {"stratified": {"side": 8}}
//! ```

use super::{AnyPointSet, PointSet, SamplerDescription};
use juggler_math::{Vec2, hash};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// One random point in each cell of an n × n grid.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Stratified {
    /// Cells along an edge of the grid, n, 0 to 4096. n² samples fill one grid; further samples
    /// start another. The default, 0, uses the largest grid that the number of samples fills.
    #[schemars(range(min = 0, max = 4096))]
    pub side: u32,
}

impl SamplerDescription for Stratified {
    fn point_set(&self, samples: u32) -> AnyPointSet {
        let side = if self.side == 0 { samples.isqrt() } else { self.side };
        StratifiedPoints { side: side.clamp(1, 4096) }.into()
    }
}

/// Points of [`Stratified`]: one random point in each cell, grid after grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StratifiedPoints {
    /// Cells along an edge, at least 1.
    side: u32,
}

impl PointSet for StratifiedPoints {
    #[inline]
    fn point(&self, index: u32, is_first_dimension: bool, seed: u32) -> Vec2 {
        point(index, is_first_dimension, seed, self.side)
    }

    #[inline]
    fn fill(&self, first: u32, seed: u32, points: &mut [Vec2]) {
        points_in_order(first, seed, self.side, points);
    }
}

/// Point `index` of the stream `seed`. The first dimension visits the cells in order; all others
/// visit them in random order, so that film position and light sample are not correlated.
#[inline]
pub fn point(index: u32, in_order: bool, seed: u32, side: u32) -> Vec2 {
    let cells = side * side;
    // Most indices lie in the first set; avoid slow divisions there.
    let (set, cell) = if index < cells { (0, index) } else { (index / cells, index % cells) };
    let cell = if in_order { cell } else { permutation(cell, cells, hash::combine(seed, set)) };
    in_cell(Vec2::new((cell % side) as f32, (cell / side) as f32), index, seed, 1.0 / side as f32)
}

/// Points from `first` on in the order of their cells: [`point`] without its divisions, and
/// vectorized.
#[inline]
pub fn points_in_order(first: u32, seed: u32, side: u32, points: &mut [Vec2]) {
    let cell = first % (side * side);
    let (mut column, mut row) = (cell % side, cell / side);
    for point in &mut *points {
        *point = Vec2::new(column as f32, row as f32);
        column += 1;
        if column == side {
            column = 0;
            row = if row + 1 == side { 0 } else { row + 1 };
        }
    }
    let edge = 1.0 / side as f32;
    for (i, point) in points.iter_mut().enumerate() {
        *point = in_cell(*point, first.wrapping_add(i as u32), seed, edge);
    }
}

#[inline]
fn in_cell(cell: Vec2, index: u32, seed: u32, edge: f32) -> Vec2 {
    let jitter = super::independent::point(index, seed);
    ((cell + jitter) * edge).min(Vec2::splat(1.0 - f32::EPSILON / 2.0))
}

/// Element `i` of a random permutation of `0..length` (Kensler, Correlated Multi-Jittered Sampling,
/// 2013): an invertible hash on the next power of two, repeated until the result is in range.
fn permutation(mut i: u32, length: u32, seed: u32) -> u32 {
    let mask = length.next_power_of_two().wrapping_sub(1);
    loop {
        i ^= seed;
        i = i.wrapping_mul(0xe170_893d) ^ seed >> 16;
        i ^= (i & mask) >> 4;
        i = (i ^ seed >> 8).wrapping_mul(0x0929_eb3f) ^ seed >> 23;
        i ^= (i & mask) >> 1;
        i = i.wrapping_mul(1 | seed >> 27).wrapping_mul(0x6935_fa69);
        i ^= (i & mask) >> 11;
        i = i.wrapping_mul(0x74dc_b303);
        i ^= (i & mask) >> 2;
        i = i.wrapping_mul(0x9e50_1cc3);
        i ^= (i & mask) >> 2;
        i = i.wrapping_mul(0xc860_a3df) & mask;
        i ^= i >> 5;
        if i < length {
            return (i.wrapping_add(seed)) % length;
        }
    }
}

#[cfg(any(test, feature = "testing"))]
impl Stratified {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self { side: 0 }, Self { side: 4 }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn permutation_hits_every_place_once() {
        for (length, seed) in [(1, 5), (2, 9), (9, 3), (64, 77), (100, 1)] {
            let mut elements: Vec<u32> = (0..length).map(|i| permutation(i, length, hash::mix(seed))).collect();
            elements.sort_unstable();
            assert!(elements.into_iter().eq(0..length), "length {length}");
        }
    }
}
