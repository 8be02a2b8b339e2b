//! PNG: 8 or 16 bits a channel, streamed; tagged as sRGB, because that is the display that every tone curve aims
//! at; texts in tEXt or (beyond ASCII) iTXt chunks (W3C, Portable Network Graphics, third edition).

use super::{Header, Inspected, ReadSeek, RowWriter, Source};
use crate::ImageError;
use crate::output::Destination;
use crate::raster::{Encoding, Layout, Raster, Samples};
use crate::tone::{Curve, Gamma, Quantizer, Srgb};
use juggler_math::{Image, Rgb};
use png::{BitDepth, ColorType, DecodingError, EncodingError, StreamWriter};
use std::io::{self, BufRead, Seek, Write};
use std::sync::{Arc, Mutex, PoisonError};

/// Streams rows into a PNG.
pub(super) struct Writer {
    stream: StreamWriter<'static, Sink>,
    sink: Sink,
    quantizer: Quantizer,
    words: bool,
    bytes: Vec<u8>,
    place: String,
}

impl Writer {
    pub fn new(destination: Destination, header: &Header) -> Result<Self, ImageError> {
        let place = destination.name().to_owned();
        let words = header.options.png_16_bit;
        let sink = Sink::new(destination);
        let stream = stream(sink.clone(), header).map_err(|e| failed(&place, e))?;
        let quantizer = Quantizer::new(&header.tone, if words { u16::MAX } else { 255 });
        Ok(Self { stream, sink, quantizer, words, bytes: Vec::new(), place })
    }
}

impl RowWriter for Writer {
    fn write_rows(&mut self, rows: &[Rgb]) -> Result<(), ImageError> {
        // Rows come in any number: a fixed piece at a time keeps the buffer small.
        for piece in rows.chunks(1 << 12) {
            self.bytes.clear();
            if self.words {
                self.quantizer.append_words(piece, &mut self.bytes);
            } else {
                self.quantizer.append_bytes(piece, &mut self.bytes);
            }
            self.stream.write_all(&self.bytes).map_err(|e| failed(&self.place, EncodingError::IoError(e)))?;
        }
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), ImageError> {
        let Self { stream, sink, place, .. } = *self;
        stream.finish().map_err(|e| failed(&place, e))?;
        sink.finish().map_err(|e| failed(&place, EncodingError::IoError(e)))
    }
}

/// The encoder writes its last chunk while it is dropped, and tells nobody when that fails: this remembers.
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

    /// After the encoder is gone: whether all was written.
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

/// The file up to its pixels.
fn stream(sink: Sink, header: &Header) -> Result<StreamWriter<'static, Sink>, EncodingError> {
    let mut encoder = png::Encoder::new(sink, header.width, header.height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(if header.options.png_16_bit { BitDepth::Sixteen } else { BitDepth::Eight });
    encoder.set_compression(png::Compression::Fast);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    for (key, text) in &header.metadata {
        if text.is_ascii() && key.is_ascii() {
            encoder.add_text_chunk(key.clone(), text.clone())?;
        } else {
            encoder.add_itxt_chunk(key.clone(), text.clone())?;
        }
    }
    encoder.write_header()?.into_stream_writer()
}

fn failed(place: &str, error: EncodingError) -> ImageError {
    let place = place.to_owned();
    match error {
        EncodingError::IoError(source) => ImageError::Write { place, source },
        other => ImageError::Encode { place, format: crate::Format::Png, message: other.to_string() },
    }
}

fn unreadable(source: Source, error: DecodingError) -> ImageError {
    match error {
        DecodingError::IoError(error) => source.failed(error),
        other => source.malformed(other.to_string()),
    }
}

/// Any PNG as linear light: levels decoded by the curve that the file names, sRGB when it names none; alpha is
/// left out.
pub(super) fn read(source: Source, bytes: &mut dyn ReadSeek) -> Result<Image, ImageError> {
    let mut decoder = png::Decoder::new(&mut *bytes);
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(|e| unreadable(source, e))?;
    let info = reader.info();
    let (width, height) = source.size(u64::from(info.width), u64::from(info.height))?;
    let curve: Box<dyn Curve> = match encoding(info) {
        Encoding::Gamma(gamma) => Box::new(Gamma { gamma }),
        _ => Box::new(Srgb {}),
    };
    let interlaced = info.interlaced;
    let (color, depth) = reader.output_color_type();
    let row = Row::new(color, depth, curve.as_ref(), u64::from(width) * u64::from(height));
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
    source.image(width, height, pixels)
}

