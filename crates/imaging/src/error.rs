//! Errors of image and movie files.

use crate::{DisplayLook, ImageFormat, Primaries};
use std::io;

/// Why an image could not be written, read or compared. `file` is the file as the user named it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// The file extension names no known image format.
    #[error("`{file}` has an unknown extension; supported: {}", ImageFormat::extensions())]
    UnknownFormat {
        /// Name of the file.
        file: String,
    },
    /// The file extension names a format that is read but not written.
    #[error("`{file}`: Juggler reads {format} pictures but does not write them; use {}", ImageFormat::extensions())]
    ReadOnly {
        /// Name of the file.
        file: String,
        /// Format of the file.
        format: ImageFormat,
    },
    /// Layers need an EXR file, or a file name with a placeholder for the layer.
    #[error(
        "`{file}`: write AOVs to one .exr file, or to one .exr or .npy file each with `{{}}` in the name for the AOV"
    )]
    Layers {
        /// Name of the file.
        file: String,
    },
    /// The format does not support the image size.
    #[error("a {format} file cannot be {width} × {height} pixels: each side is 1 to {max_side}")]
    Dimensions {
        /// Format of the file.
        format: ImageFormat,
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Longest side that the format supports, in pixels.
        max_side: u32,
    },
    /// Reading failed.
    #[error("cannot read `{file}`: {source}")]
    Read {
        /// Name of the file.
        file: String,
        /// Error of the operating system.
        source: io::Error,
    },
    /// Writing failed.
    #[error("cannot write `{file}`: {source}")]
    Write {
        /// Name of the file.
        file: String,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The file is damaged or uses an unsupported feature of its format.
    #[error("cannot read `{file}`: {message} ({format}{})", at.map_or_else(String::new, |at| format!(", byte {at}")))]
    Malformed {
        /// Name of the file.
        file: String,
        /// Format, detected by the first bytes.
        format: ImageFormat,
        /// What is wrong.
        message: String,
        /// File offset where decoding stopped, if known.
        at: Option<u64>,
    },
    /// The file is truncated.
    #[error("cannot read `{file}`: unexpected end of file at byte {at}")]
    Truncated {
        /// Name of the file.
        file: String,
        /// Length of the file in bytes.
        at: u64,
    },
    /// The header claims more pixels than the file's bytes can hold at any compression ratio.
    #[error("cannot read `{file}`: {width} × {height} pixels are more than a {format} file of {bytes} bytes can hold")]
    ImplausibleSize {
        /// Name of the file.
        file: String,
        /// Format, detected by the first bytes.
        format: ImageFormat,
        /// Width in pixels.
        width: u64,
        /// Height in pixels.
        height: u64,
        /// Length of the file in bytes.
        bytes: u64,
    },
    /// The first bytes match no supported image format.
    #[error("cannot read `{file}`: its first bytes match no supported format ({})", ImageFormat::readable_extensions())]
    UnknownContent {
        /// Name of the file.
        file: String,
    },
    /// A side exceeds the caller's limit.
    #[error("cannot read `{file}`: {width} × {height} pixels; the limit is {longest_side} pixels per side")]
    TooLong {
        /// Name of the file.
        file: String,
        /// Width in pixels.
        width: u64,
        /// Height in pixels.
        height: u64,
        /// Longest side allowed, in pixels.
        longest_side: u32,
    },
    /// The image has more pixels than the limit allows.
    #[error("cannot read `{file}`: {width} × {height} pixels are more than the limit of {max_pixels} pixels")]
    TooLarge {
        /// Name of the file.
        file: String,
        /// Width in pixels.
        width: u64,
        /// Height in pixels.
        height: u64,
        /// Maximum number of pixels.
        max_pixels: u64,
    },
    /// The frames do not fit the movie's header, or the encoder failed.
    #[error("cannot write `{file}`: {message}")]
    Animation {
        /// Name of the file.
        file: String,
        /// What is wrong.
        message: String,
    },
    /// The encoder failed, for example because of unsupported metadata.
    #[error("cannot encode `{file}` as {format}: {message}")]
    Encode {
        /// Name of the file.
        file: String,
        /// Format of the file.
        format: ImageFormat,
        /// Message of the encoder.
        message: String,
    },
    /// The format cannot store the primaries.
    #[error(
        "a {format} file cannot store the primaries `{}`; PNG without a display look stores display_p3 and rec2020, OpenEXR all",
        primaries.name()
    )]
    Primaries {
        /// Format of the file.
        format: ImageFormat,
        /// Primaries of the tone settings.
        primaries: Primaries,
    },
    /// The format or its display look cannot store alpha.
    #[error(
        "a {format} file{} cannot be transparent; use .png, .webp or .exr{}, or a background",
        if *look == DisplayLook::Plain { String::new() } else { format!(" with the display look `{}`", look.name()) },
        if *look == DisplayLook::Plain { "" } else { " without a look" }
    )]
    Transparency {
        /// Format of the file.
        format: ImageFormat,
        /// Display look of the file.
        look: DisplayLook,
    },
    /// The caller passed incomplete rows, too many rows or too few.
    #[error("{given} pixels given, but {expected} expected")]
    Rows {
        /// Pixels expected.
        expected: u64,
        /// Pixels passed.
        given: u64,
    },
    /// Images of different sizes cannot be compared.
    #[error("the pictures differ in size: {}×{} and {}×{}", a.0, a.1, b.0, b.1)]
    SizesDiffer {
        /// Width and height of the first image.
        a: (u32, u32),
        /// Width and height of the second image.
        b: (u32, u32),
    },
}
