//! The bytes of what a run keeps beside radiance: each layer's colours packed as sums are, masks as plain numbers through LZ4.

use super::Layered;
use super::pack::{pack_colors, unpack_colors};
use juggler_camera::film::{Extras, MASKS, Mask};
use juggler_math::Rgb;

/// Most things that a pixel may show: more than any has samples worth telling apart.
const MOST_THINGS: usize = 1 << 16;

/// Of a run of so many pixels.
pub(super) fn pack(extras: &Extras, pixels: usize) -> Vec<u8> {
    let mut bytes = Vec::new();
    let count = extras.planes.len() / pixels.max(1);
    for layer in 0..count {
        let colors: Vec<Rgb> = extras.planes.iter().skip(layer).step_by(count).copied().collect();
        put(&mut bytes, &pack_colors(&colors));
    }
    for mask in &extras.masks {
        let entries = mask.entries().iter();
        let numbers = entries.flat_map(|(thing, sum)| [*thing, sum.to_bits()]);
        let plain: Vec<u8> = mask.ends().iter().copied().chain(numbers).flat_map(u32::to_le_bytes).collect();
        bytes.extend_from_slice(&(mask.entries().len() as u32).to_le_bytes());
        put(&mut bytes, &lz4_flex::block::compress(&plain));
    }
    bytes
}

/// A length, and as many bytes.
fn put(bytes: &mut Vec<u8>, packed: &[u8]) {
    // A tile's layer is a few kilobytes.
    bytes.extend_from_slice(&(packed.len() as u32).to_le_bytes());
    bytes.extend_from_slice(packed);
}

/// The way back from [`pack`] for a picture of such layers: what there is, and the bytes that follow. `None` when the bytes
/// hold something else.
pub(super) fn unpack<'b>(mut bytes: &'b [u8], pixels: usize, kept: &Layered) -> Option<(Extras, &'b [u8])> {
    let count = kept.planes as usize;
    // LZ4 makes no more than 255 bytes of one: what is claimed beyond that is not made room for.
    if count.saturating_mul(pixels).saturating_mul(12) > bytes.len().saturating_mul(256) {
        return None;
    }
    let mut planes = vec![Rgb::BLACK; count * pixels];
    for layer in 0..count {
        let colors = unpack_colors(take(&mut bytes)?, pixels)?;
        planes.iter_mut().skip(layer).step_by(count).zip(colors).for_each(|(place, color)| *place = color);
    }
    let masks = (0..if kept.masks { MASKS } else { 0 }).map(|_| mask(&mut bytes, pixels)).collect::<Option<_>>()?;
    Some((Extras { planes, masks }, bytes))
}

fn mask(bytes: &mut &[u8], pixels: usize) -> Option<Mask> {
    let entries = number(bytes)? as usize;
    if entries > pixels.saturating_mul(MOST_THINGS) {
        return None;
    }
    let packed = take(bytes)?;
    // LZ4 makes no more than 255 bytes of one: what is claimed beyond that is not made room for.
    let length = (pixels + 2 * entries).checked_mul(4).filter(|length| *length <= packed.len().saturating_mul(256))?;
    let plain = lz4_flex::block::decompress(packed, length).ok().filter(|plain| plain.len() == length)?;
    let mut numbers = plain.as_chunks().0.iter().map(|four| u32::from_le_bytes(*four));
    let ends: Vec<u32> = numbers.by_ref().take(pixels).collect();
    let rest: Vec<u32> = numbers.collect();
    Mask::new(ends, rest.as_chunks().0.iter().map(|[thing, sum]| (*thing, f32::from_bits(*sum))).collect()).ok()
}

fn number(bytes: &mut &[u8]) -> Option<u32> {
    let (four, rest) = bytes.split_first_chunk()?;
    *bytes = rest;
    Some(u32::from_le_bytes(*four))
}

fn take<'b>(bytes: &mut &'b [u8]) -> Option<&'b [u8]> {
    let length = number(bytes)? as usize;
    let (taken, rest) = bytes.split_at_checked(length)?;
    *bytes = rest;
    Some(taken)
}
