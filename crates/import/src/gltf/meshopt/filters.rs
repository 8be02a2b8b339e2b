//! Filters of decoded attributes (appendix B of the extension's README).
//!
//! An encoder chooses the precision per element: values are integers of K bits, and one component
//! carries K. Elements that break the rules of their filter give unspecified numbers, but never an
//! error.

use super::Filter;

/// Applies a filter to elements of `stride` bytes, in place. The stride fits the filter.
pub(super) fn apply(filter: Filter, stride: usize, bytes: &mut [u8]) {
    match (filter, stride) {
        (Filter::None, _) => {}
        (Filter::Octahedral, 4) => map_bytes(bytes, |[x, y, one, rest]| {
            let [x, y, z] = octahedral([x, y, one].map(|byte| f32::from(byte as i8)), 127.0);
            [x as i8 as u8, y as i8 as u8, z as i8 as u8, rest]
        }),
        (Filter::Octahedral, _) => map_words(bytes, |[x, y, one, rest]| {
            let [x, y, z] = octahedral([x, y, one].map(|word| f32::from(word as i16)), 32767.0);
            [x as i16 as u16, y as i16 as u16, z as i16 as u16, rest]
        }),
        (Filter::Quaternion, _) => map_words(bytes, quaternion),
        (Filter::Exponential, _) => {
            for bytes in bytes.as_chunks_mut().0 {
                *bytes = exponential(i32::from_le_bytes(*bytes)).to_le_bytes();
            }
        }
        (Filter::Color, 4) => map_bytes(bytes, |[y, co, cg, alpha]| {
            let [co, cg] = [co, cg].map(|byte| i32::from(byte as i8));
            color(i32::from(y), co, cg, u32::from(alpha), 255.0).map(|channel| channel as u8)
        }),
        (Filter::Color, _) => map_words(bytes, |[y, co, cg, alpha]| {
            let [co, cg] = [co, cg].map(|word| i32::from(word as i16));
            color(i32::from(y), co, cg, u32::from(alpha), 65535.0).map(|channel| channel as u16)
        }),
    }
}

/// Replaces each element of four bytes.
fn map_bytes(bytes: &mut [u8], convert: impl Fn([u8; 4]) -> [u8; 4]) {
    for element in bytes.as_chunks_mut().0 {
        *element = convert(*element);
    }
}

/// Replaces each element of four 16-bit integers.
fn map_words(bytes: &mut [u8], convert: impl Fn([u16; 4]) -> [u16; 4]) {
    for element in bytes.as_chunks_mut::<8>().0 {
        let mut words = [0; 4];
        for (word, bytes) in words.iter_mut().zip(element.as_chunks().0) {
            *word = u16::from_le_bytes(*bytes);
        }
        for (bytes, word) in element.as_chunks_mut().0.iter_mut().zip(convert(words)) {
            *bytes = word.to_le_bytes();
        }
    }
}

/// Unit vector of octahedral coordinates (x, y), scaled to `max` and rounded. `one` is the integer
/// that stands for 1.
fn octahedral([x, y, one]: [f32; 3], max: f32) -> [f32; 3] {
    let z = one - x.abs() - y.abs();
    // Fold the lower hemisphere back: points with z < 0 lie outside of |x| + |y| = 1.
    let fold = z.min(0.0);
    let x = x + if x < 0.0 { -fold } else { fold };
    let y = y + if y < 0.0 { -fold } else { fold };
    let scale = max / (x * x + (y * y + z * z)).sqrt();
    [x, y, z].map(|component| (component * scale).round_ties_even())
}

/// Unit quaternion of its three smaller components, which are scaled by √2. The fourth word has the
/// integer that stands for 1, with the number of the largest component in its lowest two bits.
fn quaternion([x, y, z, code]: [u16; 4]) -> [u16; 4] {
    let one = f32::from((code | 3) as i16);
    let scale = 32767.0 / std::f32::consts::SQRT_2 / one;
    let [x, y, z] = [x, y, z].map(|word| f32::from(word as i16));
    // The squares of all four components add to 1, which is 2 · one² on the scale of the integers.
    let w = (2.0 * one * one - (x * x + (y * y + z * z))).max(0.0).sqrt();
    let mut words = [w, x, y, z].map(|component| (component * scale).round_ties_even() as i16 as u16);
    words.rotate_right(usize::from(code & 3));
    words
}

/// The number m · 2^e of a mantissa m in the lower 24 bits and an exponent e in the upper 8 bits,
/// both signed.
fn exponential(code: i32) -> f32 {
    let exponent = code >> 24;
    let mantissa = (code << 8) >> 8;
    // The exponents -127 and -128 give subnormal powers.
    let power = match exponent {
        -128 => 1 << 21,
        -127 => 1 << 22,
        normal => ((normal + 127) as u32) << 23,
    };
    f32::from_bits(power) * mantissa as f32
}

/// Color channels red, green, blue and alpha in 0..=`max`. The highest bit of `alpha` that is set
/// marks the number of bits.
fn color(y: i32, co: i32, cg: i32, alpha: u32, max: f32) -> [f32; 4] {
    // The largest integer of K bits, where bit K - 1 is the marker.
    let largest = u32::MAX.checked_shr(alpha.leading_zeros()).unwrap_or(0);
    // Alpha has one bit less than the other channels; repeat its last bit.
    let alpha = ((alpha << 1) & largest) | (alpha & 1);
    let scale = max / largest as f32;
    let channels = [y + co - cg, y + cg, y - co - cg, alpha as i32];
    channels.map(|channel| (channel as f32 * scale).round_ties_even())
}
