//! Truevision TGA (TGA File Format Specification 2.0), read only: palettes, gray and colors of 15 to
//! 32 bits, raw or with run lengths, in all four orders of rows and columns. Levels are taken as
//! sRGB. The files begin with no magic number, so their file extension selects this reader.

use super::{ReadSeek, Source, image_crate};
use crate::ImageError;
use crate::raster::{Raster, RasterLayout};
use image::codecs::tga::TgaDecoder;
use std::io::Read;

/// Length of the header in bytes.
const HEADER: u64 = 18;

/// Reads the 8-bit samples.
pub(super) fn raster(source: Source, bytes: &mut dyn ReadSeek) -> Result<Raster, ImageError> {
    let (layout, decoder) = decoder(source, bytes)?;
    image_crate::raster(source, layout, decoder)
}

/// Reads the layout of [`raster`] from the header.
pub(super) fn layout(source: Source, bytes: &mut dyn ReadSeek) -> Result<RasterLayout, ImageError> {
    decoder(source, bytes).map(|(layout, _)| layout)
}

fn decoder<'b>(
    source: Source,
    bytes: &'b mut dyn ReadSeek,
) -> Result<(RasterLayout, TgaDecoder<&'b mut dyn ReadSeek>), ImageError> {
    let max_pixels_per_byte = max_pixels_per_byte(source, bytes)?;
    let decoder = TgaDecoder::new(bytes).map_err(|e| image_crate::unreadable(source, e))?;
    let layout = image_crate::layout(source, &decoder, max_pixels_per_byte)?;
    Ok((layout, decoder))
}

/// Maximum number of pixels per byte, after a check of the type of the image. A run of 128 pixels
/// takes at least 2 bytes.
fn max_pixels_per_byte(source: Source, bytes: &mut dyn ReadSeek) -> Result<u64, ImageError> {
    let mut head = Vec::new();
    let read = bytes.take(HEADER).read_to_end(&mut head).and_then(|_| bytes.rewind());
    read.map_err(|e| source.failed(e))?;
    match head.as_slice() {
        [] => Err(source.malformed("it is empty")),
        [_, 0 | 1, 1..=3, ..] => Ok(1),
        [_, 0 | 1, 9..=11, ..] => Ok(64),
        [_, 0 | 1, 0, ..] => Err(source.malformed("it holds no pixels")),
        _ => Err(source.malformed("its header is not that of a TGA file")),
    }
}
