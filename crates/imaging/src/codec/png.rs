//! PNG with 8 or 16 bits per channel (W3C, Portable Network Graphics, third edition). Files are
//! tagged as sRGB, the display that tone curves target; other primaries are stored in cICP with the
//! sRGB transfer function, and in cHRM and gAMA for readers without cICP. Metadata goes to tEXt
//! chunks, non-ASCII text to iTXt.

use super::{Header, Inspected, ReadSeek, RowWriter, Source, UNEXPECTED_END};
use crate::ImageError;
use crate::orientation::Orientation;
use crate::output::Destination;
use crate::raster::{Raster, RasterLayout, RasterSamples, TransferFunction};
use crate::tone::{Chromaticities, LevelEncoder, Matrix};
use juggler_math::{Image, PixelRows, Rgb};
use png::{BitDepth, ColorType, DecodingError, EncodingError, StreamWriter};
use std::io::{self, BufRead, Seek, Write};
use std::sync::{Arc, Mutex, PoisonError};

/// Code point of the sRGB transfer function in cICP (ITU-T H.273, table 3).
const SRGB_CURVE: u8 = 13;

/// Streams rows into a PNG.
pub(super) struct Writer {
    stream: StreamWriter<'static, Sink>,
    sink: Sink,
    levels: LevelEncoder,
    bytes: Vec<u8>,
    file: String,
}

impl Writer {
    pub fn new(destination: Destination, header: &Header) -> Result<Self, ImageError> {
        let file = destination.name().to_owned();
        let is_16_bit = header.options.png_16_bit;
        let sink = Sink::new(destination);
        let stream = stream(sink.clone(), header).map_err(|e| failed(&file, e))?;
        let levels =
            if is_16_bit { LevelEncoder::words(&header.tone) } else { LevelEncoder::bytes(&header.tone, header.width) };
        let levels = levels.with_alpha(header.transparent);
        Ok(Self { stream, sink, levels, bytes: Vec::new(), file })
    }
}

impl RowWriter for Writer {
    fn write_rows(&mut self, rows: PixelRows) -> Result<(), ImageError> {
        // Quantize in pieces of fixed size, so that the buffer stays small.
        for piece in rows.chunks(1 << 12) {
            self.bytes.clear();
            self.levels.append(piece, &mut self.bytes);
            self.stream.write_all(&self.bytes).map_err(|e| failed(&self.file, EncodingError::IoError(e)))?;
        }
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), ImageError> {
        let Self { stream, sink, file, .. } = *self;
        stream.finish().map_err(|e| failed(&file, e))?;
        sink.finish().map_err(|e| failed(&file, EncodingError::IoError(e)))
    }
}

/// Records write errors, since the encoder ignores errors of the last chunk, which it writes on
/// drop.
#[derive(Clone)]
struct Sink(Arc<Mutex<Outlet>>);

struct Outlet {
    bytes: Box<dyn Write + Send>,
    failure: Option<io::Error>,
}

impl Sink {
    fn new(destination: Destination) -> Self {
        Self(Arc::new(Mutex::new(Outlet { bytes: destination.into_stream(), failure: None })))
    }

    fn with<T>(&self, act: impl FnOnce(&mut dyn Write) -> io::Result<T>) -> io::Result<T> {
        let mut outlet = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        act(&mut outlet.bytes).inspect_err(|error| outlet.failure = Some(error.kind().into()))
    }

    /// Flushes the output and returns the first error, after the encoder was dropped.
    fn finish(self) -> io::Result<()> {
        self.with(|bytes| bytes.flush())?;
        let mut outlet = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        outlet.failure.take().map_or(Ok(()), Err)
    }
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.with(|sink| sink.write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.with(|sink| sink.flush())
    }
}

