//! Formats of picture files, each with its writer (a stream of rows) and its reader (a whole image).

pub(crate) mod exr;
mod hdr;
mod jpeg;
mod pfm;
mod png;
mod webp;

use crate::look::{self, Look};
use crate::output::Destination;
use crate::raster::{Encoding, Layout, Raster, Samples};
use crate::tone::{Curve, Srgb, Tone};
use crate::{Format, ImageError, Limits, Viewpoint};
use juggler_math::message::excerpt;
use juggler_math::{Image, Rgb};
use std::io::{self, BufRead, Seek};

/// Takes a picture row by row, from the top.
pub trait RowWriter: Send {
    /// One or more whole rows of linear light.
    fn write_rows(&mut self, rows: &[Rgb]) -> Result<(), ImageError>;

    /// Completes the file, after the last row. Without this call there is no valid file.
    fn finish(self: Box<Self>) -> Result<(), ImageError>;
}

/// What a picture file says besides its pixels, and how it says it.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// From linear light to levels, for the formats that have levels.
    pub tone: Tone,
    /// Choices that some formats leave.
    pub options: Options,
    /// Texts by key, in order: the program, the fingerprint, the seed. PNG, EXR and HDR keep them.
    pub metadata: Vec<(String, String)>,
    /// From where it was taken, if anybody knows. EXR keeps it.
    pub viewpoint: Option<Viewpoint>,
}

impl Header {
    /// A picture of that size, all else by default.
    pub fn new(width: u32, height: u32) -> Self {
        let (tone, options) = (Tone::default(), Options::default());
        Self { width, height, tone, options, metadata: Vec::new(), viewpoint: None }
    }

    /// Whether the format can say which primaries these are: asked before anything is rendered.
    pub fn check_primaries(&self, format: Format) -> Result<(), ImageError> {
        let primaries = self.tone.primaries;
        let takes = match format {
            Format::Exr => true,
            Format::Png => primaries.code_point().is_some(),
            Format::Jpeg | Format::Webp | Format::Hdr | Format::Pfm => primaries.is_srgb(),
        };
        // A look's levels are those of screens of its time.
        let takes = takes && (primaries.is_srgb() || self.options.look == Look::Plain);
        if takes { Ok(()) } else { Err(ImageError::Primaries { format, primaries }) }
    }

    fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }
}

/// Choices that some formats leave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Whether a PNG has 16 bits a channel instead of 8.
    pub png_16_bit: bool,
    /// Quality of a JPEG, 1 to 100.
    pub jpeg_quality: u8,
    /// Precision of an EXR.
    pub exr_depth: SampleDepth,
    /// Packing of an EXR; nothing is lost by any.
    pub exr_compression: ExrCompression,
    /// What is done with the levels, where there are levels.
    pub look: Look,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            png_16_bit: false,
            jpeg_quality: 95,
            exr_depth: SampleDepth::Float,
            exr_compression: ExrCompression::Rle,
            look: Look::Plain,
        }
    }
}

/// Precision of a channel in an EXR file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleDepth {
    /// 32 bits: every value as it is.
    Float,
    /// 16 bits: 11 bits of precision, up to 65,504.
    Half,
}

/// Packing of an EXR file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExrCompression {
    /// As large as the numbers are.
    None,
    /// Runs: fast, good for flat areas (empty backgrounds, features for denoisers) and little else.
    Rle,
    /// Deflate: twenty times slower, worth it for halves and pictures without noise.
    Zip,
}

/// A writer for a format. Wrong sizes are refused here, before anything is written.
pub fn writer(format: Format, destination: Destination, header: &Header) -> Result<Box<dyn RowWriter>, ImageError> {
    format.check_dimensions(header.width, header.height)?;
    header.check_primaries(format)?;
    let inner = if format.has_looks() {
        look::Writer::before(header, |header| encoder(format, destination, header))?
    } else {
        encoder(format, destination, header)?
    };
    Ok(Box::new(Counted { inner, width: u64::from(header.width), left: header.pixels() }))
}

fn encoder(format: Format, destination: Destination, header: &Header) -> Result<Box<dyn RowWriter>, ImageError> {
    Ok(match format {
        Format::Png => Box::new(png::Writer::new(destination, header)?),
        Format::Jpeg => Box::new(jpeg::Writer::new(destination, header)),
        Format::Exr => Box::new(exr::Writer::new(destination, header)?),
        Format::Hdr => Box::new(hdr::Writer::new(destination, header)?),
        Format::Webp => Box::new(webp::Writer::new(destination, header)),
        Format::Pfm => Box::new(pfm::Writer::new(destination, header)?),
    })
}

