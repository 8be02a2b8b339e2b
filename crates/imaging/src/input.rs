//! From files to images. What a file is, its first bytes say, not its name.

use crate::codec::{self, Facts, Source};
use crate::{Format, ImageError, regular};
use juggler_math::Image;
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

/// What a file may ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Pixels of a picture; each takes 12 bytes of memory, and 8 more while it is decoded.
    pub most_pixels: u64,
    /// Pixels of the longer side.
    pub longest_side: u32,
}

impl Limits {
    /// No limits but that of what the file can hold: for readers that read no pixels.
    pub(crate) const NONE: Self = Self { most_pixels: u64::MAX, longest_side: u32::MAX };
}

impl Default for Limits {
    /// Room for 20,000 × 20,000 pixels.
    fn default() -> Self {
        Self { most_pixels: 1 << 29, longest_side: u32::MAX }
    }
}

/// Reads a picture of any format that we write, as linear light.
pub fn read(path: &Path) -> Result<Image, ImageError> {
    read_within(path, &Limits::default())
}

/// Reads a picture within limits.
pub fn read_within(path: &Path, limits: &Limits) -> Result<Image, ImageError> {
    decode(&path.display().to_string(), open(path)?, limits)
}

/// Reads a picture from bytes; `place` is how messages call them.
pub fn decode(place: &str, bytes: impl BufRead + Seek, limits: &Limits) -> Result<Image, ImageError> {
    let mut bytes = bytes;
    codec::read(source(place, &mut bytes, limits)?, &mut bytes)
}

/// Reads what a picture says besides its pixels, whatever its size.
pub fn inspect(path: &Path) -> Result<Facts, ImageError> {
    let (place, mut bytes) = (path.display().to_string(), open(path)?);
    codec::inspect(source(&place, &mut bytes, &Limits::NONE)?, &mut bytes)
}

pub(crate) fn open(path: &Path) -> Result<BufReader<File>, ImageError> {
    let failed = |source| ImageError::Read { place: path.display().to_string(), source };
    regular::open(path).map(BufReader::new).map_err(failed)
}

/// What is to be read: its format, by the first bytes, and its length.
pub(crate) fn source<'a>(
    place: &'a str,
    bytes: &mut (impl BufRead + Seek),
    limits: &'a Limits,
) -> Result<Source<'a>, ImageError> {
    let failed = |source| ImageError::Read { place: place.to_owned(), source };
    let mut start = Vec::new();
    bytes.by_ref().take(12).read_to_end(&mut start).map_err(failed)?;
    let length = bytes.seek(SeekFrom::End(0)).map_err(failed)?;
    bytes.rewind().map_err(failed)?;
    let format = Format::from_first_bytes(&start);
    let format = format.ok_or_else(|| ImageError::UnknownContent { place: place.to_owned() })?;
    Ok(Source { place, format, limits, length })
}