/// Writes everything before the pixels.
fn stream(sink: Sink, header: &Header) -> Result<StreamWriter<'static, Sink>, EncodingError> {
    let mut encoder = png::Encoder::new(sink, header.width, header.height);
    encoder.set_color(if header.transparent { ColorType::Rgba } else { ColorType::Rgb });
    encoder.set_depth(if header.options.png_16_bit { BitDepth::Sixteen } else { BitDepth::Eight });
    encoder.set_compression(png::Compression::Fast);
    let primaries = header.tone.primaries;
    if primaries.is_srgb() {
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    } else {
        // Readers without cICP use the power curve closest to sRGB's, gamma 2.2.
        encoder.set_source_gamma(png::ScaledFloat::from_scaled(45_455));
        encoder.set_source_chromaticities(to_chrm(&primaries.chromaticities()));
    }
    for (key, text) in &header.metadata {
        if text.is_ascii() && key.is_ascii() {
            encoder.add_text_chunk(key.clone(), text.clone())?;
        } else {
            encoder.add_itxt_chunk(key.clone(), text.clone())?;
        }
    }
    let mut writer = encoder.write_header()?;
    if let Some(number) = primaries.code_point().filter(|_| !primaries.is_srgb()) {
        writer.write_chunk(png::chunk::cICP, &[number, SRGB_CURVE, 0, 1])?;
    }
    writer.into_stream_writer()
}

fn to_chrm(c: &Chromaticities) -> png::SourceChromaticities {
    let pair = |[x, y]: [f64; 2]| (x as f32, y as f32);
    png::SourceChromaticities::new(pair(c.white), pair(c.red), pair(c.green), pair(c.blue))
}

fn failed(file: &str, error: EncodingError) -> ImageError {
    let file = file.to_owned();
    match error {
        EncodingError::IoError(source) => ImageError::Write { file, source },
        other => ImageError::Encode { file, format: crate::ImageFormat::Png, message: other.to_string() },
    }
}

fn unreadable(source: Source, error: DecodingError) -> ImageError {
    match error {
        DecodingError::IoError(error) => source.failed(error),
        DecodingError::Format(error) => source.malformed(describe(&error.to_string())),
        DecodingError::Parameter(_) => source.malformed(DAMAGED),
        DecodingError::LimitsExceeded => source.malformed("its text or color profile is too large"),
    }
}

const DAMAGED: &str = "its structure is damaged";

/// Describes a decoder error in plain words, by the beginning of its text.
fn describe(text: &str) -> &'static str {
    let known = [
        ("CRC error", "the checksum of a chunk is wrong"),
        ("Corrupt deflate stream", "its compressed pixels are damaged"),
        ("IDAT or fDAT", UNEXPECTED_END),
        ("IDAT or fdAT", "it holds no pixels"),
        ("Chunk", "a chunk is out of place"),
        ("Missing palette", "its palette is missing"),
        ("Not enough palette", "its palette is too short"),
        ("Invalid image dimensions", "its width or height is 0 or too large"),
        ("Invalid color", "its header has an invalid color type"),
        ("Invalid bit depth", "its header has an invalid bit depth"),
        ("Transparency", "it has transparency for a color type without transparency"),
    ];
    known.into_iter().find(|(start, _)| text.starts_with(start)).map_or(DAMAGED, |(_, words)| words)
}

/// Maximum number of pixels per byte: Deflate expands by a factor of 1032 at most.
fn max_pixels_per_byte(info: &png::Info) -> u64 {
    8 * 1032 / (info.bits_per_pixel() as u64).max(1)
}

/// Reads an image as linear RGB with sRGB primaries. Levels are decoded by the file's transfer
/// function (sRGB if it names none); alpha is ignored.
pub(super) fn read(source: Source, bytes: &mut dyn ReadSeek) -> Result<Image, ImageError> {
    let mut decoder = png::Decoder::new(&mut *bytes);
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(|e| unreadable(source, e))?;
    let info = reader.info();
    let (width, height) = source.size(u64::from(info.width), u64::from(info.height), max_pixels_per_byte(info))?;
    let (interlaced, transfer_function, matrix) = (info.interlaced, transfer_function(info), to_srgb(info));
    let orientation = orientation(info);
    let (color, depth) = reader.output_color_type();
    let row = Row::new(color, depth, has_video_levels(info), transfer_function, u64::from(width) * u64::from(height));
    let mut pixels = Vec::new();
    if interlaced {
        let mut bytes = vec![0; reader.output_buffer_size().ok_or_else(|| source.malformed("it is too large"))?];
        reader.next_frame(&mut bytes).map_err(|e| unreadable(source, e))?;
        row.append(&bytes, &mut pixels);
    } else {
        while let Some(bytes) = reader.next_row().map_err(|e| unreadable(source, e))? {
            row.append(bytes.data(), &mut pixels);
        }
    }
    super::convert_primaries(&mut pixels, matrix);
    let pixels = orientation.turn(pixels, (width, height), 1);
    let (width, height) = orientation.size((width, height));
    source.image(width, height, pixels)
}

