//! How a picture is cut into tiles.

use serde::{Deserialize, Serialize};

/// Edge of a tile in pixels.
pub const TILE: u32 = 16;

/// A rectangle of pixels; x to the right, y down, from the picture's top left.
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
    /// How many pixels.
    pub fn area(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// What it shares with another, of no area when nothing.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        let (x, y) = (self.x.max(other.x), self.y.max(other.y));
        let end = |a: u32, b: u32, c: u32, d: u32| a.saturating_add(b).min(c.saturating_add(d));
        let width = end(self.x, self.width, other.x, other.width).saturating_sub(x);
        let height = end(self.y, self.height, other.y, other.height).saturating_sub(y);
        Self { x, y, width, height }
    }

    /// Copies its `pixels` to their places in a `band` that holds it; both row by row.
    pub fn copy<T: Copy>(&self, pixels: &[T], band: &Self, target: &mut [T]) {
        let width = self.width as usize;
        let place = |row: usize| {
            let row = (self.y as usize + row).checked_sub(band.y as usize)?;
            Some(row * band.width as usize + self.x.checked_sub(band.x)? as usize)
        };
        for (row, line) in pixels.chunks_exact(width.max(1)).enumerate() {
            if let Some(start) = place(row)
                && let Some(target) = target.get_mut(start..start + width)
            {
                target.copy_from_slice(line);
            }
        }
    }
}

/// The tiles of a region: the cells of a grid from the picture's top left, [`TILE`] pixels wide and high, as far as
/// they lie in the region. Numbered row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    region: Rect,
}

impl Layout {
    /// Of this region.
    pub fn new(region: Rect) -> Self {
        Self { region }
    }

    /// All pixels.
    pub fn region(&self) -> Rect {
        self.region
    }

    fn cells(start: u32, length: u32) -> u32 {
        if length == 0 { 0 } else { (start.saturating_add(length) - 1) / TILE - start / TILE + 1 }
    }

    /// Tiles side by side.
    pub fn columns(&self) -> u32 {
        Self::cells(self.region.x, self.region.width)
    }

    /// Rows of tiles.
    pub fn rows(&self) -> u32 {
        Self::cells(self.region.y, self.region.height)
    }

    /// How many tiles.
    pub fn tiles(&self) -> u64 {
        u64::from(self.columns()) * u64::from(self.rows())
    }

    /// The pixels of tile `number`; `None` beyond the last.
    pub fn tile(&self, number: u64) -> Option<Rect> {
        if number >= self.tiles() {
            return None;
        }
        let (column, row) = (number % u64::from(self.columns()), number / u64::from(self.columns()));
        let (column, row) = (u32::try_from(column).ok()?, u32::try_from(row).ok()?);
        let cell = |start: u32, place: u32| (start / TILE).checked_add(place)?.checked_mul(TILE);
        let (x, y) = (cell(self.region.x, column)?, cell(self.region.y, row)?);
        Some(self.region.intersection(&Rect { x, y, width: TILE, height: TILE }))
    }

    /// The region in bands, a row of tiles each, from the top.
    pub fn bands(&self) -> impl Iterator<Item = Rect> {
        let Rect { x, width, .. } = self.region;
        let first = (0..u64::from(self.rows())).filter_map(|row| self.tile(row * u64::from(self.columns())));
        first.map(move |tile| Rect { x, width, ..tile })
    }

    /// The numbers of the tiles of band `row`.
    pub fn in_band(&self, row: u64) -> std::ops::Range<u64> {
        let columns = u64::from(self.columns());
        row * columns..(row + 1) * columns
    }
}
