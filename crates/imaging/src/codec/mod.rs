//! Image file formats, each with a reader and, if images of the format are written, a streaming
//! writer.

mod bmp;
pub(crate) mod exr;
mod gif;
mod hdr;
mod header;
mod image_crate;
pub(crate) mod jpeg;
mod pfm;
mod png;
mod row_count;
mod tga;
pub(crate) mod tiff;
mod webp;

use crate::look::{self, DisplayLook};
use crate::output::Destination;
use crate::raster::{Raster, RasterLayout, RasterSamples, TransferFunction};
use crate::tone::{Curve, Matrix, Srgb};
use crate::{ExrWindows, ImageError, ImageFormat, Limits};
pub use gif::{GifLength, gif_length};
pub use header::Header;
use juggler_math::message::excerpt;
use juggler_math::{Image, PixelRows, Rgb};
use row_count::RowCountCheck;
use std::io::{self, BufRead, Seek};

/// Encoder that takes rows from top to bottom.
pub trait RowWriter: Send {
    /// Encodes one or more whole rows of linear RGB. Their alpha counts if the file is transparent
    /// ([`Header::transparent`]).
    fn write_rows(&mut self, rows: PixelRows) -> Result<(), ImageError>;

    /// Completes the file after the last row; without this call the file is invalid.
    fn finish(self: Box<Self>) -> Result<(), ImageError>;
}

/// Options of particular formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Whether PNG files have 16 bits per channel instead of 8.
    pub png_16_bit: bool,
    /// JPEG quality, 1 to 100.
    pub jpeg_quality: u8,
    /// Sample type of EXR files.
    pub exr_depth: SampleDepth,
    /// Compression of EXR files, always lossless.
    pub exr_compression: ExrCompression,
    /// Display look applied to integer samples.
    pub look: DisplayLook,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            png_16_bit: false,
            jpeg_quality: 95,
            exr_depth: SampleDepth::Float,
            exr_compression: ExrCompression::Rle,
            look: DisplayLook::Plain,
        }
    }
}

/// Sample type of an EXR channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SampleDepth {
    /// 32-bit float.
    Float,
    /// 16-bit float: 11 significant bits, up to 65,504.
    Half,
}

/// Lossless compression of an EXR file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ExrCompression {
    /// Uncompressed.
    None,
    /// Run-length encoding: fast; effective only in flat areas such as empty backgrounds and AOVs
    /// for denoisers.
    Rle,
    /// Deflate: twenty times slower; worthwhile for half floats and images without noise.
    Zip,
}

/// Creates a writer for a format. Invalid sizes and primaries are rejected before anything is
/// written.
pub fn writer(
    format: ImageFormat,
    destination: Destination,
    header: &Header,
) -> Result<Box<dyn RowWriter>, ImageError> {
    format.check_dimensions(header.width, header.height)?;
    header.check(format)?;
    let header = &Header { transparent: header.has_alpha(format), ..header.clone() };
    let inner = if format.supports_display_looks() {
        look::Writer::wrap(header, |header| encoder(format, destination, header))?
    } else {
        encoder(format, destination, header)?
    };
    Ok(Box::new(RowCountCheck::new(inner, header)))
}

fn encoder(format: ImageFormat, destination: Destination, header: &Header) -> Result<Box<dyn RowWriter>, ImageError> {
    Ok(match format {
        ImageFormat::Png => Box::new(png::Writer::new(destination, header)?),
        ImageFormat::Jpeg => Box::new(jpeg::Writer::new(destination, header)),
        ImageFormat::Exr => Box::new(exr::Writer::new(destination, header)?),
        ImageFormat::Hdr => Box::new(hdr::Writer::new(destination, header)?),
        ImageFormat::Webp => Box::new(webp::Writer::new(destination, header)),
        ImageFormat::Pfm => Box::new(pfm::Writer::new(destination, header)?),
        ImageFormat::Tiff | ImageFormat::Tga | ImageFormat::Bmp | ImageFormat::Gif => {
            return Err(ImageError::ReadOnly { file: destination.name().to_owned(), format });
        }
    })
}

/// Quotes a text from a file for a message: shortened, and only if it is printable.
fn quoted(text: &str) -> String {
    const LONGEST: usize = 40;
    if text.chars().any(|c| c.is_control() || c == char::REPLACEMENT_CHARACTER) {
        return "bytes that are not text".to_owned();
    }
    format!("`{}`", excerpt(text, LONGEST))
}

/// Input of a reader.
pub(crate) trait ReadSeek: BufRead + Seek {}
impl<T: BufRead + Seek> ReadSeek for T {}

/// A file being read, with its name for messages, format and limits.
#[derive(Clone, Copy)]
pub(crate) struct Source<'a> {
    pub file: &'a str,
    pub format: ImageFormat,
    pub limits: &'a Limits,
    /// Length of the file in bytes.
    pub length: u64,
}

/// Message for unexpected end of data.
pub(crate) const UNEXPECTED_END: &str = "unexpected end of data";

