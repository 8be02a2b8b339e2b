//! JPEG (ITU-T T.81), 8 bits, without chroma subsampling above quality 90. The encoder pulls rows, so the picture
//! in 8 bits is held until the end.

use super::{ENDS, Header, ReadSeek, RowWriter, Source};
use crate::output::Destination;
use crate::raster::{Encoding, Raster, Samples};
use crate::tone::Levels;
use crate::{Format, ImageError};
use jpeg_encoder::{ColorType, Encoder, EncodingError, SamplingFactor};
use juggler_math::{Image, Rgb};
use std::io::{Cursor, Read, Write};
use zune_core::bytestream::ZByteReaderTrait;
use zune_core::colorspace::ColorSpace;
use zune_core::options::DecoderOptions;
use zune_jpeg::JpegDecoder;
use zune_jpeg::errors::DecodeErrors;

/// Where the size is looked for: profiles and previews may stand before it.
const HEAD_BYTES: u64 = 16 << 20;
/// Most pixels that a byte can hold: a block of 64 takes at least one bit.
const DENSEST: u64 = 512;

/// Gathers rows and encodes them at the end.
pub(super) struct Writer {
    destination: Destination,
    levels: Levels,
    size: (u32, u32),
    quality: u8,
    bytes: Vec<u8>,
}

impl Writer {
    pub fn new(destination: Destination, header: &Header) -> Self {
        Self {
            destination,
            levels: Levels::bytes(&header.tone, header.width),
            size: (header.width, header.height),
            quality: header.options.jpeg_quality.clamp(1, 100),
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
        let mut encoder = Encoder::new(&mut bytes, self.quality);
        encoder.set_sampling_factor(if self.quality > 90 { SamplingFactor::F_1_1 } else { SamplingFactor::F_2_2 });
        // Sides were checked to fit.
        let (width, height) = (self.size.0 as u16, self.size.1 as u16);
        let encoded = encoder.encode(&self.bytes, width, height, ColorType::Rgb);
        let encoded = encoded.and_then(|()| bytes.flush().map_err(EncodingError::IoError));
        encoded.map_err(|error| match error {
            EncodingError::IoError(source) => ImageError::Write { place, source },
            other => ImageError::Encode { place, format: Format::Jpeg, message: other.to_string() },
        })
    }
}

/// Any baseline or progressive JPEG, taken as sRGB.
pub(super) fn read(source: Source, bytes: &mut dyn ReadSeek) -> Result<Image, ImageError> {
    let ((width, height), bytes) = samples(source, bytes)?;
    source.image(width, height, super::pixels_from_srgb(&bytes))
}

/// The same as its samples, three a pixel.
pub(super) fn raster(source: Source, bytes: &mut dyn ReadSeek) -> Result<Raster, ImageError> {
    let (size, bytes) = samples(source, bytes)?;
    Ok(Raster { layout: source.layout(size, 3, 1), samples: Samples::Bytes(bytes), encoding: Encoding::Srgb })
}

fn samples(source: Source, bytes: &mut dyn ReadSeek) -> Result<((u32, u32), Vec<u8>), ImageError> {
    let mut file = Vec::new();
    let most_bytes = source.limits.most_pixels.saturating_mul(4).saturating_add(1 << 24);
    bytes.take(most_bytes).read_to_end(&mut file).map_err(|e| source.failed(e))?;
    if !is_complete(&file) {
        return Err(source.malformed(ENDS));
    }
    let mut decoder = JpegDecoder::new_with_options(Cursor::new(&file), options());
    let size = decoded_size(source, &mut decoder)?;
    let bytes = decoder.decode().map_err(|e| source.malformed(in_words(&e)))?;
    Ok((size, bytes))
}

fn options() -> DecoderOptions {
    let side = Format::Jpeg.longest_side() as usize;
    DecoderOptions::new_safe()
        .set_max_width(side)
        .set_max_height(side)
        .set_strict_mode(true)
        .jpeg_set_out_colorspace(ColorSpace::RGB)
}

fn decoded_size<T: ZByteReaderTrait>(source: Source, decoder: &mut JpegDecoder<T>) -> Result<(u32, u32), ImageError> {
    decoder.decode_headers().map_err(|e| source.malformed(in_words(&e)))?;
    let info = decoder.info().ok_or_else(|| source.malformed("it has no size"))?;
    source.size(u64::from(info.width), u64::from(info.height), DENSEST)
}

/// Width and height, which stand in the first bytes.
pub(super) fn size(source: Source, bytes: &mut dyn ReadSeek) -> Result<(u32, u32), ImageError> {
    let mut start = Vec::new();
    bytes.take(HEAD_BYTES).read_to_end(&mut start).map_err(|e| source.failed(e))?;
    decoded_size(source, &mut JpegDecoder::new_with_options(Cursor::new(&start), options()))
}

/// What is wrong, without the decoder's own words.
fn in_words(error: &DecodeErrors) -> &'static str {
    match error {
        DecodeErrors::ExhaustedData | DecodeErrors::IoErrors(_) => ENDS,
        DecodeErrors::HuffmanDecode(_) => "a Huffman table or code is damaged",
        DecodeErrors::DqtError(_) => "its quantization tables are damaged",
        DecodeErrors::SosError(_) => "the head of a scan is damaged",
        DecodeErrors::SofError(_) => "the head of its frame is damaged",
        DecodeErrors::MCUError(_) => "its pixels are damaged",
        DecodeErrors::ZeroError => "its width or height is 0",
        DecodeErrors::Unsupported(_) => "only baseline and progressive JPEGs are read",
        _ => "its structure is damaged",
    }
}

/// Whether an end follows the last scan: the decoder itself fills up what is missing with grey. Neither marker
/// can stand in packed pixels.
fn is_complete(file: &[u8]) -> bool {
    let last = |marker: u8| file.windows(2).rposition(|pair| pair == [0xff, marker]);
    last(0xd9) > last(0xda)
}
