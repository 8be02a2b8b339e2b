//! Errors of reading and writing `.jfilm` files.

use std::io;

/// Why a partial render cannot be written or read. `file` is its path as the user gave it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PartialRenderError {
    /// Reading failed.
    #[error("cannot read `{file}`: {source}")]
    Read {
        /// Path of the file.
        file: String,
        /// Error of the operating system.
        source: io::Error,
    },
    /// Writing failed.
    #[error("cannot write `{file}`: {source}")]
    Write {
        /// Path of the file.
        file: String,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The file is not a `.jfilm` file.
    #[error("`{file}` is not a partial render (.jfilm)")]
    NotAPartialRender {
        /// Path of the file.
        file: String,
    },
    /// The file has a newer format version.
    #[error("`{file}` has format version {version}; this program supports versions up to {known}")]
    Version {
        /// Path of the file.
        file: String,
        /// Version of the file.
        version: u32,
        /// Newest supported version.
        known: u32,
    },
    /// The file stores layers that this version does not know.
    #[error("`{file}` has the layers {layers}; this program supports {known}")]
    Layers {
        /// Path of the file.
        file: String,
        /// Layers of the file.
        layers: String,
        /// Known layers.
        known: String,
    },
    /// The file is truncated.
    #[error("cannot read `{file}`: unexpected end of file at byte {length} of {expected}")]
    Truncated {
        /// Path of the file.
        file: String,
        /// Length in bytes.
        length: u64,
        /// Length in bytes that the file's header states.
        expected: u64,
    },
    /// The file is damaged or inconsistent.
    #[error("`{file}` is damaged: {what}")]
    Damaged {
        /// Path of the file.
        file: String,
        /// What is wrong.
        what: String,
    },
    /// The description or a tile is invalid, so nothing was written.
    #[error("cannot write `{file}`: {what}")]
    Invalid {
        /// Path of the file.
        file: String,
        /// What is wrong.
        what: String,
    },
}
