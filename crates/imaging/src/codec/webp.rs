//! WebP, lossless (RFC 9649). The encoder needs the whole image, so 8-bit pixels are buffered.

use super::{Header, ReadSeek, RowWriter, Source, UNEXPECTED_END};
use crate::orientation::Orientation;
use crate::output::Destination;
use crate::raster::{Raster, RasterLayout, RasterSamples, TransferFunction};
use crate::tone::LevelEncoder;
use crate::{ImageError, ImageFormat};
use image_webp::{ColorType, DecodingError, EncodingError, WebPDecoder, WebPEncoder};
use juggler_math::{Image, PixelRows};
use std::io::{BufRead, Seek, Write};

/// Maximum number of pixels per byte. The format itself has no limit, since a single color takes no
/// bits; this one allows the longest sides for files of 1 KiB.
const MAX_PIXELS_PER_BYTE: u64 = 1 << 18;

/// Buffers rows and encodes them at the end.
pub(super) struct Writer {
    destination: Destination,
    levels: LevelEncoder,
    size: (u32, u32),
    color_type: ColorType,
    bytes: Vec<u8>,
}

impl Writer {
    pub fn new(destination: Destination, header: &Header) -> Self {
        Self {
            destination,
            levels: LevelEncoder::bytes(&header.tone, header.width).with_alpha(header.transparent),
            size: (header.width, header.height),
            color_type: if header.transparent { ColorType::Rgba8 } else { ColorType::Rgb8 },
            bytes: Vec::with_capacity(header.pixels() as usize * if header.transparent { 4 } else { 3 }),
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
        let encoder = WebPEncoder::new(&mut bytes);
        let encoded = encoder.encode(&self.bytes, self.size.0, self.size.1, self.color_type);
        let encoded = encoded.and_then(|()| bytes.flush().map_err(EncodingError::IoError));
        encoded.map_err(|error| match error {
            EncodingError::IoError(source) => ImageError::Write { file, source },
            other => ImageError::Encode { file, format: ImageFormat::Webp, message: other.to_string() },
        })
    }
}

/// Reads a still image, lossless or lossy, as sRGB; alpha is ignored.
pub(super) fn read(source: Source, bytes: &mut dyn ReadSeek) -> Result<Image, ImageError> {
    let (layout, mut bytes, _) = samples(source, bytes)?;
    if layout.channels == 4 {
        bytes = bytes.chunks_exact(4).flat_map(|c| [c[0], c[1], c[2]]).collect();
    }
    source.image(layout.width, layout.height, super::pixels_from_srgb(&bytes))
}

/// Reads the samples of a still image.
pub(super) fn raster(source: Source, bytes: &mut dyn ReadSeek) -> Result<Raster, ImageError> {
    let (layout, bytes, is_first_of_several) = samples(source, bytes)?;
    let samples = RasterSamples::Bytes(bytes);
    Ok(Raster { layout, samples, transfer_function: TransferFunction::Srgb, is_first_of_several })
}

/// Layout and samples of the image, and whether it is the first frame of a movie.
fn samples(source: Source, bytes: &mut dyn ReadSeek) -> Result<(RasterLayout, Vec<u8>, bool), ImageError> {
    let mut decoder = decoder(source, bytes)?;
    let layout = layout_of(source, &decoder)?;
    let size = decoder.output_buffer_size().ok_or_else(|| source.malformed("it is too large"))?;
    let mut samples = vec![0; size];
    decoder.read_image(&mut samples).map_err(|e| unreadable(source, e))?;
    let orientation = orientation(&mut decoder);
    let samples = orientation.turn(samples, (layout.width, layout.height), usize::from(layout.channels));
    let (width, height) = orientation.size((layout.width, layout.height));
    Ok((RasterLayout { width, height, ..layout }, samples, decoder.num_frames() > 1))
}

/// Creates a decoder after checking the file's length against its RIFF header.
fn decoder<'b>(source: Source, bytes: &'b mut dyn ReadSeek) -> Result<WebPDecoder<&'b mut dyn ReadSeek>, ImageError> {
    let mut head = [0; 8];
    bytes.read_exact(&mut head).and_then(|()| bytes.rewind()).map_err(|e| source.failed(e))?;
    let [.., a, b, c, d] = head;
    if u64::from(u32::from_le_bytes([a, b, c, d])) + 8 > source.length {
        return Err(source.truncated());
    }
    WebPDecoder::new(bytes).map_err(|e| unreadable(source, e))
}

fn layout_of<R: BufRead + Seek>(source: Source, decoder: &WebPDecoder<R>) -> Result<RasterLayout, ImageError> {
    let (width, height) = decoder.dimensions();
    let size = source.size(u64::from(width), u64::from(height), MAX_PIXELS_PER_BYTE)?;
    Ok(source.layout(size, if decoder.has_alpha() { 4 } else { 3 }, 1))
}

/// Reads the layout of [`raster`] from the header.
pub(super) fn layout(source: Source, bytes: &mut dyn ReadSeek) -> Result<RasterLayout, ImageError> {
    let mut decoder = decoder(source, bytes)?;
    let layout = layout_of(source, &decoder)?;
    let (width, height) = orientation(&mut decoder).size((layout.width, layout.height));
    Ok(RasterLayout { width, height, ..layout })
}

/// Image size.
pub(super) fn size(source: Source, bytes: &mut dyn ReadSeek) -> Result<(u32, u32), ImageError> {
    layout(source, bytes).map(|layout| (layout.width, layout.height))
}

/// Orientation that Exif states; a damaged block states none.
fn orientation<R: BufRead + Seek>(decoder: &mut WebPDecoder<R>) -> Orientation {
    Orientation::from_exif(decoder.exif_metadata().ok().flatten().as_deref())
}

fn unreadable(source: Source, error: DecodingError) -> ImageError {
    match error {
        DecodingError::IoError(error) => source.failed(error),
        other => source.malformed(describe(&other)),
    }
}

/// Describes a decoder error in plain words.
fn describe(error: &DecodingError) -> &'static str {
    match error {
        DecodingError::ChunkMissing => "a chunk is missing",
        DecodingError::ChunkHeaderInvalid(_) | DecodingError::InvalidChunkSize => "the header of a chunk is damaged",
        DecodingError::HuffmanError => "a Huffman code is damaged",
        DecodingError::BitStreamError | DecodingError::TransformError => "its pixels are damaged",
        DecodingError::NotEnoughInitData => UNEXPECTED_END,
        DecodingError::ImageTooLarge | DecodingError::MemoryLimitExceeded => "it is too large",
        DecodingError::InconsistentImageSizes | DecodingError::AlphaChunkSizeMismatch => {
            "its sizes contradict each other"
        }
        DecodingError::UnsupportedFeature(_) => "it uses an unsupported feature of WebP",
        _ => "its structure is damaged",
    }
}
