//! Non-local means weights of the pixels of each window: similarity, in the other half, of the
//! patches around pixel and window center, beyond the difference that noise explains (Rousselle,
//! Knaus, Zwicker 2012, equation 3).
//!
//! Deviations: one ratio of sums over the channels instead of a sum of ratios, and a polynomial of
//! compact support instead of an exponential.

use crate::features::exp_approximation;
use crate::grid::{LANES, MARGIN, PATCH_RADIUS, STEP, TILE_COLUMNS, TILE_ROWS, Tile, WINDOW_PIXELS, offsets};
use crate::prepare::Prepared;
use fearless_simd::f32x16;
use fearless_simd::prelude::*;

/// Number of pixel rows that the patches of a tile's window centers cover.
const ROWS: usize = (TILE_ROWS - 1) * STEP + 2 * PATCH_RADIUS + 1;
/// Number of pixel columns, rounded up to whole vectors.
const COLUMNS: usize = ((TILE_COLUMNS - 1) * STEP + 2 * PATCH_RADIUS + 1).next_multiple_of(LANES);
/// Bandwidth: color difference of similar pixels, in standard deviations of the noise.
const BANDWIDTH: f32 = 0.6;

/// Factors of the weights from 3 × 3 patches and single pixels. They decide where no other large
/// patch is similar, such as beside bright edges.
const SMALL_PATCH_FACTOR: f32 = 0.1;
const PIXEL_FACTOR: f32 = 0.02;

/// Weights of a tile's windows: a vector for each row of windows, each block of lanes in it and
/// each offset.
pub(crate) type Weights = Vec<[f32; LANES]>;

/// The half whose pixels are compared.
pub(crate) struct Guide<'a> {
    pub stride: usize,
    pub channels: [&'a [f32]; 3],
    pub variance: &'a [f32],
    /// Squared difference that counts as none.
    pub tolerance: f32,
    /// Squared bandwidth.
    pub bandwidth: f32,
}

impl<'a> Guide<'a> {
    /// Creates the guide from a half; it weights the windows of the other half.
    pub fn new(prepared: &'a Prepared, half: usize, strength: f32) -> Self {
        let [red, green, blue] = &prepared.guides[half];
        let bandwidth = (BANDWIDTH * strength.max(0.0)).min(100.0);
        Self {
            stride: prepared.grid.stride,
            channels: [red, green, blue],
            variance: &prepared.variance,
            tolerance: (prepared.scale * prepared.scale * 1e-7).max(1e-30),
            bandwidth: bandwidth * bandwidth,
        }
    }

    /// Computes the weights of all windows of a tile; 0 for windows beyond the picture's edge.
    #[inline(always)]
    pub fn weights<S: Simd>(&self, simd: S, tile: &Tile) -> Weights {
        let blocks = TILE_COLUMNS / LANES;
        let mut weights = vec![[0.0; LANES]; tile.rows.len() * blocks * WINDOW_PIXELS];
        let mut distances = vec![[0.0; COLUMNS]; ROWS];
        let first = (MARGIN + tile.rows.start * STEP - PATCH_RADIUS) * self.stride + MARGIN + tile.columns.start * STEP
            - PATCH_RADIUS;
        let rows = (tile.rows.len() - 1) * STEP + 2 * PATCH_RADIUS + 1;
        for (offset, (x, y)) in offsets().enumerate() {
            let shift = y * self.stride as isize + x;
            for (row, line) in distances[..rows].iter_mut().enumerate() {
                self.distances(simd, first + row * self.stride, shift, line);
            }
            for row in 0..tile.rows.len() {
                let lines = &distances[row * STEP..];
                let large = patches(simd, lines, PATCH_RADIUS);
                let small = patches(simd, lines, 1);
                let single = patches(simd, lines, 0);
                for block in 0..blocks {
                    let weight = &mut weights[(row * blocks + block) * WINDOW_PIXELS + offset];
                    let lesser = patch_weights(simd, &small[block], 1) * SMALL_PATCH_FACTOR;
                    let least = patch_weights(simd, &single[block], 0) * PIXEL_FACTOR;
                    patch_weights(simd, &large[block], PATCH_RADIUS).max(lesser).max(least).store_slice(weight);
                    let there = tile.columns.len().saturating_sub(block * LANES).min(LANES);
                    weight[there..].fill(0.0);
                }
            }
        }
        weights
    }

    /// Normalized squared differences, minus those expected from noise, between the pixels from
    /// `first` on and those at the offset `shift`.
    #[inline(always)]
    fn distances<S: Simd>(&self, simd: S, first: usize, shift: isize, line: &mut [f32; COLUMNS]) {
        let other = first.wrapping_add_signed(shift);
        let [red, green, blue] = self.channels;
        let (red_here, red_there) = (&red[first..][..COLUMNS], &red[other..][..COLUMNS]);
        let (green_here, green_there) = (&green[first..][..COLUMNS], &green[other..][..COLUMNS]);
        let (blue_here, blue_there) = (&blue[first..][..COLUMNS], &blue[other..][..COLUMNS]);
        let (here, there) = (&self.variance[first..][..COLUMNS], &self.variance[other..][..COLUMNS]);
        for at in (0..COLUMNS).step_by(LANES) {
            let r = load(simd, red_here, at) - load(simd, red_there, at);
            let g = load(simd, green_here, at) - load(simd, green_there, at);
            let b = load(simd, blue_here, at) - load(simd, blue_there, at);
            let (own, its) = (load(simd, here, at), load(simd, there, at));
            let excess = r * r + g * g + b * b - (own + own.min(its));
            let distance = excess / ((own + its) * self.bandwidth + self.tolerance);
            distance.store_slice(&mut line[at..at + LANES]);
        }
    }
}

/// Loads a vector of values from index `at` on.
#[inline(always)]
pub(crate) fn load<S: Simd>(simd: S, numbers: &[f32], at: usize) -> f32x16<S> {
    f32x16::from_slice(simd, &numbers[at..at + LANES])
}

/// Sums over the patches of `radius` around a row of window centers.
// No closures or folds: they are compiled without SIMD instructions and run several times slower.
#[inline(always)]
fn patches<S: Simd>(simd: S, rows: &[[f32; COLUMNS]], radius: usize) -> [[f32; LANES]; TILE_COLUMNS / LANES] {
    let (mut down, mut across) = ([0.0; COLUMNS + LANES], [0.0; COLUMNS]);
    for at in (0..COLUMNS).step_by(LANES) {
        let mut sum = load(simd, &rows[PATCH_RADIUS - radius], at);
        for row in &rows[PATCH_RADIUS - radius + 1..=PATCH_RADIUS + radius] {
            sum += load(simd, row, at);
        }
        sum.store_slice(&mut down[at..at + LANES]);
    }
    for at in (0..COLUMNS).step_by(LANES) {
        let mut sum = load(simd, &down, at);
        for shift in 1..=2 * radius {
            sum += load(simd, &down, at + shift);
        }
        sum.store_slice(&mut across[at..at + LANES]);
    }
    let mut sums = [[0.0; LANES]; TILE_COLUMNS / LANES];
    for (window, sum) in sums.as_flattened_mut().iter_mut().enumerate() {
        *sum = across[window * STEP + PATCH_RADIUS - radius];
    }
    sums
}

/// Converts sums over patches of `radius` to weights.
#[inline(always)]
fn patch_weights<S: Simd>(simd: S, sums: &[f32; LANES], radius: usize) -> f32x16<S> {
    exp_approximation(simd, load(simd, sums, 0) * (1.0 / ((2 * radius + 1) * (2 * radius + 1)) as f32))
}
