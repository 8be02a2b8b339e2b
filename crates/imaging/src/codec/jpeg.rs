//! JPEG (ITU-T T.81), 8 bits, without chroma subsampling above quality 90. The encoder needs the
//! whole image, so 8-bit pixels are buffered.

use super::{Header, ReadSeek, RowWriter, Source, UNEXPECTED_END};
use crate::orientation::Orientation;
use crate::output::Destination;
use crate::raster::{Raster, RasterSamples, TransferFunction};
use crate::tone::LevelEncoder;
use crate::{ImageError, ImageFormat};
use jpeg_encoder::{ColorType, Encoder, EncodingError, SamplingFactor};
use juggler_math::{Image, PixelRows};
use std::io::{Cursor, Read, Write};
use zune_core::bytestream::ZByteReaderTrait;
use zune_core::colorspace::ColorSpace;
use zune_core::options::DecoderOptions;
use zune_jpeg::JpegDecoder;
use zune_jpeg::errors::DecodeErrors;

/// Bytes searched for the image size, since profiles and thumbnails may precede it.
const HEAD_BYTES: u64 = 16 << 20;
/// Maximum number of pixels per byte: a block of 64 pixels takes at least one bit.
const MAX_PIXELS_PER_BYTE: u64 = 512;

/// Buffers rows and encodes them at the end.
pub(super) struct Writer {
    destination: Destination,
    levels: LevelEncoder,
    size: (u32, u32),
    quality: u8,
    bytes: Vec<u8>,
}

impl Writer {
    pub fn new(destination: Destination, header: &Header) -> Self {
        Self {
            destination,
            levels: LevelEncoder::bytes(&header.tone, header.width),
            size: (header.width, header.height),
            quality: header.options.jpeg_quality.clamp(1, 100),
            bytes: Vec::with_capacity(header.pixels() as usize * 3),
        }
    }
}

impl RowWriter for Writer {
    fn write_rows(&mut self, rows: PixelRows) -> Result<(), ImageError> {
        self.levels.append(rows, &mut self.bytes);
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), ImageError> {
        let file = self.destination.name().to_owned();
        let mut bytes = self.destination.into_stream();
        let mut encoder = Encoder::new(&mut bytes, self.quality);
        encoder.set_sampling_factor(if self.quality > 90 { SamplingFactor::F_1_1 } else { SamplingFactor::F_2_2 });
        // `check_dimensions` has limited the sides to 16 bits.
        let (width, height) = (self.size.0 as u16, self.size.1 as u16);
        let encoded = encoder.encode(&self.bytes, width, height, ColorType::Rgb);
        let encoded = encoded.and_then(|()| bytes.flush().map_err(EncodingError::IoError));
        encoded.map_err(|error| match error {
            EncodingError::IoError(source) => ImageError::Write { file, source },
            other => ImageError::Encode { file, format: ImageFormat::Jpeg, message: other.to_string() },
        })
    }
}

/// Reads a baseline or progressive JPEG and decodes it as sRGB.
pub(super) fn read(source: Source, bytes: &mut dyn ReadSeek) -> Result<Image, ImageError> {
    let ((width, height), bytes) = samples(source, bytes)?;
    source.image(width, height, super::pixels_from_srgb(&bytes))
}

/// Reads the 8-bit RGB samples, turned by the orientation that Exif states.
pub(super) fn raster(source: Source, bytes: &mut dyn ReadSeek) -> Result<Raster, ImageError> {
    let (size, bytes) = samples(source, bytes)?;
    Ok(Raster {
        layout: source.layout(size, 3, 1),
        samples: RasterSamples::Bytes(bytes),
        transfer_function: TransferFunction::Srgb,
        is_first_of_several: false,
    })
}

