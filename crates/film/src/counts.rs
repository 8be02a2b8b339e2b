//! How many samples each tile of a picture has, as a text: runs of tiles, `64x512 48x1523` for 512 tiles with 64
//! samples and 1523 with 48.

use crate::part::{Part, PartError};

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

    #[test]
    fn counts_are_read_as_they_were_written() {
        for counts in [vec![], vec![7], vec![64; 512], vec![64, 64, 48, 64], (0..100).collect()] {
            assert_eq!(from_text(&to_text(&counts), counts.len() as u64), Some(counts));
        }
        assert_eq!(to_text(&[64, 64, 48]), "64x2 48x1");
    }

    #[test]
    fn other_texts_are_refused() {
        for text in ["64x2", "64x4", "64x2 48", "x3", "64x-1", "64x99999999999999999999", "64x18446744073709551615"] {
            assert_eq!(from_text(text, 3), None, "{text}");
        }
    }
}
