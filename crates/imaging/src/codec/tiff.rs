//! TIFF (revision 6.0), read only: gray, RGB, palettes and CMYK, with or without alpha, in 1 to 16
//! bits (32 bits are reduced to 16) or floats, as strips or tiles, uncompressed or with LZW, Deflate
//! or PackBits. Integers are taken as sRGB, floats as linear. A sample beyond the colors is alpha,
//! whatever the file states about it; colors that alpha has multiplied are divided by it.

pub(crate) mod directory;
mod head;

use super::{ReadSeek, Source};
use crate::ImageError;
use crate::raster::{Raster, RasterLayout, RasterSamples, TransferFunction};
use directory::Directory;
use head::{Colors, EXTRA_SAMPLES, Extra, Head, PHOTOMETRIC};
use std::io::Cursor;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::{TiffError, TiffFormatError};

/// Kind of a further image in the file; bit 0 marks a smaller copy.
const NEW_SUBFILE_TYPE: u16 = 254;
const BLACK_IS_ZERO: u16 = 1;
const UNASSOCIATED_ALPHA: u16 = 2;

/// Reads the layout of [`raster`] from the directory.
pub(super) fn layout(source: Source, bytes: &mut dyn ReadSeek) -> Result<RasterLayout, ImageError> {
    Head::read(source, bytes).map(|head| layout_of(source, &head))
}

fn layout_of(source: Source, head: &Head) -> RasterLayout {
    let layout = source.layout(head.orientation.size(head.size), head.channels(), head.sample_bytes());
    RasterLayout { to_srgb: head.to_srgb, ..layout }
}

/// Reads the samples of the first image.
pub(super) fn raster(source: Source, bytes: &mut dyn ReadSeek) -> Result<Raster, ImageError> {
    let head = Head::read(source, bytes)?;
    let layout = layout_of(source, &head);
    let is_first_of_several = has_more_pages(&head.directory, bytes);
    let samples = match decode(source, &head, bytes)? {
        DecodingResult::U8(levels) if head.colors == Colors::Palette => {
            let palette = head.palette(source, bytes)?;
            let color = |index: u8| palette.get(usize::from(index)).copied().unwrap_or_default();
            RasterSamples::Bytes(turned(&head, unpacked(&head, &levels).flat_map(color).collect(), 3))
        }
        DecodingResult::U8(levels) if head.bits < 8 => {
            let top = (1_u8 << head.bits) - 1;
            let levels = unpacked(&head, &levels).map(|level| level * (255 / top)).collect();
            RasterSamples::Bytes(turned(&head, levels, 1))
        }
        DecodingResult::U8(levels) => RasterSamples::Bytes(integers(&head, levels, u8::MAX)),
        DecodingResult::U16(levels) => RasterSamples::Words(integers(&head, levels, u16::MAX)),
        DecodingResult::U32(levels) => {
            let words = levels.iter().map(|level| (level >> 16) as u16).collect();
            RasterSamples::Words(integers(&head, words, u16::MAX))
        }
        DecodingResult::F16(values) => floats(&head, values.iter().map(|value| value.to_f32()).collect()),
        DecodingResult::F32(values) => floats(&head, values),
        DecodingResult::F64(values) => floats(&head, values.iter().map(|value| *value as f32).collect()),
        _ => return Err(source.malformed("its samples have an unsupported type")),
    };
    let transfer_function = if head.is_float { TransferFunction::Linear } else { TransferFunction::Srgb };
    Ok(Raster { layout, samples, transfer_function, is_first_of_several })
}

/// Whether another page follows; smaller copies of the image are none.
fn has_more_pages(directory: &Directory, bytes: &mut dyn ReadSeek) -> bool {
    let next = directory.following(bytes).ok().flatten();
    next.is_some_and(|next| next.number(NEW_SUBFILE_TYPE).unwrap_or(0) & 1 == 0)
}

/// Decodes the samples as stored. The decoder knows no palettes and drops samples that the file says
/// nothing about, so it reads a copy of such a file with gray indices and with alpha.
fn decode(source: Source, head: &Head, bytes: &mut dyn ReadSeek) -> Result<DecodingResult, ImageError> {
    let change = match (head.colors, head.extra) {
        (Colors::Palette, _) => Some((PHOTOMETRIC, BLACK_IS_ZERO)),
        (Colors::Rgb, Extra::Unspecified) => Some((EXTRA_SAMPLES, UNASSOCIATED_ALPHA)),
        _ => None,
    };
    bytes.rewind().map_err(|error| source.failed(error))?;
    let Some((tag, number)) = change else { return decode_as_stated(source, bytes) };
    let mut file = Vec::new();
    bytes.read_to_end(&mut file).map_err(|error| source.failed(error))?;
    head.directory.replace(&mut file, tag, number);
    decode_as_stated(source, &mut Cursor::new(file))
}

