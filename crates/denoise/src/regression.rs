//! The light around a window's centre as a linear function of place and features (Bitterli et al. 2016, sections 4 and 5.2): fitted
//! by weighted least squares, then spread over the whole window. Sixteen windows side by side.

#![expect(
    clippy::needless_range_loop,
    reason = "indices as in the formulas; iterators and closures lose the vector unit"
)]

use crate::features::{FEATURES, falling};
use crate::grid::{LANES, MARGIN, OFFSETS, REACH, STEP, TILE_COLUMNS, offsets};
use crate::prepare::Prepared;
use crate::weights::{Weights, load};
use fearless_simd::f32x16;
use fearless_simd::prelude::*;

/// One, place, features.
const MOST: usize = 3 + FEATURES;
/// What is added to the variances of the numbers in a window: slopes along a number that varies less are not trusted.
const RIDGE: [f32; MOST] = [0.0, 4e-3, 4e-3, 2e-4, 2e-4, 2e-4, 2e-4, 2e-4, 2e-4, 2e-5];
/// What the squares of the features' differences are multiplied by in weights.
const LIKENESS: [f32; FEATURES] = [3.2, 3.2, 3.2, 3.2, 3.2, 3.2, 6.4];

/// Pixels in a row of what a tile adds to.
pub(crate) const SUMS_STRIDE: usize = STEP * PHASE;
/// Pixels of one class of columns in it.
pub(crate) const PHASE: usize = TILE_COLUMNS + ((MARGIN + REACH) / STEP + 1).next_multiple_of(LANES);
/// Red, green, blue, weight.
pub(crate) const SUMS: usize = 4;

/// A row of windows side by side.
pub(crate) struct Windows<'a> {
    prepared: &'a Prepared,
    /// Where the first pixel of the first window is in planes in phases, but for the offset's part.
    base: usize,
    /// Likewise in what the tile adds to.
    target: usize,
    /// From there to each pixel of a window, in planes and in the sums.
    steps: &'a Steps,
}

/// From a window's first row to each of its pixels.
pub(crate) struct Steps {
    planes: Vec<usize>,
    sums: Vec<usize>,
}

impl Steps {
    pub fn new(prepared: &Prepared) -> Self {
        let grid = &prepared.grid;
        let step = |stride: usize, phase: usize| {
            offsets().map(move |(x, y)| {
                let column = MARGIN.wrapping_add_signed(x);
                y.wrapping_add_unsigned(REACH).unsigned_abs() * stride + column % STEP * phase + column / STEP
            })
        };
        let planes = step(grid.stride, grid.phase_stride()).collect();
        Self { planes, sums: step(SUMS_STRIDE, PHASE).collect() }
    }
}

/// What least squares need of one half: the lower triangle of the matrix, and a right side for each channel.
#[derive(Clone, Copy)]
struct System<S: Simd> {
    matrix: [[f32x16<S>; MOST]; MOST],
    right: [[f32x16<S>; 3]; MOST],
}

impl<'a> Windows<'a> {
    /// The windows from `column` on in a row of windows; `local` is what row and block these are of the tile.
    pub fn new(prepared: &'a Prepared, steps: &'a Steps, at: [usize; 2], local: [usize; 2]) -> Self {
        let ([row, column], [local_row, block]) = (at, local);
        Self {
            prepared,
            base: (MARGIN + row * STEP - REACH) * prepared.grid.stride + column,
            target: local_row * STEP * SUMS_STRIDE + block * LANES,
            steps,
        }
    }

    /// Fits and spreads. `weights[h]` are those of half `h`'s pixels; `sums` is a plane for each half and number.
    #[inline(always)]
    pub fn filter<S: Simd, const N: usize>(
        &self,
        simd: S,
        weights: [&mut [[f32; LANES]]; 2],
        sums: &mut [Vec<f32>; 2 * SUMS],
    ) {
        let zero = f32x16::splat(simd, 0.0);
        let mut systems = [System { matrix: [[zero; MOST]; MOST], right: [[zero; 3]; MOST] }; 2];
        let [first, second] = weights;
        for (offset, place) in offsets().enumerate() {
            let pair = [f32x16::from_slice(simd, &first[offset]), f32x16::from_slice(simd, &second[offset])];
            if !(pair[0] + pair[1]).simd_gt(zero).any_true() {
                continue;
            }
            let (numbers, likeness) = self.numbers::<S, N>(simd, offset, place);
            let at = self.base + self.steps.planes[offset];
            for half in 0..2 {
                let weight = pair[half] * likeness * load(simd, &self.prepared.masks[half], at);
                let [red, green, blue] = &self.prepared.colours[half];
                let colour = [load(simd, red, at), load(simd, green, at), load(simd, blue, at)];
                systems[half].add::<N>(weight, &numbers, colour);
                let target = if half == 0 { &mut first[offset] } else { &mut second[offset] };
                weight.store_slice(target);
            }
        }
        let [one, other] = systems;
        let slopes = [one.solved::<N>(simd), other.solved::<N>(simd)];
        for (offset, place) in offsets().enumerate() {
            let pair = [f32x16::from_slice(simd, &first[offset]), f32x16::from_slice(simd, &second[offset])];
            if (pair[0] + pair[1]).simd_gt(zero).any_true() {
                let (numbers, _) = self.numbers::<S, N>(simd, offset, place);
                self.spread::<S, N>(simd, offset, pair, &numbers, &slopes, sums);
            }
        }
    }

