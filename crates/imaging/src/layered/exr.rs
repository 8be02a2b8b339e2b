//! Multi-part OpenEXR: one scanline part per layer, channels as 32-bit or 16-bit floats. The crate
//! `exr` compresses the blocks. (OpenEXR file layout, openexr.com.)

use super::attributes::{self, Attributes};
use super::{LayerHeader, LayerRows, LayeredHeader};
use crate::clamp_count::LARGEST_HALF;
use crate::output::WriteSeek;
use crate::tone::Matrix;
use crate::{ClampCount, ExrCompression, ImageError, ImageFormat, SampleDepth};
use exr::block::{BlockIndex, UncompressedBlock};
use exr::error::Error as ExrError;
use exr::math::Vec2;
use exr::meta::BlockDescription;
use exr::meta::attribute::{ChannelDescription, LineOrder, SampleType};
use exr::meta::header::Header as ExrHeader;
use exr::prelude::{Compression, f16};
use juggler_math::Rgb;
use std::io::{self, SeekFrom};

/// Streams rows of all layers into an EXR file.
pub struct Writer {
    bytes: Box<dyn WriteSeek>,
    file: String,
    headers: Vec<ExrHeader>,
    parts: Vec<Part>,
    width: usize,
    height: usize,
    block_rows: usize,
    /// Offset of the chunk offset tables, and current end of the file.
    tables: u64,
    end: u64,
    clamped: ClampCount,
}

/// State of one part.
struct Part {
    depth: SampleDepth,
    /// Matrix to the file's primaries, for color layers.
    primaries: Option<Matrix>,
    /// Channel indices sorted by channel name.
    order: Vec<usize>,
    /// Buffered rows of the current block, per channel.
    pending: Vec<Vec<f32>>,
    offsets: Vec<u64>,
}

impl Writer {
    pub fn new(mut bytes: Box<dyn WriteSeek>, file: String, header: &LayeredHeader) -> Result<Self, ImageError> {
        let (width, height) = (header.width as usize, header.height as usize);
        let block_rows = exr_compression(header.compression).scan_lines_per_block();
        let blocks = height.div_ceil(block_rows);
        let start = header_bytes(header, blocks);
        let tables = start.len() as u64;
        let end = tables + 8 * (blocks * header.layers.len()) as u64;
        let written = bytes.write_all(&start).and_then(|()| bytes.seek(SeekFrom::Start(end)));
        if let Err(source) = written {
            return Err(ImageError::Write { file, source });
        }
        let headers = header.layers.iter().map(|layer| description(layer, header)).collect();
        let part = |layer: &LayerHeader| {
            let primaries = header.primaries.matrix_from_srgb().filter(|_| layer.is_color);
            let (order, pending) = (by_name(layer), vec![Vec::new(); layer.channels.len()]);
            Part { depth: layer.depth, primaries, order, pending, offsets: Vec::with_capacity(blocks) }
        };
        let parts = header.layers.iter().map(part).collect();
        let clamped = header.clamped.clone();
        Ok(Self { bytes, file, headers, parts, width, height, block_rows, tables, end, clamped })
    }

    /// Compresses and writes the buffered block of a part.
    fn write_block(&mut self, number: usize) -> Result<(), ImageError> {
        let Some(part) = self.parts.get_mut(number) else { return Ok(()) };
        let rows = part.pending.first().map_or(0, Vec::len) / self.width.max(1);
        let y = part.offsets.len() * self.block_rows;
        let (pixel_position, pixel_size) = (Vec2(0, y), Vec2(self.width, rows));
        let index = BlockIndex { layer: number, pixel_position, pixel_size, level: Vec2(0, 0) };
        let data = part.planes(self.width);
        self.clamped.add(part.beyond_half());
        part.pending.iter_mut().for_each(Vec::clear);
        part.offsets.push(self.end);
        let mut chunk = Vec::new();
        let packed = UncompressedBlock { index, data }.compress_to_chunk(&self.headers);
        let packed = packed.and_then(|packed| packed.write(&mut chunk, self.headers.len()));
        packed.map_err(|error| self.refused(&error))?;
        self.end += chunk.len() as u64;
        self.bytes.write_all(&chunk).map_err(|error| self.failed(error))
    }

    fn failed(&self, source: io::Error) -> ImageError {
        ImageError::Write { file: self.file.clone(), source }
    }

    fn refused(&self, error: &ExrError) -> ImageError {
        ImageError::Encode { file: self.file.clone(), format: ImageFormat::Exr, message: error.to_string() }
    }

    /// Takes one row of all channels and writes the blocks that it completes.
    fn write_row(&mut self, channels: &[&[f32]], row: usize) -> Result<(), ImageError> {
        let mut channels = channels.iter();
        let pixels = row * self.width..(row + 1) * self.width;
        let full = self.width * self.block_rows;
        for number in 0..self.parts.len() {
            let Some(part) = self.parts.get_mut(number) else { continue };
            let count = part.pending.len();
            let rows: Vec<&[f32]> =
                channels.by_ref().take(count).map(|channel| channel.get(pixels.clone()).unwrap_or_default()).collect();
            part.take(&rows);
            let waiting = part.pending.first().map_or(0, Vec::len);
            let done = part.offsets.len() * self.block_rows + waiting / self.width.max(1);
            if waiting == full || done == self.height {
                self.write_block(number)?;
            }
        }
        Ok(())
    }
}

impl LayerRows for Writer {
    fn write_rows(&mut self, channels: &[&[f32]]) -> Result<(), ImageError> {
        let rows = channels.first().map_or(0, |channel| channel.len()) / self.width.max(1);
        (0..rows).try_for_each(|row| self.write_row(channels, row))
    }

