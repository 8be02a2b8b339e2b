//! Packing the sums of a run: differences between neighbours, cut into planes of bits, through LZ4.
//!
//! The bits of a float that is not negative rise with it, so the difference between the bits of two pixels side by
//! side is small where the picture is smooth, and its upper bits are zeros. The lower bits of a total are zeros as long
//! as few blocks are summed in it. What is left in between is noise. Planes of bits (all lowest bits, then all second
//! ones, ...) part them cleanly, so that even a compressor without an entropy coder finds what is to be found (the
//! idea of Masui and others, "A compression scheme for radio data in high performance computing", 2015). Planes of
//! bytes and slower compressors were measured too: docs/benchmarks.md.

use juggler_tracer::film::Sum;

/// Channels of a sum.
const CHANNELS: usize = 3;
/// Bits of a total.
const TOTAL: usize = 64;
/// Bits of a spread.
const SPREAD: usize = 32;

/// The packed sums of some pixels.
pub(super) fn pack(sums: &[Sum]) -> Vec<u8> {
    let groups = groups(sums.len());
    let mut planes = vec![0; groups * (TOTAL + SPREAD)];
    let (totals, spreads) = planes.split_at_mut(groups * TOTAL);
    to_planes(&differences(sums, TOTAL, |sum, channel| sum.total[channel].to_bits()), totals);
    to_planes(&differences(sums, SPREAD, |sum, channel| sum.spread[channel].to_bits().into()), spreads);
    lz4_flex::block::compress(&planes)
}

/// The sums of so many pixels; `None` when the bytes hold something else.
pub(super) fn unpack(packed: &[u8], pixels: usize) -> Option<Vec<Sum>> {
    let groups = groups(pixels);
    let mut planes = vec![0; groups * (TOTAL + SPREAD)];
    let length = lz4_flex::block::decompress_into(packed, &mut planes).ok()?;
    if length != planes.len() {
        return None;
    }
    let (totals, spreads) = planes.split_at(groups * TOTAL);
    let mut sums = vec![Sum::default(); pixels];
    restore(&mut sums, &from_planes(totals, groups), |sum, channel, bits| sum.total[channel] = f64::from_bits(bits));
    // Only 32 planes were there: what the additions carry beyond is cut off.
    restore(&mut sums, &from_planes(spreads, groups), |sum, channel, bits| {
        sum.spread[channel] = f32::from_bits(bits as u32);
    });
    Some(sums)
}

/// Values go into planes by eight, a byte of each plane.
fn groups(pixels: usize) -> usize {
    (pixels * CHANNELS).div_ceil(8)
}

/// Channel after channel, each pixel's bits less those of the pixel before: 0, -1, 1, -2, ... as 0, 1, 2, 3, ...
fn differences(sums: &[Sum], width: usize, bits: impl Fn(&Sum, usize) -> u64) -> Vec<u64> {
    let unused = 64 - width;
    let mut values = Vec::with_capacity(groups(sums.len()) * 8);
    for channel in 0..CHANNELS {
        let mut previous = 0;
        for sum in sums {
            let bits = bits(sum, channel);
            let difference = (bits.wrapping_sub(previous) << unused).cast_signed() >> unused;
            values.push(((difference << 1) ^ (difference >> 63)).cast_unsigned());
            previous = bits;
        }
    }
    values.resize(groups(sums.len()) * 8, 0);
    values
}

/// The way back from [`differences`].
fn restore(sums: &mut [Sum], differences: &[u64], put: impl Fn(&mut Sum, usize, u64)) {
    let mut differences = differences.iter();
    for channel in 0..CHANNELS {
        let mut bits = 0u64;
        // The slice first: a zip that ends with it takes no difference too many.
        for (sum, value) in sums.iter_mut().zip(&mut differences) {
            bits = bits.wrapping_add((value >> 1) ^ (value & 1).wrapping_neg());
            put(sum, channel, bits);
        }
    }
}

/// Bit b of value v goes to bit v % 8 of byte v / 8 of plane b.
fn to_planes(values: &[u64], planes: &mut [u8]) {
    let groups = values.len() / 8;
    for (group, values) in values.as_chunks::<8>().0.iter().enumerate() {
        let bytes = values.map(u64::to_le_bytes);
        for (byte, planes) in planes.chunks_exact_mut(groups * 8).enumerate() {
            let rows = transposed(u64::from_le_bytes(bytes.map(|bytes| bytes[byte]))).to_le_bytes();
            for (plane, row) in planes.chunks_exact_mut(groups).zip(rows) {
                plane[group] = row;
            }
        }
    }
}

/// The way back from [`to_planes`].
fn from_planes(planes: &[u8], groups: usize) -> Vec<u64> {
    let mut values = Vec::with_capacity(groups * 8);
    for group in 0..groups {
        let mut bytes = [[0; 8]; 8];
        for (byte, planes) in planes.chunks_exact(groups * 8).enumerate() {
            let mut rows = [0; 8];
            rows.iter_mut().zip(planes.chunks_exact(groups)).for_each(|(row, plane)| *row = plane[group]);
            let columns = transposed(u64::from_le_bytes(rows)).to_le_bytes();
            bytes.iter_mut().zip(columns).for_each(|(value, column)| value[byte] = column);
        }
        values.extend(bytes.map(u64::from_le_bytes));
    }
    values
}

/// A matrix of 8 × 8 bits, mirrored at its diagonal (Warren, Hacker's Delight, 2nd edition 2012, section 7-3).
fn transposed(mut x: u64) -> u64 {
    for (shift, mask) in [(7, 0x00aa_00aa_00aa_00aa), (14, 0x0000_cccc_0000_cccc), (28, 0x0000_0000_f0f0_f0f0)] {
        let swapped = (x ^ (x >> shift)) & mask;
        x ^= swapped ^ (swapped << shift);
    }
    x
}
