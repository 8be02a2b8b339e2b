//! Tiling of a picture.

use serde::{Deserialize, Serialize};

/// Edge length of a tile in pixels.
pub const TILE_EDGE: u32 = 16;

/// Rectangle of pixels; x to the right, y down, from the picture's top left.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rect {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Rect {
    /// Creates the rectangle of a size whose top left pixel is (`x`, `y`).
    pub fn new(x: u32, y: u32, width: u32, height: u32) -> Self {
        Self { x, y, width, height }
    }

    /// Number of pixels.
    pub fn area(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// Intersection with another rectangle; its area is 0 if they are disjoint.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        let (x, y) = (self.x.max(other.x), self.y.max(other.y));
        let end = |a: u32, b: u32, c: u32, d: u32| a.saturating_add(b).min(c.saturating_add(d));
        let width = end(self.x, self.width, other.x, other.width).saturating_sub(x);
        let height = end(self.y, self.height, other.y, other.height).saturating_sub(y);
        Self { x, y, width, height }
    }

    /// Copies the `pixels` of this rectangle into `target`, the pixels of an enclosing `band`; both
    /// are stored row by row.
    pub fn copy_into<T: Copy>(&self, pixels: &[T], band: &Self, target: &mut [T]) {
        let width = self.width as usize;
        let start_of = |row: usize| {
            let row = (self.y as usize + row).checked_sub(band.y as usize)?;
            Some(row * band.width as usize + self.x.checked_sub(band.x)? as usize)
        };
        for (row, line) in pixels.chunks_exact(width.max(1)).enumerate() {
            if let Some(start) = start_of(row)
                && let Some(target) = target.get_mut(start..start + width)
            {
                target.copy_from_slice(line);
            }
        }
    }
}

/// Tiling of a region: the cells of a grid from the picture's top left, [`TILE_EDGE`] ×
/// [`TILE_EDGE`] pixels, clipped to the region and numbered row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tiling {
    region: Rect,
}

impl Tiling {
    /// Creates the tiling of a region.
    pub fn new(region: Rect) -> Self {
        Self { region }
    }

    /// Region of all tiles.
    pub fn region(&self) -> Rect {
        self.region
    }

    fn cells(start: u32, length: u32) -> u32 {
        if length == 0 { 0 } else { (start.saturating_add(length) - 1) / TILE_EDGE - start / TILE_EDGE + 1 }
    }

    /// Number of tile columns.
    pub fn columns(&self) -> u32 {
        Self::cells(self.region.x, self.region.width)
    }

    /// Number of tile rows.
    pub fn rows(&self) -> u32 {
        Self::cells(self.region.y, self.region.height)
    }

    /// Number of tiles.
    pub fn tile_count(&self) -> u64 {
        u64::from(self.columns()) * u64::from(self.rows())
    }

    /// Pixels of tile `number`; `None` beyond the last.
    pub fn tile(&self, number: u64) -> Option<Rect> {
        if number >= self.tile_count() {
            return None;
        }
        let (column, row) = (number % u64::from(self.columns()), number / u64::from(self.columns()));
        let (column, row) = (u32::try_from(column).ok()?, u32::try_from(row).ok()?);
        let cell = |start: u32, offset: u32| (start / TILE_EDGE).checked_add(offset)?.checked_mul(TILE_EDGE);
        let (x, y) = (cell(self.region.x, column)?, cell(self.region.y, row)?);
        Some(self.region.intersection(&Rect { x, y, width: TILE_EDGE, height: TILE_EDGE }))
    }

    /// Bands of the region, one per row of tiles, from the top.
    pub fn bands(&self) -> impl Iterator<Item = Rect> {
        let Rect { x, width, .. } = self.region;
        let first = (0..u64::from(self.rows())).filter_map(|row| self.tile(row * u64::from(self.columns())));
        first.map(move |tile| Rect { x, width, ..tile })
    }

    /// Numbers of the tiles in band `row`.
    pub fn tiles_of_band(&self, row: u64) -> std::ops::Range<u64> {
        let columns = u64::from(self.columns());
        row * columns..(row + 1) * columns
    }
}
