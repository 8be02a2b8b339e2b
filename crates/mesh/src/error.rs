//! Errors of loading a mesh file: the file, the position in it, and the expected content.

use juggler_imaging::regular::ReadError;
use juggler_math::Cancelled;
use std::fmt;
use std::io;
use std::path::PathBuf;

/// Error of loading a mesh file.
#[derive(Debug, thiserror::Error)]
#[error("{}: {kind}", path.display())]
pub struct MeshError {
    /// The file, as the caller named it.
    pub path: PathBuf,
    /// Cause of the error.
    pub kind: MeshErrorKind,
}

/// Cause of an [`MeshError`].
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshErrorKind {
    /// The file cannot be opened or read.
    #[error("cannot be read: {0}")]
    Read(#[from] io::Error),
    /// Neither the content nor the extension determines a format.
    #[error("not a known mesh format: expected a file named {extensions}")]
    UnknownFormat {
        /// Extensions of the supported formats, in words.
        extensions: String,
    },
    /// The file is of a known format that is not supported yet, which the message names.
    #[error("{0}")]
    Unsupported(String),
    /// The content violates the rules of its format.
    #[error("{place}: {message}")]
    Malformed {
        /// Position of the error.
        place: FilePosition,
        /// Description of the found and the expected content.
        message: String,
    },
    /// The file exceeds one of the limits.
    #[error("at least {found} {quantity}, the limit is {limit}")]
    TooMany {
        /// The limited quantity: `bytes`, `vertices` or `triangles`.
        quantity: &'static str,
        /// Number found or declared before reading stopped.
        found: u64,
        /// Maximum number allowed.
        limit: u64,
    },
    /// The file is well formed but contains no triangle.
    #[error("contains no triangles{note}")]
    NoTriangles {
        /// List of ignored content in parentheses; empty if nothing was ignored.
        note: String,
    },
    /// The reading was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// A position in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilePosition {
    /// A line of a text, counted from 1.
    Line(u64),
    /// A byte of a binary file, counted from 0.
    Byte(u64),
}

impl fmt::Display for FilePosition {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(formatter, "line {line}"),
            Self::Byte(byte) => write!(formatter, "byte {byte}"),
        }
    }
}

impl FilePosition {
    /// Creates an error at this position.
    pub(crate) fn error(self, message: impl Into<String>) -> MeshErrorKind {
        MeshErrorKind::Malformed { place: self, message: message.into() }
    }
}

impl From<ReadError> for MeshErrorKind {
    fn from(error: ReadError) -> Self {
        match error {
            ReadError::Io(error) => Self::Read(error),
            ReadError::TooLarge { found, limit } => Self::TooMany { quantity: "bytes", found, limit },
        }
    }
}

impl MeshErrorKind {
    /// Moves the error down by a number of lines.
    pub(crate) fn offset_lines(mut self, lines: u64) -> Self {
        if let Self::Malformed { place: FilePosition::Line(line), .. } = &mut self {
            *line += lines;
        }
        self
    }
}

/// Formats a part of a file for a message: printable, at most 40 characters, in quotes.
pub(crate) fn quote(bytes: &[u8]) -> String {
    const LONGEST: usize = 40;
    // A character has at most four bytes. Decode one character more, to know whether to add dots.
    let text = String::from_utf8_lossy(bytes.get(..4 * (LONGEST + 1)).unwrap_or(bytes));
    let shown: String = text.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    let dots = if text.chars().nth(LONGEST).is_some() { "..." } else { "" };
    format!("'{shown}{dots}'")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_state_file_position_and_expectation() {
        let kind = FilePosition::Line(7).error("expected a number");
        let error = MeshError { path: "models/cow.obj".into(), kind };
        assert_eq!(error.to_string(), "models/cow.obj: line 7: expected a number");
    }

    #[test]
    fn quotes_are_short_and_printable() {
        assert_eq!(quote(b"a\x00\x1bb"), "'a\\0\\u{1b}b'");
        assert_eq!(quote(&[b'x'; 100]), format!("'{}...'", "x".repeat(40)));
        assert_eq!(quote(&[0xff]), "'\u{fffd}'");
    }
}
