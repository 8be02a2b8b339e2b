//! Images as stored in their files, for textures: samples without conversion, alpha included, and
//! the transfer function that maps them to linear values.

use crate::codec;
use crate::input::{open, source};
use crate::tone::{Curve, Gamma, Matrix, Srgb, high_dynamic_range};
use crate::{ImageError, ImageFormat, Limits};
use std::io::{BufRead, Seek};
use std::path::Path;

/// Image as stored in its file.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// Size and sample format.
    pub layout: RasterLayout,
    /// Samples, rows from the top, channels interleaved.
    pub samples: RasterSamples,
    /// Transfer function of the color samples.
    pub transfer_function: TransferFunction,
}

/// Size, sample format and primaries of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RasterLayout {
    /// Format, detected by the first bytes.
    pub format: ImageFormat,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Number of channels: 1 gray, 2 gray and alpha, 3 RGB, 4 RGBA.
    pub channels: u8,
    /// Bytes per sample: 1, 2, or 4 for floats.
    pub sample_bytes: u8,
    /// Matrix from the primaries that the file states to those of sRGB, for linear values; `None`
    /// if the file states sRGB's or none.
    pub to_srgb: Option<Matrix>,
}

/// Samples of an image.
#[derive(Clone, Debug, PartialEq)]
pub enum RasterSamples {
    /// 8-bit levels.
    Bytes(Vec<u8>),
    /// 16-bit levels.
    Words(Vec<u16>),
    /// Floating-point values.
    Floats(Vec<f32>),
}

impl RasterSamples {
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Bytes(levels) => levels.len(),
            Self::Words(levels) => levels.len(),
            Self::Floats(numbers) => numbers.len(),
        }
    }
}

/// Transfer function of color samples; alpha is always linear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TransferFunction {
    /// sRGB, assumed for integer samples if the file states nothing.
    Srgb,
    /// Power function stated by the file: linear = level^gamma.
    Gamma(f64),
    /// Linear values, as in floating-point formats.
    Linear,
    /// Perceptual quantizer (ITU-R BT.2100), with the reference white of 203 cd/m² as 1.
    Pq,
    /// Hybrid log-gamma (ITU-R BT.2100), as scene light with the reference white of 75 % as 1.
    Hlg,
}

impl TransferFunction {
    /// Linear value of a level from 0 to 1.
    pub fn decode(self, level: f64) -> f64 {
        match self {
            Self::Srgb => Srgb {}.decode(level),
            Self::Gamma(gamma) => Gamma { gamma }.decode(level),
            Self::Linear => level,
            Self::Pq => high_dynamic_range::pq(level),
            Self::Hlg => high_dynamic_range::hlg(level),
        }
    }
}

/// Reads an image's samples; `file` names the bytes in messages.
pub fn decode_raster(file: &str, bytes: impl BufRead + Seek, limits: &Limits) -> Result<Raster, ImageError> {
    let mut bytes = bytes;
    let source = source(file, &mut bytes, limits)?;
    let raster = codec::raster(source, &mut bytes)?;
    let RasterLayout { width, height, channels, .. } = raster.layout;
    if raster.samples.len() as u64 != u64::from(width) * u64::from(height) * u64::from(channels) {
        return Err(source.malformed(codec::UNEXPECTED_END));
    }
    Ok(raster)
}

/// Reads the layout from the header without decoding pixels, whatever the size. EXR samples count
/// as 4 bytes even if all channels are half floats.
pub fn inspect_raster(path: &Path) -> Result<RasterLayout, ImageError> {
    let (file, mut bytes) = (path.display().to_string(), open(path)?);
    codec::layout(source(&file, &mut bytes, &Limits::NONE)?, &mut bytes)
}