/// Sees to it that the formats' writers get whole rows, and neither too many nor too few.
struct Counted {
    inner: Box<dyn RowWriter>,
    width: u64,
    /// Pixels still to come.
    left: u64,
}

impl RowWriter for Counted {
    fn write_rows(&mut self, rows: &[Rgb]) -> Result<(), ImageError> {
        let given = rows.len() as u64;
        if given > self.left || !given.is_multiple_of(self.width) {
            return Err(ImageError::Rows { expected: self.left.min(self.width), given });
        }
        self.left -= given;
        if rows.is_empty() { Ok(()) } else { self.inner.write_rows(rows) }
    }

    fn finish(self: Box<Self>) -> Result<(), ImageError> {
        if self.left > 0 {
            return Err(ImageError::Rows { expected: self.left, given: 0 });
        }
        self.inner.finish()
    }
}

/// A piece of a file's text as it may stand in a message: short, and only if all of it can be read.
fn shown(text: &str) -> String {
    const LONGEST: usize = 40;
    if text.chars().any(|c| c.is_control() || c == char::REPLACEMENT_CHARACTER) {
        return "bytes that are no text".to_owned();
    }
    format!("`{}`", excerpt(text, LONGEST))
}

/// What a reader reads from.
pub(crate) trait ReadSeek: BufRead + Seek {}
impl<T: BufRead + Seek> ReadSeek for T {}

/// A file being read: where it is (for messages), what it should be, and the limits.
#[derive(Clone, Copy)]
pub(crate) struct Source<'a> {
    pub place: &'a str,
    pub format: Format,
    pub limits: &'a Limits,
    /// Bytes of the file.
    pub length: u64,
}

/// What is said of data that should go on and does not.
pub(crate) const ENDS: &str = "its data ends too early";

impl Source<'_> {
    pub(crate) fn malformed(self, message: impl Into<String>) -> ImageError {
        ImageError::Malformed { place: self.place.into(), format: self.format, message: message.into(), at: None }
    }

    pub(crate) fn truncated(self) -> ImageError {
        ImageError::Truncated { place: self.place.into(), at: self.length }
    }

    /// A system's failure; the end of the file is one of the file itself.
    pub(crate) fn failed(self, source: io::Error) -> ImageError {
        match source.kind() {
            io::ErrorKind::UnexpectedEof => self.malformed(ENDS),
            io::ErrorKind::InvalidData | io::ErrorKind::InvalidInput | io::ErrorKind::Other => {
                self.malformed(source.to_string())
            }
            _ => ImageError::Read { place: self.place.into(), source },
        }
    }

    /// Checks width and height before any pixel is decoded: there are pixels, not too many, and no more than the bytes
    /// of the file can hold if each holds `densest`.
    pub(crate) fn size(self, width: u64, height: u64, densest: u64) -> Result<(u32, u32), ImageError> {
        let place = || self.place.to_owned();
        let (Limits { most_pixels, longest_side }, bytes) = (*self.limits, self.length);
        let (Ok(columns), Ok(rows)) = (u32::try_from(width), u32::try_from(height)) else {
            return Err(ImageError::TooLong { place: place(), width, height, longest_side });
        };
        if columns == 0 || rows == 0 {
            return Err(self.malformed(format!("its size is {width} × {height}")));
        }
        // Two factors of 32 bits do not overflow 64.
        let pixels = width * height;
        if pixels > bytes.saturating_mul(densest) {
            return Err(ImageError::Claim { place: place(), format: self.format, width, height, bytes });
        }
        if columns.max(rows) > longest_side {
            return Err(ImageError::TooLong { place: place(), width, height, longest_side });
        }
        if pixels > most_pixels {
            return Err(ImageError::TooLarge { place: place(), width, height, most_pixels });
        }
        Ok((columns, rows))
    }

    /// Adds to an error where in the file reading stopped.
    fn located<T>(self, bytes: &mut dyn ReadSeek, result: Result<T, ImageError>) -> Result<T, ImageError> {
        let Err(ImageError::Malformed { place, format, message, at: None }) = result else { return result };
        // A JPEG is read as a whole before it is decoded.
        let at = bytes.stream_position().ok().filter(|_| self.format != Format::Jpeg);
        Err(match at {
            at if message == ENDS && at.is_none_or(|at| at >= self.length) => self.truncated(),
            at => ImageError::Malformed { place, format, message, at },
        })
    }

    fn layout(self, (width, height): (u32, u32), channels: u8, sample_bytes: u8) -> Layout {
        Layout { format: self.format, width, height, channels, sample_bytes }
    }

    fn image(self, width: u32, height: u32, pixels: Vec<Rgb>) -> Result<Image, ImageError> {
        Image::from_pixels(width, height, pixels).ok_or_else(|| self.malformed(ENDS))
    }
}

