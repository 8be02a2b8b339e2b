//! OpenEXR: one part of scanlines, channels B, G, R as floats or halves, plain or packed; values
//! are scene-referred and no tone curve applies; primaries other than those of sRGB are named. The header is written here, in a fixed order, since the bytes of
//! equal pictures must be equal; blocks are packed by the crate `exr`. (OpenEXR file layout, openexr.com.)

use super::{ExrCompression, Header, Inspected, ReadSeek, RowWriter, SampleDepth, Source, Texts};
use crate::output::{Destination, WriteSeek};
use crate::raster::{Encoding, Layout, Raster, Samples};
use crate::tone::{Chromaticities, Matrix};
use crate::{Format, ImageError};
use exr::block::{BlockIndex, UncompressedBlock};
use exr::error::Error as ExrError;
use exr::math::Vec2;
use exr::meta::BlockDescription;
use exr::meta::attribute::{ChannelDescription, LineOrder, SampleType};
use exr::meta::header::Header as ExrHeader;
use exr::prelude::{Compression, ReadChannels, ReadLayers, ReadSpecificChannel, f16};
use juggler_math::{Image, Rgb};
use std::io::{self, BufRead, Read, SeekFrom};

/// The version, and the flag for names of more than 31 bytes.
const VERSION: u32 = 2;
const LONG_NAMES: u32 = 0x400;

/// Streams blocks of rows into an EXR.
pub(super) struct Writer {
    bytes: Box<dyn WriteSeek>,
    place: String,
    headers: [ExrHeader; 1],
    depth: SampleDepth,
    width: usize,
    height: usize,
    block_rows: usize,
    /// To the file's primaries.
    primaries: Option<Matrix>,
    /// Rows of a block that is not full yet.
    pending: Vec<Rgb>,
    /// Where the table of offsets stands, and the file's end so far.
    table: u64,
    end: u64,
    offsets: Vec<u64>,
}

impl Writer {
    pub fn new(destination: Destination, header: &Header) -> Result<Self, ImageError> {
        let place = destination.name().to_owned();
        let mut bytes = destination.into_seekable();
        let start = header_bytes(header);
        let (width, height) = (header.width as usize, header.height as usize);
        let block_rows = packing(header.options.exr_compression).scan_lines_per_block();
        let blocks = height.div_ceil(block_rows);
        let offsets = Vec::with_capacity(blocks);
        let table = start.len() as u64;
        let end = table + 8 * blocks as u64;
        let written = bytes.write_all(&start).and_then(|()| bytes.seek(SeekFrom::Start(end)));
        if let Err(source) = written {
            return Err(ImageError::Write { place, source });
        }
        let (depth, headers) = (header.options.exr_depth, [description(header)]);
        let (primaries, pending) = (header.tone.primaries.conversion(), Vec::new());
        Ok(Self { bytes, place, headers, depth, width, height, block_rows, primaries, pending, table, end, offsets })
    }

    fn write_block(&mut self) -> Result<(), ImageError> {
        let y = self.offsets.len() * self.block_rows;
        let rows = self.pending.len() / self.width;
        let index =
            BlockIndex { layer: 0, pixel_position: Vec2(0, y), pixel_size: Vec2(self.width, rows), level: Vec2(0, 0) };
        let data = planes(&self.pending, self.width, self.depth);
        self.pending.clear();
        let mut chunk = Vec::new();
        let packed = UncompressedBlock { index, data }.compress_to_chunk(&self.headers);
        let packed = packed.and_then(|packed| packed.write(&mut chunk, 1));
        packed.map_err(|e| self.refused(&e))?;
        self.offsets.push(self.end);
        self.end += chunk.len() as u64;
        self.bytes.write_all(&chunk).map_err(|e| self.failed(e))
    }

    fn failed(&self, source: io::Error) -> ImageError {
        ImageError::Write { place: self.place.clone(), source }
    }

    fn refused(&self, error: &ExrError) -> ImageError {
        ImageError::Encode { place: self.place.clone(), format: Format::Exr, message: error.to_string() }
    }
}

