//! Compression of a run's sums: delta coding between adjacent pixels, transposition into bit
//! planes, LZ4.
//!
//! The bit pattern of a non-negative float grows with its value, so the difference between the bit
//! patterns of adjacent pixels has leading zeros where the image is smooth. The low bits of a total
//! are zero while few blocks are summed. The bits in between are noise. Bit planes (all lowest
//! bits, then all second-lowest bits, and so on) separate the three, so that even a compressor
//! without entropy coding removes the redundancy (bitshuffle: Masui et al., "A compression scheme
//! for radio data in high performance computing", 2015). docs/notes/partial-renders.md compares
//! byte planes and slower compressors.

use juggler_camera::film::Sum;
use juggler_math::Rgb;

/// Channels of a sum.
const CHANNELS: usize = 3;
/// Bits of a total.
const TOTAL: usize = 64;
/// Bits of a squared deviation and of a clamped value.
const SINGLE: usize = 32;

/// Compresses the sums, with the radiance removed by clamping if `clamped`.
pub(super) fn pack(sums: &[Sum], clamped: bool) -> Vec<u8> {
    let plane = plane_length(sums.len());
    let mut planes = vec![0; plane * bits(clamped)];
    let (totals, rest) = planes.split_at_mut(plane * TOTAL);
    let (deviations, clamped_planes) = rest.split_at_mut(plane * SINGLE);
    let count = sums.len();
    to_planes(differences(count, TOTAL, |pixel, channel| sums[pixel].total[channel].to_bits()), totals);
    to_planes(
        differences(count, SINGLE, |pixel, channel| sums[pixel].squared_deviations[channel].to_bits().into()),
        deviations,
    );
    if clamped {
        // The clamped value is a scalar: store it as the first channel, zeros in the others.
        let first = |pixel: usize, channel| if channel == 0 { sums[pixel].clamped.to_bits().into() } else { 0 };
        to_planes(differences(count, SINGLE, first), clamped_planes);
    }
    lz4_flex::block::compress(&planes)
}

/// Bits per channel of a pixel.
fn bits(clamped: bool) -> usize {
    TOTAL + if clamped { 2 * SINGLE } else { SINGLE }
}

/// Decompresses the sums of `pixels` pixels; `None` if the bytes are malformed.
pub(super) fn unpack(packed: &[u8], pixels: usize, clamped: bool) -> Option<Vec<Sum>> {
    let plane = plane_length(pixels);
    let mut planes = vec![0; plane * bits(clamped)];
    let length = lz4_flex::block::decompress_into(packed, &mut planes).ok()?;
    if length != planes.len() {
        return None;
    }
    let (totals, rest) = planes.split_at(plane * TOTAL);
    let (deviations, clamped_planes) = rest.split_at(plane * SINGLE);
    let mut sums = vec![Sum::default(); pixels];
    restore(&mut sums, &from_planes(totals, plane), |sum, channel, bits| sum.total[channel] = f64::from_bits(bits));
    // Only 32 planes are stored: discard the carries of the additions.
    restore(&mut sums, &from_planes(deviations, plane), |sum, channel, bits| {
        sum.squared_deviations[channel] = f32::from_bits(bits as u32);
    });
    if clamped {
        restore(&mut sums, &from_planes(clamped_planes, plane), |sum, channel, bits| {
            if channel == 0 {
                sum.clamped = f32::from_bits(bits as u32);
            }
        });
    }
    Some(sums)
}

/// Length of a bit plane in bytes: values are transposed in groups of 64, one word per plane.
fn plane_length(pixels: usize) -> usize {
    (pixels * CHANNELS).div_ceil(64) * 8
}

/// Compresses one RGB value per pixel.
pub(super) fn pack_colors(colors: &[Rgb]) -> Vec<u8> {
    let mut planes = vec![0; plane_length(colors.len()) * SINGLE];
    let bits = |pixel: usize, channel: usize| colors[pixel].to_array()[channel].to_bits().into();
    to_planes(differences(colors.len(), SINGLE, bits), &mut planes);
    lz4_flex::block::compress(&planes)
}

/// Inverse of [`pack_colors`] for `pixels` pixels; `None` if the bytes are malformed.
pub(super) fn unpack_colors(packed: &[u8], pixels: usize) -> Option<Vec<Rgb>> {
    let plane = plane_length(pixels);
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

/// Differences between the bit patterns of adjacent pixels, channel by channel, in zigzag encoding:
/// 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
fn differences(count: usize, width: usize, bits: impl Fn(usize, usize) -> u64) -> Vec<u64> {
    let unused = 64 - width;
    let values = plane_length(count) * 8;
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

/// Inverse of [`differences`].
fn restore<T>(sums: &mut [T], differences: &[u64], put: impl Fn(&mut T, usize, u64)) {
    for (channel, differences) in differences.chunks(sums.len().max(1)).take(CHANNELS).enumerate() {
        let mut bits = 0u64;
        for (sum, value) in sums.iter_mut().zip(differences) {
            bits = bits.wrapping_add((value >> 1) ^ (value & 1).wrapping_neg());
            put(sum, channel, bits);
        }
    }
}

/// Transposes values into bit planes: bit b of value v becomes bit v % 8 of byte v / 8 of plane b.
fn to_planes(mut values: Vec<u64>, planes: &mut [u8]) {
    let plane = values.len() / 8;
    for (at, words) in values.as_chunks_mut().0.iter_mut().enumerate() {
        transpose(words);
        for (plane, word) in planes.chunks_exact_mut(plane).zip(words) {
            plane.as_chunks_mut().0[at] = word.to_le_bytes();
        }
    }
}

/// Inverse of [`to_planes`].
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

/// Transposes a 64 × 64 bit matrix by recursively swapping off-diagonal quadrants (Warren, Hacker's
/// Delight, 2nd edition 2012, section 7-3).
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
