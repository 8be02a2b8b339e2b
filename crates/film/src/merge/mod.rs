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
use juggler_camera::film::{Digest, Layout, Rect, Summary, TILE, Tile};
use juggler_math::Rgb;
use std::ops::Range;
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

    /// How many tiles all parts hold together.
    pub fn tiles(&self) -> u64 {
        self.parts.iter().map(|part| part.tiles().len() as u64).sum()
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
        for tiles in bands(&layout) {
            let tiles = self.gather(&layout, &tiles)?;
            for tiles in tiles.chunks((layout.columns() as usize).max(1)) {
                let (band, pixels) = row_of_tiles(&layout, tiles);
                digest.clamp(tiles.iter().map(Tile::clamped).sum());
                digest.update(&pixels);
                rows(&band, tiles, &pixels)?;
            }
        }
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
        let layout = self.description.layout();
        for band in bands(&layout).filter(|band| self.holds_any(band)) {
            let tiles = self.gather(&layout, &band)?;
            for (number, tile) in band.zip(&tiles).filter(|(_, tile)| !tile.runs().is_empty()) {
                proceed()?;
                writer.add(number, &Chunk::encode(tile, self.description.clamped))?;
            }
        }
        Ok(writer.finish()?)
    }

    fn holds_any(&self, band: &Range<u64>) -> bool {
        self.parts.iter().any(|part| part.tiles_in(band.start, band.end).len() > 0)
    }

    /// The tiles of whole rows from all parts.
    fn gather(&self, layout: &Layout, band: &Range<u64>) -> Result<Vec<Tile>, PartError> {
        let Range { start: first, end } = *band;
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

/// The numbers of the tiles of some whole rows at a time, from top to bottom.
fn bands(layout: &Layout) -> impl Iterator<Item = Range<u64>> + use<> {
    let (row, tiles) = (u64::from(layout.columns()), layout.tiles());
    let rows = (BAND / (row * u64::from(TILE * TILE)).max(1)).max(1);
    let length = (row * rows).max(1);
    (0..tiles.div_ceil(length)).map(move |number| number * length..((number + 1) * length).min(tiles))
}

/// The pixels of tiles side by side, row by row, and where they are.
fn row_of_tiles(layout: &Layout, tiles: &[Tile]) -> (Rect, Vec<Rgb>) {
    let Rect { x, y, width, .. } = layout.region();
    let band = tiles.first().map_or(Rect { x, y, width, height: 0 }, |first| Rect { x, width, ..first.pixels() });
    let mut pixels = vec![Rgb::BLACK; band.area() as usize];
    tiles.iter().for_each(|tile| tile.copy_to(&band, &mut pixels));
    (band, pixels)
}
