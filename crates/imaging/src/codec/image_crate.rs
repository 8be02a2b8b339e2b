//! Images of 8 bits per channel, decoded by the crate `image`.

use super::Source;
use crate::ImageError;
use crate::raster::{Raster, RasterLayout, RasterSamples, TransferFunction};
use image::error::ImageError as DecodingError;
use image::{ColorType, ImageDecoder};

/// Layout after the header was read, before anything is allocated for pixels.
pub(super) fn layout(
    source: Source,
    decoder: &impl ImageDecoder,
    max_pixels_per_byte: u64,
) -> Result<RasterLayout, ImageError> {
    let (width, height) = decoder.dimensions();
    let size = source.size(u64::from(width), u64::from(height), max_pixels_per_byte)?;
    let channels = match decoder.color_type() {
        ColorType::L8 => 1,
        ColorType::La8 => 2,
        ColorType::Rgb8 => 3,
        ColorType::Rgba8 => 4,
        _ => return Err(source.malformed("its pixels have an unsupported format")),
    };
    Ok(source.layout(size, channels, 1))
}

/// Samples of an image with this layout.
pub(super) fn raster(source: Source, layout: RasterLayout, decoder: impl ImageDecoder) -> Result<Raster, ImageError> {
    let bytes = usize::try_from(decoder.total_bytes()).map_err(|_| source.malformed("it is too large"))?;
    let mut samples = vec![0; bytes];
    decoder.read_image(&mut samples).map_err(|e| unreadable(source, e))?;
    let (samples, transfer_function) = (RasterSamples::Bytes(samples), TransferFunction::Srgb);
    Ok(Raster { layout, samples, transfer_function, is_first_of_several: false })
}

/// Translates a decoder error into a message that names the file.
pub(super) fn unreadable(source: Source, error: DecodingError) -> ImageError {
    match error {
        DecodingError::IoError(error) => source.failed(error),
        DecodingError::Unsupported(_) => source.malformed("it uses a feature of the format that is not supported"),
        DecodingError::Limits(_) => source.malformed("it is too large"),
        _ => source.malformed(describe(&error.to_string())),
    }
}

/// Describes a decoder error in plain words, by a part of its text.
fn describe(text: &str) -> &'static str {
    let known = [
        ("Invalid empty image", "its width or height is 0"),
        ("too large", "its width or height is too large"),
        ("Negative width", "its width is negative"),
        ("Invalid height", "its height is too large"),
        ("RLE", "its compressed pixels are damaged"),
        ("olor map", "its palette is damaged"),
        ("Palette", "its palette is too large"),
        ("itfield mask", "the bit masks of its colors are damaged"),
        ("plane", "it has several planes"),
        ("channel bit count", "its number of bits per pixel does not fit its compression"),
        ("compression type", "its type of compression is unknown"),
        ("top-down", "compressed rows are stored from the top"),
    ];
    let found = known.into_iter().find(|(part, _)| text.contains(part));
    found.map_or("its structure is damaged", |(_, words)| words)
}
