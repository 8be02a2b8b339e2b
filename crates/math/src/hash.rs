//! Counter-based randomness: a number is a pure function of its address.

/// Mixes 32 bits so that each input bit reaches every output bit (the `lowbias32` constants of Chris
/// Wellons' hash-prospector search, 2018).
pub const fn mix(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x7feb_352d);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

/// A hash of a pair that depends on the order.
pub const fn combine(a: u32, b: u32) -> u32 {
    mix(a ^ mix(b.wrapping_add(0x9e37_79b9)).wrapping_add(a << 6))
}

/// 24 random bits as a float in [0, 1).
pub fn unit_f32(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / 16_777_216.0)
}
