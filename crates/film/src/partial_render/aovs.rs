//! Encoding of a run's AOVs: RGB planes are compressed like sums, masks by LZ4 alone.

use super::AovDescription;
use super::pack::{pack_colors, unpack_colors};
use juggler_camera::film::{AovSums, CoverageMask, MASKS};
use juggler_math::Rgb;

/// Maximum number of mask entries per pixel.
const MAX_MASK_ENTRIES: usize = 1 << 16;

/// Encodes the AOVs of a run of `pixels` pixels.
pub(super) fn pack(aov_sums: &AovSums, pixels: usize) -> Vec<u8> {
    let mut bytes = Vec::new();
    let count = aov_sums.planes.len() / pixels.max(1);
    for layer in 0..count {
        let colors: Vec<Rgb> = aov_sums.planes.iter().skip(layer).step_by(count).copied().collect();
        append_with_length(&mut bytes, &pack_colors(&colors));
    }
    for mask in &aov_sums.masks {
        let entries = mask.entries().iter();
        let numbers = entries.flat_map(|(id, sum)| [*id, sum.to_bits()]);
        let plain: Vec<u8> = mask.ends().iter().copied().chain(numbers).flat_map(u32::to_le_bytes).collect();
        bytes.extend_from_slice(&(mask.entries().len() as u32).to_le_bytes());
        append_with_length(&mut bytes, &lz4_flex::block::compress(&plain));
    }
    bytes
}

/// Appends the length of `packed` and its bytes.
fn append_with_length(bytes: &mut Vec<u8>, packed: &[u8]) {
    // A layer of a tile takes a few kilobytes, so the length fits 32 bits.
    bytes.extend_from_slice(&(packed.len() as u32).to_le_bytes());
    bytes.extend_from_slice(packed);
}

/// Inverse of [`pack`] for an image with the AOVs `aovs`: the AOVs and the remaining bytes. `None`
/// if the bytes are malformed.
pub(super) fn unpack<'b>(mut bytes: &'b [u8], pixels: usize, aovs: &AovDescription) -> Option<(AovSums, &'b [u8])> {
    let count = aovs.planes as usize;
    // LZ4 expands by a factor of 255 at most: reject larger claims before allocating.
    if count.saturating_mul(pixels).saturating_mul(12) > bytes.len().saturating_mul(256) {
        return None;
    }
    let mut planes = vec![Rgb::BLACK; count * pixels];
    for layer in 0..count {
        let colors = unpack_colors(take(&mut bytes)?, pixels)?;
        planes.iter_mut().skip(layer).step_by(count).zip(colors).for_each(|(value, color)| *value = color);
    }
    let masks = (0..if aovs.masks { MASKS } else { 0 }).map(|_| mask(&mut bytes, pixels)).collect::<Option<_>>()?;
    Some((AovSums { planes, masks }, bytes))
}

fn mask(bytes: &mut &[u8], pixels: usize) -> Option<CoverageMask> {
    let entries = number(bytes)? as usize;
    if entries > pixels.saturating_mul(MAX_MASK_ENTRIES) {
        return None;
    }
    let packed = take(bytes)?;
    // LZ4 expands by a factor of 255 at most: reject larger claims before allocating.
    let length = (pixels + 2 * entries).checked_mul(4).filter(|length| *length <= packed.len().saturating_mul(256))?;
    let plain = lz4_flex::block::decompress(packed, length).ok().filter(|plain| plain.len() == length)?;
    let mut numbers = plain.as_chunks().0.iter().map(|four| u32::from_le_bytes(*four));
    let ends: Vec<u32> = numbers.by_ref().take(pixels).collect();
    let rest: Vec<u32> = numbers.collect();
    CoverageMask::new(ends, rest.as_chunks().0.iter().map(|[id, sum]| (*id, f32::from_bits(*sum))).collect()).ok()
}

fn number(bytes: &mut &[u8]) -> Option<u32> {
    let (four, rest) = bytes.split_first_chunk()?;
    *bytes = rest;
    Some(u32::from_le_bytes(*four))
}

fn take<'b>(bytes: &mut &'b [u8]) -> Option<&'b [u8]> {
    let length = number(bytes)? as usize;
    let (content, rest) = bytes.split_at_checked(length)?;
    *bytes = rest;
    Some(content)
}
