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
    #[error("cannot read `{place}`: {source}")]
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
    /// The file is damaged, or uses what is not read of its format.
    #[error("cannot read `{place}`: {message} ({format}{})", at.map_or_else(String::new, |at| format!(", byte {at}")))]
    Malformed {
        /// The file.
        place: String,
        /// The format that its first bytes say.
        format: Format,
        /// What is wrong.
        message: String,
        /// The byte at which reading stopped, if the decoder reads byte by byte.
        at: Option<u64>,
    },
    /// The file is cut short.
    #[error("cannot read `{place}`: unexpected end of file at byte {at}")]
    Truncated {
        /// The file.
        place: String,
        /// Bytes that are there.
        at: u64,
    },
    /// The head of the file claims a size that its bytes cannot hold, however well they are compressed.
    #[error("cannot read `{place}`: {width} × {height} pixels are more than a {format} file of {bytes} bytes can hold")]
    Claim {
        /// The file.
        place: String,
        /// The format that its first bytes say.
        format: Format,
        /// Pixels in a row.
        width: u64,
        /// Rows.
        height: u64,
        /// Bytes of the file.
        bytes: u64,
    },
    /// The first bytes are those of no picture that is read.
    #[error("cannot read `{place}`: its first bytes are those of no known picture format ({})", Format::endings())]
    UnknownContent {
        /// The file.
        place: String,
    },
    /// A side is longer than the caller allows.
    #[error("cannot read `{place}`: {width} × {height} pixels, a side is {longest_side} pixels at most")]
    TooLong {
        /// The file.
        place: String,
        /// Pixels in a row.
        width: u64,
        /// Rows.
        height: u64,
        /// The longest side that is allowed.
        longest_side: u32,
    },
    /// The user allows more, or makes the picture smaller.
    #[error("cannot read `{place}`: {width} × {height} pixels are more than the limit of {most_pixels} pixels")]
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
