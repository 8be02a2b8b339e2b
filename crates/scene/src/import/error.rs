//! Why a mesh file could not be loaded: which file, where in it, and what was expected there.

use super::foreign::Foreign;
use std::fmt;
use std::io;
use std::path::PathBuf;

/// A mesh file that could not be loaded.
#[derive(Debug, thiserror::Error)]
#[error("{}: {fault}", path.display())]
pub struct ImportError {
    /// The file, as the caller named it.
    pub path: PathBuf,
    /// What is wrong with it.
    pub fault: Fault,
}

/// What is wrong with a mesh file.
#[derive(Debug, thiserror::Error)]
pub enum Fault {
    /// The file cannot be opened or read.
    #[error("cannot be read: {0}")]
    Read(#[from] io::Error),
    /// Neither the content nor the ending says what it is.
    #[error("not a known mesh format: expected a file named .obj, .ply or .stl")]
    UnknownFormat,
    /// The file is of a format that is known, but not read yet.
    #[error("{0}")]
    Foreign(Foreign),
    /// The content breaks the rules of its format.
    #[error("{place}: {message}")]
    Malformed {
        /// Where.
        place: Place,
        /// What was found and what was expected.
        message: String,
    },
    /// More of something than [`Limits`](super::Limits) allows.
    #[error("at least {found} {quantity}, the limit is {limit}")]
    TooMany {
        /// Of what: `bytes`, `vertices`, `triangles`.
        quantity: &'static str,
        /// How many were found or announced before reading stopped.
        found: u64,
        /// How many are allowed.
        limit: u64,
    },
    /// The file is well formed but shows nothing.
    #[error("holds no triangle{note}")]
    NoTriangles {
        /// What was left out on the way, in brackets; often empty.
        note: String,
    },
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line of a text, counted from 1.
    Line(u64),
    /// A byte of a binary file, counted from 0.
    Byte(u64),
}

impl fmt::Display for Place {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(formatter, "line {line}"),
            Self::Byte(byte) => write!(formatter, "byte {byte}"),
        }
    }
}

impl Place {
    /// A fault at this place.
    pub(super) fn fault(self, message: impl Into<String>) -> Fault {
        Fault::Malformed { place: self, message: message.into() }
    }
}

impl Fault {
    /// The same fault in a text with this many more lines before it.
    pub(super) fn further_down(mut self, lines: u64) -> Self {
        if let Self::Malformed { place: Place::Line(line), .. } = &mut self {
            *line += lines;
        }
        self
    }
}

/// A piece of a file as it may stand in a message: printable, short, in quotes.
pub(super) fn quote(bytes: &[u8]) -> String {
    const LONGEST: usize = 40;
    // No character has more than four bytes; one more character shows that there is more.
    let text = String::from_utf8_lossy(bytes.get(..4 * (LONGEST + 1)).unwrap_or(bytes));
    let shown: String = text.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    let dots = if text.chars().nth(LONGEST).is_some() { "..." } else { "" };
    format!("'{shown}{dots}'")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn says_file_place_and_expectation() {
        let fault = Place::Line(7).fault("expected a number");
        let error = ImportError { path: "models/cow.obj".into(), fault };
        assert_eq!(error.to_string(), "models/cow.obj: line 7: expected a number");
    }

    #[test]
    fn quotes_are_short_and_printable() {
        assert_eq!(quote(b"a\x00\x1bb"), "'a\\0\\u{1b}b'");
        assert_eq!(quote(&[b'x'; 100]), format!("'{}...'", "x".repeat(40)));
        assert_eq!(quote(&[0xff]), "'\u{fffd}'");
    }
}
