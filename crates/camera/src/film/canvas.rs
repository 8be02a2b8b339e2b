//! A film that stays in memory while it is exposed, and can be read meanwhile.

use super::tile::Tile;
use super::{Clamped, Layout, Run, Sum, TILE, TileError};
use juggler_math::Rgb;
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The tiles of a region, or some of them, each with the samples that it is to get.
#[derive(Debug)]
pub struct Film {
    layout: Layout,
    cells: Vec<Cell>,
}

#[derive(Debug)]
struct Cell {
    number: u64,
    wanted: Vec<Range<u32>>,
    tile: Mutex<Tile>,
}

impl Film {
    /// All tiles, for the samples `wanted`.
    pub fn new(layout: Layout, wanted: Range<u32>) -> Self {
        Self::of(layout, (0..layout.tiles()).map(|number| (number, wanted.clone())))
    }

    /// Some of the tiles, by number, with the samples that they are to get; a number may come again with others.
    /// Numbers beyond the last tile are left out.
    pub fn of(layout: Layout, shares: impl IntoIterator<Item = (u64, Range<u32>)>) -> Self {
        let mut shares: Vec<(u64, Range<u32>)> = shares.into_iter().collect();
        shares.sort_by_key(|(number, wanted)| (*number, wanted.start));
        let cell = |shares: &[(u64, Range<u32>)]| {
            let (number, _) = *shares.first()?;
            let wanted = joined(shares.iter().map(|(_, wanted)| wanted.clone()));
            Some(Cell { number, wanted, tile: Mutex::new(Tile::new(layout.tile(number)?)) })
        };
        let cells = shares.chunk_by(|a, b| a.0 == b.0).filter_map(cell).collect();
        Self { layout, cells }
    }

    /// Bytes that a film of so many pixels holds at most while each tile is in no more than `runs` runs of samples, with
    /// `extras` bytes a pixel of what samples have beside radiance.
    pub fn bytes(pixels: u64, runs: usize, extras: u64) -> u64 {
        // Tiles are arrays of their own, which come and go while others stay: a sixth is lost between them.
        const LOST: u64 = 6;
        let sums = pixels.saturating_mul(size_of::<Sum>() as u64 + extras);
        let tiles = (pixels / u64::from(TILE * TILE)).saturating_add(1);
        let cells = tiles.saturating_mul((size_of::<Cell>() + size_of::<Run>()) as u64);
        sums.saturating_add(sums / LOST).saturating_mul(runs as u64).saturating_add(cells)
    }

    /// How the region is cut.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// How many tiles are held.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether no tile is held.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// The samples that the tile at `place` is to get.
    pub fn wanted(&self, place: usize) -> &[Range<u32>] {
        self.cells.get(place).map_or(&[], |cell| &cell.wanted)
    }

    /// The samples that tile `number` is to get; none when it is not held.
    pub fn wanted_of(&self, number: u64) -> &[Range<u32>] {
        self.place(number).map_or(&[], |place| self.wanted(place))
    }

    /// Samples that all tiles together are to get, over all pixels.
    pub fn goal(&self) -> u64 {
        let each = |cell: &Cell| {
            let area = self.layout.tile(cell.number).map_or(0, |tile| tile.area());
            area * cell.wanted.iter().map(|wanted| wanted.len() as u64).sum::<u64>()
        };
        self.cells.iter().map(each).fold(0, u64::saturating_add)
    }

    fn place(&self, number: u64) -> Option<usize> {
        self.cells.binary_search_by_key(&number, |cell| cell.number).ok()
    }

    /// The tile at `place`, for as long as nobody else needs it.
    pub fn tile(&self, place: usize) -> Option<MutexGuard<'_, Tile>> {
        // Poison only says that another thread panicked, which rayon passes on anyway.
        self.cells.get(place).map(|cell| cell.tile.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Copies of all tiles with samples, one at a time, with their numbers.
    pub fn tiles(&self) -> impl Iterator<Item = (u64, Tile)> {
        let copies = (0..self.cells.len()).map(|place| (self.cells[place].number, self.tile(place)));
        copies.filter_map(|(number, tile)| tile.map(|tile| (number, tile.clone()))).filter(|(_, tile)| !tile.is_empty())
    }

    /// A copy of tile `number`; nothing when it is not held.
    pub fn tile_of(&self, number: u64) -> Option<Tile> {
        self.place(number).and_then(|place| self.tile(place)).map(|tile| tile.clone())
    }

    /// Adds what another film holds of tile `number`; `false` when the tile is not held here.
    pub fn add(&self, number: u64, tile: Tile) -> Result<bool, TileError> {
        let held = self.place(number).and_then(|place| self.tile(place));
        held.map_or(Ok(false), |mut held| held.merge(tile).map(|()| true))
    }

    /// Samples that are there, over all pixels.
    pub fn samples(&self) -> u64 {
        let each = |place: usize| self.tile(place).map_or(0, |tile| tile.pixels().area() * u64::from(tile.count()));
        (0..self.cells.len()).map(each).sum()
    }

    /// How many samples each tile has, in the order of their numbers.
    pub fn counts(&self) -> Vec<u32> {
        (0..self.cells.len()).map(|place| self.tile(place).map_or(0, |tile| tile.count())).collect()
    }

    /// What clamping took off the finished pixels.
    pub fn clamped(&self) -> Clamped {
        (0..self.cells.len()).filter_map(|place| self.tile(place)).map(|tile| tile.clamped()).sum()
    }

    /// Hands the finished pixels to `rows`, whole rows from top to bottom, a band at a time. Tiles that are not held
    /// are black.
    pub fn develop<E>(&self, mut rows: impl FnMut(&[Rgb]) -> Result<(), E>) -> Result<(), E> {
        for (row, band) in (0..).zip(self.layout.bands()) {
            let mut pixels = vec![Rgb::BLACK; band.area() as usize];
            for number in self.layout.in_band(row) {
                if let Some(tile) = self.place(number).and_then(|place| self.tile(place)) {
                    tile.copy_to(&band, &mut pixels);
                }
            }
            rows(&pixels)?;
        }
        Ok(())
    }
}

/// Ranges in order, those that touch as one.
fn joined(ranges: impl Iterator<Item = Range<u32>>) -> Vec<Range<u32>> {
    ranges.fold(Vec::new(), |mut all: Vec<Range<u32>>, range| {
        match all.last_mut() {
            Some(last) if range.start <= last.end => last.end = last.end.max(range.end),
            _ => all.push(range),
        }
        all
    })
}
