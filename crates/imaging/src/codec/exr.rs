//! OpenEXR: one part of scanlines, channels B, G, R as floats or halves, plain or packed; values
//! are scene-referred and no tone curve applies; primaries other than those of sRGB are named. It is written as a file of layers
//! that has one. (OpenEXR file layout, openexr.com.)

use super::{ENDS, Header, Inspected, ReadSeek, RowWriter, Source, Texts};
use crate::ImageError;
use crate::layered::{self, LayerHeader, LayerRows, LayeredHeader};
use crate::output::Destination;
use crate::raster::{Encoding, Layout, Raster, Samples};
use crate::tone::{Chromaticities, Matrix};
use exr::error::Error as ExrError;
use exr::math::Vec2;
use exr::meta::header::Header as ExrHeader;
use exr::prelude::{Compression, ReadChannels, ReadLayers, ReadSpecificChannel};
use juggler_math::{Image, Rgb};
use std::io::{self, BufRead, Read};

/// Streams blocks of rows into an EXR: one layer, without a name of its own.
pub(super) struct Writer(layered::exr::Writer);

impl Writer {
    pub fn new(destination: Destination, header: &Header) -> Result<Self, ImageError> {
        let place = destination.name().to_owned();
        let picture = LayeredHeader::new(header, vec![LayerHeader::beauty(header.options.exr_depth)]);
        layered::exr::Writer::new(destination.into_seekable(), place, &picture).map(Self)
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

/// What a decoder's error says, in words that name the file.
pub(crate) fn unreadable(source: Source, error: ExrError) -> ImageError {
    match error {
        ExrError::Io(error) => source.failed(error),
        ExrError::Invalid(what) if ["reference to missing bytes", "not enough data"].contains(&&*what) => {
            source.malformed(ENDS)
        }
        ExrError::Invalid(what) => source.malformed(format!("its data is invalid: {what}")),
        ExrError::NotSupported(what) => source.malformed(format!("it uses what is not read: {what}")),
        ExrError::Aborted => source.malformed("reading was broken off"),
    }
}

/// The heads of all layers, whose sizes the file can hold.
pub(crate) fn heads(source: Source, bytes: &mut dyn ReadSeek) -> Result<Vec<ExrHeader>, ImageError> {
    let meta = exr::meta::MetaData::read_from_buffered(&mut *bytes, false).map_err(|e| unreadable(source, e))?;
    for header in &meta.headers {
        let Vec2(width, height) = header.layer_size;
        source.size(width as u64, height as u64, densest(header))?;
    }
    bytes.rewind().map_err(|e| source.failed(e))?;
    Ok(meta.headers.into_iter().collect())
}

/// Most pixels that a byte can hold. Deflate makes at most 1032 bytes of one, of which PXR24 makes a third more; DWA keeps little
/// more than two numbers of 64 pixels, and these deflated.
fn densest(header: &ExrHeader) -> u64 {
    let most_bytes: u64 = match header.compression {
        Compression::DWAA(_) | Compression::DWAB(_) => 64 * 1032,
        Compression::Uncompressed => 1,
        _ => 1376,
    };
    let eighths = header.channels.list.iter().map(|channel| {
        let Vec2(x, y) = channel.sampling;
        8 * channel.sample_type.bytes_per_sample() / (x * y).clamp(1, 64)
    });
    (8 * most_bytes / (eighths.sum::<usize>() as u64).max(1)).max(1)
}

/// What [`raster`] will bring: of the first layer with R, G and B, or with Y alone, and with A if it has one.
pub(super) fn layout(source: Source, bytes: &mut dyn ReadSeek) -> Result<Layout, ImageError> {
    let heads = heads(source, bytes)?;
    let has = |header: &ExrHeader, names: &[&str]| {
        names.iter().all(|name| header.channels.list.iter().any(|channel| channel.name == **name))
    };
    let found = |names: &[&str]| heads.iter().find(|header| !header.deep && has(header, names));
    let (colors, header) = match (found(&["R", "G", "B"]), found(&["Y"])) {
        (Some(header), _) => (3, header),
        (None, Some(header)) => (1, header),
        (None, None) => return Err(source.malformed("it has no layer with channels R, G and B, or Y")),
    };
    let Vec2(width, height) = header.layer_size;
    let size = source.size(width as u64, height as u64, densest(header))?;
    Ok(source.layout(size, colors + u8::from(has(header, &["A"])), 4))
}

/// The layer that [`layout`] finds, in its data window.
pub(super) fn raster(source: Source, bytes: &mut dyn ReadSeek) -> Result<Raster, ImageError> {
    let layout = layout(source, bytes)?;
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
    heads(source, bytes)?;
    let reader = exr::prelude::read().no_deep_data().largest_resolution_level();
    let reader = reader.rgb_channels(
        |size, _| (size.0, vec![[0f32; 3]; size.0 * size.1]),
        |(width, pixels), position, (r, g, b): (f32, f32, f32)| pixels[position.1 * *width + position.0] = [r, g, b],
    );
    let reader = reader.first_valid_layer().all_attributes().non_parallel();
    let image = reader.from_buffered(&mut *bytes).map_err(|error| unreadable(source, error))?;
    let size = image.layer_data.size;
    let matrix = image.attributes.chromaticities.and_then(to_srgb);
    let light = |pixel: [f32; 3]| matrix.map_or(Rgb::from(pixel), |matrix| matrix.color(Rgb::from(pixel)));
    let pixels = image.layer_data.channel_data.pixels.1.into_iter().map(light).collect();
    let (width, height) = source.size(size.0 as u64, size.1 as u64, u64::MAX)?;
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
    heads(source, bytes)?;
    let (window, texts) = attributes(bytes).map_err(|e| source.failed(e))?;
    let [left, top, right, bottom] = window;
    let [width, height] = [(left, right), (top, bottom)].map(|(first, last)| u64::try_from(last - first + 1));
    let (Ok(width), Ok(height)) = (width, height) else {
        return Err(source.malformed("its data window is inside out"));
    };
    Ok((source.size(width, height, u64::MAX)?, texts))
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
