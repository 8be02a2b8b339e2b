//! Reasons why partial renders cannot be merged, all reported at once.

use crate::partial_render::{Mismatch, PartialRenderError};
use std::fmt;
use std::ops::Range;

/// Maximum number of missing sample ranges that a message lists.
const MAX_LISTED_RANGES: usize = 8;

/// One reason; files are named as the user gave them.
#[derive(Debug)]
#[non_exhaustive]
pub enum MergeProblem {
    /// The list of files is empty.
    None,
    /// A file cannot be read, is damaged, or is not a `.jfilm` file.
    Unreadable(PartialRenderError),
    /// The partial render belongs to another image than most of the others.
    OtherImage {
        /// The partial render that differs.
        file: String,
        /// One of the matching partial renders.
        other: String,
        /// The settings that differ: `here` is the value in `other`, `there` the value in `file`.
        mismatches: Vec<Mismatch>,
    },
    /// Two files hold the same samples.
    Duplicate {
        /// The two files.
        files: [String; 2],
        /// Number of tiles with samples in both files.
        tiles: u64,
    },
    /// The render stopped before it was complete.
    Unfinished {
        /// Path of the file.
        file: String,
    },
    /// No partial render holds these samples.
    Missing(RemainingWork),
}

/// Work that remains before the image is complete.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RemainingWork {
    /// Missing shards of an image that was split by `--shard`.
    Shards {
        /// Indices of the missing shards, in ascending order.
        shards: Vec<u32>,
        /// Total number of shards.
        count: u32,
    },
    /// Missing sample ranges, each with the number of tiles that lack it and the pixel coordinates
    /// of the first tile's top left corner.
    Samples(Vec<(Range<u32>, u64, [u32; 2])>),
}

/// Why partial renders cannot be merged.
#[derive(Debug, thiserror::Error)]
pub struct MergeError {
    /// All files, as the user named them.
    pub files: Vec<String>,
    /// Every reason found.
    pub problems: Vec<MergeProblem>,
}

impl MergeError {
    /// Whether a file is unreadable or damaged; otherwise the selection of files is wrong.
    pub fn has_file_errors(&self) -> bool {
        self.problems.iter().any(|problem| matches!(problem, MergeProblem::Unreadable(_)))
    }

    /// Work that remains before all partial renders can be merged, if samples are missing.
    pub fn remaining_work(&self) -> Option<&RemainingWork> {
        self.problems.iter().find_map(|problem| match problem {
            MergeProblem::Missing(remaining_work) => Some(remaining_work),
            _ => None,
        })
    }
}

impl fmt::Display for MergeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.files.as_slice() {
            [] => f.write_str("the partial renders cannot be merged:")?,
            [only] => write!(f, "the partial render `{only}` cannot be merged:")?,
            [first, others @ ..] => {
                write!(f, "the partial renders `{first}` and {} more cannot be merged:", others.len())?;
            }
        }
        self.problems.iter().try_for_each(|problem| write!(f, "\n  {problem}"))
    }
}

impl fmt::Display for MergeProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => f.write_str("no partial render was given"),
            Self::Unreadable(error) => error.fmt(f),
            Self::OtherImage { file, other, mismatches } => {
                let what: Vec<String> = mismatches.iter().map(ToString::to_string).collect();
                write!(f, "`{file}` is of another picture than `{other}`: {}", what.join("; "))
            }
            Self::Duplicate { files: [a, b], tiles } => {
                let plural = if *tiles == 1 { "" } else { "s" };
                write!(f, "`{b}` repeats samples of `{a}` in {tiles} tile{plural}")
            }
            Self::Unfinished { file } => write!(f, "`{file}` is not finished; run its command again to continue"),
            Self::Missing(RemainingWork::Shards { shards, count }) => {
                let (plural, first) = (if shards.len() == 1 { "" } else { "s" }, shards.first().unwrap_or(&0));
                write!(f, "still to do: shard{plural} {} of {count} (--shard {first}/{count})", ranges(shards))
            }
            Self::Missing(RemainingWork::Samples(missing_ranges)) => missing(f, missing_ranges),
        }
    }
}

fn missing(f: &mut fmt::Formatter<'_>, missing_ranges: &[(Range<u32>, u64, [u32; 2])]) -> fmt::Result {
    f.write_str("still to do:")?;
    for (i, (samples, tiles, [x, y])) in missing_ranges.iter().take(MAX_LISTED_RANGES).enumerate() {
        let (comma, plural) = (if i == 0 { "" } else { "," }, if *tiles == 1 { "" } else { "s" });
        write!(f, "{comma} samples {}..{} of {tiles} tile{plural} (the first at {x},{y})", samples.start, samples.end)?;
    }
    match missing_ranges.len().saturating_sub(MAX_LISTED_RANGES) {
        0 => Ok(()),
        more => write!(f, " and {more} more"),
    }
}

/// Formats sorted numbers as ranges, such as `3,7-9`.
fn ranges(numbers: &[u32]) -> String {
    let alone = numbers.chunk_by(|a, b| a.checked_add(1) == Some(*b));
    let texts: Vec<String> = alone
        .filter_map(|run| Some((run.first()?, run.last()?)))
        .map(|(first, last)| if first == last { first.to_string() } else { format!("{first}-{last}") })
        .collect();
    texts.join(",")
}
