//! Sets of units of work as text: `0..64: 0-3,7; 64..128: 1` means samples 0 to 63 of the tiles 0, 1,
//! 2, 3 and 7, and samples 64 to 127 of tile 1.

use super::WorkUnit;
use juggler_camera::film::BLOCK_SAMPLES;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};
use std::fmt;
use std::ops::Range;

/// Consecutive tiles with the same range of samples.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnitRun {
    /// Numbers of the tiles.
    pub tiles: Range<u64>,
    /// Range of samples.
    pub samples: Range<u32>,
}

/// Set of units, ordered by samples, then by tile.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Units(Vec<UnitRun>);

impl Units {
    /// Creates the set of these units, whose order does not matter.
    pub fn new(units: &[WorkUnit]) -> Self {
        let mut sorted: Vec<&WorkUnit> = units.iter().collect();
        sorted.sort_unstable_by_key(|unit| (unit.samples.start, unit.samples.end, unit.tile));
        sorted.dedup();
        let runs = sorted.chunk_by(|a, b| a.samples == b.samples && a.tile.checked_add(1) == Some(b.tile));
        let run = |units: &[&WorkUnit]| {
            let (first, last) = (units.first()?, units.last()?);
            Some(UnitRun { tiles: first.tile..last.tile.saturating_add(1), samples: first.samples.clone() })
        };
        Self(runs.filter_map(run).collect())
    }

    /// Whether there are no units.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Runs of tiles with the same samples.
    pub fn runs(&self) -> &[UnitRun] {
        &self.0
    }

    /// Whether all units are tiles below `tiles`, and ranges of `samples` that begin and end between
    /// blocks.
    pub(crate) fn fit(&self, tiles: u64, samples: &Range<u32>) -> bool {
        self.0.iter().all(|run| {
            let Range { start, end } = run.samples;
            let between_blocks =
                start.is_multiple_of(BLOCK_SAMPLES) && (end.is_multiple_of(BLOCK_SAMPLES) || end == samples.end);
            let inside = samples.start <= start && start < end && end <= samples.end;
            inside && between_blocks && run.tiles.start < run.tiles.end && run.tiles.end <= tiles
        })
    }

    fn from_text(text: &str) -> Option<Self> {
        let mut runs = Vec::new();
        for group in text.split("; ").filter(|group| !group.is_empty()) {
            let (samples, tiles) = group.split_once(": ")?;
            let (start, end) = samples.split_once("..")?;
            let samples = start.parse().ok()?..end.parse().ok()?;
            for run in tiles.split(',') {
                let (first, last) = run.split_once('-').unwrap_or((run, run));
                let tiles = first.parse().ok()?..last.parse::<u64>().ok()?.checked_add(1)?;
                runs.push(UnitRun { tiles, samples: samples.clone() });
            }
        }
        Some(Self(runs))
    }
}

impl fmt::Display for Units {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, group) in self.0.chunk_by(|a, b| a.samples == b.samples).enumerate() {
            let Some(UnitRun { samples, .. }) = group.first() else { continue };
            write!(f, "{}{}..{}: ", if i == 0 { "" } else { "; " }, samples.start, samples.end)?;
            for (i, UnitRun { tiles, .. }) in group.iter().enumerate() {
                let (comma, last) = (if i == 0 { "" } else { "," }, tiles.end.saturating_sub(1));
                write!(f, "{comma}{}", tiles.start)?;
                if last > tiles.start {
                    write!(f, "-{last}")?;
                }
            }
        }
        Ok(())
    }
}

impl Serialize for Units {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Units {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        Self::from_text(&text).ok_or_else(|| D::Error::custom("units are text such as `0..64: 0-3,7`"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(tile: u64, samples: Range<u32>) -> WorkUnit {
        WorkUnit { tile, samples }
    }

    #[test]
    fn units_are_read_as_they_were_written() {
        let some = [unit(7, 0..64), unit(1, 64..128), unit(0, 0..64), unit(1, 0..64), unit(7, 0..64)];
        for (units, text) in [
            (Units::new(&some), "0..64: 0-1,7; 64..128: 1"),
            (Units::new(&[unit(3, 0..16)]), "0..16: 3"),
            (Units::new(&[unit(u64::MAX - 1, 0..16)]), "0..16: 18446744073709551614"),
            (Units::default(), ""),
        ] {
            assert_eq!(units.to_string(), text);
            assert_eq!(Units::from_text(text), Some(units));
        }
    }

    #[test]
    fn malformed_units_are_refused() {
        for text in ["3", "0..16", "0..16: ", "0..16: a", "0..16: 1-", "..16: 1", "0..16: 18446744073709551615", "; ;"]
        {
            assert_eq!(Units::from_text(text), None, "{text}");
        }
    }

    #[test]
    fn units_lie_in_the_picture_and_between_blocks() {
        let fits = |text: &str| Units::from_text(text).unwrap().fit(10, &(0..70));
        assert!(fits("0..64: 0-9; 64..70: 3") && fits("16..32: 9") && fits(""));
        for text in
            ["0..64: 10", "0..64: 0-10", "0..80: 1", "8..16: 1", "0..20: 1", "16..16: 1", "32..16: 1", "0..64: 5-3"]
        {
            assert!(!fits(text), "{text}");
        }
    }
}
