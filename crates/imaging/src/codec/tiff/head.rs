//! What the first directory of a TIFF file states about its image (TIFF 6.0, section 8), checked
//! before anything is allocated for pixels.

use super::directory::Directory;
use crate::ImageError;
use crate::codec::{ReadSeek, Source, gif};
use crate::orientation::{ORIENTATION, Orientation};
use crate::tone::{Chromaticities, Matrix};

const IMAGE_WIDTH: u16 = 256;
const IMAGE_LENGTH: u16 = 257;
const BITS_PER_SAMPLE: u16 = 258;
const COMPRESSION: u16 = 259;
pub(super) const PHOTOMETRIC: u16 = 262;
const STRIP_OFFSETS: u16 = 273;
const SAMPLES_PER_PIXEL: u16 = 277;
const ROWS_PER_STRIP: u16 = 278;
const STRIP_BYTE_COUNTS: u16 = 279;
const PLANAR: u16 = 284;
const PREDICTOR: u16 = 317;
const WHITE_POINT: u16 = 318;
const PRIMARIES: u16 = 319;
const COLOR_MAP: u16 = 320;
const TILE_WIDTH: u16 = 322;
const TILE_LENGTH: u16 = 323;
const TILE_OFFSETS: u16 = 324;
const TILE_BYTE_COUNTS: u16 = 325;
pub(super) const EXTRA_SAMPLES: u16 = 338;
const SAMPLE_FORMAT: u16 = 339;
const CHROMA_SUBSAMPLING: u16 = 530;
const ICC_PROFILE: u16 = 34_675;
/// Tags that the decoder reads, with a value for each sample at most.
const SHORT_TAGS: [u16; 14] = [
    IMAGE_WIDTH,
    IMAGE_LENGTH,
    BITS_PER_SAMPLE,
    COMPRESSION,
    PHOTOMETRIC,
    SAMPLES_PER_PIXEL,
    ROWS_PER_STRIP,
    PLANAR,
    PREDICTOR,
    TILE_WIDTH,
    TILE_LENGTH,
    EXTRA_SAMPLES,
    SAMPLE_FORMAT,
    CHROMA_SUBSAMPLING,
];
/// Longest side of a tile in pixels.
const LONGEST_TILE: u32 = 65_536;

/// Meaning of the samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Colors {
    Gray,
    Rgb,
    /// Indices of a palette.
    Palette,
    Cmyk,
}

/// Meaning of a sample beyond the colors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Extra {
    None,
    /// The file states nothing about the sample, which is read as alpha.
    Unspecified,
    /// Alpha that has multiplied the colors.
    AssociatedAlpha,
    Alpha,
}

/// Properties of the image.
pub(super) struct Head {
    pub directory: Directory,
    /// Width and height in pixels, as stored.
    pub size: (u32, u32),
    pub colors: Colors,
    pub extra: Extra,
    /// Samples per pixel in the file.
    pub samples: u32,
    /// Bits per sample.
    pub bits: u16,
    pub is_float: bool,
    /// Whether each channel is stored by itself.
    pub is_planar: bool,
    pub orientation: Orientation,
    /// Matrix from the stated primaries to sRGB's.
    pub to_srgb: Option<Matrix>,
}

