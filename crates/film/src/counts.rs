//! Samples per pixel of each tile as run-length encoded text: `64x512 48x1523` means 512 tiles of
//! 64 samples followed by 1523 tiles of 48.

use crate::partial_render::{PartialRender, PartialRenderError};
use juggler_camera::film::{Film, Tiling};
use serde::Serialize;
use std::fmt;

/// Range and mean of the samples per pixel of an image rendered with adaptive sampling.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SampleCountStats {
    /// Fewest samples per pixel of any tile.
    pub min: u32,
    /// Mean over all pixels.
    pub mean: f64,
    /// Most samples per pixel of any tile.
    pub max: u32,
}

impl SampleCountStats {
    /// Statistics of an image with the same number of samples in every pixel.
    pub fn uniform(samples: u32) -> Self {
        Self { min: samples, mean: samples.into(), max: samples }
    }

    /// Statistics of the tiles of `film` that are present.
    pub fn from_film(film: &Film) -> Self {
        let tiles = (0..film.len()).filter_map(|place| film.tile(place));
        Self::from_tiles(tiles.map(|tile| (tile.pixels().area(), tile.samples_per_pixel())))
    }

    /// Statistics of an image from `counts`, the samples per pixel of each tile of `tiling` in
    /// order.
    pub fn from_counts(tiling: &Tiling, counts: &[u32]) -> Self {
        let tiles = (0..).zip(counts);
        Self::from_tiles(tiles.filter_map(|(number, count)| Some((tiling.tile(number)?.area(), *count))))
    }

    /// Statistics of tiles given as pairs of pixel count and samples per pixel.
    fn from_tiles(tiles: impl Iterator<Item = (u64, u32)>) -> Self {
        let (mut pixels, mut samples, mut ends) = (0_u64, 0.0, None);
        for (area, count) in tiles {
            pixels += area;
            samples += area as f64 * f64::from(count);
            let (min, max) = ends.unwrap_or((count, count));
            ends = Some((count.min(min), count.max(max)));
        }
        let (min, max) = ends.unwrap_or_default();
        Self { min, mean: samples / pixels.max(1) as f64, max }
    }
}

/// Formats as `64`, or `16 to 512, 120.5 on average`.
impl fmt::Display for SampleCountStats {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { min, mean, max } = self;
        if min == max { write!(f, "{min}") } else { write!(f, "{min} to {max}, {mean:.1} on average") }
    }
}

/// Encodes the counts as text.
pub fn to_text(counts: &[u32]) -> String {
    let run = |run: &[u32]| Some(format!("{}x{}", run.first()?, run.len()));
    counts.chunk_by(|a, b| a == b).filter_map(run).collect::<Vec<_>>().join(" ")
}

/// Parses the counts of `tiles` tiles; `None` if the text is malformed or covers another number of
/// tiles.
pub fn from_text(text: &str, tiles: u64) -> Option<Vec<u32>> {
    let mut counts = Vec::new();
    for run in text.split_ascii_whitespace() {
        let (count, length) = run.split_once('x')?;
        let (count, length) = (count.parse().ok()?, length.parse::<u64>().ok()?);
        let end = (counts.len() as u64).checked_add(length).filter(|end| *end <= tiles)?;
        counts.resize(usize::try_from(end).ok()?, count);
    }
    (counts.len() as u64 == tiles).then_some(counts)
}

/// Samples per pixel of each tile of a partial render, in tile order; 0 for tiles that it lacks.
pub fn from_partial_render(partial_render: &PartialRender) -> Result<Vec<u32>, PartialRenderError> {
    let mut counts = vec![0; usize::try_from(partial_render.description().tiling().tile_count()).unwrap_or(0)];
    let mut reader = partial_render.reader()?;
    for number in partial_render.tiles() {
        let tile = reader.tile(number)?;
        if let Some(count) = usize::try_from(number).ok().and_then(|number| counts.get_mut(number)) {
            *count = tile.gapless_samples();
        }
    }
    Ok(counts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_camera::film::Rect;

    #[test]
    fn counts_are_read_as_they_were_written() {
        for counts in [vec![], vec![7], vec![64; 512], vec![64, 64, 48, 64], (0..100).collect()] {
            assert_eq!(from_text(&to_text(&counts), counts.len() as u64), Some(counts));
        }
        assert_eq!(to_text(&[64, 64, 48]), "64x2 48x1");
    }

    #[test]
    fn mean_sample_count_weights_tiles_by_pixel_count() {
        // One tile of 16 × 16 pixels, one of 4 × 16.
        let tiling = Tiling::new(Rect { x: 0, y: 0, width: 20, height: 16 });
        let stats = SampleCountStats::from_counts(&tiling, &[10, 60]);
        assert_eq!(stats, SampleCountStats { min: 10, mean: 20.0, max: 60 });
        assert_eq!(stats.to_string(), "10 to 60, 20.0 on average");
        assert_eq!(
            (SampleCountStats::uniform(7).to_string(), SampleCountStats::from_counts(&tiling, &[])),
            ("7".into(), SampleCountStats::default())
        );
    }

    #[test]
    fn malformed_sample_counts_are_rejected() {
        for text in ["64x2", "64x4", "64x2 48", "x3", "64x-1", "64x99999999999999999999", "64x18446744073709551615"] {
            assert_eq!(from_text(text, 3), None, "{text}");
        }
    }
}