impl Source<'_> {
    pub(crate) fn malformed(self, message: impl Into<String>) -> ImageError {
        ImageError::Malformed { file: self.file.into(), format: self.format, message: message.into(), at: None }
    }

    pub(crate) fn truncated(self) -> ImageError {
        ImageError::Truncated { file: self.file.into(), at: self.length }
    }

    /// Translates an I/O error; an unexpected end is a fault of the file.
    pub(crate) fn failed(self, source: io::Error) -> ImageError {
        match source.kind() {
            io::ErrorKind::UnexpectedEof => self.malformed(UNEXPECTED_END),
            io::ErrorKind::InvalidData | io::ErrorKind::InvalidInput | io::ErrorKind::Other => {
                self.malformed(source.to_string())
            }
            _ => ImageError::Read { file: self.file.into(), source },
        }
    }

    /// Validates an image size before pixels are decoded: it must be positive, within the limits,
    /// and plausible for the file's length at `max_pixels_per_byte` pixels per byte.
    pub(crate) fn size(self, width: u64, height: u64, max_pixels_per_byte: u64) -> Result<(u32, u32), ImageError> {
        let file = || self.file.to_owned();
        let (Limits { max_pixels, longest_side }, bytes) = (*self.limits, self.length);
        let (Ok(columns), Ok(rows)) = (u32::try_from(width), u32::try_from(height)) else {
            return Err(ImageError::TooLong { file: file(), width, height, longest_side });
        };
        if columns == 0 || rows == 0 {
            return Err(self.malformed(format!("its size is {width} × {height}")));
        }
        // The product of two 32-bit numbers fits 64 bits.
        let pixels = width * height;
        if pixels > bytes.saturating_mul(max_pixels_per_byte) {
            return Err(ImageError::ImplausibleSize { file: file(), format: self.format, width, height, bytes });
        }
        if columns.max(rows) > longest_side {
            return Err(ImageError::TooLong { file: file(), width, height, longest_side });
        }
        if pixels > max_pixels {
            return Err(ImageError::TooLarge { file: file(), width, height, max_pixels });
        }
        Ok((columns, rows))
    }

    /// Adds the file offset where decoding stopped to an error.
    fn with_offset<T>(self, bytes: &mut dyn ReadSeek, result: Result<T, ImageError>) -> Result<T, ImageError> {
        let Err(ImageError::Malformed { file, format, message, at: None }) = result else { return result };
        // The decoders of these formats read ahead, or the parts of a file in another order.
        let is_elsewhere = matches!(self.format, ImageFormat::Jpeg | ImageFormat::Tiff | ImageFormat::Gif);
        let at = bytes.stream_position().ok().filter(|_| !is_elsewhere);
        Err(match at {
            at if message == UNEXPECTED_END && at.is_none_or(|at| at >= self.length) => self.truncated(),
            at => ImageError::Malformed { file, format, message, at },
        })
    }

    fn layout(self, (width, height): (u32, u32), channels: u8, sample_bytes: u8) -> RasterLayout {
        RasterLayout { format: self.format, width, height, channels, sample_bytes, to_srgb: None }
    }

    /// Raster of linear RGB pixels in the file's primaries.
    fn float_raster(self, image: &Image, to_srgb: Option<Matrix>) -> Raster {
        let samples = image.pixels().iter().flat_map(|pixel| pixel.to_array()).collect();
        let layout = RasterLayout { to_srgb, ..self.layout((image.width(), image.height()), 3, 4) };
        let samples = RasterSamples::Floats(samples);
        Raster { layout, samples, transfer_function: TransferFunction::Linear, is_first_of_several: false }
    }

    fn image(self, width: u32, height: u32, pixels: Vec<Rgb>) -> Result<Image, ImageError> {
        Image::from_pixels(width, height, pixels).ok_or_else(|| self.malformed(UNEXPECTED_END))
    }
}

/// Reads an image as linear RGB.
pub(crate) fn read(source: Source, bytes: &mut dyn ReadSeek) -> Result<Image, ImageError> {
    let image = match source.format {
        ImageFormat::Png => png::read(source, bytes),
        ImageFormat::Jpeg => jpeg::read(source, bytes),
        ImageFormat::Exr => exr::read(source, bytes),
        ImageFormat::Hdr => hdr::read(source, bytes),
        ImageFormat::Webp => webp::read(source, bytes),
        ImageFormat::Pfm => pfm::read(source, bytes),
        ImageFormat::Tiff | ImageFormat::Tga | ImageFormat::Bmp | ImageFormat::Gif => stored(source, bytes)
            .and_then(|raster| source.image(raster.layout.width, raster.layout.height, raster.to_pixels())),
    };
    source.with_offset(bytes, image)
}

/// Reads an image's samples without conversion.
pub(crate) fn raster(source: Source, bytes: &mut dyn ReadSeek) -> Result<Raster, ImageError> {
    let raster = stored(source, bytes);
    source.with_offset(bytes, raster)
}

