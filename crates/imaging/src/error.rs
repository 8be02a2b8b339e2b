//! What can go wrong with files of pixels, told apart by who can act.

use crate::{Format, Primaries};
use std::io;

/// Why a picture was not written, read or compared. `place` is the file, as the user named it.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// The user names the file differently.
    #[error("{place}: the ending says no format of pictures; known are {}", Format::endings())]
    UnknownFormat {
        /// The file.
        place: String,
    },
    /// The user names the file differently.
    #[error("{place}: layers go into one .exr, or one .exr or .npy each where the name holds `{{}}` for theirs")]
    Layers {
        /// The file.
        place: String,
    },
    /// The user picks another format or size.
    #[error("a {format} file cannot be {width} × {height} pixels: each side is 1 to {most}")]
    Dimensions {
        /// The format.
        format: Format,
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
        /// The longest side that the format allows.
        most: u32,
    },
    /// The system could not read.
    #[error("{place}: cannot be read: {source}")]
    Read {
        /// The file.
        place: String,
        /// What the system says.
        source: io::Error,
    },
    /// The system could not write.
    #[error("{place}: cannot be written: {source}")]
    Write {
        /// The file.
        place: String,
        /// What the system says.
        source: io::Error,
    },
    /// The file is damaged, cut short, or something else than its start says.
    #[error("{place}: not a readable {format} file: {message}")]
    Malformed {
        /// The file.
        place: String,
        /// The format that its first bytes say.
        format: Format,
        /// What is wrong.
        message: String,
    },
    /// The first bytes are those of no picture that we read.
    #[error("{place}: not a picture in a known format ({})", Format::endings())]
    UnknownContent {
        /// The file.
        place: String,
    },
    /// The user allows more, or makes the picture smaller.
    #[error("{place}: {width} × {height} pixels are more than the limit of {most_pixels} pixels")]
    TooLarge {
        /// The file.
        place: String,
        /// Pixels in a row.
        width: u64,
        /// Rows.
        height: u64,
        /// Pixels allowed.
        most_pixels: u64,
    },
    /// The frames do not fit the file of moving pictures, or its encoder refused.
    #[error("{place}: {message}")]
    Animation {
        /// The file.
        place: String,
        /// What is wrong.
        message: String,
    },
    /// The encoder refused: metadata that the format cannot hold, for instance.
    #[error("{place}: cannot be encoded as {format}: {message}")]
    Encode {
        /// The file.
        place: String,
        /// The format.
        format: Format,
        /// What the encoder says.
        message: String,
    },
    /// The user picks another format, or the usual primaries.
    #[error(
        "a {format} file cannot say that its primaries are `{}`: PNG without a look takes display_p3 and rec2020, OpenEXR all",
        primaries.name()
    )]
    Primaries {
        /// The format.
        format: Format,
        /// The primaries.
        primaries: Primaries,
    },
    /// The caller gave half a row, a row too much, or too few rows.
    #[error("{given} pixels given where {expected} were expected")]
    Rows {
        /// Pixels that still belong to the picture.
        expected: u64,
        /// Pixels given.
        given: u64,
    },
    /// Two pictures of different size cannot be compared.
    #[error("the pictures differ in size: {}×{} and {}×{}", a.0, a.1, b.0, b.1)]
    SizesDiffer {
        /// Width and height of the one.
        a: (u32, u32),
        /// Width and height of the other.
        b: (u32, u32),
    },
}
