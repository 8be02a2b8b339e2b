//! Linear RGB (primaries and white of sRGB) and the sRGB curve.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Sub};

/// Linear light in three channels; scene-referred, so values above 1 are ordinary.
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
    /// No light.
    pub const BLACK: Self = Self::splat(0.0);
    /// One in every channel.
    pub const WHITE: Self = Self::splat(1.0);

    /// From channels.
    pub const fn new(r: f32, g: f32, b: f32) -> Self {
        Self { r, g, b }
    }

    /// The same value in each channel.
    pub const fn splat(v: f32) -> Self {
        Self { r: v, g: v, b: v }
    }

    /// Channels in order.
    pub const fn to_array(self) -> [f32; 3] {
        [self.r, self.g, self.b]
    }

    /// Relative luminance (ITU-R BT.709).
    pub fn luminance(self) -> f32 {
        0.2126 * self.r + 0.7152 * self.g + 0.0722 * self.b
    }

    /// The largest channel.
    pub fn max_channel(self) -> f32 {
        self.r.max(self.g).max(self.b)
    }

    /// Whether every channel is exactly zero.
    pub fn is_black(self) -> bool {
        self == Self::BLACK
    }

    /// Whether no channel is NaN or infinite.
    pub fn is_finite(self) -> bool {
        self.r.is_finite() && self.g.is_finite() && self.b.is_finite()
    }

    /// From `self` at 0 to `other` at 1.
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
        self * (1.0 / s)
    }
}

/// Linear value → sRGB-encoded value, both 0..1 (IEC 61966-2-1); values outside are clamped.
pub fn srgb_encode(linear: f32) -> f32 {
    let v = linear.clamp(0.0, 1.0);
    if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * crate::fun::powf(v, 1.0 / 2.4) - 0.055 }
}

/// sRGB-encoded value → linear value, both 0..1; values outside are clamped.
pub fn srgb_decode(encoded: f32) -> f32 {
    let v = encoded.clamp(0.0, 1.0);
    if v <= 0.040_45 { v / 12.92 } else { crate::fun::powf((v + 0.055) / 1.055, 2.4) }
}

/// How a colour is written: `[r, g, b]` in linear light, `"#rrggbb"` in sRGB, or one number for a grey.
#[derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "Color")]
enum Written {
    /// Linear red, green, blue; 0 to 1 for reflectances, any size for light.
    Channels([f32; 3]),
    /// The same value in all three channels.
    Grey(f32),
    /// sRGB as `#rrggbb`.
    Hex(#[schemars(regex(pattern = r"^#[0-9a-fA-F]{6}$"))] String),
}

impl serde::Serialize for Rgb {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.to_array().serialize(serializer)
    }
}

impl<'de> serde::Deserialize<'de> for Rgb {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match Written::deserialize(deserializer)? {
            Written::Channels(channels) => Ok(channels.into()),
            Written::Grey(v) => Ok(Self::splat(v)),
            Written::Hex(text) => {
                Self::from_hex(&text).ok_or_else(|| serde::de::Error::custom("a colour is written `#rrggbb`"))
            }
        }
    }
}

impl schemars::JsonSchema for Rgb {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Color".into()
    }
    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        Written::json_schema(generator)
    }
}

impl Rgb {
    /// From `#rrggbb` in sRGB; `None` for any other text.
    pub fn from_hex(text: &str) -> Option<Self> {
        let digits = text.strip_prefix('#').filter(|d| d.len() == 6 && d.is_ascii())?;
        let value = u32::from_str_radix(digits, 16).ok()?;
        let channel = |shift: u32| srgb_decode((value >> shift & 0xff) as f32 / 255.0);
        Some(Self::new(channel(16), channel(8), channel(0)))
    }
}
