//! Weights of the pixels of each window: how alike the patches around a pixel and the window's centre are in the other half,
//! beyond what noise makes of them (Rousselle, Knaus, Zwicker 2012, equation 3).
//!
//! Deviations: one ratio of sums over the channels instead of a sum of ratios, and instead of an exponential a polynomial of
//! like form that ends.

use crate::features::falling;
use crate::grid::{LANES, MARGIN, OFFSETS, PATCH, STEP, TILE_COLUMNS, TILE_ROWS, Tile, offsets};
use crate::prepare::Prepared;
use fearless_simd::f32x16;
use fearless_simd::prelude::*;

/// Rows of pixels that the patches of a tile's centres cover.
const ROWS: usize = (TILE_ROWS - 1) * STEP + 2 * PATCH + 1;
/// Columns likewise, filled up to whole lanes.
const COLUMNS: usize = ((TILE_COLUMNS - 1) * STEP + 2 * PATCH + 1).next_multiple_of(LANES);
/// How far, in standard deviations of the noise, alike colours may be apart.
const BANDWIDTH: f32 = 0.6;

/// What patches of 3 × 3 pixels and single pixels count: where no other large patch is alike, beside bright edges, they decide.
const SMALL: f32 = 0.1;
const SINGLE: f32 = 0.02;

/// For each row of windows, each block of lanes in it and each offset: the weights of the lanes.
pub(crate) type Weights = Vec<[f32; LANES]>;

/// What is compared: a guide's channels, their variance, and how.
pub(crate) struct Guide<'a> {
    pub stride: usize,
    pub channels: [&'a [f32]; 3],
    pub variance: &'a [f32],
    /// The square of a difference that is none.
    pub tolerance: f32,
    /// The square of the bandwidth.
    pub bandwidth: f32,
}

impl<'a> Guide<'a> {
    /// Of a half, which the other one's windows are weighed by.
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

    /// All weights of a tile's windows. Windows that the tile has not get none.
    #[inline(always)]
    pub fn weights<S: Simd>(&self, simd: S, tile: &Tile) -> Weights {
        let blocks = TILE_COLUMNS / LANES;
        let mut weights = vec![[0.0; LANES]; tile.rows.len() * blocks * OFFSETS];
        let mut distances = vec![[0.0; COLUMNS]; ROWS];
        let first =
            (MARGIN + tile.rows.start * STEP - PATCH) * self.stride + MARGIN + tile.columns.start * STEP - PATCH;
        let rows = (tile.rows.len() - 1) * STEP + 2 * PATCH + 1;
        for (offset, (x, y)) in offsets().enumerate() {
            let shift = y * self.stride as isize + x;
            for (row, line) in distances[..rows].iter_mut().enumerate() {
                self.distances(simd, first + row * self.stride, shift, line);
            }
            for row in 0..tile.rows.len() {
                let around = &distances[row * STEP..];
                let large = patches(simd, around, PATCH);
                let small = patches(simd, around, 1);
                let single = patches(simd, around, 0);
                for block in 0..blocks {
                    let weight = &mut weights[(row * blocks + block) * OFFSETS + offset];
                    let lesser = by_patch(simd, &small[block], 1) * SMALL;
                    let least = by_patch(simd, &single[block], 0) * SINGLE;
                    by_patch(simd, &large[block], PATCH).max(lesser).max(least).store_slice(weight);
                    let there = tile.columns.len().saturating_sub(block * LANES).min(LANES);
                    weight[there..].fill(0.0);
                }
            }
        }
        weights
    }

    /// How different the pixels from `first` on are from those `shift` further, each, beyond their noise.
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

/// Numbers from `at` on.
#[inline(always)]
pub(crate) fn load<S: Simd>(simd: S, numbers: &[f32], at: usize) -> f32x16<S> {
    f32x16::from_slice(simd, &numbers[at..at + LANES])
}

/// Sums over the patches of `radius` around a row of windows' centres.
// No closures and no folds: they are compiled without the vector unit's instructions and cost several times as much.
#[inline(always)]
fn patches<S: Simd>(simd: S, rows: &[[f32; COLUMNS]], radius: usize) -> [[f32; LANES]; TILE_COLUMNS / LANES] {
    let (mut down, mut across) = ([0.0; COLUMNS + LANES], [0.0; COLUMNS]);
    for at in (0..COLUMNS).step_by(LANES) {
        let mut sum = load(simd, &rows[PATCH - radius], at);
        for row in &rows[PATCH - radius + 1..=PATCH + radius] {
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
        *sum = across[window * STEP + PATCH - radius];
    }
    sums
}

/// Weights by patches of `radius`.
#[inline(always)]
fn by_patch<S: Simd>(simd: S, sums: &[f32; LANES], radius: usize) -> f32x16<S> {
    falling(simd, load(simd, sums, 0) * (1.0 / ((2 * radius + 1) * (2 * radius + 1)) as f32))
}