fn stored(source: Source, bytes: &mut dyn ReadSeek) -> Result<Raster, ImageError> {
    match source.format {
        ImageFormat::Png => png::raster(source, bytes),
        ImageFormat::Jpeg => jpeg::raster(source, bytes),
        ImageFormat::Exr => exr::raster(source, bytes),
        ImageFormat::Webp => webp::raster(source, bytes),
        ImageFormat::Hdr => hdr::pixels(source, bytes).map(|(image, to_srgb)| source.float_raster(&image, to_srgb)),
        ImageFormat::Pfm => pfm::read(source, bytes).map(|image| source.float_raster(&image, None)),
        ImageFormat::Tiff => tiff::raster(source, bytes),
        ImageFormat::Tga => tga::raster(source, bytes),
        ImageFormat::Bmp => bmp::raster(source, bytes),
        ImageFormat::Gif => gif::raster(source, bytes),
    }
}

/// Reads the layout of [`raster`] from the header.
pub(crate) fn layout(source: Source, bytes: &mut dyn ReadSeek) -> Result<RasterLayout, ImageError> {
    let layout = stored_layout(source, bytes);
    source.with_offset(bytes, layout)
}

fn stored_layout(source: Source, bytes: &mut dyn ReadSeek) -> Result<RasterLayout, ImageError> {
    match source.format {
        ImageFormat::Png => png::layout(source, bytes),
        ImageFormat::Webp => webp::layout(source, bytes),
        ImageFormat::Exr => exr::layout(source, bytes),
        ImageFormat::Jpeg => jpeg::size(source, bytes).map(|size| source.layout(size, 3, 1)),
        ImageFormat::Hdr => hdr::layout(source, bytes),
        ImageFormat::Pfm => pfm::size(source, bytes).map(|size| source.layout(size, 3, 4)),
        ImageFormat::Tiff => tiff::layout(source, bytes),
        ImageFormat::Tga => tga::layout(source, bytes),
        ImageFormat::Bmp => bmp::layout(source, bytes),
        ImageFormat::Gif => gif::layout(source, bytes),
    }
}

/// Properties of an image file, read from its header.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageInfo {
    /// Format, detected by the first bytes (TGA by the file extension).
    pub format: ImageFormat,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Whether the file stores tone-mapped levels instead of linear, scene-referred values.
    pub is_tone_mapped: bool,
    /// Metadata as pairs of key and text, in order; empty for formats without metadata.
    pub metadata: Vec<(String, String)>,
    /// Data and display windows of an EXR file.
    pub windows: Option<ExrWindows>,
}

/// Reads image size and metadata without decoding pixels.
pub(crate) fn inspect(source: Source, bytes: &mut dyn ReadSeek) -> Result<ImageInfo, ImageError> {
    let plain = |size| (size, Vec::new());
    let (mut windows, mut is_tone_mapped) = (None, source.format.is_tone_mapped());
    let inspected = match source.format {
        ImageFormat::Png => png::inspect(source, bytes),
        ImageFormat::Exr => exr::inspect(source, bytes).map(|(inspected, found)| {
            windows = Some(found);
            inspected
        }),
        ImageFormat::Hdr => hdr::inspect(source, bytes),
        ImageFormat::Jpeg => jpeg::size(source, bytes).map(plain),
        ImageFormat::Webp => webp::size(source, bytes).map(plain),
        ImageFormat::Pfm => pfm::size(source, bytes).map(plain),
        ImageFormat::Tiff | ImageFormat::Tga | ImageFormat::Bmp | ImageFormat::Gif => {
            stored_layout(source, bytes).map(|RasterLayout { width, height, sample_bytes, .. }| {
                is_tone_mapped = sample_bytes < 4;
                plain((width, height))
            })
        }
    };
    let ((width, height), metadata) = source.with_offset(bytes, inspected)?;
    Ok(ImageInfo { format: source.format, width, height, is_tone_mapped, metadata, windows })
}

/// Metadata as pairs of key and text, in order.
type Metadata = Vec<(String, String)>;
/// Width and height, and metadata.
type Inspected = ((u32, u32), Metadata);

/// Linear values of the 256 sRGB levels, by the curve that the writers use, so that all formats
/// decode equal levels to equal values.
fn srgb_levels() -> [f32; 256] {
    std::array::from_fn(|k| Srgb {}.decode(k as f64 / 255.0) as f32)
}

/// Converts pixels from a file's primaries to sRGB's.
pub(crate) fn convert_primaries(pixels: &mut [Rgb], to_srgb: Option<Matrix>) {
    if let Some(matrix) = to_srgb {
        pixels.iter_mut().for_each(|pixel| *pixel = matrix.color(*pixel));
    }
}

/// Converts 8-bit sRGB pixels to linear RGB.
fn pixels_from_srgb(bytes: &[u8]) -> Vec<Rgb> {
    let levels = srgb_levels();
    let linear = |b: u8| levels[usize::from(b)];
    bytes.chunks_exact(3).map(|c| Rgb::new(linear(c[0]), linear(c[1]), linear(c[2]))).collect()
}