/// Matrix from the file's primaries (cICP, else cHRM) to sRGB's; `None` if they are equal.
fn to_srgb(info: &png::Info) -> Option<Matrix> {
    if let Some(codes) = &info.coding_independent_code_points {
        return Chromaticities::from_code_point(codes.color_primaries)?.to_srgb();
    }
    if info.srgb.is_some() || info.icc_profile.is_some() {
        return None;
    }
    let chunk = info.chrm_chunk?;
    let pair = |(x, y): (png::ScaledFloat, png::ScaledFloat)| [x, y].map(|v| f64::from(v.into_value()));
    let [red, green, blue, white] = [chunk.red, chunk.green, chunk.blue, chunk.white].map(pair);
    Chromaticities { red, green, blue, white }.to_srgb()
}

/// Orientation that an eXIf chunk before the pixels states.
fn orientation(info: &png::Info) -> Orientation {
    Orientation::from_exif(info.exif_metadata.as_deref())
}

/// Transfer function of the file; sRGB if it names none.
fn transfer_function(info: &png::Info) -> TransferFunction {
    if let Some(codes) = &info.coding_independent_code_points {
        // ITU-T H.273, table 3. Browsers show the curves of standard video as sRGB, too.
        return match codes.transfer_function {
            4 => TransferFunction::Gamma(2.2),
            5 => TransferFunction::Gamma(2.8),
            8 => TransferFunction::Linear,
            16 => TransferFunction::Pq,
            17 => TransferFunction::Gamma(2.6),
            18 => TransferFunction::Hlg,
            _ => TransferFunction::Srgb,
        };
    }
    match (info.srgb, info.gama_chunk) {
        (None, Some(gama)) if gama.into_value() > 0.0 => TransferFunction::Gamma(1.0 / f64::from(gama.into_value())),
        _ => TransferFunction::Srgb,
    }
}

/// Whether the file states video levels (cICP): of 255, black has level 16 and white 235.
fn has_video_levels(info: &png::Info) -> bool {
    info.coding_independent_code_points.is_some_and(|codes| !codes.is_video_full_range_image)
}

/// Level from 0 to 1 of a video level out of `top` (ITU-R BT.2100, table 9).
fn expanded(level: f64, top: f64) -> f64 {
    // The digital values of 8 bits, times a power of two for more bits.
    let unit = (top + 1.0) / 256.0;
    ((level / unit - 16.0) / 219.0).clamp(0.0, 1.0)
}

/// Expands the video levels of colors; alpha keeps its levels.
fn expand_video_levels(samples: &mut RasterSamples, channels: usize) {
    let colors = if channels < 3 { 1 } else { 3 };
    match samples {
        RasterSamples::Bytes(levels) => levels
            .chunks_mut(channels)
            .flat_map(|pixel| pixel.iter_mut().take(colors))
            .for_each(|level| *level = (255.0 * expanded(f64::from(*level), 255.0)).round() as u8),
        RasterSamples::Words(levels) => levels
            .chunks_mut(channels)
            .flat_map(|pixel| pixel.iter_mut().take(colors))
            .for_each(|level| *level = (65_535.0 * expanded(f64::from(*level), 65_535.0)).round() as u16),
        RasterSamples::Floats(_) => {}
    }
}

/// Layout of [`raster`] after the header was read.
fn layout_of<R: BufRead + Seek>(source: Source, reader: &png::Reader<R>) -> Result<RasterLayout, ImageError> {
    let info = reader.info();
    let size = source.size(u64::from(info.width), u64::from(info.height), max_pixels_per_byte(info))?;
    let (color, depth) = reader.output_color_type();
    let layout = source.layout(
        orientation(info).size(size),
        color.samples() as u8,
        if depth == BitDepth::Sixteen { 2 } else { 1 },
    );
    // White keeps its value, and so does gray.
    Ok(RasterLayout { to_srgb: to_srgb(info).filter(|_| layout.channels > 2), ..layout })
}

