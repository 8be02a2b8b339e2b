//! Linear RGB with the primaries and white point of sRGB, and the sRGB transfer function.

mod css;
mod json;

pub use css::{color_names, hex_of_name};

use crate::portable;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Sub};

/// Linear RGB color with sRGB primaries. Scene-referred: channels may exceed 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rgb {
    /// Red.
    pub r: f32,
    /// Green.
    pub g: f32,
    /// Blue.
    pub b: f32,
}

impl Rgb {
    /// Zero in every channel.
    pub const BLACK: Self = Self::splat(0.0);
    /// One in every channel.
    pub const WHITE: Self = Self::splat(1.0);

    /// Constructs a color from its channels.
    pub const fn new(r: f32, g: f32, b: f32) -> Self {
        Self { r, g, b }
    }

    /// Constructs a gray with `v` in every channel.
    pub const fn splat(v: f32) -> Self {
        Self { r: v, g: v, b: v }
    }

    /// Channels in the order red, green, blue.
    pub const fn to_array(self) -> [f32; 3] {
        [self.r, self.g, self.b]
    }

    /// Relative luminance (ITU-R BT.709).
    pub fn luminance(self) -> f32 {
        0.2126 * self.r + 0.7152 * self.g + 0.0722 * self.b
    }

    /// Largest of the three channels.
    pub fn max_channel(self) -> f32 {
        self.r.max(self.g).max(self.b)
    }

    /// Whether every channel is exactly zero.
    #[inline]
    pub fn is_black(self) -> bool {
        (self.r.to_bits() | self.g.to_bits() | self.b.to_bits()) << 1 == 0
    }

    /// Whether no channel is NaN or infinite.
    #[inline]
    pub fn is_finite(self) -> bool {
        // Zero times a finite number is zero; times infinity or NaN it is NaN, and so is the sum.
        self.r * 0.0 + self.g * 0.0 + self.b * 0.0 == 0.0
    }

    /// Interpolates linearly: `self` at `t = 0`, `other` at `t = 1`.
    pub fn lerp(self, other: Self, t: f32) -> Self {
        self + (other - self) * t
    }

    /// Applies `f` to each channel.
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        Self::new(f(self.r), f(self.g), f(self.b))
    }
}

impl From<[f32; 3]> for Rgb {
    fn from([r, g, b]: [f32; 3]) -> Self {
        Self { r, g, b }
    }
}

impl Add for Rgb {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self::new(self.r + o.r, self.g + o.g, self.b + o.b)
    }
}

impl AddAssign for Rgb {
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl Sub for Rgb {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self::new(self.r - o.r, self.g - o.g, self.b - o.b)
    }
}

impl Mul for Rgb {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self::new(self.r * o.r, self.g * o.g, self.b * o.b)
    }
}

impl MulAssign for Rgb {
    fn mul_assign(&mut self, o: Self) {
        *self = *self * o;
    }
}

impl Mul<f32> for Rgb {
    type Output = Self;
    fn mul(self, s: f32) -> Self {
        Self::new(self.r * s, self.g * s, self.b * s)
    }
}

impl Div<f32> for Rgb {
    type Output = Self;
    fn div(self, s: f32) -> Self {
        Self::new(self.r / s, self.g / s, self.b / s)
    }
}

/// Encodes a linear value with the sRGB transfer function (IEC 61966-2-1). Domain and range are 0
/// to 1; the argument is clamped.
pub fn srgb_encode(linear: f32) -> f32 {
    srgb_encode_f64(f64::from(linear)) as f32
}

/// Decodes an sRGB-encoded value to linear. Domain and range are 0 to 1; the argument is clamped.
pub fn srgb_decode(encoded: f32) -> f32 {
    srgb_decode_f64(f64::from(encoded)) as f32
}

/// [`srgb_encode`] in double precision.
pub fn srgb_encode_f64(linear: f64) -> f64 {
    let v = linear.clamp(0.0, 1.0);
    if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * portable::pow_f64(v, 1.0 / 2.4) - 0.055 }
}

/// [`srgb_decode`] in double precision.
pub fn srgb_decode_f64(encoded: f64) -> f64 {
    let v = encoded.clamp(0.0, 1.0);
    if v <= 0.040_45 { v / 12.92 } else { portable::pow_f64((v + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_agrees_with_the_standard() {
        // Reference values: the formula of IEC 61966-2-1 evaluated with 50 digits.
        for (encoded, linear) in [
            (10.0 / 255.0, 0.003_035_27),
            (11.0 / 255.0, 0.003_346_536),
            (0.5, 0.214_041_14),
            (128.0 / 255.0, 0.215_860_5),
            (1.0, 1.0),
        ] {
            assert!((srgb_decode(encoded) - linear).abs() < 1e-7, "{encoded}");
            assert!((srgb_encode(linear) - encoded).abs() < 1e-6, "{linear}");
        }
        assert!((srgb_encode(0.18) - 0.461_356_13).abs() < 1e-6);
        assert_eq!((srgb_encode(-1.0), srgb_encode(7.0), srgb_decode(-1.0), srgb_decode(7.0)), (0.0, 1.0, 0.0, 1.0));
    }

    #[test]
    fn all_eight_and_sixteen_bit_codes_survive_the_round_trip() {
        for limit in [255.0, 65_535.0] {
            for code in 0..=limit as u32 {
                let encoded = code as f32 / limit;
                assert_eq!((srgb_encode(srgb_decode(encoded)) * limit).round() as u32, code);
            }
        }
    }

    #[test]
    fn srgb_encoding_is_strictly_monotonic() {
        let mut last = -1.0;
        for i in 0..=100_000 {
            let v = srgb_encode(i as f32 * 1e-5);
            assert!(v > last, "{i}");
            last = v;
        }
    }

    #[test]
    fn color_arithmetic_is_per_channel_and_division_is_exact() {
        let (a, b) = (Rgb::new(0.5, 1.0, 2.0), Rgb::new(4.0, 0.25, 1.0));
        assert_eq!((a + b, a - b, a * b), ([4.5, 1.25, 3.0].into(), [-3.5, 0.75, 1.0].into(), [2.0, 0.25, 2.0].into()));
        assert_eq!(a.lerp(b, 0.5).to_array(), [2.25, 0.625, 1.5]);
        assert_eq!((a.max_channel(), Rgb::WHITE.luminance()), (2.0, 1.0));
        // The mean of n equal colors is that color.
        for n in 1..1000 {
            assert_eq!(Rgb::splat(n as f32 * 0.75) / n as f32, Rgb::splat(0.75));
        }
    }
}
