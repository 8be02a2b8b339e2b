//! Film in memory, which other threads can read during rendering.

use super::tile::Tile;
use super::{ClampedRadiance, SampleRun, Sum, TILE_EDGE, TileError, Tiling};
use juggler_math::Rgb;
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Tiles of a region, or a subset of them, each with the samples that it should receive.
#[derive(Debug)]
pub struct Film {
    tiling: Tiling,
    cells: Vec<Cell>,
}

#[derive(Debug)]
struct Cell {
    number: u64,
    requested: Vec<Range<u32>>,
    tile: Mutex<Tile>,
}

impl Film {
    /// Creates a film of all tiles, for the samples `requested`.
    pub fn new(tiling: Tiling, requested: Range<u32>) -> Self {
        Self::from_tiles(tiling, (0..tiling.tile_count()).map(|number| (number, requested.clone())))
    }

    /// Creates a film of some tiles, by number, with the samples that each should receive. A number
    /// may occur several times, and its samples are united. Numbers beyond the last tile are
    /// ignored.
    pub fn from_tiles(tiling: Tiling, tiles: impl IntoIterator<Item = (u64, Range<u32>)>) -> Self {
        let mut tiles: Vec<(u64, Range<u32>)> = tiles.into_iter().collect();
        tiles.sort_by_key(|(number, requested)| (*number, requested.start));
        let cell = |tiles: &[(u64, Range<u32>)]| {
            let (number, _) = *tiles.first()?;
            let requested = merge_ranges(tiles.iter().map(|(_, requested)| requested.clone()));
            Some(Cell { number, requested, tile: Mutex::new(Tile::new(tiling.tile(number)?)) })
        };
        let cells = tiles.chunk_by(|a, b| a.0 == b.0).filter_map(cell).collect();
        Self { tiling, cells }
    }

    /// Upper bound on the memory in bytes of a film with `pixels` pixels and at most `runs` runs of
    /// samples per tile. `aov_sums` is the number of bytes per pixel for AOVs and masks.
    pub fn max_bytes(pixels: u64, runs: usize, aov_sums: u64) -> u64 {
        // Tiles are separate allocations of changing lifetime; fragmentation wastes a sixth.
        const FRAGMENTATION: u64 = 6;
        let sums = pixels.saturating_mul(size_of::<Sum>() as u64 + aov_sums);
        let tiles = (pixels / u64::from(TILE_EDGE * TILE_EDGE)).saturating_add(1);
        let cells = tiles.saturating_mul((size_of::<Cell>() + size_of::<SampleRun>()) as u64);
        sums.saturating_add(sums / FRAGMENTATION).saturating_mul(runs as u64).saturating_add(cells)
    }

    /// Tiling of the region.
    pub fn tiling(&self) -> Tiling {
        self.tiling
    }

    /// Number of tiles.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether the film has no tiles.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Samples that the tile at index `index` should receive.
    pub fn requested(&self, index: usize) -> &[Range<u32>] {
        self.cells.get(index).map_or(&[], |cell| &cell.requested)
    }

    /// Samples that tile `number` should receive; empty if the film does not have the tile.
    pub fn requested_of(&self, number: u64) -> &[Range<u32>] {
        self.index_of(number).map_or(&[], |index| self.requested(index))
    }

    /// Total number of samples that all pixels should receive.
    pub fn requested_samples(&self) -> u64 {
        let each = |cell: &Cell| {
            let area = self.tiling.tile(cell.number).map_or(0, |tile| tile.area());
            area * cell.requested.iter().map(|requested| requested.len() as u64).sum::<u64>()
        };
        self.cells.iter().map(each).fold(0, u64::saturating_add)
    }

    fn index_of(&self, number: u64) -> Option<usize> {
        self.cells.binary_search_by_key(&number, |cell| cell.number).ok()
    }

    /// Locks the tile at index `index`; `None` beyond the last.
    pub fn tile(&self, index: usize) -> Option<MutexGuard<'_, Tile>> {
        // A poisoned lock only means that another thread panicked, which rayon propagates anyway.
        self.cells.get(index).map(|cell| cell.tile.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Locks tile `number`; `None` if the film does not have the tile.
    pub fn tile_of(&self, number: u64) -> Option<MutexGuard<'_, Tile>> {
        self.index_of(number).and_then(|index| self.tile(index))
    }

    /// Copies of all tiles with samples, one at a time, with their numbers.
    pub fn tiles(&self) -> impl Iterator<Item = (u64, Tile)> {
        let copies = (0..self.cells.len()).map(|index| (self.cells[index].number, self.tile(index)));
        copies.filter_map(|(number, tile)| tile.map(|tile| (number, tile.clone()))).filter(|(_, tile)| !tile.is_empty())
    }

    /// Copy of tile `number`; `None` if the film does not have the tile.
    pub fn copy_of_tile(&self, number: u64) -> Option<Tile> {
        self.tile_of(number).map(|tile| tile.clone())
    }

    /// Adds the samples of tile `number` of another film; `false` if this film does not have the
    /// tile.
    pub fn add(&self, number: u64, tile: Tile) -> Result<bool, TileError> {
        self.tile_of(number).map_or(Ok(false), |mut held| held.merge(tile).map(|()| true))
    }

    /// Number of tiles that have samples.
    pub fn tiles_held(&self) -> usize {
        (0..self.cells.len()).filter_map(|index| self.tile(index)).filter(|tile| !tile.is_empty()).count()
    }

    /// Number of samples over all pixels.
    pub fn samples(&self) -> u64 {
        let each = |index: usize| {
            self.tile(index).map_or(0, |tile| tile.pixels().area() * u64::from(tile.samples_per_pixel()))
        };
        (0..self.cells.len()).map(each).sum()
    }

    /// Number of samples per pixel of each tile, in the order of tile numbers.
    pub fn counts(&self) -> Vec<u32> {
        (0..self.cells.len()).map(|index| self.tile(index).map_or(0, |tile| tile.samples_per_pixel())).collect()
    }

    /// Radiance that clamping removed from the finished pixels.
    pub fn clamped(&self) -> ClampedRadiance {
        (0..self.cells.len()).filter_map(|index| self.tile(index)).map(|tile| tile.clamped()).sum()
    }

    /// Passes the finished pixels to `rows` in bands of whole rows, from top to bottom. Missing
    /// tiles are black.
    pub fn develop<E>(&self, mut rows: impl FnMut(&[Rgb]) -> Result<(), E>) -> Result<(), E> {
        for (row, band) in (0..).zip(self.tiling.bands()) {
            let mut pixels = vec![Rgb::BLACK; band.area() as usize];
            for number in self.tiling.tiles_of_band(row) {
                if let Some(tile) = self.tile_of(number) {
                    tile.copy_to(&band, &mut pixels);
                }
            }
            rows(&pixels)?;
        }
        Ok(())
    }
}

/// Merges sorted ranges that touch or overlap.
fn merge_ranges(ranges: impl Iterator<Item = Range<u32>>) -> Vec<Range<u32>> {
    ranges.fold(Vec::new(), |mut all: Vec<Range<u32>>, range| {
        match all.last_mut() {
            Some(last) if range.start <= last.end => last.end = last.end.max(range.end),
            _ => all.push(range),
        }
        all
    })
}
