//! OpenEXR with one scanline part and channels B, G, R as 32-bit or 16-bit floats, optionally
//! compressed (OpenEXR file layout, openexr.com). Values are scene-referred, so no tone curve
//! applies; primaries other than sRGB's are stored in the header. Writing delegates to the layered
//! writer.

use super::{Header, Inspected, Metadata, ReadSeek, RowWriter, Source, UNEXPECTED_END};
use crate::ImageError;
use crate::layered::{self, LayerHeader, LayerRows, LayeredHeader};
use crate::output::Destination;
use crate::raster::{Raster, RasterLayout, RasterSamples, TransferFunction};
use crate::tone::{Chromaticities, Matrix};
use exr::error::Error as ExrError;
use exr::math::Vec2;
use exr::meta::header::Header as ExrHeader;
use exr::prelude::{Compression, ReadChannels, ReadLayers, ReadSpecificChannel};
use juggler_math::{Image, Rgb};
use std::io::{self, BufRead, Read};

/// Streams rows into a single unnamed layer.
pub(super) struct Writer(layered::exr::Writer);

impl Writer {
    pub fn new(destination: Destination, header: &Header) -> Result<Self, ImageError> {
        let file = destination.name().to_owned();
        let picture = LayeredHeader::new(header, vec![LayerHeader::beauty(header.options.exr_depth)]);
        layered::exr::Writer::new(destination.into_seekable(), file, &picture).map(Self)
    }
}

impl RowWriter for Writer {
    fn write_rows(&mut self, rows: &[Rgb]) -> Result<(), ImageError> {
        let [red, green, blue] =
            [0, 1, 2].map(|channel| rows.iter().map(|pixel| pixel.to_array()[channel]).collect::<Vec<_>>());
        self.0.write_rows(&[&red, &green, &blue])
    }

    fn finish(mut self: Box<Self>) -> Result<(), ImageError> {
        self.0.finish()
    }
}

/// Translates a decoder error into a message that names the file.
pub(crate) fn unreadable(source: Source, error: ExrError) -> ImageError {
    match error {
        ExrError::Io(error) => source.failed(error),
        ExrError::Invalid(what) if ["reference to missing bytes", "not enough data"].contains(&&*what) => {
            source.malformed(UNEXPECTED_END)
        }
        ExrError::Invalid(what) => source.malformed(format!("its data is invalid: {what}")),
        ExrError::NotSupported(what) => source.malformed(format!("it uses an unsupported feature: {what}")),
        ExrError::Aborted => source.malformed("reading was aborted"),
    }
}

/// Reads the headers of all parts and checks their sizes against the file's length.
pub(crate) fn read_headers(source: Source, bytes: &mut dyn ReadSeek) -> Result<Vec<ExrHeader>, ImageError> {
    let meta = exr::meta::MetaData::read_from_buffered(&mut *bytes, false).map_err(|e| unreadable(source, e))?;
    for header in &meta.headers {
        let Vec2(width, height) = header.layer_size;
        source.size(width as u64, height as u64, max_pixels_per_byte(header))?;
    }
    bytes.rewind().map_err(|e| source.failed(e))?;
    Ok(meta.headers.into_iter().collect())
}

/// Maximum number of pixels per byte of the file. Deflate expands by a factor of 1032 at most,
/// which PXR24 raises by a third; DWA stores little more than two deflated numbers per 64 pixels.
fn max_pixels_per_byte(header: &ExrHeader) -> u64 {
    let max_bytes: u64 = match header.compression {
        Compression::DWAA(_) | Compression::DWAB(_) => 64 * 1032,
        Compression::Uncompressed => 1,
        _ => 1376,
    };
    let eighths = header.channels.list.iter().map(|channel| {
        let Vec2(x, y) = channel.sampling;
        8 * channel.sample_type.bytes_per_sample() / (x * y).clamp(1, 64)
    });
    (8 * max_bytes / (eighths.sum::<usize>() as u64).max(1)).max(1)
}

/// Layout of [`raster`]: the first part with R, G and B, else the first with Y, plus A if present.
pub(super) fn layout(source: Source, bytes: &mut dyn ReadSeek) -> Result<RasterLayout, ImageError> {
    let headers = read_headers(source, bytes)?;
    let has = |header: &ExrHeader, names: &[&str]| {
        names.iter().all(|name| header.channels.list.iter().any(|channel| channel.name == **name))
    };
    let found = |names: &[&str]| headers.iter().find(|header| !header.deep && has(header, names));
    let (colors, header) = match (found(&["R", "G", "B"]), found(&["Y"])) {
        (Some(header), _) => (3, header),
        (None, Some(header)) => (1, header),
        (None, None) => return Err(source.malformed("it has no layer with channels R, G and B, or Y")),
    };
    let Vec2(width, height) = header.layer_size;
    let size = source.size(width as u64, height as u64, max_pixels_per_byte(header))?;
    let to_srgb = header.shared_attributes.chromaticities.filter(|_| colors == 3).and_then(to_srgb);
    Ok(RasterLayout { to_srgb, ..source.layout(size, colors + u8::from(has(header, &["A"])), 4) })
}