/// Reads a picture from its first byte on.
pub(crate) fn read(source: Source, bytes: &mut dyn ReadSeek) -> Result<Image, ImageError> {
    let image = match source.format {
        Format::Png => png::read(source, bytes),
        Format::Jpeg => jpeg::read(source, bytes),
        Format::Exr => exr::read(source, bytes),
        Format::Hdr => hdr::read(source, bytes),
        Format::Webp => webp::read(source, bytes),
        Format::Pfm => pfm::read(source, bytes),
    };
    source.located(bytes, image)
}

/// Reads a picture's samples as they are.
pub(crate) fn raster(source: Source, bytes: &mut dyn ReadSeek) -> Result<Raster, ImageError> {
    let raster = match source.format {
        Format::Png => png::raster(source, bytes),
        Format::Jpeg => jpeg::raster(source, bytes),
        Format::Exr => exr::raster(source, bytes),
        Format::Webp => webp::raster(source, bytes),
        Format::Hdr | Format::Pfm => {
            let image = read(source, bytes)?;
            let samples = image.pixels().iter().flat_map(|pixel| pixel.to_array()).collect();
            let layout = source.layout((image.width(), image.height()), 3, 4);
            Ok(Raster { layout, samples: Samples::Floats(samples), encoding: Encoding::Linear })
        }
    };
    source.located(bytes, raster)
}

/// Reads what [`raster`] will bring.
pub(crate) fn layout(source: Source, bytes: &mut dyn ReadSeek) -> Result<Layout, ImageError> {
    let layout = match source.format {
        Format::Png => png::layout(source, bytes),
        Format::Webp => webp::layout(source, bytes),
        Format::Exr => exr::layout(source, bytes),
        Format::Jpeg => jpeg::size(source, bytes).map(|size| source.layout(size, 3, 1)),
        Format::Hdr => hdr::inspect(source, bytes).map(|(size, _)| source.layout(size, 3, 4)),
        Format::Pfm => pfm::size(source, bytes).map(|size| source.layout(size, 3, 4)),
    };
    source.located(bytes, layout)
}

/// What a picture file says before its pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Facts {
    /// The format, by the first bytes.
    pub format: Format,
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Texts by key, in order; none in formats that we write none to.
    pub metadata: Vec<(String, String)>,
}

/// Reads a picture's size and texts, and no pixels.
pub(crate) fn inspect(source: Source, bytes: &mut dyn ReadSeek) -> Result<Facts, ImageError> {
    let plain = |size| (size, Vec::new());
    let inspected = match source.format {
        Format::Png => png::inspect(source, bytes),
        Format::Exr => exr::inspect(source, bytes),
        Format::Hdr => hdr::inspect(source, bytes),
        Format::Jpeg => jpeg::size(source, bytes).map(plain),
        Format::Webp => webp::size(source, bytes).map(plain),
        Format::Pfm => pfm::size(source, bytes).map(plain),
    };
    let ((width, height), metadata) = source.located(bytes, inspected)?;
    Ok(Facts { format: source.format, width, height, metadata })
}

/// Texts by key, in order.
type Texts = Vec<(String, String)>;
/// Width and height, and texts.
type Inspected = ((u32, u32), Texts);

/// Linear light of the 256 levels of sRGB: by the curve that wrote them, so that equal levels are equal light
/// whatever the format.
fn srgb_levels() -> [f32; 256] {
    std::array::from_fn(|k| Srgb {}.decode(k as f64 / 255.0) as f32)
}

/// Linear pixels of bytes in sRGB, three a pixel.
fn pixels_from_srgb(bytes: &[u8]) -> Vec<Rgb> {
    let levels = srgb_levels();
    let linear = |b: u8| levels[usize::from(b)];
    bytes.chunks_exact(3).map(|c| Rgb::new(linear(c[0]), linear(c[1]), linear(c[2]))).collect()
}
