//! Packing the sums of a run: differences between neighbours, cut into planes of bits, through LZ4.
//!
//! The bits of a float that is not negative rise with it, so the difference between the bits of two pixels side by
//! side is small where the picture is smooth, and its upper bits are zeros. The lower bits of a total are zeros as long
//! as few blocks are summed in it. What is left in between is noise. Planes of bits (all lowest bits, then all second
//! ones, ...) part them cleanly, so that even a compressor without an entropy coder finds what is to be found (the
//! idea of Masui and others, "A compression scheme for radio data in high performance computing", 2015). Planes of
//! bytes and slower compressors were measured too: docs/benchmarks.md.

use juggler_camera::film::Sum;
use juggler_math::Rgb;

/// Channels of a sum.
const CHANNELS: usize = 3;
/// Bits of a total.
const TOTAL: usize = 64;
/// Bits of a spread, and of what clamping took.
const SINGLE: usize = 32;

/// The packed sums of some pixels, with what clamping took off them or without.
pub(super) fn pack(sums: &[Sum], clamped: bool) -> Vec<u8> {
    let plane = plane(sums.len());
    let mut planes = vec![0; plane * bits(clamped)];
    let (totals, rest) = planes.split_at_mut(plane * TOTAL);
    let (spreads, taken) = rest.split_at_mut(plane * SINGLE);
    let count = sums.len();
    to_planes(differences(count, TOTAL, |pixel, channel| sums[pixel].total[channel].to_bits()), totals);
    to_planes(differences(count, SINGLE, |pixel, channel| sums[pixel].spread[channel].to_bits().into()), spreads);
    if clamped {
        // Of one channel only: the others' places stay empty.
        let first = |pixel: usize, channel| if channel == 0 { sums[pixel].clamped.to_bits().into() } else { 0 };
        to_planes(differences(count, SINGLE, first), taken);
    }
    lz4_flex::block::compress(&planes)
}

/// Bits of a channel of a pixel.
fn bits(clamped: bool) -> usize {
    TOTAL + if clamped { 2 * SINGLE } else { SINGLE }
}

/// The sums of so many pixels, packed with what clamping took off them or without; `None` when the bytes hold something
/// else.
pub(super) fn unpack(packed: &[u8], pixels: usize, clamped: bool) -> Option<Vec<Sum>> {
    let plane = plane(pixels);
    let mut planes = vec![0; plane * bits(clamped)];
    let length = lz4_flex::block::decompress_into(packed, &mut planes).ok()?;
    if length != planes.len() {
        return None;
    }
    let (totals, rest) = planes.split_at(plane * TOTAL);
    let (spreads, taken) = rest.split_at(plane * SINGLE);
    let mut sums = vec![Sum::default(); pixels];
    restore(&mut sums, &from_planes(totals, plane), |sum, channel, bits| sum.total[channel] = f64::from_bits(bits));
    // Only 32 planes were there: what the additions carry beyond is cut off.
    restore(&mut sums, &from_planes(spreads, plane), |sum, channel, bits| {
        sum.spread[channel] = f32::from_bits(bits as u32);
    });
    if clamped {
        restore(&mut sums, &from_planes(taken, plane), |sum, channel, bits| {
            if channel == 0 {
                sum.clamped = f32::from_bits(bits as u32);
            }
        });
    }
    Some(sums)
}

/// Bytes of a plane: values go into planes by 64, a word of each plane.
fn plane(pixels: usize) -> usize {
    (pixels * CHANNELS).div_ceil(64) * 8
}

/// One colour of each of some pixels, packed.
pub(super) fn pack_colors(colors: &[Rgb]) -> Vec<u8> {
    let mut planes = vec![0; plane(colors.len()) * SINGLE];
    let bits = |pixel: usize, channel: usize| colors[pixel].to_array()[channel].to_bits().into();
    to_planes(differences(colors.len(), SINGLE, bits), &mut planes);
    lz4_flex::block::compress(&planes)
}

/// The way back from [`pack_colors`] for so many pixels; `None` when the bytes hold something else.
pub(super) fn unpack_colors(packed: &[u8], pixels: usize) -> Option<Vec<Rgb>> {
    let plane = plane(pixels);
    let mut planes = vec![0; plane * SINGLE];
    let length = lz4_flex::block::decompress_into(packed, &mut planes).ok()?;
    if length != planes.len() {
        return None;
    }
    let mut colors = vec![[0.0; CHANNELS]; pixels];
    restore(&mut colors, &from_planes(&planes, plane), |color, channel, bits| {
        color[channel] = f32::from_bits(bits as u32);
    });
    Some(colors.into_iter().map(Rgb::from).collect())
}

/// Channel after channel, each pixel's bits less those of the pixel before: 0, -1, 1, -2, ... as 0, 1, 2, 3, ...
fn differences(count: usize, width: usize, bits: impl Fn(usize, usize) -> u64) -> Vec<u64> {
    let unused = 64 - width;
    let values = plane(count) * 8;
    let mut differences = Vec::with_capacity(values);
    for channel in 0..CHANNELS {
        let mut previous = 0;
        differences.extend((0..count).map(|pixel| {
            let bits = bits(pixel, channel);
            let difference = (bits.wrapping_sub(previous) << unused).cast_signed() >> unused;
            previous = bits;
            ((difference << 1) ^ (difference >> 63)).cast_unsigned()
        }));
    }
    differences.resize(values, 0);
    differences
}

/// The way back from [`differences`].
fn restore<T>(sums: &mut [T], differences: &[u64], put: impl Fn(&mut T, usize, u64)) {
    for (channel, differences) in differences.chunks(sums.len().max(1)).take(CHANNELS).enumerate() {
        let mut bits = 0u64;
        for (sum, value) in sums.iter_mut().zip(differences) {
            bits = bits.wrapping_add((value >> 1) ^ (value & 1).wrapping_neg());
            put(sum, channel, bits);
        }
    }
}

/// Bit b of value v goes to bit v % 8 of byte v / 8 of plane b.
fn to_planes(mut values: Vec<u64>, planes: &mut [u8]) {
    let plane = values.len() / 8;
    for (at, words) in values.as_chunks_mut().0.iter_mut().enumerate() {
        transpose(words);
        for (plane, word) in planes.chunks_exact_mut(plane).zip(words) {
            plane.as_chunks_mut().0[at] = word.to_le_bytes();
        }
    }
}

/// The way back from [`to_planes`].
fn from_planes(planes: &[u8], plane: usize) -> Vec<u64> {
    let mut values = vec![0; plane * 8];
    for (at, values) in values.as_chunks_mut().0.iter_mut().enumerate() {
        for (word, plane) in values.iter_mut().zip(planes.chunks_exact(plane)) {
            *word = u64::from_le_bytes(plane.as_chunks().0[at]);
        }
        transpose(values);
    }
    values
}

/// Mirrors a matrix of 64 × 64 bits at its diagonal: first its quarters change places, then theirs, and so on
/// (Warren, Hacker's Delight, 2nd edition 2012, section 7-3).
fn transpose(matrix: &mut [u64; 64]) {
    let (mut size, mut mask) = (32, u64::from(u32::MAX));
    while size > 0 {
        for rows in matrix.chunks_exact_mut(2 * size) {
            let (upper, lower) = rows.split_at_mut(size);
            for (a, b) in upper.iter_mut().zip(lower) {
                let swapped = ((*a >> size) ^ *b) & mask;
                *a ^= swapped << size;
                *b ^= swapped;
            }
        }
        size /= 2;
        mask ^= mask << size;
    }
}
