//! OpenEXR with one scanline part and channels B, G, R as 32-bit or 16-bit floats, optionally
//! compressed (OpenEXR file layout, openexr.com). Values are scene-referred, so no tone curve
//! applies; primaries other than sRGB's are stored in the header. Writing delegates to the layered
//! writer. `exr/selection.rs` states which channels are the picture.

mod selection;

use super::{Header, Inspected, Metadata, ReadSeek, RowWriter, Source, UNEXPECTED_END};
use crate::layered::{self, LayerHeader, LayerRows, LayeredHeader};
use crate::output::Destination;
use crate::raster::{Raster, RasterLayout, RasterSamples, TransferFunction};
use crate::tone::{Chromaticities, Matrix};
use crate::{ExrWindows, ImageError};
use exr::error::Error as ExrError;
use exr::math::Vec2;
use exr::meta::header::Header as ExrHeader;
use exr::prelude::{Compression, ReadChannels, ReadLayers, ReadSpecificChannel};
use juggler_math::{Image, PixelRows, Rgb};
pub(crate) use selection::Placement;
use selection::Selection;
use std::io::{self, BufRead, Read};

/// Streams rows into a single unnamed layer.
pub(super) struct Writer(layered::exr::Writer);

impl Writer {
    pub fn new(destination: Destination, header: &Header) -> Result<Self, ImageError> {
        let file = destination.name().to_owned();
        let picture = LayeredHeader::new(header, vec![LayerHeader::beauty(header)]);
        layered::exr::Writer::new(destination.into_seekable(), file, &picture).map(Self)
    }
}

impl RowWriter for Writer {
    fn write_rows(&mut self, rows: PixelRows) -> Result<(), ImageError> {
        let channels = layered::channels(rows);
        self.0.write_rows(&channels.iter().map(Vec::as_slice).collect::<Vec<_>>())
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

/// Picture of a file and its place in the display window.
struct Picture<'h> {
    selection: Selection<'h>,
    placement: Placement,
    to_srgb: Option<Matrix>,
}

impl<'h> Picture<'h> {
    fn new(source: Source, headers: &'h [ExrHeader]) -> Result<Self, ImageError> {
        let selection = selection::picture(source, headers)?;
        let header = selection.header;
        let placement = placement(source, header)?;
        let chromaticities = header.shared_attributes.chromaticities.filter(|_| selection.colors.len() == 3);
        Ok(Self { selection, placement, to_srgb: chromaticities.and_then(to_srgb) })
    }

