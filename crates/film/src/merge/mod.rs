//! Merges partial renders into an image or a larger one, bit-identical to a single render.
//!
//! [`Merge::open`] and [`Merge::new`] first validate everything: all partial renders belong to one
//! image, every byte matches its hash, no sample is missing or present twice. They report all
//! problems at once. The image is then streamed in bands of tile rows with one file open at a time, so memory depends on
//! neither the number of partial renders nor the image height, except for a few dozen bytes per
//! tile of each partial render.

mod check;
mod problem;
#[cfg(test)]
mod tests;

pub use problem::{MergeError, MergeProblem, RemainingWork};

use crate::counts;
use crate::partial_render::{Chunk, PartialRender, PartialRenderError, PartialRenderWriter, RenderDescription};
use juggler_camera::film::{FilmDigest, FilmSummary, Rect, TILE_EDGE, Tile, Tiling};
use juggler_math::Rgb;
use std::ops::Range;
use std::path::Path;

/// Maximum number of pixels of a band, unless a single row of tiles has more.
const BAND: u64 = 1 << 20;

/// Kind of result of a merge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MergeGoal {
    /// The complete image; missing samples are an error.
    Whole,
    /// A larger partial render; samples may be missing.
    PartialRender,
}

/// Validated partial renders of one image.
#[derive(Clone, Debug)]
pub struct Merge {
    partial_renders: Vec<PartialRender>,
    description: RenderDescription,
}

impl Merge {
    /// Opens and validates the partial renders in `files`; their order does not matter.
    pub fn open<P: AsRef<Path>>(files: &[P], goal: MergeGoal) -> Result<Self, MergeError> {
        let names = files.iter().map(|file| file.as_ref().display().to_string()).collect();
        let (partial_renders, problems) = check::open(files);
        let (partial_renders, description) = check::check(names, partial_renders, problems, goal)?;
        Ok(Self { partial_renders, description })
    }

    /// Validates partial renders in files or in memory; their order does not matter.
    pub fn new(partial_renders: Vec<PartialRender>, goal: MergeGoal) -> Result<Self, MergeError> {
        let names = partial_renders.iter().map(|partial_render| partial_render.name().to_owned()).collect();
        let (partial_renders, description) = check::check(names, partial_renders, Vec::new(), goal)?;
        Ok(Self { partial_renders, description })
    }

    /// Description of the merged partial render.
    pub fn description(&self) -> &RenderDescription {
        &self.description
    }

    /// Total number of tiles in all partial renders.
    pub fn tiles(&self) -> u64 {
        self.partial_renders.iter().map(|partial_render| partial_render.tiles().len() as u64).sum()
    }

    /// Streams the image to `rows` from top to bottom, some complete pixel rows at a time. Pixels
    /// without samples are black.
    pub fn rows<E: From<PartialRenderError>>(
        &self,
        mut rows: impl FnMut(&[Rgb]) -> Result<(), E>,
    ) -> Result<FilmSummary, E> {
        self.tile_rows(|_, _, pixels| rows(pixels))
    }

    /// Like [`Merge::rows`], one row of tiles at a time, with its rectangle and its tiles.
    pub fn tile_rows<E: From<PartialRenderError>>(
        &self,
        mut rows: impl FnMut(&Rect, &[Tile], &[Rgb]) -> Result<(), E>,
    ) -> Result<FilmSummary, E> {
        let tiling = self.description.tiling();
        let mut digest = FilmDigest::new(tiling.region().width, tiling.region().height);
        for tiles in bands(&tiling) {
            let tiles = self.gather(&tiling, &tiles)?;
            for tiles in tiles.chunks((tiling.columns() as usize).max(1)) {
                let (band, pixels) = tile_row(&tiling, tiles);
                digest.add_clamped(tiles.iter().map(Tile::clamped).sum());
                digest.update(&pixels);
                rows(&band, tiles, &pixels)?;
            }
        }
        Ok(digest.finish())
    }