/// Reads the samples; palettes and depths below 8 bits are expanded to bytes.
pub(super) fn raster(source: Source, bytes: &mut dyn ReadSeek) -> Result<Raster, ImageError> {
    let mut decoder = png::Decoder::new(&mut *bytes);
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(|e| unreadable(source, e))?;
    let (layout, transfer_function) = (layout_of(source, &reader)?, transfer_function(reader.info()));
    let mut bytes = vec![0; reader.output_buffer_size().ok_or_else(|| source.malformed("it is too large"))?];
    reader.next_frame(&mut bytes).map_err(|e| unreadable(source, e))?;
    let orientation = orientation(reader.info());
    let is_first_of_several = reader.info().animation_control.is_some_and(|movie| movie.num_frames > 1);
    let (stored, channels) = (orientation.size((layout.width, layout.height)), usize::from(layout.channels));
    let mut samples = if layout.sample_bytes == 2 {
        let words = bytes.chunks_exact(2).map(|two| u16::from(two[0]) << 8 | u16::from(two[1])).collect();
        RasterSamples::Words(orientation.turn(words, stored, channels))
    } else {
        RasterSamples::Bytes(orientation.turn(bytes, stored, channels))
    };
    if has_video_levels(reader.info()) {
        expand_video_levels(&mut samples, channels.max(1));
    }
    Ok(Raster { layout, samples, transfer_function, is_first_of_several })
}

/// Reads the layout of [`raster`] from the header.
pub(super) fn layout(source: Source, bytes: &mut dyn ReadSeek) -> Result<RasterLayout, ImageError> {
    let mut decoder = png::Decoder::new(&mut *bytes);
    decoder.set_transformations(png::Transformations::EXPAND);
    layout_of(source, &decoder.read_info().map_err(|e| unreadable(source, e))?)
}

/// Converts rows of samples to linear RGB.
struct Row {
    /// Samples per pixel: 1 gray, 2 gray and alpha, 3 RGB, 4 RGBA.
    samples: usize,
    is_16_bit: bool,
    has_video_levels: bool,
    transfer_function: TransferFunction,
    /// Table of linear values by level; empty for images too small to pay for it.
    levels: Vec<f32>,
}

impl Row {
    fn new(
        color: ColorType,
        depth: BitDepth,
        has_video_levels: bool,
        transfer_function: TransferFunction,
        pixels: u64,
    ) -> Self {
        let is_16_bit = depth == BitDepth::Sixteen;
        let mut row =
            Self { samples: color.samples(), is_16_bit, has_video_levels, transfer_function, levels: Vec::new() };
        let count = if is_16_bit { 65_536 } else { 256 };
        if pixels > count {
            row.levels = (0..count as usize).map(|level| row.linear(level)).collect();
        }
        row
    }

    fn linear(&self, level: usize) -> f32 {
        let top = if self.is_16_bit { 65_535.0 } else { 255.0 };
        self.levels.get(level).copied().unwrap_or_else(|| {
            let level = level as f64;
            let level = if self.has_video_levels { expanded(level, top) } else { level / top };
            self.transfer_function.decode(level) as f32
        })
    }

    fn append(&self, bytes: &[u8], pixels: &mut Vec<Rgb>) {
        let size = if self.is_16_bit { 2 } else { 1 };
        let level = |bytes: &[u8]| bytes.iter().fold(0, |level, &b| level << 8 | usize::from(b));
        let linear = |bytes: &[u8]| self.linear(level(bytes));
        pixels.extend(bytes.chunks_exact(self.samples * size).map(|pixel| {
            let mut samples = pixel.chunks_exact(size).map(linear);
            let first = samples.next().unwrap_or_default();
            match (self.samples, samples.next(), samples.next()) {
                (3 | 4, Some(g), Some(b)) => Rgb::new(first, g, b),
                _ => Rgb::splat(first),
            }
        }));
    }
}

/// Image size and metadata: tEXt chunks, then iTXt chunks.
pub(super) fn inspect(source: Source, bytes: &mut dyn ReadSeek) -> Result<Inspected, ImageError> {
    let reader = png::Decoder::new(&mut *bytes).read_info().map_err(|e| unreadable(source, e))?;
    let info = reader.info();
    let plain = info.uncompressed_latin1_text.iter().map(|t| (t.keyword.clone(), t.text.clone()));
    let wide = info.utf8_text.iter().map(|t| (t.keyword.clone(), t.get_text().unwrap_or_default()));
    let size = source.size(u64::from(info.width), u64::from(info.height), max_pixels_per_byte(info))?;
    let size = orientation(info).size(size);
    Ok((size, plain.chain(wide).collect()))
}
