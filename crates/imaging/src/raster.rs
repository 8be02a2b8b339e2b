//! Images as stored in their files, for textures: samples without conversion, alpha included, and
//! the transfer function that maps them to linear values.

use crate::codec;
use crate::input::{open, source};
use crate::tone::{Curve, Gamma, Matrix, Srgb, high_dynamic_range};
use crate::{ImageError, ImageFormat, Limits};
use juggler_math::Rgb;
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
    /// Whether the file holds more images, such as frames of a movie or pages of a document. The
    /// raster is the first.
    pub is_first_of_several: bool,
}

impl Raster {
    /// Alpha of the pixels, 0 to 1; `None` if the file has none. Values that are not finite count as
    /// 0.
    pub fn alpha(&self) -> Option<Vec<f32>> {
        let channels = usize::from(self.layout.channels);
        let limited = |value: f32| if value.is_finite() { value.clamp(0.0, 1.0) } else { 0.0 };
        matches!(channels, 2 | 4).then(|| match &self.samples {
            RasterSamples::Bytes(levels) => alphas(levels, channels, |level| f32::from(level) / 255.0),
            RasterSamples::Words(levels) => alphas(levels, channels, |level| f32::from(level) / 65_535.0),
            RasterSamples::Floats(values) => alphas(values, channels, limited),
        })
    }

    /// Linear RGB pixels with sRGB primaries. Gray becomes equal channels; alpha is ignored.
    pub fn to_pixels(&self) -> Vec<Rgb> {
        let RasterLayout { channels, to_srgb, .. } = self.layout;
        let channels = usize::from(channels).max(1);
        let table = |count: u32| -> Vec<f32> {
            let top = f64::from(count - 1);
            (0..count).map(|level| self.transfer_function.decode(f64::from(level) / top) as f32).collect()
        };
        let linear = |table: &[f32], level: usize| table.get(level).copied().unwrap_or_default();
        let mut pixels = match &self.samples {
            RasterSamples::Bytes(levels) => {
                let table = table(1 << 8);
                colors(levels, channels, |level| linear(&table, usize::from(level)))
            }
            RasterSamples::Words(levels) => {
                let table = table(1 << 16);
                colors(levels, channels, |level| linear(&table, usize::from(level)))
            }
            RasterSamples::Floats(values) => colors(values, channels, |value| match self.transfer_function {
                TransferFunction::Linear => value,
                curve => curve.decode(f64::from(value)) as f32,
            }),
        };
        codec::convert_primaries(&mut pixels, to_srgb);
        pixels
    }
}

/// Alpha of pixels of 2 or 4 channels, by the value of a sample.
fn alphas<T: Copy>(samples: &[T], channels: usize, value: impl Fn(T) -> f32) -> Vec<f32> {
    samples.chunks_exact(channels).filter_map(|pixel| pixel.last().copied()).map(value).collect()
}

/// Colors of pixels whose samples have these linear values.
fn colors<T: Copy>(samples: &[T], channels: usize, linear: impl Fn(T) -> f32) -> Vec<Rgb> {
    let color = |pixel: &[T]| match *pixel {
        [r, g, b, ..] => Rgb::new(linear(r), linear(g), linear(b)),
        [gray, ..] => Rgb::splat(linear(gray)),
        [] => Rgb::BLACK,
    };
    samples.chunks_exact(channels).map(color).collect()
}

/// Size, sample format and primaries of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RasterLayout {
    /// Format, detected by the first bytes (TGA by the file extension).
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
#[non_exhaustive]
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

/// Layout of an image, and the memory that decoding it needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RasterHead {
    /// Size and sample format.
    pub layout: RasterLayout,
    /// Upper bound of the memory of the decoder beside the samples, in bytes.
    pub decoder_bytes: u64,
}

impl RasterHead {
    /// Bytes of the samples.
    pub fn samples_bytes(&self) -> u64 {
        let RasterLayout { width, height, channels, sample_bytes, .. } = self.layout;
        let pixels = u64::from(width).saturating_mul(u64::from(height));
        pixels.saturating_mul(u64::from(channels) * u64::from(sample_bytes))
    }
}

/// Reads the head of an image within the limits, without decoding pixels; `file` names the bytes in
/// messages.
pub fn raster_head(file: &str, bytes: impl BufRead + Seek, limits: &Limits) -> Result<RasterHead, ImageError> {
    let mut bytes = bytes;
    let image = source(file, &mut bytes, limits)?;
    let layout = codec::layout(image, &mut bytes)?;
    let per_sample = match layout.format {
        // A copy that Exif turns, and of 16 bits the bytes before they become words.
        ImageFormat::Png if layout.sample_bytes == 1 => 1,
        ImageFormat::Png => 4,
        // A copy that Exif turns, and the coefficients of all blocks if several scans refine them.
        ImageFormat::Jpeg if !codec::jpeg::has_several_scans(image, &mut bytes)? => 1,
        ImageFormat::Jpeg => 3,
        // Planes of the colors, and colors with alpha.
        ImageFormat::Webp => 3,
        ImageFormat::Exr | ImageFormat::Hdr | ImageFormat::Pfm => 10,
        ImageFormat::Tiff | ImageFormat::Tga | ImageFormat::Bmp | ImageFormat::Gif => {
            4 * u64::from(layout.sample_bytes)
        }
    };
    // Sizes above the limits of textures are possible here.
    let sides = u64::from(layout.width).saturating_mul(u64::from(layout.height));
    let decoder_bytes = sides.saturating_mul(u64::from(layout.channels)).saturating_mul(per_sample);
    Ok(RasterHead { layout, decoder_bytes })
}
