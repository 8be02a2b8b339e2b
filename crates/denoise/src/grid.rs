//! Layout of padded planes, and the grid of windows.

use std::ops::Range;

/// Distance between window centers, in pixels, in both directions.
pub(crate) const STEP: usize = 2;
/// Radius of a window, in pixels.
pub(crate) const WINDOW_RADIUS: usize = 9;
/// Radius of a patch, in pixels: patches are the neighborhoods by which pixels are compared.
pub(crate) const PATCH_RADIUS: usize = 3;
/// Width of the margin, in pixels, so that no window or patch leaves the plane. A multiple of
/// `STEP`.
pub(crate) const MARGIN: usize = 12;
/// Width and height of a window, in pixels.
pub(crate) const WINDOW_SIZE: usize = 2 * WINDOW_RADIUS + 1;
/// Number of pixels in a window.
pub(crate) const WINDOW_PIXELS: usize = WINDOW_SIZE * WINDOW_SIZE;
/// Number of windows in a SIMD vector; two vectors where registers are shorter.
pub(crate) const LANES: usize = 16;
/// Number of windows in a row of a tile.
pub(crate) const TILE_COLUMNS: usize = 32;
/// Number of rows of windows in a tile.
pub(crate) const TILE_ROWS: usize = 8;

const _: () = assert!(
    MARGIN >= WINDOW_RADIUS + PATCH_RADIUS && MARGIN.is_multiple_of(STEP) && TILE_COLUMNS.is_multiple_of(LANES)
);

/// Size of a picture and of its padded planes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    /// Width of the picture, in pixels.
    pub width: usize,
    /// Height of the picture, in pixels.
    pub height: usize,
    /// Row stride of a plane: margins included, and space for an incomplete last tile. A multiple
    /// of `STEP`.
    pub stride: usize,
}

impl Grid {
    pub fn new(width: usize, height: usize) -> Self {
        let tiles = width.div_ceil(STEP * TILE_COLUMNS);
        Self { width, height, stride: (tiles * TILE_COLUMNS + LANES) * STEP + 2 * MARGIN }
    }

    /// Number of windows in a row.
    pub fn columns(&self) -> usize {
        self.width.div_ceil(STEP)
    }

    /// Number of rows of windows.
    pub fn rows(&self) -> usize {
        self.height.div_ceil(STEP)
    }

    /// Number of values in one row that belong to one of the `STEP` column phases.
    pub fn phase_stride(&self) -> usize {
        self.stride / STEP
    }

    /// Pads a plane by repeating the outermost pixels.
    pub fn pad(&self, pixel: impl Fn(usize) -> f32) -> Vec<f32> {
        let mut plane = Vec::with_capacity(self.stride * (self.height + 2 * MARGIN));
        for y in 0..self.height + 2 * MARGIN {
            let row = y.saturating_sub(MARGIN).min(self.height - 1) * self.width;
            plane.extend((0..self.stride).map(|x| pixel(row + x.saturating_sub(MARGIN).min(self.width - 1))));
        }
        plane
    }

    /// Pads a plane with zeros.
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

    /// Sorts each row of a plane by column modulo `STEP`, so that pixels at the same offset of
    /// neighboring windows are contiguous.
    pub fn phases(&self, plane: &[f32]) -> Vec<f32> {
        let mut sorted = Vec::with_capacity(plane.len());
        for row in plane.chunks_exact(self.stride) {
            for phase in 0..STEP {
                sorted.extend(row.iter().skip(phase).step_by(STEP));
            }
        }
        sorted
    }

    /// All tiles, in row-major order.
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

/// A block of windows that are computed together.
#[derive(Clone, Debug)]
pub(crate) struct Tile {
    /// Range in the grid's rows of windows.
    pub rows: Range<usize>,
    /// Range of windows in each row.
    pub columns: Range<usize>,
}

/// Offsets (x, y) of a window's pixels from its center, in row-major order.
pub(crate) fn offsets() -> impl Iterator<Item = (isize, isize)> {
    let radius = WINDOW_RADIUS as isize;
    (-radius..=radius).flat_map(move |y| (-radius..=radius).map(move |x| (x, y)))
}