fn decode_as_stated(source: Source, bytes: &mut dyn ReadSeek) -> Result<DecodingResult, ImageError> {
    let mut result = DecodingResult::U8(Vec::new());
    let decoder = Decoder::new(bytes).map(|decoder| decoder.with_limits(Limits::unlimited()));
    let decoded = decoder.and_then(|mut decoder| decoder.read_image_to_buffer(&mut result));
    decoded.map(|_| result).map_err(|error| unreadable(source, error))
}

/// Translates a decoder error into a message that names the file.
fn unreadable(source: Source, error: TiffError) -> ImageError {
    match error {
        TiffError::IoError(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => source.failed(error),
        TiffError::IoError(_) | TiffError::FormatError(TiffFormatError::CompressedDataCorrupt(_)) => {
            source.malformed("its compressed pixels are damaged")
        }
        TiffError::UnsupportedError(_) => source.malformed("it uses an unsupported feature of TIFF"),
        TiffError::LimitsExceeded | TiffError::IntSizeError => source.malformed("it is too large"),
        TiffError::FormatError(_) | TiffError::UsageError(_) => source.malformed("its directory is damaged"),
    }
}

/// Samples of less than 8 bits, of which a byte holds several. Each row begins with a new byte.
fn unpacked<'l>(head: &Head, levels: &'l [u8]) -> impl Iterator<Item = u8> + use<'l> {
    let (width, bits) = (head.size.0 as usize, usize::from(head.bits).clamp(1, 8));
    let mask = (0xff_u16 >> (8 - bits)) as u8;
    levels.chunks_exact((width * bits).div_ceil(8)).flat_map(move |row| {
        row.iter().flat_map(move |byte| (0..8 / bits).rev().map(move |k| byte >> (k * bits) & mask)).take(width)
    })
}

/// Pixels with all samples of a pixel side by side, turned by the orientation.
fn turned<T: Copy>(head: &Head, samples: Vec<T>, channels: usize) -> Vec<T> {
    let samples = if head.is_planar { interleaved(&samples, channels) } else { samples };
    head.orientation.turn(samples, head.size, channels)
}

fn interleaved<T: Copy>(planes: &[T], channels: usize) -> Vec<T> {
    let pixels = planes.len() / channels.max(1);
    let sample = |pixel: usize, plane: usize| planes.get(plane * pixels + pixel).copied();
    (0..pixels).flat_map(|pixel| (0..channels).filter_map(move |plane| sample(pixel, plane))).collect()
}

/// Levels from 0 to `top`: RGB for CMYK, and colors that alpha has not multiplied.
fn integers<T: Copy + Into<u32> + TryFrom<u32>>(head: &Head, samples: Vec<T>, top: T) -> Vec<T> {
    let mut samples = turned(head, samples, head.samples as usize);
    let top_level: u32 = top.into();
    let level = |number: u32| T::try_from(number).unwrap_or(top);
    if head.colors == Colors::Cmyk {
        let white = |ink: T| top_level.saturating_sub(ink.into());
        let color = |ink: T, black: T| level((white(ink) * white(black) + top_level / 2) / top_level);
        let pixels = samples.chunks_exact(4);
        return pixels.flat_map(|pixel| [0, 1, 2].map(|ink| color(pixel[ink], pixel[3]))).collect();
    }
    if head.extra == Extra::AssociatedAlpha {
        let straight = |color: u32, alpha: u32| level(((color * top_level + alpha / 2) / alpha).min(top_level));
        divide(&mut samples, head.samples as usize, |color, alpha| match alpha.into() {
            0 => color,
            alpha => straight(color.into(), alpha),
        });
    }
    samples
}

fn floats(head: &Head, samples: Vec<f32>) -> RasterSamples {
    let mut samples = turned(head, samples, head.samples as usize);
    if head.extra == Extra::AssociatedAlpha {
        divide(&mut samples, head.samples as usize, |color, alpha| if alpha > 0.0 { color / alpha } else { color });
    }
    RasterSamples::Floats(samples)
}

/// Divides the colors of all pixels by alpha, their last channel.
fn divide<T: Copy>(samples: &mut [T], channels: usize, divided: impl Fn(T, T) -> T) {
    for pixel in samples.chunks_exact_mut(channels) {
        if let Some((alpha, colors)) = pixel.split_last_mut() {
            colors.iter_mut().for_each(|color| *color = divided(*color, *alpha));
        }
    }
}