impl Head {
    /// Reads and checks the directory.
    pub fn read(source: Source, bytes: &mut dyn ReadSeek) -> Result<Self, ImageError> {
        let failed = |error| source.failed(error);
        let directory = Directory::first(bytes).map_err(failed)?;
        let directory = directory.ok_or_else(|| source.malformed("it is a BigTIFF file, which is not supported"))?;
        if SHORT_TAGS.iter().any(|tag| directory.count(*tag) > 4) {
            return Err(source.malformed("its directory is damaged"));
        }
        let number = |tag, default| directory.number(tag).unwrap_or(default);
        let samples = number(SAMPLES_PER_PIXEL, 1);
        let bits = first(&directory, bytes, BITS_PER_SAMPLE, 1).map_err(failed)?;
        let size = size(source, &directory, u64::from(samples) * u64::from(bits))?;
        let format = first(&directory, bytes, SAMPLE_FORMAT, 1).map_err(failed)?;
        let extra = first(&directory, bytes, EXTRA_SAMPLES, 0).map_err(failed)?;
        let (colors, extra) = colors(source, directory.number(PHOTOMETRIC), samples, extra)?;
        check_depth(source, colors, bits, format)?;
        let is_planar = number(PLANAR, 1) == 2 && samples > 1;
        check_pieces(source, &directory, size, if is_planar { samples } else { 1 })?;
        let orientation = Orientation::from_code(number(ORIENTATION, 1).try_into().unwrap_or(1));
        let to_srgb = if colors == Colors::Rgb { to_srgb(&directory, bytes).map_err(failed)? } else { None };
        let is_float = format == 3;
        Ok(Self { directory, size, colors, extra, samples, bits, is_float, is_planar, orientation, to_srgb })
    }

    /// Number of channels of the raster.
    pub fn channels(&self) -> u8 {
        let colors = if self.colors == Colors::Gray { 1 } else { 3 };
        colors + u8::from(self.extra != Extra::None)
    }

    /// Bytes per sample of the raster: 1, 2, or 4 for floats.
    pub fn sample_bytes(&self) -> u8 {
        match self.bits {
            _ if self.is_float => 4,
            ..=8 => 1,
            _ => 2,
        }
    }

    /// Colors of the palette, with 8 bits per channel. Some files store 8 bits, the others 16.
    pub fn palette(&self, source: Source, bytes: &mut dyn ReadSeek) -> Result<Vec<[u8; 3]>, ImageError> {
        let count = 1_usize << self.bits;
        let levels = self.directory.shorts(bytes, COLOR_MAP, 3 << self.bits).map_err(|error| source.failed(error))?;
        let shift = if levels.iter().all(|level| *level < 256) { 0 } else { 8 };
        let [reds, greens, blues] = [0, 1, 2].map(|plane| levels.get(plane * count..(plane + 1) * count));
        let (Some(reds), Some(greens), Some(blues)) = (reds, greens, blues) else {
            return Err(source.malformed("its palette is missing or too short"));
        };
        let colors = reds.iter().zip(greens).zip(blues);
        Ok(colors.map(|((r, g), b)| [r, g, b].map(|level| (level >> shift) as u8)).collect())
    }
}

/// First value of a tag.
fn first(directory: &Directory, bytes: &mut dyn ReadSeek, tag: u16, default: u16) -> std::io::Result<u16> {
    if directory.has(tag) { Ok(directory.shorts(bytes, tag, 1)?.first().copied().unwrap_or(0)) } else { Ok(default) }
}

/// Checks the stated size against the file's length.
fn size(source: Source, directory: &Directory, bits_per_pixel: u64) -> Result<(u32, u32), ImageError> {
    let (Some(width), Some(height)) = (directory.number(IMAGE_WIDTH), directory.number(IMAGE_LENGTH)) else {
        return Err(source.malformed("its directory states no width or height"));
    };
    let max_bytes = match directory.number(COMPRESSION).unwrap_or(1) {
        1 => 1,
        5 => gif::MAX_PIXELS_PER_BYTE,
        // Deflate.
        8 | 32_946 => 1032,
        // A run of PackBits has 128 bytes and takes 2.
        32_773 => 64,
        6 | 7 => return Err(unsupported(source, "JPEG compression")),
        2..=4 => return Err(unsupported(source, "fax compression")),
        other => return Err(unsupported(source, &format!("compression of type {other}"))),
    };
    source.size(width.into(), height.into(), (8 * max_bytes / bits_per_pixel.max(1)).max(1))
}

fn unsupported(source: Source, what: &str) -> ImageError {
    source.malformed(format!("{what} is not supported; save it uncompressed, or with LZW or Deflate"))
}

