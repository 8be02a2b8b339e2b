//! WebP, lossless (RFC 9649). The encoder takes a whole picture, so the picture in 8 bits is held.

use super::{ENDS, Header, ReadSeek, RowWriter, Source};
use crate::output::Destination;
use crate::raster::{Encoding, Layout, Raster, Samples};
use crate::tone::Levels;
use crate::{Format, ImageError};
use image_webp::{ColorType, DecodingError, EncodingError, WebPDecoder, WebPEncoder};
use juggler_math::{Image, Rgb};
use std::io::{BufRead, Seek, Write};

/// Most pixels that a byte may hold. The format itself has no limit, since one color takes no bits; this one lets a file of
/// 1 KiB have the longest sides that there are.
const DENSEST: u64 = 1 << 18;

/// Gathers rows and encodes them at the end.
pub(super) struct Writer {
    destination: Destination,
    levels: Levels,
    size: (u32, u32),
    bytes: Vec<u8>,
}

impl Writer {
    pub fn new(destination: Destination, header: &Header) -> Self {
        Self {
            destination,
            levels: Levels::bytes(&header.tone, header.width),
            size: (header.width, header.height),
            bytes: Vec::with_capacity(header.pixels() as usize * 3),
        }
    }
}

impl RowWriter for Writer {
    fn write_rows(&mut self, rows: &[Rgb]) -> Result<(), ImageError> {
        self.levels.append(rows, &mut self.bytes);
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), ImageError> {
        let place = self.destination.name().to_owned();
        let mut bytes = self.destination.into_stream();
        let encoder = WebPEncoder::new(&mut bytes);
        let encoded = encoder.encode(&self.bytes, self.size.0, self.size.1, ColorType::Rgb8);
        let encoded = encoded.and_then(|()| bytes.flush().map_err(EncodingError::IoError));
        encoded.map_err(|error| match error {
            EncodingError::IoError(source) => ImageError::Write { place, source },
            other => ImageError::Encode { place, format: Format::Webp, message: other.to_string() },
        })
    }
}

/// Any still WebP, lossless or lossy, taken as sRGB; alpha is left out.
pub(super) fn read(source: Source, bytes: &mut dyn ReadSeek) -> Result<Image, ImageError> {
    let (layout, mut bytes) = samples(source, bytes)?;
    if layout.channels == 4 {
        bytes = bytes.chunks_exact(4).flat_map(|c| [c[0], c[1], c[2]]).collect();
    }
    source.image(layout.width, layout.height, super::pixels_from_srgb(&bytes))
}

/// Any still WebP as its samples.
pub(super) fn raster(source: Source, bytes: &mut dyn ReadSeek) -> Result<Raster, ImageError> {
    let (layout, bytes) = samples(source, bytes)?;
    Ok(Raster { layout, samples: Samples::Bytes(bytes), encoding: Encoding::Srgb })
}

fn samples(source: Source, bytes: &mut dyn ReadSeek) -> Result<(Layout, Vec<u8>), ImageError> {
    let mut decoder = decoder(source, bytes)?;
    let layout = layout_of(source, &decoder)?;
    let size = decoder.output_buffer_size().ok_or_else(|| source.malformed("it is too large"))?;
    let mut samples = vec![0; size];
    decoder.read_image(&mut samples).map_err(|e| unreadable(source, e))?;
    Ok((layout, samples))
}

/// A decoder of a file that has as many bytes as its head says.
fn decoder<'b>(source: Source, bytes: &'b mut dyn ReadSeek) -> Result<WebPDecoder<&'b mut dyn ReadSeek>, ImageError> {
    let mut head = [0; 8];
    bytes.read_exact(&mut head).and_then(|()| bytes.rewind()).map_err(|e| source.failed(e))?;
    let [.., a, b, c, d] = head;
    if u64::from(u32::from_le_bytes([a, b, c, d])) + 8 > source.length {
        return Err(source.truncated());
    }
    WebPDecoder::new(bytes).map_err(|e| unreadable(source, e))
}

fn layout_of<R: BufRead + Seek>(source: Source, decoder: &WebPDecoder<R>) -> Result<Layout, ImageError> {
    let (width, height) = decoder.dimensions();
    let size = source.size(u64::from(width), u64::from(height), DENSEST)?;
    Ok(source.layout(size, if decoder.has_alpha() { 4 } else { 3 }, 1))
}

/// What [`raster`] will bring.
pub(super) fn layout(source: Source, bytes: &mut dyn ReadSeek) -> Result<Layout, ImageError> {
    layout_of(source, &decoder(source, bytes)?)
}

/// Width and height.
pub(super) fn size(source: Source, bytes: &mut dyn ReadSeek) -> Result<(u32, u32), ImageError> {
    let (width, height) = decoder(source, bytes)?.dimensions();
    source.size(u64::from(width), u64::from(height), DENSEST)
}

fn unreadable(source: Source, error: DecodingError) -> ImageError {
    match error {
        DecodingError::IoError(error) => source.failed(error),
        other => source.malformed(in_words(&other)),
    }
}

/// What is wrong, without the decoder's own words.
fn in_words(error: &DecodingError) -> &'static str {
    match error {
        DecodingError::ChunkMissing => "a chunk is missing",
        DecodingError::ChunkHeaderInvalid(_) | DecodingError::InvalidChunkSize => "the head of a chunk is damaged",
        DecodingError::HuffmanError => "a Huffman code is damaged",
        DecodingError::BitStreamError | DecodingError::TransformError => "its pixels are damaged",
        DecodingError::NotEnoughInitData => ENDS,
        DecodingError::ImageTooLarge | DecodingError::MemoryLimitExceeded => "it is too large",
        DecodingError::InconsistentImageSizes | DecodingError::AlphaChunkSizeMismatch => {
            "its sizes contradict each other"
        }
        DecodingError::UnsupportedFeature(_) => "it uses a feature of WebP that is not read",
        _ => "its structure is damaged",
    }
}