impl RowWriter for Writer {
    fn write_rows(&mut self, rows: &[Rgb]) -> Result<(), ImageError> {
        for row in rows.chunks_exact(self.width) {
            match &self.primaries {
                Some(matrix) => self.pending.extend(row.iter().map(|pixel| matrix.color(*pixel))),
                None => self.pending.extend(row),
            }
            let done = self.offsets.len() * self.block_rows + self.pending.len() / self.width;
            if self.pending.len() == self.width * self.block_rows || done == self.height {
                self.write_block()?;
            }
        }
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> Result<(), ImageError> {
        let table: Vec<u8> = self.offsets.iter().flat_map(|o| o.to_le_bytes()).collect();
        let written = self.bytes.seek(SeekFrom::Start(self.table)).and_then(|_| self.bytes.write_all(&table));
        written.and_then(|()| self.bytes.flush()).map_err(|e| self.failed(e))
    }
}

/// A block's samples: row by row, in each all of B, then G, then R.
fn planes(rows: &[Rgb], width: usize, depth: SampleDepth) -> Vec<u8> {
    let mut data = Vec::with_capacity(rows.len() * 12);
    for row in rows.chunks_exact(width) {
        for channel in [2, 1, 0] {
            let samples = row.iter().map(|p| p.to_array()[channel]);
            match depth {
                SampleDepth::Float => data.extend(samples.flat_map(f32::to_ne_bytes)),
                SampleDepth::Half => data.extend(samples.flat_map(|v| f16::from_f32(v).to_ne_bytes())),
            }
        }
    }
    data
}

fn packing(compression: ExrCompression) -> Compression {
    match compression {
        ExrCompression::None => Compression::Uncompressed,
        ExrCompression::Rle => Compression::RLE,
        ExrCompression::Zip => Compression::ZIP16,
    }
}

/// What the packer needs to know.
fn description(header: &Header) -> ExrHeader {
    let sample_type = match header.options.exr_depth {
        SampleDepth::Float => SampleType::F32,
        SampleDepth::Half => SampleType::F16,
    };
    let channels = ["B", "G", "R"].map(|name| ChannelDescription::new(name, sample_type, false));
    let size = (header.width as usize, header.height as usize);
    let plain = ExrHeader::new("".into(), size, channels.into_iter().collect());
    plain.with_encoding(packing(header.options.exr_compression), BlockDescription::ScanLines, LineOrder::Increasing)
}

/// Magic, version and attributes, ours after the required ones.
fn header_bytes(header: &Header) -> Vec<u8> {
    let long = header.metadata.iter().any(|(key, _)| key.len() > 31);
    let mut bytes = vec![0x76, 0x2f, 0x31, 0x01];
    bytes.extend((VERSION | if long { LONG_NAMES } else { 0 }).to_le_bytes());
    let mut attribute = |name: &str, kind: &str, value: &[u8]| {
        bytes.extend(name.bytes().filter(|&b| b != 0).take(255).chain([0]));
        bytes.extend(kind.bytes().chain([0]));
        bytes.extend((value.len() as u32).to_le_bytes());
        bytes.extend(value);
    };
    let pixel_type = if header.options.exr_depth == SampleDepth::Half { 1u32 } else { 2 };
    let mut channels = Vec::new();
    for name in [b'B', b'G', b'R'] {
        channels.extend([name, 0]);
        channels.extend([pixel_type, 0, 1, 1].into_iter().flat_map(u32::to_le_bytes));
    }
    channels.push(0);
    let window: Vec<u8> = [0, 0, header.width - 1, header.height - 1].into_iter().flat_map(u32::to_le_bytes).collect();
    attribute("channels", "chlist", &channels);
    if !header.tone.primaries.is_srgb() {
        attribute("chromaticities", "chromaticities", &eight(header.tone.primaries.chromaticities()));
    }
    let code = match header.options.exr_compression {
        ExrCompression::None => 0,
        ExrCompression::Rle => 1,
        ExrCompression::Zip => 3,
    };
    attribute("compression", "compression", &[code]);
    attribute("dataWindow", "box2i", &window);
    attribute("displayWindow", "box2i", &window);
    attribute("lineOrder", "lineOrder", &[0]);
    attribute("pixelAspectRatio", "float", &1f32.to_le_bytes());
    attribute("screenWindowCenter", "v2f", &[0; 8]);
    attribute("screenWindowWidth", "float", &1f32.to_le_bytes());
    for (key, text) in header.metadata.iter().filter(|(key, _)| !key.is_empty()) {
        attribute(key, "string", text.as_bytes());
    }
    bytes.push(0);
    bytes
}

/// Eight floats: x and y of each.
fn eight(Chromaticities { red, green, blue, white }: Chromaticities) -> Vec<u8> {
    [red, green, blue, white].into_iter().flatten().flat_map(|v| (v as f32).to_le_bytes()).collect()
}

fn unreadable(source: Source, error: ExrError) -> ImageError {
    match error {
        ExrError::Io(error) => source.failed(error),
        other => source.malformed(other.to_string()),
    }
}

/// What [`raster`] will bring: of the first layer with R, G and B, or with Y alone, and with A if it has one.
pub(super) fn layout(source: Source, bytes: &mut dyn ReadSeek) -> Result<Layout, ImageError> {
    let meta = exr::meta::MetaData::read_from_buffered(&mut *bytes, false).map_err(|e| unreadable(source, e))?;
    let has = |header: &ExrHeader, names: &[&str]| {
        names.iter().all(|name| header.channels.list.iter().any(|channel| channel.name == **name))
    };
    let found = |names: &[&str]| meta.headers.iter().find(|header| !header.deep && has(header, names));
    let (colors, header) = match (found(&["R", "G", "B"]), found(&["Y"])) {
        (Some(header), _) => (3, header),
        (None, Some(header)) => (1, header),
        (None, None) => return Err(source.malformed("it has no layer with channels R, G and B, or Y")),
    };
    let size = source.size(header.layer_size.0 as u64, header.layer_size.1 as u64)?;
    Ok(source.layout(size, colors + u8::from(has(header, &["A"])), 4))
}

/// The layer that [`layout`] finds, in its data window.
pub(super) fn raster(source: Source, bytes: &mut dyn ReadSeek) -> Result<Raster, ImageError> {
    let layout = layout(source, bytes)?;
    bytes.rewind().map_err(|e| source.failed(e))?;
    let channels = usize::from(layout.channels);
    let room = move |size: Vec2<usize>| (size.0, vec![0_f32; size.0 * size.1 * channels]);
    let put = move |(width, samples): &mut (usize, Vec<f32>), position: Vec2<usize>, pixel: &[f32]| {
        let start = (position.1 * *width + position.0) * channels;
        if let Some(place) = samples.get_mut(start..start + channels) {
            place.copy_from_slice(&pixel[..channels]);
        }
    };
    let reader = exr::prelude::read().no_deep_data().largest_resolution_level();
    let samples = if channels >= 3 {
        let reader = reader.rgba_channels(
            move |size, _| room(size),
            move |image, position, (r, g, b, a): (f32, f32, f32, f32)| put(image, position, &[r, g, b, a]),
        );
        let reader = reader.first_valid_layer().all_attributes().non_parallel();
        reader.from_buffered(&mut *bytes).map(|image| image.layer_data.channel_data.pixels.1)
    } else {
        let reader = reader.specific_channels().required("Y").optional("A", 1.0_f32).collect_pixels(
            move |size, _| room(size),
            move |image, position, (y, a): (f32, f32)| put(image, position, &[y, a]),
        );
        let reader = reader.first_valid_layer().all_attributes().non_parallel();
        reader.from_buffered(&mut *bytes).map(|image| image.layer_data.channel_data.pixels.1)
    };
    let samples = Samples::Floats(samples.map_err(|e| unreadable(source, e))?);
    Ok(Raster { layout, samples, encoding: Encoding::Linear })
}

/// The first layer with R, G and B of an EXR, in its data window, in the primaries of sRGB whatever those of the file.
pub(super) fn read(source: Source, bytes: &mut dyn ReadSeek) -> Result<Image, ImageError> {
    let unreadable = |error| unreadable(source, error);
    let meta = exr::meta::MetaData::read_from_buffered(&mut *bytes, false).map_err(unreadable)?;
    for header in &meta.headers {
        source.size(header.layer_size.0 as u64, header.layer_size.1 as u64)?;
    }
    bytes.rewind().map_err(|e| source.failed(e))?;
    let reader = exr::prelude::read().no_deep_data().largest_resolution_level();
    let reader = reader.rgb_channels(
        |size, _| (size.0, vec![[0f32; 3]; size.0 * size.1]),
        |(width, pixels), position, (r, g, b): (f32, f32, f32)| pixels[position.1 * *width + position.0] = [r, g, b],
    );
    let reader = reader.first_valid_layer().all_attributes().non_parallel();
    let image = reader.from_buffered(&mut *bytes).map_err(unreadable)?;
    let size = image.layer_data.size;
    let matrix = image.attributes.chromaticities.and_then(to_srgb);
    let light = |pixel: [f32; 3]| matrix.map_or(Rgb::from(pixel), |matrix| matrix.color(Rgb::from(pixel)));
    let pixels = image.layer_data.channel_data.pixels.1.into_iter().map(light).collect();
    let (width, height) = source.size(size.0 as u64, size.1 as u64)?;
    source.image(width, height, pixels)
}

/// What turns the file's primaries into those of sRGB, where it names others.
fn to_srgb(named: exr::meta::attribute::Chromaticities) -> Option<Matrix> {
    let [red, green, blue, white] =
        [named.red, named.green, named.blue, named.white].map(|Vec2(x, y)| [f64::from(x), f64::from(y)]);
    Chromaticities { red, green, blue, white }.to_srgb()
}

/// Size, and attributes that are texts, in the file's order.
pub(super) fn inspect(source: Source, bytes: &mut dyn ReadSeek) -> Result<Inspected, ImageError> {
    let (window, texts) = attributes(bytes).map_err(|e| source.failed(e))?;
    let [left, top, right, bottom] = window;
    let [width, height] = [(left, right), (top, bottom)].map(|(first, last)| u64::try_from(last - first + 1));
    let (Ok(width), Ok(height)) = (width, height) else {
        return Err(source.malformed("its data window is inside out"));
    };
    Ok((source.size(width, height)?, texts))
}

/// The data window's left, top, right and bottom, and all texts.
fn attributes(bytes: &mut dyn ReadSeek) -> io::Result<([i64; 4], Texts)> {
    let (mut window, mut texts) = ([0, 0, -1, -1], Vec::new());
    let mut eight = [0; 8];
    bytes.read_exact(&mut eight)?;
    for _ in 0..10_000 {
        let name = name(bytes)?;
        if name.is_empty() {
            return Ok((window, texts));
        }
        let kind = self::name(bytes)?;
        let mut size = [0; 4];
        bytes.read_exact(&mut size)?;
        let size = u64::from(u32::from_le_bytes(size));
        let mut value = Vec::new();
        if (&mut *bytes).take(size).read_to_end(&mut value)? as u64 != size {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        if kind == "string" {
            texts.push((name, String::from_utf8_lossy(&value).into_owned()));
        } else if name == "dataWindow" {
            for (edge, four) in window.iter_mut().zip(value.chunks_exact(4)) {
                *edge = four.iter().rev().fold(0_i32, |number, byte| number << 8 | i32::from(*byte)).into();
            }
        }
    }
    Err(io::Error::new(io::ErrorKind::InvalidData, "it has too many attributes"))
}

/// A name of at most 255 bytes and the zero after it.
fn name(bytes: &mut dyn ReadSeek) -> io::Result<String> {
    let mut name = Vec::new();
    (&mut *bytes).take(256).read_until(0, &mut name)?;
    match name.pop() {
        Some(0) => Ok(String::from_utf8_lossy(&name).into_owned()),
        _ => Err(io::Error::new(io::ErrorKind::InvalidData, "a name has no end")),
    }
}