    /// The numbers of the pixels at an offset, less those of the centres, and what these
    /// pixels' weights are multiplied by: how alike their features are, and how sure they are compared with the centres'
    /// surroundings.
    #[inline(always)]
    fn numbers<S: Simd, const N: usize>(
        &self,
        simd: S,
        offset: usize,
        (x, y): (isize, isize),
    ) -> ([f32x16<S>; N], f32x16<S>) {
        let mut numbers = [f32x16::splat(simd, 1.0); N];
        numbers[1] = f32x16::splat(simd, x as f32 / REACH as f32);
        numbers[2] = f32x16::splat(simd, y as f32 / REACH as f32);
        let (at, centre) = (self.base + self.steps.planes[offset], self.base + self.steps.planes[OFFSETS / 2]);
        let mut distance = f32x16::splat(simd, 0.0);
        for k in 3..N {
            let plane = &self.prepared.features[k - 3];
            let difference = load(simd, plane, at) - load(simd, plane, centre);
            distance += difference * difference * LIKENESS[k - 3];
            numbers[k] = difference;
        }
        let sure = load(simd, &self.prepared.usual, centre) / load(simd, &self.prepared.single, at);
        (numbers, falling(simd, distance) * sure.min(f32x16::splat(simd, 1.0)))
    }

    /// Adds what the fitted functions say of the pixels at an offset.
    #[inline(always)]
    fn spread<S: Simd, const N: usize>(
        &self,
        simd: S,
        offset: usize,
        weights: [f32x16<S>; 2],
        numbers: &[f32x16<S>; N],
        slopes: &[[[f32x16<S>; 3]; N]; 2],
        sums: &mut [Vec<f32>; 2 * SUMS],
    ) {
        let at = self.target + self.steps.sums[offset];
        for half in 0..2 {
            for channel in 0..3 {
                let mut value = slopes[half][0][channel];
                for k in 1..N {
                    value += slopes[half][k][channel] * numbers[k];
                }
                add(simd, &mut sums[half * SUMS + channel], at, value * weights[half]);
            }
            add(simd, &mut sums[half * SUMS + 3], at, weights[half]);
        }
    }
}

/// Adds numbers from `at` on.
#[inline(always)]
fn add<S: Simd>(simd: S, sums: &mut [f32], at: usize, more: f32x16<S>) {
    let target = &mut sums[at..at + LANES];
    (f32x16::from_slice(simd, target) + more).store_slice(target);
}

impl<S: Simd> System<S> {
    #[inline(always)]
    fn add<const N: usize>(&mut self, weight: f32x16<S>, numbers: &[f32x16<S>; N], colour: [f32x16<S>; 3]) {
        for i in 0..N {
            let weighted = weight * numbers[i];
            for j in 0..=i {
                self.matrix[i][j] += weighted * numbers[j];
            }
            for channel in 0..3 {
                self.right[i][channel] += weighted * colour[channel];
            }
        }
    }

    /// The constant and the slopes: Cholesky's method without roots, after a ridge was added.
    #[inline(always)]
    fn solved<const N: usize>(mut self, simd: S) -> [[f32x16<S>; 3]; N] {
        let one = f32x16::splat(simd, 1.0);
        let total = self.matrix[0][0];
        let mut inverse = [one; N];
        for i in 0..N {
            self.matrix[i][i] = self.matrix[i][i] + total * RIDGE[i] + 1e-20;
            for j in 0..i {
                for k in 0..j {
                    // The rows above were divided already, this one still has the products.
                    self.matrix[i][j] -= self.matrix[i][k] * self.matrix[j][k];
                }
            }
            for j in 0..i {
                let product = self.matrix[i][j];
                self.matrix[i][j] = product * inverse[j];
                self.matrix[i][i] -= product * self.matrix[i][j];
                for channel in 0..3 {
                    self.right[i][channel] -= self.matrix[i][j] * self.right[j][channel];
                }
            }
            inverse[i] = one / self.matrix[i][i].max(total * 1e-7 + 1e-20);
        }
        let mut slopes = [[one; 3]; N];
        for i in (0..N).rev() {
            for channel in 0..3 {
                let mut value = self.right[i][channel] * inverse[i];
                for j in i + 1..N {
                    value -= self.matrix[j][i] * slopes[j][channel];
                }
                slopes[i][channel] = value;
            }
        }
        slopes
    }
}

/// Both halves' weights of one block of windows, to be read and changed.
pub(crate) fn block(weights: &mut [Weights; 2], index: usize) -> [&mut [[f32; LANES]]; 2] {
    weights.each_mut().map(|weights| &mut weights[index * OFFSETS..(index + 1) * OFFSETS])
}
