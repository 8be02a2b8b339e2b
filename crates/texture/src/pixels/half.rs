//! Half-precision floats (IEEE 754 binary16): 11 bits of precision, up to 65,504.

/// Value of a half-precision float.
#[inline]
pub fn to_f32(half: u16) -> f32 {
    let sign = u32::from(half & 0x8000) << 16;
    let (exponent, mantissa) = (u32::from(half >> 10 & 31), u32::from(half & 0x3ff));
    match exponent {
        // Subnormal: a whole number of 2^-24.
        0 => f32::from_bits((mantissa as f32 * (1.0 / 16_777_216.0)).to_bits() | sign),
        31 => f32::from_bits(sign | 0x7f80_0000 | mantissa << 13),
        _ => f32::from_bits(sign | (exponent + 112) << 23 | mantissa << 13),
    }
}

/// Nearest half-precision float, ties to even. Larger numbers saturate.
pub fn from_f32(value: f32) -> u16 {
    let sign = (value.to_bits() >> 16 & 0x8000) as u16;
    let size = value.abs().min(65_504.0);
    let bits = if size < 6.103_515_6e-5 {
        // Adding 1/2 rounds to multiples of 2^-24, the spacing of floats there.
        ((size + 0.5).to_bits() - 0.5f32.to_bits()) as u16
    } else {
        let bits = size.to_bits() - (112 << 23);
        ((bits + 0xfff + (bits >> 13 & 1)) >> 13) as u16
    };
    sign | bits
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::Random;

    #[test]
    fn all_half_floats_round_trip() {
        for half in (0..=u16::MAX).filter(|half| half >> 10 & 31 != 31) {
            assert_eq!(from_f32(to_f32(half)), half, "{half:#x} {}", to_f32(half));
        }
        assert_eq!((to_f32(0x3c00), to_f32(0x3555), to_f32(0xc000)), (1.0, 0.333_251_95, -2.0));
        assert_eq!((to_f32(1), to_f32(0x7bff)), (5.960_464_5e-8, 65_504.0));
    }

    #[test]
    fn floats_are_rounded_to_the_nearest_half() {
        let mut random = Random::new(730);
        for _ in 0..20_000 {
            let value = random.range(-2.0, 2.0) * [1e-7, 1e-4, 1.0, 1e4][random.below(4)];
            let half = from_f32(value);
            let near = (to_f32(half) - value).abs();
            for other in [half.wrapping_sub(1), half.wrapping_add(1)].into_iter().filter(|h| h >> 10 & 31 != 31) {
                let closer = (to_f32(other) - value).abs() < near;
                assert!(!closer || to_f32(other) * value < 0.0, "{value}");
            }
        }
        assert_eq!((from_f32(1e9), from_f32(-1e9)), (0x7bff, 0xfbff));
    }
}
