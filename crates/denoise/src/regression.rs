//! First-order regression (Bitterli et al. 2016, sections 4 and 5.2): the color around a window's
//! center is fitted by a linear function of position and features, by weighted least squares, and
//! the fit is accumulated over the whole window. Sixteen windows are computed in parallel lanes.

#![expect(
    clippy::needless_range_loop,
    reason = "indices as in the formulas; iterators and closures lose the vector unit"
)]

use crate::features::{FEATURES, exp_approximation};
use crate::grid::{LANES, MARGIN, STEP, TILE_COLUMNS, WINDOW_PIXELS, WINDOW_RADIUS, offsets};
use crate::prepare::Prepared;
use crate::weights::{Weights, load};
use fearless_simd::f32x16;
use fearless_simd::prelude::*;

/// Maximum number of regressors: constant, position (2), features.
const MAX_REGRESSORS: usize = 3 + FEATURES;
/// Ridge added to the variance of each regressor in a window, so that slopes along nearly constant
/// regressors are damped.
const RIDGE: [f32; MAX_REGRESSORS] = [0.0, 4e-3, 4e-3, 2e-4, 2e-4, 2e-4, 2e-4, 2e-4, 2e-4, 2e-5];
/// Factors of squared feature differences in the weights.
const FEATURE_FACTORS: [f32; FEATURES] = [3.2, 3.2, 3.2, 3.2, 3.2, 3.2, 6.4];

/// Row stride of a tile's sums.
pub(crate) const SUMS_STRIDE: usize = STEP * PHASE;
/// Number of values of one column phase in that row.
pub(crate) const PHASE: usize = TILE_COLUMNS + ((MARGIN + WINDOW_RADIUS) / STEP + 1).next_multiple_of(LANES);
/// Number of components: red, green, blue, weight.
pub(crate) const SUMS: usize = 4;

/// A vector of neighboring windows.
pub(crate) struct Windows<'a> {
    prepared: &'a Prepared,
    /// Index of the first pixel of the first window in planes in phases, without the offset.
    base: usize,
    /// Index of that pixel in the sums of the tile, without the offset.
    target: usize,
    /// Index offsets of each pixel of a window, in planes and in sums.
    steps: &'a Steps,
}

/// Index offsets of each pixel of a window from the window's first row.
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
                y.wrapping_add_unsigned(WINDOW_RADIUS).unsigned_abs() * stride + column % STEP * phase + column / STEP
            })
        };
        let planes = step(grid.stride, grid.phase_stride()).collect();
        Self { planes, sums: step(SUMS_STRIDE, PHASE).collect() }
    }
}

/// Normal equations of one half: lower triangle of the matrix, and a right-hand side for each
/// channel.
#[derive(Clone, Copy)]
struct System<S: Simd> {
    matrix: [[f32x16<S>; MAX_REGRESSORS]; MAX_REGRESSORS],
    right_side: [[f32x16<S>; 3]; MAX_REGRESSORS],
}

impl<'a> Windows<'a> {
    /// Creates the windows at `at`, row and column in the grid of windows. `local` is their row and
    /// block in the tile.
    pub fn new(prepared: &'a Prepared, steps: &'a Steps, at: [usize; 2], local: [usize; 2]) -> Self {
        let ([row, column], [local_row, block]) = (at, local);
        Self {
            prepared,
            base: (MARGIN + row * STEP - WINDOW_RADIUS) * prepared.grid.stride + column,
            target: local_row * STEP * SUMS_STRIDE + block * LANES,
            steps,
        }
    }

    /// Fits all windows and accumulates the results. `weights[h]` are those of half `h`; `sums` has
    /// a plane for each half and component.
    #[inline(always)]
    pub fn filter<S: Simd, const N: usize>(
        &self,
        simd: S,
        weights: [&mut [[f32; LANES]]; 2],
        sums: &mut [Vec<f32>; 2 * SUMS],
    ) {
        let zero = f32x16::splat(simd, 0.0);
        let mut systems =
            [System { matrix: [[zero; MAX_REGRESSORS]; MAX_REGRESSORS], right_side: [[zero; 3]; MAX_REGRESSORS] }; 2];
        let [first, second] = weights;
        for (offset, place) in offsets().enumerate() {
            let pair = [f32x16::from_slice(simd, &first[offset]), f32x16::from_slice(simd, &second[offset])];
            if !(pair[0] + pair[1]).simd_gt(zero).any_true() {
                continue;
            }
            let (regressors, similarity) = self.regressors::<S, N>(simd, offset, place);
            let at = self.base + self.steps.planes[offset];
            for half in 0..2 {
                let weight = pair[half] * similarity * load(simd, &self.prepared.masks[half], at);
                let [red, green, blue] = &self.prepared.colors[half];
                let color = [load(simd, red, at), load(simd, green, at), load(simd, blue, at)];
                systems[half].add::<N>(weight, &regressors, color);
                let target = if half == 0 { &mut first[offset] } else { &mut second[offset] };
                weight.store_slice(target);
            }
        }
        let [one, other] = systems;
        let slopes = [one.solve::<N>(simd), other.solve::<N>(simd)];
        for (offset, place) in offsets().enumerate() {
            let pair = [f32x16::from_slice(simd, &first[offset]), f32x16::from_slice(simd, &second[offset])];
            if (pair[0] + pair[1]).simd_gt(zero).any_true() {
                let (regressors, _) = self.regressors::<S, N>(simd, offset, place);
                self.accumulate::<S, N>(simd, offset, pair, &regressors, &slopes, sums);
            }
        }
    }

