//! Parallel filtering of tiles. Sums are added in the order of the tiles, so that the result does
//! not depend on the threads.

use crate::features::FEATURES;
use crate::grid::{LANES, MARGIN, STEP, TILE_COLUMNS, TILE_ROWS, Tile, WINDOW_RADIUS};
use crate::prepare::Prepared;
use crate::regression::{PHASE, SUMS, SUMS_STRIDE, Steps, Windows, block};
use crate::weights::Guide;
use crate::{Settings, SimdLevel};
use fearless_simd::dispatch;
use rayon::prelude::*;

/// Maximum number of tiles whose sums are in memory at the same time.
const AT_ONCE: usize = 64;

/// Weighted sums of red, green and blue and the sum of weights, for each pixel.
pub(crate) type Sums = Vec<[f32; SUMS]>;

/// Filters both halves; `None` if cancelled.
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

/// Sums of a tile's windows over the pixels that they cover: a plane for each half and component,
/// columns in phases.
type TileSums = [Vec<f32>; 2 * SUMS];

fn windows(level: SimdLevel, prepared: &Prepared, settings: &Settings, steps: &Steps, tile: &Tile) -> TileSums {
    let rows = (tile.rows.len() - 1) * STEP + 2 * WINDOW_RADIUS + 1;
    debug_assert!(rows <= (TILE_ROWS - 1) * STEP + 2 * WINDOW_RADIUS + 1);
    let mut sums: TileSums = std::array::from_fn(|_| vec![0.0; rows * SUMS_STRIDE]);
    // Cross filtering: the weights of a half come from the other.
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
    // Convert the column of the tile's first window to pixels.
    let first = tile.columns.start * STEP;
    for (row, start) in (0..sums[0].len()).step_by(SUMS_STRIDE).enumerate() {
        let Some(y) = (tile.rows.start * STEP + row).checked_sub(WINDOW_RADIUS).filter(|y| *y < height) else {
            continue;
        };
        for x in (first.saturating_sub(WINDOW_RADIUS))..width.min(first + SUMS_STRIDE - MARGIN) {
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
