//! Samples of images in memory, one to four per texel.

use super::half;

/// Largest finite half-precision float.
const LARGEST_HALF: f32 = 65_504.0;

/// Samples of one image, in the smallest type that holds them exactly.
#[derive(Clone, Debug, PartialEq)]
pub enum Texels {
    /// Levels of 8 bits, which [`DecodingTable`] decodes to linear light.
    Bytes(Vec<u8>),
    /// Half-precision floats, with 11 bits of precision.
    Halves(Vec<u16>),
    /// Single-precision floats.
    Floats(Vec<f32>),
}

impl Texels {
    /// Stores numbers as halves if that loses nothing, otherwise as floats. NaN becomes 0,
    /// infinity the largest finite half, and all others are clamped to ±1e30.
    pub fn from_floats(mut numbers: Vec<f32>) -> Self {
        for number in &mut numbers {
            *number = match *number {
                number if number.is_nan() => 0.0,
                number if number.is_infinite() => LARGEST_HALF.copysign(number),
                number => number.clamp(-1e30, 1e30),
            };
        }
        let is_half = |number: &f32| half::to_f32(half::from_f32(*number)).to_bits() == number.to_bits();
        if numbers.iter().all(is_half) {
            return Self::Halves(numbers.iter().map(|number| half::from_f32(*number)).collect());
        }
        Self::Floats(numbers)
    }

    /// As many zeros of the same type.
    pub fn zeros(&self, count: usize) -> Self {
        match self {
            Self::Bytes(_) => Self::Bytes(vec![0; count]),
            Self::Halves(_) => Self::Halves(vec![0; count]),
            Self::Floats(_) => Self::Floats(vec![0.0; count]),
        }
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        match self {
            Self::Bytes(samples) => samples.len(),
            Self::Halves(samples) => samples.len(),
            Self::Floats(samples) => samples.len(),
        }
    }

    /// Size on the heap in bytes.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Bytes(samples) => samples.len(),
            Self::Halves(samples) => samples.len() * 2,
            Self::Floats(samples) => samples.len() * 4,
        }
    }
}

/// Decoding table of the 256 levels of a byte.
#[derive(Clone, Debug, PartialEq)]
pub struct DecodingTable {
    /// Linear light of each level, in rising order.
    color: [f32; 256],
}

impl DecodingTable {
    /// Table of `decode`, which maps an encoded value from 0 to 1 to linear light and must be
    /// monotonic.
    pub fn new(decode: impl Fn(f64) -> f64) -> Self {
        Self { color: std::array::from_fn(|level| decode(level as f64 / 255.0) as f32) }
    }

    /// Linear light of a level.
    #[inline]
    pub fn light(&self, level: u8) -> f32 {
        self.color[usize::from(level)]
    }

    /// Level whose light is nearest to `light`.
    pub fn nearest(&self, light: f32) -> u8 {
        let above = self.color.partition_point(|entry| *entry < light).min(255);
        let below = above.saturating_sub(1);
        let closer = light - self.color[below] < self.color[above] - light;
        (if closer { below } else { above }) as u8
    }
}

/// Alpha of a level, which is linear.
#[inline]
pub fn alpha_from_level(level: u8) -> f32 {
    f32::from(level) / 255.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::color::srgb_decode_f64;

    #[test]
    fn levels_round_trip_and_other_values_round_to_the_nearest_level() {
        for table in [DecodingTable::new(srgb_decode_f64), DecodingTable::new(|level| level)] {
            for level in 0..=255u8 {
                assert_eq!(table.nearest(table.light(level)), level);
            }
            for i in -10..1010 {
                let light = i as f32 / 1000.0;
                let off = |level: u8| (table.light(level) - light).abs();
                let best = (0..=255u8).map(off).fold(f32::MAX, f32::min);
                assert_eq!(off(table.nearest(light)), best, "{light}");
            }
        }
    }

    #[test]
    fn texels_use_the_smallest_sufficient_type() {
        assert_eq!(
            Texels::from_floats(vec![1.0, -0.5, 65_504.0, f32::NAN]),
            Texels::Halves(vec![0x3c00, 0xb800, 0x7bff, 0])
        );
        assert_eq!(Texels::from_floats(vec![1.0, 0.1]), Texels::Floats(vec![1.0, 0.1]));
        // Halves of infinity are the largest finite ones.
        assert_eq!(Texels::from_floats(vec![f32::INFINITY, -f32::INFINITY]), Texels::Halves(vec![0x7bff, 0xfbff]));
        assert_eq!(Texels::from_floats(vec![f32::MAX, f32::INFINITY]), Texels::Floats(vec![1e30, 65_504.0]));
        assert_eq!((Texels::Halves(vec![0; 3]).bytes(), Texels::Floats(vec![0.0; 3]).bytes()), (6, 12));
    }
}
