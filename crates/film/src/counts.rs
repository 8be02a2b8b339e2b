//! How many samples each tile of a picture has, as a text: runs of tiles, `64x512 48x1523` for 512 tiles with 64
//! samples and 1523 with 48. And what that is per pixel of the whole picture.

use crate::part::{Part, PartError};
use juggler_camera::film::{Film, Layout};
use serde::Serialize;
use std::fmt;

/// Samples per pixel of a picture whose tiles may have different numbers of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// Of the tile with the fewest samples.
    pub min: u32,
    /// Mean over all pixels.
    pub mean: f64,
    /// Of the tile with the most samples.
    pub max: u32,
}

impl Spread {
    /// Of a picture all pixels of which have the same number.
    pub fn even(samples: u32) -> Self {
        Self { min: samples, mean: samples.into(), max: samples }
    }

    /// Of the tiles that a film holds.
    pub fn of_film(film: &Film) -> Self {
        let tiles = (0..film.len()).filter_map(|place| film.tile(place));
        Self::of(tiles.map(|tile| (tile.pixels().area(), tile.count())))
    }

    /// Of a whole picture, from the counts of its tiles.
    pub fn of_counts(layout: &Layout, counts: &[u32]) -> Self {
        let tiles = (0..).zip(counts);
        Self::of(tiles.filter_map(|(number, count)| Some((layout.tile(number)?.area(), *count))))
    }

    /// Of tiles with so many pixels, each of which has so many samples.
    fn of(tiles: impl Iterator<Item = (u64, u32)>) -> Self {
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

/// `64`, or `16 to 512, 120.5 on average`.
impl fmt::Display for Spread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { min, mean, max } = self;
        if min == max { write!(f, "{min}") } else { write!(f, "{min} to {max}, {mean:.1} on average") }
    }
}

/// The counts as a text.
pub fn to_text(counts: &[u32]) -> String {
    let run = |run: &[u32]| Some(format!("{}x{}", run.first()?, run.len()));
    counts.chunk_by(|a, b| a == b).filter_map(run).collect::<Vec<_>>().join(" ")
}

/// The counts in a text, for as many `tiles`; `None` when it is none of that.
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

/// The counts of a part, tile by tile; tiles that it does not hold have none.
pub fn of_part(part: &Part) -> Result<Vec<u32>, PartError> {
    let mut counts = vec![0; usize::try_from(part.description().layout().tiles()).unwrap_or(0)];
    let mut reader = part.reader()?;
    for number in part.tiles() {
        let tile = reader.tile(number)?;
        if let Some(count) = usize::try_from(number).ok().and_then(|number| counts.get_mut(number)) {
            *count = tile.samples();
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
    fn spreads_weigh_tiles_by_their_pixels() {
        // Tiles of 16 × 16 pixels and, at the right, of 4 × 16.
        let layout = Layout::new(Rect { x: 0, y: 0, width: 20, height: 16 });
        let spread = Spread::of_counts(&layout, &[10, 60]);
        assert_eq!(spread, Spread { min: 10, mean: 20.0, max: 60 });
        assert_eq!(spread.to_string(), "10 to 60, 20.0 on average");
        assert_eq!((Spread::even(7).to_string(), Spread::of_counts(&layout, &[])), ("7".into(), Spread::default()));
    }

    #[test]
    fn other_texts_are_refused() {
        for text in ["64x2", "64x4", "64x2 48", "x3", "64x-1", "64x99999999999999999999", "64x18446744073709551615"] {
            assert_eq!(from_text(text, 3), None, "{text}");
        }
    }
}
