//! Pictures as their files have them, for textures: levels as they are, alpha included, and by which curve levels stand for
//! light.

use crate::codec;
use crate::input::{open, source};
use crate::tone::{Curve, Gamma, Srgb};
use crate::{Format, ImageError, Limits};
use std::io::{BufRead, Seek};
use std::path::Path;

/// A picture as its file has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// What it is.
    pub layout: Layout,
    /// Rows from the top, in each row pixel by pixel all channels.
    pub samples: Samples,
    /// What levels mean.
    pub encoding: Encoding,
}

/// What a picture's samples are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// The format, by the first bytes.
    pub format: Format,
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// 1 is grey, 2 grey and alpha, 3 red, green and blue, 4 these and alpha.
    pub channels: u8,
    /// Bytes of a sample: 1, 2, or 4 for floats.
    pub sample_bytes: u8,
}

/// The samples of a picture.
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// Levels up to 255.
    Bytes(Vec<u8>),
    /// Levels up to 65,535.
    Words(Vec<u16>),
    /// Numbers as they are.
    Floats(Vec<f32>),
}

impl Samples {
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Bytes(levels) => levels.len(),
            Self::Words(levels) => levels.len(),
            Self::Floats(numbers) => numbers.len(),
        }
    }
}

/// What the levels of a picture's colours mean. Alpha is linear always.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Encoding {
    /// The curve of sRGB: what a file with levels means that says nothing.
    Srgb,
    /// A power curve, by what the file says: light = level^gamma.
    Gamma(f64),
    /// The numbers themselves: files of floats.
    Linear,
}

impl Encoding {
    /// Linear light of a level from 0 to 1.
    pub fn decode(self, level: f64) -> f64 {
        match self {
            Self::Srgb => Srgb {}.decode(level),
            Self::Gamma(gamma) => Gamma { gamma }.decode(level),
            Self::Linear => level,
        }
    }
}

/// Reads a picture from bytes; `place` is how messages call them.
pub fn decode_raster(place: &str, bytes: impl BufRead + Seek, limits: &Limits) -> Result<Raster, ImageError> {
    let mut bytes = bytes;
    let source = source(place, &mut bytes, limits)?;
    let raster = codec::raster(source, &mut bytes)?;
    let Layout { width, height, channels, .. } = raster.layout;
    if raster.samples.len() as u64 != u64::from(width) * u64::from(height) * u64::from(channels) {
        return Err(source.malformed(codec::ENDS));
    }
    Ok(raster)
}

/// Reads what a picture is, and no pixels, whatever its size. For floats it is not known yet whether all are halves.
pub fn inspect_raster(path: &Path) -> Result<Layout, ImageError> {
    let (place, mut bytes) = (path.display().to_string(), open(path)?);
    codec::layout(source(&place, &mut bytes, &Limits::NONE)?, &mut bytes)
}