fn samples(source: Source, bytes: &mut dyn ReadSeek) -> Result<((u32, u32), Vec<u8>), ImageError> {
    let mut file = Vec::new();
    let max_bytes = source.limits.max_pixels.saturating_mul(4).saturating_add(1 << 24);
    bytes.take(max_bytes).read_to_end(&mut file).map_err(|e| source.failed(e))?;
    if !is_complete(&file) {
        return Err(source.malformed(UNEXPECTED_END));
    }
    let mut decoder = JpegDecoder::new_with_options(Cursor::new(&file), options());
    let size = decoded_size(source, &mut decoder)?;
    let orientation = orientation(&decoder);
    let bytes = decoder.decode().map_err(|e| source.malformed(describe(&e)))?;
    Ok((orientation.size(size), orientation.turn(bytes, size, 3)))
}

fn options() -> DecoderOptions {
    let side = ImageFormat::Jpeg.longest_side() as usize;
    DecoderOptions::new_safe()
        .set_max_width(side)
        .set_max_height(side)
        .set_strict_mode(true)
        .jpeg_set_out_colorspace(ColorSpace::RGB)
}

fn decoded_size<T: ZByteReaderTrait>(source: Source, decoder: &mut JpegDecoder<T>) -> Result<(u32, u32), ImageError> {
    decoder.decode_headers().map_err(|e| source.malformed(describe(&e)))?;
    let info = decoder.info().ok_or_else(|| source.malformed("it has no size"))?;
    source.size(u64::from(info.width), u64::from(info.height), MAX_PIXELS_PER_BYTE)
}

fn orientation<T: ZByteReaderTrait>(decoder: &JpegDecoder<T>) -> Orientation {
    Orientation::from_exif(decoder.exif().map(Vec::as_slice))
}

/// Image size from the file's first bytes.
pub(super) fn size(source: Source, bytes: &mut dyn ReadSeek) -> Result<(u32, u32), ImageError> {
    let mut start = Vec::new();
    bytes.take(HEAD_BYTES).read_to_end(&mut start).map_err(|e| source.failed(e))?;
    let mut decoder = JpegDecoder::new_with_options(Cursor::new(&start), options());
    let size = decoded_size(source, &mut decoder)?;
    Ok(orientation(&decoder).size(size))
}

/// Whether more than one scan begins in a file, so that a decoder holds the coefficients of all blocks
/// until the last scan: scans of thumbnails count too. Entropy-coded data cannot contain the marker.
pub(crate) fn has_several_scans(source: Source, bytes: &mut dyn ReadSeek) -> Result<bool, ImageError> {
    bytes.rewind().map_err(|e| source.failed(e))?;
    let (mut last, mut scans) = (0, 0);
    loop {
        let block = bytes.fill_buf().map_err(|e| source.failed(e))?;
        let Some(end) = block.last().copied() else { return Ok(false) };
        let begins = |pair: &&[u8]| **pair == [0xff, 0xda];
        scans += usize::from(last == 0xff && block.first() == Some(&0xda)) + block.windows(2).filter(begins).count();
        if scans > 1 {
            return Ok(true);
        }
        last = end;
        let length = block.len();
        bytes.consume(length);
    }
}

/// Describes a decoder error in plain words.
fn describe(error: &DecodeErrors) -> &'static str {
    match error {
        DecodeErrors::ExhaustedData | DecodeErrors::IoErrors(_) => UNEXPECTED_END,
        DecodeErrors::HuffmanDecode(_) => "a Huffman table or code is damaged",
        DecodeErrors::DqtError(_) => "its quantization tables are damaged",
        DecodeErrors::SosError(_) => "the header of a scan is damaged",
        DecodeErrors::SofError(_) => "the header of its frame is damaged",
        DecodeErrors::MCUError(_) => "its pixels are damaged",
        DecodeErrors::ZeroError => "its width or height is 0",
        DecodeErrors::Unsupported(_) => "only baseline and progressive JPEGs are supported",
        _ => "its structure is damaged",
    }
}

/// Whether an end-of-image marker follows the last scan; the decoder would pad missing data with
/// gray. Entropy-coded data cannot contain either marker.
fn is_complete(file: &[u8]) -> bool {
    let last = |marker: u8| file.windows(2).rposition(|pair| pair == [0xff, marker]);
    last(0xd9) > last(0xda)
}
