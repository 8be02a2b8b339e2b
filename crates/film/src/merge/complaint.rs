//! Why parts cannot be merged, all reasons at once.

use crate::part::{Mismatch, PartError};
use std::fmt;
use std::ops::Range;

/// Most lines about missing samples of a kind, when no share is to blame.
const MOST_GAPS: usize = 8;

/// One reason. Files are named as the user gave them.
#[derive(Debug)]
pub enum Complaint {
    /// No part was given.
    None,
    /// A file cannot be read, is damaged, or is no part.
    Unreadable(PartError),
    /// A part of another picture than most.
    Foreign {
        /// The file.
        file: String,
        /// One of those that belong together.
        other: String,
        /// What differs: `here` in `other`, `there` in `file`.
        mismatches: Vec<Mismatch>,
    },
    /// Two files that hold the same samples.
    Doubled {
        /// The files.
        files: [String; 2],
        /// Tiles of which both hold the same samples.
        tiles: u64,
    },
    /// A part whose render was stopped before its end.
    Unfinished {
        /// The file.
        file: String,
    },
    /// Samples that no part holds.
    Missing(ToDo),
}

/// What no part holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ToDo {
    /// Shares of a picture that was cut by the program.
    Shards {
        /// Which, rising.
        shards: Vec<u32>,
        /// Of how many.
        count: u32,
    },
    /// Anything: for each range of samples, of how many tiles it is missing, and the first one's corner.
    Samples(Vec<(Range<u32>, u64, [u32; 2])>),
}

/// Why parts cannot be merged.
#[derive(Debug, thiserror::Error)]
pub struct MergeError {
    /// The parts, as the user named them.
    pub files: Vec<String>,
    /// Every reason there is.
    pub complaints: Vec<Complaint>,
}

impl MergeError {
    /// Whether a file failed: it cannot be read or is damaged. Otherwise the choice of files is wrong.
    pub fn is_of_files(&self) -> bool {
        self.complaints.iter().any(|complaint| matches!(complaint, Complaint::Unreadable(_)))
    }

    /// What is still to do before all can be merged.
    pub fn to_do(&self) -> Option<&ToDo> {
        self.complaints.iter().find_map(|complaint| match complaint {
            Complaint::Missing(to_do) => Some(to_do),
            _ => None,
        })
    }
}

impl fmt::Display for MergeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.files.as_slice() {
            [] => f.write_str("the parts cannot be merged:")?,
            [only] => write!(f, "the part `{only}` cannot be merged:")?,
            [first, others @ ..] => write!(f, "the parts `{first}` and {} more cannot be merged:", others.len())?,
        }
        self.complaints.iter().try_for_each(|complaint| write!(f, "\n  {complaint}"))
    }
}

impl fmt::Display for Complaint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => f.write_str("no part was given"),
            Self::Unreadable(error) => error.fmt(f),
            Self::Foreign { file, other, mismatches } => {
                let what: Vec<String> = mismatches.iter().map(ToString::to_string).collect();
                write!(f, "{file}: is of another picture than {other}: {}", what.join("; "))
            }
            Self::Doubled { files: [a, b], tiles } => {
                let plural = if *tiles == 1 { "" } else { "s" };
                write!(f, "{b}: holds samples that {a} holds too, of {tiles} tile{plural}")
            }
            Self::Unfinished { file } => write!(f, "{file}: is not finished; the same command goes on with it"),
            Self::Missing(ToDo::Shards { shards, count }) => {
                let (plural, first) = (if shards.len() == 1 { "" } else { "s" }, shards.first().unwrap_or(&0));
                write!(f, "still to do: shard{plural} {} of {count} (--shard {first}/{count})", ranges(shards))
            }
            Self::Missing(ToDo::Samples(gaps)) => missing(f, gaps),
        }
    }
}

fn missing(f: &mut fmt::Formatter<'_>, gaps: &[(Range<u32>, u64, [u32; 2])]) -> fmt::Result {
    f.write_str("still to do:")?;
    for (i, (samples, tiles, [x, y])) in gaps.iter().take(MOST_GAPS).enumerate() {
        let (comma, plural) = (if i == 0 { "" } else { "," }, if *tiles == 1 { "" } else { "s" });
        write!(f, "{comma} samples {}..{} of {tiles} tile{plural} (the first at {x},{y})", samples.start, samples.end)?;
    }
    match gaps.len().saturating_sub(MOST_GAPS) {
        0 => Ok(()),
        more => write!(f, " and {more} more"),
    }
}

/// `3,7-9`.
fn ranges(numbers: &[u32]) -> String {
    let alone = numbers.chunk_by(|a, b| a.checked_add(1) == Some(*b));
    let texts: Vec<String> = alone
        .filter_map(|run| Some((run.first()?, run.last()?)))
        .map(|(first, last)| if first == last { first.to_string() } else { format!("{first}-{last}") })
        .collect();
    texts.join(",")
}
