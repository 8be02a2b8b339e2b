//! Windows bitmap (BITMAPCOREHEADER to BITMAPV5HEADER), read only: palettes, run lengths, 16 to 32
//! bits, rows from the bottom or from the top. Levels are taken as sRGB; alpha counts if the header
//! has a mask for it.

use super::{ReadSeek, Source, image_crate};
use crate::ImageError;
use crate::raster::{Raster, RasterLayout};
use image::codecs::bmp::BmpDecoder;
use std::io::{Read, SeekFrom};

/// Offset of the header of the image in the file.
const HEADER: u64 = 14;
/// Maximum number of pixels per byte of uncompressed files, which have at least 1 bit per pixel.
const MAX_PIXELS_PER_BYTE: u64 = 8;
/// Maximum number of pixels per byte of run lengths. A run has 255 pixels in 2 bytes; a row may end
/// early, and so may the image, which the format does not limit.
const MAX_PIXELS_PER_BYTE_OF_RUNS: u64 = 1 << 13;

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
) -> Result<(RasterLayout, BmpDecoder<&'b mut dyn ReadSeek>), ImageError> {
    let max_pixels_per_byte =
        if has_runs(bytes).map_err(|e| source.failed(e))? { MAX_PIXELS_PER_BYTE_OF_RUNS } else { MAX_PIXELS_PER_BYTE };
    let decoder = BmpDecoder::new(bytes).map_err(|e| image_crate::unreadable(source, e))?;
    let layout = image_crate::layout(source, &decoder, max_pixels_per_byte)?;
    Ok((layout, decoder))
}

/// Whether the header states compression by run lengths (BI_RLE8 or BI_RLE4).
fn has_runs(bytes: &mut dyn ReadSeek) -> std::io::Result<bool> {
    let mut head = Vec::new();
    bytes.seek(SeekFrom::Start(HEADER))?;
    bytes.take(20).read_to_end(&mut head)?;
    bytes.rewind()?;
    // The core header of 12 bytes has no compression.
    Ok(matches!(head.as_slice(), [size, 0, 0, 0, .., 1 | 2, 0, 0, 0] if *size > 12))
}