    /// Regressors of the pixels at an offset, relative to the window centers, and the factor of
    /// their weights: similarity of features, and confidence relative to the center's surroundings.
    #[inline(always)]
    fn regressors<S: Simd, const N: usize>(
        &self,
        simd: S,
        offset: usize,
        (x, y): (isize, isize),
    ) -> ([f32x16<S>; N], f32x16<S>) {
        let mut regressors = [f32x16::splat(simd, 1.0); N];
        regressors[1] = f32x16::splat(simd, x as f32 / WINDOW_RADIUS as f32);
        regressors[2] = f32x16::splat(simd, y as f32 / WINDOW_RADIUS as f32);
        let (at, center) = (self.base + self.steps.planes[offset], self.base + self.steps.planes[WINDOW_PIXELS / 2]);
        let mut distance = f32x16::splat(simd, 0.0);
        for k in 3..N {
            let plane = &self.prepared.features[k - 3];
            let difference = load(simd, plane, at) - load(simd, plane, center);
            distance += difference * difference * FEATURE_FACTORS[k - 3];
            regressors[k] = difference;
        }
        let confidence =
            load(simd, &self.prepared.typical_variance, center) / load(simd, &self.prepared.pixel_variance, at);
        (regressors, exp_approximation(simd, distance) * confidence.min(f32x16::splat(simd, 1.0)))
    }

    /// Accumulates the fitted values of the pixels at an offset.
    #[inline(always)]
    fn accumulate<S: Simd, const N: usize>(
        &self,
        simd: S,
        offset: usize,
        weights: [f32x16<S>; 2],
        regressors: &[f32x16<S>; N],
        slopes: &[[[f32x16<S>; 3]; N]; 2],
        sums: &mut [Vec<f32>; 2 * SUMS],
    ) {
        let at = self.target + self.steps.sums[offset];
        for half in 0..2 {
            for channel in 0..3 {
                let mut value = slopes[half][0][channel];
                for k in 1..N {
                    value += slopes[half][k][channel] * regressors[k];
                }
                add(simd, &mut sums[half * SUMS + channel], at, value * weights[half]);
            }
            add(simd, &mut sums[half * SUMS + 3], at, weights[half]);
        }
    }
}

/// Adds a vector to the values from index `at` on.
#[inline(always)]
fn add<S: Simd>(simd: S, sums: &mut [f32], at: usize, more: f32x16<S>) {
    let target = &mut sums[at..at + LANES];
    (f32x16::from_slice(simd, target) + more).store_slice(target);
}

impl<S: Simd> System<S> {
    #[inline(always)]
    fn add<const N: usize>(&mut self, weight: f32x16<S>, regressors: &[f32x16<S>; N], color: [f32x16<S>; 3]) {
        for i in 0..N {
            let weighted = weight * regressors[i];
            for j in 0..=i {
                self.matrix[i][j] += weighted * regressors[j];
            }
            for channel in 0..3 {
                self.right_side[i][channel] += weighted * color[channel];
            }
        }
    }

    /// Solves for constant and slopes by an LDLᵀ (square-root-free Cholesky) decomposition, after
    /// adding the ridge.
    #[inline(always)]
    fn solve<const N: usize>(mut self, simd: S) -> [[f32x16<S>; 3]; N] {
        let one = f32x16::splat(simd, 1.0);
        let total = self.matrix[0][0];
        let mut inverse = [one; N];
        for i in 0..N {
            self.matrix[i][i] = self.matrix[i][i] + total * RIDGE[i] + 1e-20;
            for j in 0..i {
                for k in 0..j {
                    // Rows above are already divided by their pivots; this row still holds
                    // products.
                    self.matrix[i][j] -= self.matrix[i][k] * self.matrix[j][k];
                }
            }
            for j in 0..i {
                let product = self.matrix[i][j];
                self.matrix[i][j] = product * inverse[j];
                self.matrix[i][i] -= product * self.matrix[i][j];
                for channel in 0..3 {
                    self.right_side[i][channel] -= self.matrix[i][j] * self.right_side[j][channel];
                }
            }
            inverse[i] = one / self.matrix[i][i].max(total * 1e-7 + 1e-20);
        }
        let mut slopes = [[one; 3]; N];
        for i in (0..N).rev() {
            for channel in 0..3 {
                let mut value = self.right_side[i][channel] * inverse[i];
                for j in i + 1..N {
                    value -= self.matrix[j][i] * slopes[j][channel];
                }
                slopes[i][channel] = value;
            }
        }
        slopes
    }
}

/// Weights of one block of windows, for both halves.
pub(crate) fn block(weights: &mut [Weights; 2], index: usize) -> [&mut [[f32; LANES]]; 2] {
    weights.each_mut().map(|weights| &mut weights[index * WINDOW_PIXELS..(index + 1) * WINDOW_PIXELS])
}
