//! Movies, as far as `juggler info` reads them.

use super::rows;
use crate::failure::Failure;
use crate::format::counted;
use juggler::imaging::{GifLength, ImageFormat, gif_length};
use serde_json::json;
use std::path::Path;

/// Extension of MP4 files.
const MP4: &str = "mp4";

/// Whether the file is an MP4, by its name and its first bytes: a box `ftyp` after the length.
pub fn is_mp4(path: &Path, start: &[u8]) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(MP4)) && start.get(4..8) == Some(b"ftyp")
}

/// Text about an MP4, whose contents are not read.
pub fn mp4_text(name: &str, as_json: bool) -> String {
    if as_json {
        return json!({"version": 1, "movie": name, "format": MP4}).to_string();
    }
    format!("{name}\n{}", rows::row("movie", "MP4; `juggler info` does not read its frames, a video player does"))
}

/// Number of frames and duration of a picture file with several frames.
///
/// # Errors
///
/// The file cannot be read.
pub fn length(path: &Path, format: ImageFormat) -> Result<Option<GifLength>, Failure> {
    let length = if format == ImageFormat::Gif { Some(gif_length(path)?) } else { None };
    Ok(length.filter(|length| length.frames > 1))
}

/// `movie  24 frames, 0.8 s`.
pub fn row(GifLength { frames, seconds }: GifLength) -> String {
    rows::row("movie", &format!("{}, {seconds} s", counted(frames.into(), "frame")))
}
