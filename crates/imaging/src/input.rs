//! Reading of images. The first bytes of a file determine its format, not its name, except for TGA
//! files, which begin with no magic number.

use crate::codec::{self, ImageInfo, Source};
use crate::raster::{decode_raster, inspect_raster};
use crate::{ImageError, ImageFormat, RasterLayout, regular};
use juggler_math::{Image, PixelRows, Rgb};
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

/// Limits on the size of images that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Maximum number of pixels; each takes 12 bytes, and 8 more while decoding.
    pub max_pixels: u64,
    /// Longest side in pixels.
    pub longest_side: u32,
}

impl Limits {
    /// No limits, for readers that do not decode pixels.
    pub(crate) const NONE: Self = Self { max_pixels: u64::MAX, longest_side: u32::MAX };
}

impl Default for Limits {
    /// Admits 20,000 × 20,000 pixels.
    fn default() -> Self {
        Self { max_pixels: 1 << 29, longest_side: u32::MAX }
    }
}

/// Reads an image of any supported format as linear RGB, within the default limits.
pub fn read(path: &Path) -> Result<Image, ImageError> {
    read_within(path, &Limits::default())
}

/// Reads an image as linear RGB within the given limits.
pub fn read_within(path: &Path, limits: &Limits) -> Result<Image, ImageError> {
    decode(&path.display().to_string(), open(path)?, limits)
}

/// Image with alpha.
#[derive(Clone, Debug, PartialEq)]
pub struct AlphaImage {
    /// Linear RGB, multiplied by alpha.
    pub colors: Image,
    /// Alpha of the pixels, 0 to 1, row by row from the top; `None` if the file has none.
    pub alpha: Option<Vec<f32>>,
}

impl AlphaImage {
    /// All pixels, row by row from the top.
    pub fn rows(&self) -> PixelRows<'_> {
        PixelRows { colors: self.colors.pixels(), alpha: self.alpha.as_deref() }
    }
}

/// Reads an image of any supported format with its alpha, within the default limits. Colors are
/// linear RGB; straight ones, which all formats but EXR store, are multiplied by alpha.
pub fn read_with_alpha(path: &Path) -> Result<AlphaImage, ImageError> {
    let RasterLayout { format, width, height, channels, .. } = inspect_raster(path)?;
    if !matches!(channels, 2 | 4) {
        return Ok(AlphaImage { colors: read(path)?, alpha: None });
    }
    let raster = decode_raster(&path.display().to_string(), open(path)?, &Limits::default())?;
    let alpha = raster.alpha().unwrap_or_default();
    let mut pixels: Vec<Rgb> = raster.to_pixels();
    if format != ImageFormat::Exr {
        pixels.iter_mut().zip(&alpha).for_each(|(pixel, alpha)| *pixel = *pixel * *alpha);
    }
    // The number of samples is checked above.
    let colors = Image::from_pixels(width, height, pixels).unwrap_or_else(|| Image::filled(width, height, Rgb::BLACK));
    Ok(AlphaImage { colors, alpha: Some(alpha) })
}

/// Reads an image from bytes; `file` names them in messages.
pub fn decode(file: &str, bytes: impl BufRead + Seek, limits: &Limits) -> Result<Image, ImageError> {
    let mut bytes = bytes;
    codec::read(source(file, &mut bytes, limits)?, &mut bytes)
}

/// Reads image size and metadata without decoding pixels, whatever the size.
pub fn inspect(path: &Path) -> Result<ImageInfo, ImageError> {
    let (file, mut bytes) = (path.display().to_string(), open(path)?);
    codec::inspect(source(&file, &mut bytes, &Limits::NONE)?, &mut bytes)
}

pub(crate) fn open(path: &Path) -> Result<BufReader<File>, ImageError> {
    let failed = |source| ImageError::Read { file: path.display().to_string(), source };
    regular::open(path).map(BufReader::new).map_err(failed)
}

/// Detects the format and length of the input.
pub(crate) fn source<'a>(
    file: &'a str,
    bytes: &mut (impl BufRead + Seek),
    limits: &'a Limits,
) -> Result<Source<'a>, ImageError> {
    let failed = |source| ImageError::Read { file: file.to_owned(), source };
    let mut start = Vec::new();
    bytes.by_ref().take(12).read_to_end(&mut start).map_err(failed)?;
    let length = bytes.seek(SeekFrom::End(0)).map_err(failed)?;
    bytes.rewind().map_err(failed)?;
    let format = ImageFormat::detect(&start, Path::new(file));
    let format = format.ok_or_else(|| ImageError::UnknownContent { file: file.to_owned() })?;
    Ok(Source { file, format, limits, length })
}