/// Samples of the part that [`layout`] selects, within its data window.
pub(super) fn raster(source: Source, bytes: &mut dyn ReadSeek) -> Result<Raster, ImageError> {
    let layout = layout(source, bytes)?;
    let channels = usize::from(layout.channels);
    let allocate = move |size: Vec2<usize>| (size.0, vec![0_f32; size.0 * size.1 * channels]);
    let put = move |(width, samples): &mut (usize, Vec<f32>), position: Vec2<usize>, pixel: &[f32]| {
        let start = (position.1 * *width + position.0) * channels;
        if let Some(target) = samples.get_mut(start..start + channels) {
            target.copy_from_slice(&pixel[..channels]);
        }
    };
    let reader = exr::prelude::read().no_deep_data().largest_resolution_level();
    let samples = if channels >= 3 {
        let reader = reader.rgba_channels(
            move |size, _| allocate(size),
            move |image, position, (r, g, b, a): (f32, f32, f32, f32)| put(image, position, &[r, g, b, a]),
        );
        let reader = reader.first_valid_layer().all_attributes().non_parallel();
        reader.from_buffered(&mut *bytes).map(|image| image.layer_data.channel_data.pixels.1)
    } else {
        let reader = reader.specific_channels().required("Y").optional("A", 1.0_f32).collect_pixels(
            move |size, _| allocate(size),
            move |image, position, (y, a): (f32, f32)| put(image, position, &[y, a]),
        );
        let reader = reader.first_valid_layer().all_attributes().non_parallel();
        reader.from_buffered(&mut *bytes).map(|image| image.layer_data.channel_data.pixels.1)
    };
    let samples = RasterSamples::Floats(samples.map_err(|e| unreadable(source, e))?);
    Ok(Raster { layout, samples, transfer_function: TransferFunction::Linear })
}

/// Reads the first part with R, G and B within its data window and converts it to sRGB primaries.
pub(super) fn read(source: Source, bytes: &mut dyn ReadSeek) -> Result<Image, ImageError> {
    read_headers(source, bytes)?;
    let reader = exr::prelude::read().no_deep_data().largest_resolution_level();
    let reader = reader.rgb_channels(
        |size, _| (size.0, vec![[0f32; 3]; size.0 * size.1]),
        |(width, pixels), position, (r, g, b): (f32, f32, f32)| pixels[position.1 * *width + position.0] = [r, g, b],
    );
    let reader = reader.first_valid_layer().all_attributes().non_parallel();
    let image = reader.from_buffered(&mut *bytes).map_err(|error| unreadable(source, error))?;
    let size = image.layer_data.size;
    let mut pixels: Vec<Rgb> = image.layer_data.channel_data.pixels.1.into_iter().map(Rgb::from).collect();
    super::convert_primaries(&mut pixels, image.attributes.chromaticities.and_then(to_srgb));
    let (width, height) = source.size(size.0 as u64, size.1 as u64, u64::MAX)?;
    source.image(width, height, pixels)
}

/// Matrix from the file's primaries to sRGB's; `None` if they are equal.
fn to_srgb(named: exr::meta::attribute::Chromaticities) -> Option<Matrix> {
    let [red, green, blue, white] =
        [named.red, named.green, named.blue, named.white].map(|Vec2(x, y)| [f64::from(x), f64::from(y)]);
    Chromaticities { red, green, blue, white }.to_srgb()
}

/// Image size and all string attributes, in file order.
pub(super) fn inspect(source: Source, bytes: &mut dyn ReadSeek) -> Result<Inspected, ImageError> {
    read_headers(source, bytes)?;
    let (window, metadata) = attributes(bytes).map_err(|e| source.failed(e))?;
    let [left, top, right, bottom] = window;
    let [width, height] = [(left, right), (top, bottom)].map(|(first, last)| u64::try_from(last - first + 1));
    let (Ok(width), Ok(height)) = (width, height) else {
        return Err(source.malformed("its data window has a negative size"));
    };
    Ok((source.size(width, height, u64::MAX)?, metadata))
}

/// Data window as left, top, right, bottom, and all string attributes.
fn attributes(bytes: &mut dyn ReadSeek) -> io::Result<([i64; 4], Metadata)> {
    let (mut window, mut metadata) = ([0, 0, -1, -1], Vec::new());
    let mut eight = [0; 8];
    bytes.read_exact(&mut eight)?;
    for _ in 0..10_000 {
        let name = name(bytes)?;
        if name.is_empty() {
            return Ok((window, metadata));
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
            metadata.push((name, String::from_utf8_lossy(&value).into_owned()));
        } else if name == "dataWindow" {
            for (edge, four) in window.iter_mut().zip(value.chunks_exact(4)) {
                *edge = four.iter().rev().fold(0_i32, |number, byte| number << 8 | i32::from(*byte)).into();
            }
        }
    }
    Err(io::Error::new(io::ErrorKind::InvalidData, "it has too many attributes"))
}

/// Reads a null-terminated name of at most 255 bytes.
fn name(bytes: &mut dyn ReadSeek) -> io::Result<String> {
    let mut name = Vec::new();
    (&mut *bytes).take(256).read_until(0, &mut name)?;
    match name.pop() {
        Some(0) => Ok(String::from_utf8_lossy(&name).into_owned()),
        _ => Err(io::Error::new(io::ErrorKind::InvalidData, "a name is not terminated")),
    }
}
