//! Why a part cannot be written or trusted.

use std::io;

/// Why a part of a picture cannot be written, or what it holds not be trusted. `file` is its name as the user gave it.
#[derive(Debug, thiserror::Error)]
pub enum PartError {
    /// The system could not read.
    #[error("{file}: cannot be read: {source}")]
    Read {
        /// The file.
        file: String,
        /// What the system says.
        source: io::Error,
    },
    /// The system could not write.
    #[error("{file}: cannot be written: {source}")]
    Write {
        /// The file.
        file: String,
        /// What the system says.
        source: io::Error,
    },
    /// It is something else.
    #[error("{file}: is no part of a picture (.jfilm)")]
    NotAPart {
        /// The file.
        file: String,
    },
    /// A program wrote it that is newer than this one.
    #[error("{file}: is of version {version} of the format; this program knows versions up to {known}")]
    Version {
        /// The file.
        file: String,
        /// What it says.
        version: u32,
        /// The newest that is known.
        known: u32,
    },
    /// It holds what this program does not know.
    #[error("{file}: holds the layers {layers}; this program knows {known}")]
    Layers {
        /// The file.
        file: String,
        /// What it holds.
        layers: String,
        /// What is known.
        known: String,
    },
    /// Its end is missing.
    #[error("{file}: is cut short: {length} of {expected} bytes are there")]
    Truncated {
        /// The file.
        file: String,
        /// Bytes that are there.
        length: u64,
        /// Bytes that it should have.
        expected: u64,
    },
    /// Its bytes are not those that were written.
    #[error("{file}: is damaged: {what}")]
    Damaged {
        /// The file.
        file: String,
        /// What is wrong.
        what: String,
    },
    /// The caller gave what no part can hold.
    #[error("{file}: cannot be written: {what}")]
    Unfit {
        /// The file.
        file: String,
        /// What is wrong.
        what: String,
    },
}