    fn finish(&mut self) -> Result<(), ImageError> {
        let offsets = self.parts.iter().flat_map(|part| &part.offsets);
        let tables: Vec<u8> = offsets.flat_map(|offset| offset.to_le_bytes()).collect();
        let written = self.bytes.seek(SeekFrom::Start(self.tables)).and_then(|_| self.bytes.write_all(&tables));
        written.and_then(|()| self.bytes.flush()).map_err(|error| self.failed(error))
    }
}

impl Part {
    /// Buffers one row of the part's channels.
    fn take(&mut self, channels: &[&[f32]]) {
        let (Some(matrix), [red, green, blue, alpha @ ..]) = (&self.primaries, channels) else {
            return self.pending.iter_mut().zip(channels).for_each(|(pending, row)| pending.extend_from_slice(row));
        };
        for ((red, green), blue) in red.iter().zip(*green).zip(*blue) {
            let color = matrix.color(Rgb::new(*red, *green, *blue)).to_array();
            self.pending.iter_mut().zip(color).for_each(|(pending, value)| pending.push(value));
        }
        self.pending.iter_mut().skip(3).zip(alpha).for_each(|(pending, row)| pending.extend_from_slice(row));
    }

    /// Number of buffered values that half floats cannot represent.
    fn beyond_half(&self) -> u64 {
        let values = self.pending.iter().flatten().filter(|_| self.depth == SampleDepth::Half);
        values.filter(|value| value.abs() > LARGEST_HALF).count() as u64
    }

    /// Samples of the buffered block: row by row, within a row channel by channel, sorted by name.
    fn planes(&self, width: usize) -> Vec<u8> {
        let rows = self.pending.first().map_or(0, Vec::len) / width.max(1);
        let mut data = Vec::new();
        for row in 0..rows {
            for channel in &self.order {
                let samples = self.pending.get(*channel).and_then(|values| values.get(row * width..(row + 1) * width));
                let samples = samples.unwrap_or_default().iter();
                match self.depth {
                    SampleDepth::Float => data.extend(samples.flat_map(|value| value.to_ne_bytes())),
                    SampleDepth::Half => {
                        data.extend(samples.flat_map(|value| to_half(*value).to_ne_bytes()));
                    }
                }
            }
        }
        data
    }
}

/// Nearest half float, at most the largest finite one.
fn to_half(value: f32) -> f16 {
    f16::from_f32(value.clamp(-LARGEST_HALF, LARGEST_HALF))
}

/// Channel indices sorted by name, as OpenEXR requires.
fn by_name(layer: &LayerHeader) -> Vec<usize> {
    let mut order: Vec<usize> = (0..layer.channels.len()).collect();
    order.sort_by(|a, b| layer.channels.get(*a).cmp(&layer.channels.get(*b)));
    order
}

fn exr_compression(compression: ExrCompression) -> Compression {
    match compression {
        ExrCompression::None => Compression::Uncompressed,
        ExrCompression::Rle => Compression::RLE,
        ExrCompression::Zip => Compression::ZIP16,
    }
}

/// Header for the block compressor.
fn description(layer: &LayerHeader, header: &LayeredHeader) -> ExrHeader {
    let sample_type = match layer.depth {
        SampleDepth::Float => SampleType::F32,
        SampleDepth::Half => SampleType::F16,
    };
    let names = by_name(layer).into_iter().filter_map(|channel| layer.channels.get(channel));
    let channels = names.map(|name| ChannelDescription::new(name.as_str(), sample_type, false)).collect();
    let size = (header.width as usize, header.height as usize);
    let plain = ExrHeader::new(layer.name.as_str().into(), size, channels);
    let corner = header.crop.map_or([0, 0], |crop| crop.corner.map(|side| i32::try_from(side).unwrap_or(i32::MAX)));
    let plain = plain.with_position(Vec2(corner[0], corner[1]));
    plain.with_encoding(exr_compression(header.compression), BlockDescription::ScanLines, LineOrder::Increasing)
}

/// Magic number, version and headers of all parts.
fn header_bytes(header: &LayeredHeader, blocks: usize) -> Vec<u8> {
    let several = header.layers.len() > 1;
    let texts = header.layers.iter().flat_map(|layer| &layer.metadata).chain(&header.metadata);
    let names = texts.map(|(key, _)| key).chain(header.layers.iter().flat_map(|layer| &layer.channels));
    let mut bytes = attributes::start(names.map(String::len).max().unwrap_or(0), several);
    for (number, layer) in header.layers.iter().enumerate() {
        // The image's metadata goes to the first part.
        let common = if number == 0 { header.metadata.as_slice() } else { &[] };
        bytes.extend(part_bytes(header, layer, common, several.then_some(blocks)));
    }
    if several {
        bytes.push(0);
    }
    bytes
}

/// Header of one part; `blocks` is the number of chunks in a multi-part file.
fn part_bytes(
    header: &LayeredHeader,
    layer: &LayerHeader,
    common: &[(String, String)],
    blocks: Option<usize>,
) -> Vec<u8> {
    let mut attributes = Attributes::default();
    let names = by_name(layer).into_iter().filter_map(|channel| layer.channels.get(channel));
    attributes.channels(names.map(String::as_str), layer.depth);
    // Chromaticities are a shared attribute: all parts of a file must agree (OpenEXR, "shared
    // attributes").
    if !header.primaries.is_srgb() && (layer.is_color || blocks.is_some()) {
        attributes.chromaticities(header.primaries.chromaticities());
    }
    attributes.frame([header.width, header.height], header.crop, header.compression);
    if let Some(blocks) = blocks {
        attributes.part(&layer.name, blocks);
    }
    header.viewpoint.iter().for_each(|viewpoint| attributes.viewpoint(viewpoint));
    attributes.texts(common.iter().chain(&layer.metadata));
    attributes.finish()
}
