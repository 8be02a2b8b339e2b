//! From files to images. What a file is, its first bytes say, not its name.

use crate::codec::{self, Facts, Source};
use crate::{Format, ImageError};
use juggler_math::Image;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek};
use std::path::Path;

/// What a file may ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Pixels of a picture; each takes 12 bytes of memory, and 8 more while it is decoded.
    pub most_pixels: u64,
}

impl Default for Limits {
    /// Room for 20,000 × 20,000 pixels.
    fn default() -> Self {
        Self { most_pixels: 1 << 29 }
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
    let format = sniff(place, &mut bytes)?;
    codec::read(Source { place, format, limits }, &mut bytes)
}

/// Reads what a picture says besides its pixels, whatever its size.
pub fn inspect(path: &Path) -> Result<Facts, ImageError> {
    let (place, mut bytes) = (path.display().to_string(), open(path)?);
    let format = sniff(&place, &mut bytes)?;
    let limits = &Limits { most_pixels: u64::MAX };
    codec::inspect(Source { place: &place, format, limits }, &mut bytes)
}

pub(crate) fn open(path: &Path) -> Result<BufReader<File>, ImageError> {
    let failed = |source| ImageError::Read { place: path.display().to_string(), source };
    let file = File::open(path).map_err(failed)?;
    if file.metadata().map_err(failed)?.is_dir() {
        return Err(failed(io::Error::from(io::ErrorKind::IsADirectory)));
    }
    Ok(BufReader::new(file))
}

pub(crate) fn sniff(place: &str, bytes: &mut (impl BufRead + Seek)) -> Result<Format, ImageError> {
    let failed = |source| ImageError::Read { place: place.to_owned(), source };
    let mut start = Vec::new();
    bytes.by_ref().take(12).read_to_end(&mut start).map_err(failed)?;
    bytes.rewind().map_err(failed)?;
    Format::from_first_bytes(&start).ok_or_else(|| ImageError::UnknownContent { place: place.to_owned() })
}