fn colors(source: Source, photometric: Option<u32>, samples: u32, extra: u16) -> Result<(Colors, Extra), ImageError> {
    let (colors, count) = match photometric {
        Some(0 | 1) => (Colors::Gray, 1),
        Some(2) => (Colors::Rgb, 3),
        Some(3) => (Colors::Palette, 1),
        Some(5) => (Colors::Cmyk, 4),
        Some(6) => return Err(source.malformed("its colors are YCbCr, which is not supported; save it as RGB")),
        Some(8..=10) => return Err(source.malformed("its colors are Lab, which is not supported; save it as RGB")),
        _ => return Err(source.malformed("its directory states no supported meaning of the samples")),
    };
    let most = if matches!(colors, Colors::Gray | Colors::Rgb) { count + 1 } else { count };
    if !(count..=most).contains(&samples) {
        return Err(source.malformed(format!("it has {samples} samples per pixel; {count} to {most} are supported")));
    }
    let extra = match extra {
        _ if samples == count => Extra::None,
        1 => Extra::AssociatedAlpha,
        2 => Extra::Alpha,
        _ => Extra::Unspecified,
    };
    Ok((colors, extra))
}

fn check_depth(source: Source, colors: Colors, bits: u16, format: u16) -> Result<(), ImageError> {
    let is_supported = match (format, colors) {
        (1, Colors::Gray) => matches!(bits, 1 | 2 | 4 | 8 | 16 | 32),
        (1, Colors::Palette) => matches!(bits, 1 | 2 | 4 | 8),
        (1, Colors::Rgb) => matches!(bits, 8 | 16 | 32),
        (1, Colors::Cmyk) => matches!(bits, 8 | 16),
        (3, Colors::Gray | Colors::Rgb) => matches!(bits, 16 | 32 | 64),
        _ => false,
    };
    let kind = match format {
        1 => "bits",
        2 => "bits with a sign",
        3 => "bits as a float",
        _ => "bits of an unknown kind",
    };
    if is_supported { Ok(()) } else { Err(source.malformed(format!("samples of {bits} {kind} are not supported"))) }
}

/// Checks that the file lists as many strips or tiles as the image has.
fn check_pieces(
    source: Source,
    directory: &Directory,
    (width, height): (u32, u32),
    planes: u32,
) -> Result<(), ImageError> {
    let damaged = || source.malformed("its list of strips or tiles does not fit its size");
    let (pieces, offsets, lengths) = if directory.has(TILE_OFFSETS) {
        let sides = [TILE_WIDTH, TILE_LENGTH].map(|tag| directory.number(tag).unwrap_or(0));
        if sides.iter().any(|side| !(1..=LONGEST_TILE).contains(side)) {
            return Err(source.malformed("the size of its tiles is not supported"));
        }
        let count = u64::from(width.div_ceil(sides[0])) * u64::from(height.div_ceil(sides[1]));
        (count, TILE_OFFSETS, TILE_BYTE_COUNTS)
    } else {
        let rows = directory.number(ROWS_PER_STRIP).unwrap_or(height);
        if rows == 0 {
            return Err(damaged());
        }
        (u64::from(height.div_ceil(rows)), STRIP_OFFSETS, STRIP_BYTE_COUNTS)
    };
    let pieces = pieces.saturating_mul(u64::from(planes));
    let fits = [offsets, lengths].iter().all(|tag| u64::from(directory.count(*tag)) == pieces);
    // Each offset takes 2 bytes at least.
    if fits && pieces <= source.length / 2 { Ok(()) } else { Err(damaged()) }
}

/// Matrix from the primaries that the file states to sRGB's, unless it has a color profile.
fn to_srgb(directory: &Directory, bytes: &mut dyn ReadSeek) -> std::io::Result<Option<Matrix>> {
    if directory.has(ICC_PROFILE) {
        return Ok(None);
    }
    let (white, primaries) = (directory.fractions(bytes, WHITE_POINT)?, directory.fractions(bytes, PRIMARIES)?);
    let (Some(white), Some([rx, ry, gx, gy, bx, by])) = (white, primaries) else { return Ok(None) };
    Ok(Chromaticities { red: [rx, ry], green: [gx, gy], blue: [bx, by], white }.to_srgb())
}