/// The curve that the file names, sRGB when it names none.
fn encoding(info: &png::Info) -> Encoding {
    match (info.srgb, info.gama_chunk) {
        (None, Some(gama)) if gama.into_value() > 0.0 => Encoding::Gamma(1.0 / f64::from(gama.into_value())),
        _ => Encoding::Srgb,
    }
}

/// What [`raster`] brings of a file whose head was read.
fn layout_of<R: BufRead + Seek>(source: Source, reader: &png::Reader<R>) -> Result<Layout, ImageError> {
    let size = source.size(u64::from(reader.info().width), u64::from(reader.info().height))?;
    let (color, depth) = reader.output_color_type();
    Ok(source.layout(size, color.samples() as u8, if depth == BitDepth::Sixteen { 2 } else { 1 }))
}

/// Any PNG as its samples: palettes and few bits as bytes.
pub(super) fn raster(source: Source, bytes: &mut dyn ReadSeek) -> Result<Raster, ImageError> {
    let mut decoder = png::Decoder::new(&mut *bytes);
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(|e| unreadable(source, e))?;
    let (layout, encoding) = (layout_of(source, &reader)?, encoding(reader.info()));
    let mut bytes = vec![0; reader.output_buffer_size().ok_or_else(|| source.malformed("it is too large"))?];
    reader.next_frame(&mut bytes).map_err(|e| unreadable(source, e))?;
    let samples = if layout.sample_bytes == 2 {
        Samples::Words(bytes.chunks_exact(2).map(|two| u16::from(two[0]) << 8 | u16::from(two[1])).collect())
    } else {
        Samples::Bytes(bytes)
    };
    Ok(Raster { layout, samples, encoding })
}

/// What [`raster`] will bring.
pub(super) fn layout(source: Source, bytes: &mut dyn ReadSeek) -> Result<Layout, ImageError> {
    let mut decoder = png::Decoder::new(&mut *bytes);
    decoder.set_transformations(png::Transformations::EXPAND);
    layout_of(source, &decoder.read_info().map_err(|e| unreadable(source, e))?)
}

/// How samples become colours.
struct Row<'a> {
    /// Samples a pixel: 1 and 2 are grey, 2 and 4 have alpha.
    samples: usize,
    words: bool,
    curve: &'a dyn Curve,
    /// Linear light of each level; empty when the picture is too small to be worth it.
    levels: Vec<f32>,
}

impl<'a> Row<'a> {
    fn new(color: ColorType, depth: BitDepth, curve: &'a dyn Curve, pixels: u64) -> Self {
        let words = depth == BitDepth::Sixteen;
        let mut row = Self { samples: color.samples(), words, curve, levels: Vec::new() };
        let count = if words { 65_536 } else { 256 };
        if pixels > count {
            row.levels = (0..count as usize).map(|level| row.linear(level)).collect();
        }
        row
    }

    fn linear(&self, level: usize) -> f32 {
        let top = if self.words { 65_535.0 } else { 255.0 };
        self.levels.get(level).copied().unwrap_or_else(|| self.curve.decode(level as f64 / top) as f32)
    }

    fn append(&self, bytes: &[u8], pixels: &mut Vec<Rgb>) {
        let size = if self.words { 2 } else { 1 };
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

/// Size and texts, in order: tEXt before iTXt.
pub(super) fn inspect(source: Source, bytes: &mut dyn ReadSeek) -> Result<Inspected, ImageError> {
    let reader = png::Decoder::new(&mut *bytes).read_info().map_err(|e| unreadable(source, e))?;
    let info = reader.info();
    let plain = info.uncompressed_latin1_text.iter().map(|t| (t.keyword.clone(), t.text.clone()));
    let wide = info.utf8_text.iter().map(|t| (t.keyword.clone(), t.get_text().unwrap_or_default()));
    let size = source.size(u64::from(info.width), u64::from(info.height))?;
    Ok((size, plain.chain(wide).collect()))
}