    /// Samples per pixel of each tile over all partial renders, in tile order.
    pub fn counts(&self) -> Result<Vec<u32>, PartialRenderError> {
        let mut counts = vec![0_u32; usize::try_from(self.description.tiling().tile_count()).unwrap_or(0)];
        for partial_render in &self.partial_renders {
            let own = counts::from_partial_render(partial_render)?;
            counts.iter_mut().zip(own).for_each(|(count, own)| *count = count.saturating_add(own));
        }
        Ok(counts)
    }

    /// Writes a single partial render with all samples of all partial renders and returns its
    /// length in bytes.
    ///
    /// `proceed` is called before each tile; its error cancels the merge and leaves no file.
    pub fn write<E: From<PartialRenderError>>(
        &self,
        path: &Path,
        proceed: impl Fn() -> Result<(), E>,
    ) -> Result<u64, E> {
        let mut writer = PartialRenderWriter::create(path, &self.description)?;
        self.write_tiles(&mut writer, proceed)?;
        Ok(writer.finish()?)
    }

    /// Returns the bytes of the partial render that [`Merge::write`] writes. Messages call it by
    /// `name`.
    pub fn to_bytes<E: From<PartialRenderError>>(
        &self,
        name: &str,
        proceed: impl Fn() -> Result<(), E>,
    ) -> Result<Vec<u8>, E> {
        let mut writer = PartialRenderWriter::in_memory(name, &self.description)?;
        self.write_tiles(&mut writer, proceed)?;
        Ok(writer.into_bytes()?)
    }

    fn write_tiles<E: From<PartialRenderError>>(
        &self,
        writer: &mut PartialRenderWriter,
        proceed: impl Fn() -> Result<(), E>,
    ) -> Result<(), E> {
        let tiling = self.description.tiling();
        for band in bands(&tiling).filter(|band| self.holds_any(band)) {
            let tiles = self.gather(&tiling, &band)?;
            for (number, tile) in band.zip(&tiles).filter(|(_, tile)| !tile.runs().is_empty()) {
                proceed()?;
                writer.add(number, &Chunk::encode(tile, self.description.clamped))?;
            }
        }
        Ok(())
    }

    fn holds_any(&self, band: &Range<u64>) -> bool {
        self.partial_renders.iter().any(|partial_render| partial_render.tiles_in(band.start, band.end).len() > 0)
    }

    /// Merges the tiles of a band from all partial renders.
    fn gather(&self, tiling: &Tiling, band: &Range<u64>) -> Result<Vec<Tile>, PartialRenderError> {
        let Range { start: first, end } = *band;
        let mut tiles: Vec<Tile> = (first..end).filter_map(|number| Some(Tile::new(tiling.tile(number)?))).collect();
        for partial_render in
            self.partial_renders.iter().filter(|partial_render| partial_render.tiles_in(first, end).len() > 0)
        {
            let mut reader = partial_render.reader()?;
            for number in partial_render.tiles_in(first, end) {
                let more = reader.tile(number)?;
                if let Some(tile) = tiles.get_mut((number - first) as usize) {
                    // The samples were checked for overlap on opening, so the file has changed
                    // since.
                    tile.merge(more).map_err(|error| partial_render.changed(&error.to_string()))?;
                }
            }
        }
        Ok(tiles)
    }
}

/// Splits the tile numbers into bands of whole tile rows, from top to bottom.
fn bands(tiling: &Tiling) -> impl Iterator<Item = Range<u64>> + use<> {
    let (row, tiles) = (u64::from(tiling.columns()), tiling.tile_count());
    let rows = (BAND / (row * u64::from(TILE_EDGE * TILE_EDGE)).max(1)).max(1);
    let length = (row * rows).max(1);
    (0..tiles.div_ceil(length)).map(move |number| number * length..((number + 1) * length).min(tiles))
}

/// Rectangle and pixels of one row of tiles.
fn tile_row(tiling: &Tiling, tiles: &[Tile]) -> (Rect, Vec<Rgb>) {
    let Rect { x, y, width, .. } = tiling.region();
    let band = tiles.first().map_or(Rect { x, y, width, height: 0 }, |first| Rect { x, width, ..first.pixels() });
    let mut pixels = vec![Rgb::BLACK; band.area() as usize];
    tiles.iter().for_each(|tile| tile.copy_to(&band, &mut pixels));
    (band, pixels)
}
