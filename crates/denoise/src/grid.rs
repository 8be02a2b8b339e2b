//! Where things are: pictures with a margin, and the grid of windows on them.

use std::ops::Range;

/// Pixels from one window's centre to the next, in both directions.
pub(crate) const STEP: usize = 2;
/// Pixels that a window reaches to each side of its centre.
pub(crate) const REACH: usize = 9;
/// Pixels that a patch, the neighbourhood by which pixels are compared, reaches to each side.
pub(crate) const PATCH: usize = 3;
/// Pixels around the picture, so that no window or patch ends outside. A multiple of `STEP`.
pub(crate) const MARGIN: usize = 12;
/// Pixels in the rows and columns of a window.
pub(crate) const SIDE: usize = 2 * REACH + 1;
/// Pixels of a window.
pub(crate) const OFFSETS: usize = SIDE * SIDE;
/// Windows that are computed side by side; two halves where vectors are shorter.
pub(crate) const LANES: usize = 16;
/// Windows in a row of a tile.
pub(crate) const TILE_COLUMNS: usize = 32;
/// Rows of windows of a tile.
pub(crate) const TILE_ROWS: usize = 8;

const _: () = assert!(MARGIN >= REACH + PATCH && MARGIN.is_multiple_of(STEP) && TILE_COLUMNS.is_multiple_of(LANES));

/// A picture's size and that of its planes with margins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Numbers in a row of a plane: margins, and room for a last tile that is not full. A multiple of `STEP`.
    pub stride: usize,
}

impl Grid {
    pub fn new(width: usize, height: usize) -> Self {
        let tiles = width.div_ceil(STEP * TILE_COLUMNS);
        Self { width, height, stride: (tiles * TILE_COLUMNS + LANES) * STEP + 2 * MARGIN }
    }

    /// Windows in a row.
    pub fn columns(&self) -> usize {
        self.width.div_ceil(STEP)
    }

    /// Rows of windows.
    pub fn rows(&self) -> usize {
        self.height.div_ceil(STEP)
    }

    /// Numbers of a plane that belong to one of the `STEP` classes of columns, in one row.
    pub fn phase_stride(&self) -> usize {
        self.stride / STEP
    }

    /// A plane with margins, which repeat the outermost pixels.
    pub fn pad(&self, pixel: impl Fn(usize) -> f32) -> Vec<f32> {
        let mut plane = Vec::with_capacity(self.stride * (self.height + 2 * MARGIN));
        for y in 0..self.height + 2 * MARGIN {
            let row = y.saturating_sub(MARGIN).min(self.height - 1) * self.width;
            plane.extend((0..self.stride).map(|x| pixel(row + x.saturating_sub(MARGIN).min(self.width - 1))));
        }
        plane
    }

    /// A plane with margins of zero.
    pub fn pad_zero(&self, pixel: impl Fn(usize) -> f32) -> Vec<f32> {
        let mut plane = vec![0.0; self.stride * (self.height + 2 * MARGIN)];
        for y in 0..self.height {
            let start = (y + MARGIN) * self.stride + MARGIN;
            for (x, number) in plane[start..start + self.width].iter_mut().enumerate() {
                *number = pixel(y * self.width + x);
            }
        }
        plane
    }

    /// A plane with each row sorted by column modulo `STEP`, so that pixels seen from neighbouring windows are neighbours.
    pub fn phases(&self, plane: &[f32]) -> Vec<f32> {
        let mut sorted = Vec::with_capacity(plane.len());
        for row in plane.chunks_exact(self.stride) {
            for phase in 0..STEP {
                sorted.extend(row.iter().skip(phase).step_by(STEP));
            }
        }
        sorted
    }

    /// All tiles, row by row.
    pub fn tiles(&self) -> Vec<Tile> {
        let mut tiles = Vec::new();
        for row in (0..self.rows()).step_by(TILE_ROWS) {
            for column in (0..self.columns()).step_by(TILE_COLUMNS) {
                let rows = row..self.rows().min(row + TILE_ROWS);
                tiles.push(Tile { rows, columns: column..self.columns().min(column + TILE_COLUMNS) });
            }
        }
        tiles
    }
}

/// Windows that are computed together.
#[derive(Clone, Debug)]
pub(crate) struct Tile {
    /// Of the grid's rows of windows.
    pub rows: Range<usize>,
    /// Of the windows of each.
    pub columns: Range<usize>,
}

/// From a window's centre to each of its pixels (columns, rows), row by row.
pub(crate) fn offsets() -> impl Iterator<Item = (isize, isize)> {
    let reach = REACH as isize;
    (-reach..=reach).flat_map(move |y| (-reach..=reach).map(move |x| (x, y)))
}
