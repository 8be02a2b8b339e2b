//! Parts that belong together become one picture, or one part, with the bits that a single render would have given.
//!
//! First everything is checked: that the parts are of one picture, that every byte is what was written, that no sample
//! is missing or there twice; all that is wrong is said at once. Then the picture streams: a band of rows is gathered
//! from all parts, one open file at a time, so that memory depends on neither their number nor the picture's height
//! (but for a few dozen bytes for each tile of each part).

mod check;
mod complaint;
#[cfg(test)]
mod tests;

pub use complaint::{Complaint, MergeError, ToDo};

use crate::counts;
use crate::part::{Chunk, Description, Part, PartError, PartWriter};
use juggler_math::Rgb;
use juggler_tracer::film::{Digest, Layout, Rect, Summary, TILE, Tile};
use std::path::Path;

/// Most pixels of a band, if one row of tiles has not more.
const BAND: u64 = 1 << 20;

/// What parts are to become.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// The whole picture: nothing may be missing.
    Whole,
    /// A larger part.
    Part,
}

/// Parts of one picture that fit together.
#[derive(Clone, Debug)]
pub struct Merge {
    parts: Vec<Part>,
    description: Description,
}

impl Merge {
    /// Opens and checks parts, whatever their order.
    pub fn open<P: AsRef<Path>>(files: &[P], wanted: Wanted) -> Result<Self, MergeError> {
        let (parts, description) = check::check(files, wanted)?;
        Ok(Self { parts, description })
    }

    /// What the parts become together.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// Hands the picture's rows to `rows`, from top to bottom, some whole rows at a time. Pixels of which nothing is
    /// there are black.
    pub fn rows<E: From<PartError>>(&self, mut rows: impl FnMut(&[Rgb]) -> Result<(), E>) -> Result<Summary, E> {
        self.rows_of_tiles(|_, _, pixels| rows(pixels))
    }

    /// The same with each row's band and the tiles that it is made of.
    pub fn rows_of_tiles<E: From<PartError>>(
        &self,
        mut rows: impl FnMut(&Rect, &[Tile], &[Rgb]) -> Result<(), E>,
    ) -> Result<Summary, E> {
        let layout = self.description.layout();
        let mut digest = Digest::new(layout.region().width, layout.region().height);
        self.bands(|_, tiles| {
            for tiles in tiles.chunks((layout.columns() as usize).max(1)) {
                let (band, pixels) = row_of_tiles(&layout, tiles);
                digest.clamp(tiles.iter().map(Tile::clamped).sum());
                digest.update(&pixels);
                rows(&band, tiles, &pixels)?;
            }
            Ok::<(), E>(())
        })?;
        Ok(digest.finish())
    }

    /// How many samples each tile gets from all parts together, in the order of the tiles.
    pub fn counts(&self) -> Result<Vec<u32>, PartError> {
        let mut counts = vec![0_u32; usize::try_from(self.description.layout().tiles()).unwrap_or(0)];
        for part in &self.parts {
            let own = counts::of_part(part)?;
            counts.iter_mut().zip(own).for_each(|(count, own)| *count = count.saturating_add(own));
        }
        Ok(counts)
    }

    /// Writes one part that holds all that the parts hold. Returns its bytes. An error of
    /// `proceed`, which is asked again and again, ends it without a file.
    pub fn write<E: From<PartError>>(&self, path: &Path, proceed: impl Fn() -> Result<(), E>) -> Result<u64, E> {
        let mut writer = PartWriter::create(path, &self.description)?;
        self.bands(|first, tiles| {
            for (number, tile) in (first..).zip(tiles).filter(|(_, tile)| !tile.runs().is_empty()) {
                proceed()?;
                writer.add(number, &Chunk::encode(tile, self.description.clamped))?;
            }
            Ok::<(), E>(())
        })?;
        Ok(writer.finish()?)
    }

    /// Gathers whole rows of tiles from all parts: the number of the first and the tiles.
    fn bands<E: From<PartError>>(&self, mut each: impl FnMut(u64, &[Tile]) -> Result<(), E>) -> Result<(), E> {
        let layout = self.description.layout();
        let row = u64::from(layout.columns());
        let rows = (BAND / (row * u64::from(TILE * TILE)).max(1)).max(1);
        let mut first = 0;
        while first < layout.tiles() {
            let end = (first + row * rows).min(layout.tiles());
            each(first, &self.gather(&layout, first, end)?)?;
            first = end;
        }
        Ok(())
    }

    fn gather(&self, layout: &Layout, first: u64, end: u64) -> Result<Vec<Tile>, PartError> {
        let mut tiles: Vec<Tile> = (first..end).filter_map(|number| Some(Tile::new(layout.tile(number)?))).collect();
        for part in self.parts.iter().filter(|part| part.tiles_in(first, end).len() > 0) {
            let mut reader = part.reader()?;
            for number in part.tiles_in(first, end) {
                let more = reader.tile(number)?;
                if let Some(tile) = tiles.get_mut((number - first) as usize) {
                    // They fitted when they were checked.
                    tile.merge(more).map_err(|error| part.changed(&error.to_string()))?;
                }
            }
        }
        Ok(tiles)
    }
}

/// The pixels of tiles side by side, row by row, and where they are.
fn row_of_tiles(layout: &Layout, tiles: &[Tile]) -> (Rect, Vec<Rgb>) {
    let Rect { x, y, width, .. } = layout.region();
    let band = tiles.first().map_or(Rect { x, y, width, height: 0 }, |first| Rect { x, width, ..first.pixels() });
    let mut pixels = vec![Rgb::BLACK; band.area() as usize];
    tiles.iter().for_each(|tile| tile.copy_to(&band, &mut pixels));
    (band, pixels)
}