    fn layout(&self, source: Source) -> RasterLayout {
        let channels = self.selection.colors.len() as u8 + u8::from(self.selection.alpha.is_some());
        RasterLayout { to_srgb: self.to_srgb, ..source.layout(self.placement.size(), channels, 4) }
    }
}

/// Place of a part's pixels in the display window, after a check of its size.
pub(crate) fn placement(source: Source, header: &ExrHeader) -> Result<Placement, ImageError> {
    Placement::new(source, header, max_pixels_per_byte(header))
}

/// Layout of [`raster`], the size of the display window.
pub(super) fn layout(source: Source, bytes: &mut dyn ReadSeek) -> Result<RasterLayout, ImageError> {
    let headers = read_headers(source, bytes)?;
    Ok(Picture::new(source, &headers)?.layout(source))
}

/// Samples of the picture within the display window; 0 outside of the data window.
pub(super) fn raster(source: Source, bytes: &mut dyn ReadSeek) -> Result<Raster, ImageError> {
    let headers = read_headers(source, bytes)?;
    let picture = Picture::new(source, &headers)?;
    let (layout, placement) = (picture.layout(source), picture.placement);
    let channels = usize::from(layout.channels);
    let allocate = move || vec![0_f32; placement.pixels().saturating_mul(channels)];
    let put = move |samples: &mut Vec<f32>, position: Vec2<usize>, pixel: &[f32]| {
        let start = placement.index(position).map(|index| index * channels);
        if let Some(target) = start.and_then(|start| samples.get_mut(start..start + channels)) {
            target.iter_mut().zip(pixel).for_each(|(target, value)| *target = *value);
        }
    };
    let Selection { colors, alpha, .. } = &picture.selection;
    let reader = exr::prelude::read().no_deep_data().largest_resolution_level().specific_channels();
    let samples = match colors.as_slice() {
        [red, green, blue] => {
            let alpha = alpha.clone().unwrap_or_else(|| absent(red));
            let reader = reader.required(red.as_str()).required(green.as_str()).required(blue.as_str());
            let reader = reader.optional(alpha.as_str(), 1.0_f32).collect_pixels(
                move |_, _| allocate(),
                move |image, position, (r, g, b, a): (f32, f32, f32, f32)| put(image, position, &[r, g, b, a]),
            );
            let reader = reader.first_valid_layer().all_attributes().non_parallel();
            reader.from_buffered(&mut *bytes).map(|image| image.layer_data.channel_data.pixels)
        }
        colors => {
            let gray = colors.first().map(String::as_str).unwrap_or_default();
            let alpha = alpha.clone().unwrap_or_else(|| absent(gray));
            let reader = reader.required(gray).optional(alpha.as_str(), 1.0_f32).collect_pixels(
                move |_, _| allocate(),
                move |image, position, (y, a): (f32, f32)| put(image, position, &[y, a]),
            );
            let reader = reader.first_valid_layer().all_attributes().non_parallel();
            reader.from_buffered(&mut *bytes).map(|image| image.layer_data.channel_data.pixels)
        }
    };
    let samples = RasterSamples::Floats(samples.map_err(|e| unreadable(source, e))?);
    Ok(Raster { layout, samples, transfer_function: TransferFunction::Linear, is_first_of_several: false })
}

/// Name that differs from all channels of a selection, for a channel that the file does not have.
fn absent(color: &str) -> String {
    format!("{color}_")
}

/// Reads the picture within the display window, black outside of the data window, and converts it
/// to sRGB primaries.
pub(super) fn read(source: Source, bytes: &mut dyn ReadSeek) -> Result<Image, ImageError> {
    let headers = read_headers(source, bytes)?;
    let Picture { selection, placement, to_srgb } = Picture::new(source, &headers)?;
    let names: Vec<&str> = selection.colors.iter().map(String::as_str).collect();
    let values = layered::read_channels(bytes, &names, placement).map_err(|error| unreadable(source, error))?;
    let mut pixels: Vec<Rgb> = values.into_iter().map(Rgb::from).collect();
    super::convert_primaries(&mut pixels, to_srgb);
    let (width, height) = placement.size();
    source.image(width, height, pixels)
}

/// Matrix from the file's primaries to sRGB's; `None` if they are equal.
fn to_srgb(named: exr::meta::attribute::Chromaticities) -> Option<Matrix> {
    let [red, green, blue, white] =
        [named.red, named.green, named.blue, named.white].map(|Vec2(x, y)| [f64::from(x), f64::from(y)]);
    Chromaticities { red, green, blue, white }.to_srgb()
}

/// Size of the display window, all string attributes in file order, and the windows.
pub(super) fn inspect(source: Source, bytes: &mut dyn ReadSeek) -> Result<(Inspected, ExrWindows), ImageError> {
    let headers = read_headers(source, bytes)?;
    let Some(header) = headers.first() else { return Err(source.malformed("it has no layers")) };
    let (size, windows) = (placement(source, header)?.size(), selection::windows(header));
    let metadata = texts(bytes).map_err(|e| source.failed(e))?;
    Ok(((size, metadata), windows))
}

/// All string attributes.
fn texts(bytes: &mut dyn ReadSeek) -> io::Result<Metadata> {
    let mut metadata = Vec::new();
    let mut eight = [0; 8];
    bytes.read_exact(&mut eight)?;
    for _ in 0..10_000 {
        let name = name(bytes)?;
        if name.is_empty() {
            return Ok(metadata);
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
