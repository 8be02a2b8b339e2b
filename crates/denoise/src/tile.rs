//! Tiles of windows on the threads of the current pool; what they give is added in the tiles' order.

use crate::features::FEATURES;
use crate::grid::{LANES, MARGIN, REACH, STEP, TILE_COLUMNS, TILE_ROWS, Tile};
use crate::prepare::Prepared;
use crate::regression::{PHASE, SUMS, SUMS_STRIDE, Steps, Windows, block};
use crate::weights::Guide;
use crate::{Settings, SimdLevel};
use fearless_simd::dispatch;
use rayon::prelude::*;

/// Tiles whose sums are in memory at the same time.
const AT_ONCE: usize = 64;

/// Each pixel's red, green and blue, multiplied by the weight, and the weight.
pub(crate) type Sums = Vec<[f32; SUMS]>;

/// Both halves filtered, or nothing when it was cancelled.
pub(crate) fn filter(
    level: SimdLevel,
    prepared: &Prepared,
    settings: &Settings,
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Option<[Sums; 2]> {
    let grid = &prepared.grid;
    let steps = Steps::new(prepared);
    let mut filtered = [0, 1].map(|_| vec![[0.0; SUMS]; grid.width * grid.height]);
    for tiles in grid.tiles().chunks(AT_ONCE) {
        let compute = |tile: &Tile| (!cancelled()).then(|| windows(level, prepared, settings, &steps, tile));
        let computed: Option<Vec<TileSums>> = tiles.par_iter().map(compute).collect();
        for (tile, sums) in tiles.iter().zip(computed?) {
            add(prepared, tile, &sums, &mut filtered);
        }
    }
    Some(filtered)
}

/// What a tile's windows add to the pixels that they reach: a plane for each half and number, columns in phases.
type TileSums = [Vec<f32>; 2 * SUMS];

fn windows(level: SimdLevel, prepared: &Prepared, settings: &Settings, steps: &Steps, tile: &Tile) -> TileSums {
    let rows = (tile.rows.len() - 1) * STEP + 2 * REACH + 1;
    debug_assert!(rows <= (TILE_ROWS - 1) * STEP + 2 * REACH + 1);
    let mut sums: TileSums = std::array::from_fn(|_| vec![0.0; rows * SUMS_STRIDE]);
    // Weights of a half come from the other.
    let mut weights = [1, 0].map(|guide| {
        let guide = Guide::new(prepared, guide, settings.strength);
        dispatch!(level, simd => guide.weights(simd, tile))
    });
    let blocks = TILE_COLUMNS / LANES;
    for row in 0..tile.rows.len() {
        for index in 0..tile.columns.len().div_ceil(LANES) {
            let at = [tile.rows.start + row, tile.columns.start + index * LANES];
            let windows = Windows::new(prepared, steps, at, [row, index]);
            let weights = block(&mut weights, row * blocks + index);
            if prepared.features.is_empty() {
                dispatch!(level, simd => windows.filter::<_, 3>(simd, weights, &mut sums));
            } else {
                dispatch!(level, simd => windows.filter::<_, { 3 + FEATURES }>(simd, weights, &mut sums));
            }
        }
    }
    sums
}

/// Adds a tile's sums to those of the picture.
fn add(prepared: &Prepared, tile: &Tile, sums: &TileSums, filtered: &mut [Sums; 2]) {
    let (width, height) = (prepared.grid.width, prepared.grid.height);
    // Pixels before the tile's first centre that its sums begin with, in columns.
    let first = tile.columns.start * STEP;
    for (row, start) in (0..sums[0].len()).step_by(SUMS_STRIDE).enumerate() {
        let Some(y) = (tile.rows.start * STEP + row).checked_sub(REACH).filter(|y| *y < height) else { continue };
        for x in (first.saturating_sub(REACH))..width.min(first + SUMS_STRIDE - MARGIN) {
            let column = x + MARGIN - first;
            let at = start + column % STEP * PHASE + column / STEP;
            for half in 0..2 {
                let pixel = &mut filtered[half][y * width + x];
                for (k, number) in pixel.iter_mut().enumerate() {
                    *number += sums[half * SUMS + k][at];
                }
            }
        }
    }
}
