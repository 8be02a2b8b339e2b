//! Image texture.
//!
//! ```json
//! {"image": {"file": "textures/wood.png", "scale": [2, 3, 1], "wrap": "mirror"}}
//! ```
//!
//! The image covers x and y of its pattern from 0 to 1, with its lower left corner at the origin.
//! Over (u, v), that is the unit square; in object and world space, the image is projected along z.

use super::CompiledTexture;
use super::mapping::CompiledMapping;
use super::pixels::{Filter, MipMap, Wrap};
use super::{
    InvalidTexture, Mapping, SharedTexture, Space, Texture, TextureError, TextureLookup, TextureResolver, TextureTable,
    check,
};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Image texture: PNG, JPEG, WebP, TIFF, TGA, BMP, GIF (the first frame), OpenEXR, Radiance HDR or PFM.
///
/// Pictures are turned by the orientation that their Exif data states. An OpenEXR file shows its
/// display window, black where it has no data; its picture is the channels R, G and B, a layer named
/// `Combined`, `beauty`, `rgba`, `rgb` or `color`, the channel Y, the only color layer, or the only
/// channel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Image {
    /// Path of the image file, relative to the scene file.
    pub file: String,
    /// Encoding of the image's values. Set it to `linear` for data that is not color, such as
    /// roughness, heights and normals.
    #[serde(default)]
    pub color_space: ColorSpace,
    /// Channels that the texture uses.
    #[serde(default)]
    pub channel: Channel,
    /// Inverts values to 1 - value, before `factor`.
    #[serde(default)]
    pub invert: bool,
    /// Factor on the values, -1e6 to 1e6.
    #[serde(default = "one")]
    #[schemars(range(min = -1e6, max = 1e6))]
    pub factor: f32,
    /// Continuation beyond the image's borders.
    #[serde(default)]
    pub wrap: Wrap,
    /// Continuation beyond the upper and lower border, where it differs from `wrap`.
    #[serde(default)]
    pub wrap_v: Option<Wrap>,
    /// Filter that interpolates and averages texels.
    #[serde(default)]
    pub filter: Filter,
    /// Placement of the pattern: coordinate space, scale, rotation and offset.
    #[serde(flatten)]
    pub mapping: Mapping,
}

/// Encoding of an image's values. Alpha is always linear.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ColorSpace {
    /// The file's own statement of transfer function and primaries, converted to linear sRGB;
    /// without it, sRGB for integers (PNG, JPEG, WebP, TIFF, TGA, BMP, GIF) and linear light for
    /// floats (EXR, HDR, PFM, TIFF of floats).
    #[default]
    Auto,
    /// Transfer function and primaries of sRGB, whatever the file states.
    Srgb,
    /// Linear light, or values that are not light.
    Linear,
}

/// Channels of an image that a texture uses. A single channel gives gray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Channel {
    /// Red, green and blue.
    #[default]
    Rgb,
    /// Red.
    R,
    /// Green.
    G,
    /// Blue.
    B,
    /// Alpha; 1 in images without alpha.
    A,
    /// Luminance of the color.
    Luminance,
}

fn one() -> f32 {
    1.0
}

impl Image {
    /// Image texture of a file, otherwise with defaults.
    pub fn new(file: impl Into<String>) -> Self {
        Self {
            file: file.into(),
            color_space: ColorSpace::Auto,
            channel: Channel::Rgb,
            invert: false,
            factor: 1.0,
            wrap: Wrap::Repeat,
            wrap_v: None,
            filter: Filter::Trilinear,
            mapping: Mapping::default(),
        }
    }
}

impl Texture for Image {
    fn check(&self) -> Result<(), InvalidTexture> {
        if self.file.is_empty() {
            return Err(InvalidTexture::new("file", "`file` must name a picture"));
        }
        check::in_range("factor", self.factor, -1e6, 1e6)?;
        self.mapping.check()
    }

    fn compile(&self, resolver: &mut TextureResolver<'_>) -> Result<SharedTexture, TextureError> {
        Ok(Arc::new(CompiledImage {
            pixels: resolver.image(self)?,
            channel: self.channel,
            invert: self.invert,
            factor: self.factor,
            wrap: [self.wrap, self.wrap_v.unwrap_or(self.wrap)],
            filter: self.filter,
            map: self.mapping.compile(Space::Uv),
        }))
    }

    fn space(&self) -> Option<Space> {
        Some(self.mapping.space_or(Space::Uv))
    }
}

/// An [`Image`] with its pixels.
#[derive(Clone, Debug)]
pub struct CompiledImage {
    pixels: Arc<MipMap>,
    channel: Channel,
    invert: bool,
    factor: f32,
    wrap: [Wrap; 2],
    filter: Filter,
    map: CompiledMapping,
}

impl CompiledTexture for CompiledImage {
    fn eval(&self, _textures: &TextureTable, at: &TextureLookup) -> Rgb {
        let pattern = self.map.filtered_point(at);
        // Rows of the image start at the top.
        let [r, g, b, a] =
            self.pixels.sample([pattern.point.x, 1.0 - pattern.point.y], pattern.width, self.wrap, self.filter);
        let color = match self.channel {
            Channel::Rgb => Rgb::new(r, g, b),
            Channel::R => Rgb::splat(r),
            Channel::G => Rgb::splat(g),
            Channel::B => Rgb::splat(b),
            Channel::A => Rgb::splat(a),
            Channel::Luminance => Rgb::splat(Rgb::new(r, g, b).luminance()),
        };
        color.map(|v| if self.invert { 1.0 - v } else { v } * self.factor)
    }

    fn pixels(&self) -> Option<&Arc<MipMap>> {
        Some(&self.pixels)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Image {
    /// Examples for the contract tests, which have an image of that name.
    pub fn examples() -> Vec<Self> {
        let other = Self { wrap_v: Some(Wrap::Black), channel: Channel::A, invert: true, ..Self::new("test") };
        let planar = Self { mapping: Mapping::in_space(Space::Local), filter: Filter::Bilinear, ..Self::new("test") };
        vec![Self::new("test"), other, planar]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::reader;
    use juggler_math::Vec2;

    fn read(more: &str, u: f32, v: f32) -> Rgb {
        let json = format!(r#"{{"image": {{"file": "test", "filter": "nearest"{more}}}}}"#);
        reader(&json)(&TextureLookup { uv: Vec2::new(u, v), ..TextureLookup::default() })
    }

    /// The test image, from the top: 0.1 0.2 | 0.3 0.4 in red; green is twice, blue 1 minus, alpha
    /// half of red.
    #[test]
    fn v_points_up_and_channels_are_chosen() {
        for (u, v, red) in [(0.2, 0.8, 0.1), (0.7, 0.8, 0.2), (0.2, 0.2, 0.3), (0.7, 0.2, 0.4), (1.2, -0.8, 0.3)] {
            assert_eq!(read("", u, v), Rgb::new(red, red * 2.0, 1.0 - red), "{u} {v}");
            assert_eq!(read(r#", "channel": "g""#, u, v), Rgb::splat(red * 2.0));
            assert_eq!(read(r#", "channel": "a""#, u, v), Rgb::splat(red * 0.5));
            assert_eq!(
                read(r#", "channel": "b", "invert": true, "factor": 2"#, u, v),
                Rgb::splat((1.0 - (1.0 - red)) * 2.0)
            );
            let luminance = Rgb::new(red, red * 2.0, 1.0 - red).luminance();
            assert_eq!(read(r#", "channel": "luminance""#, u, v), Rgb::splat(luminance));
        }
        // A quarter turn moves the right side to the top.
        assert_eq!(
            read(r#", "channel": "r", "rotate_degrees": [0, 0, 90], "offset": [1, 0, 0]"#, 0.2, 0.2),
            Rgb::splat(0.1)
        );
        assert_eq!(read(r#", "channel": "r", "wrap": "black", "wrap_v": "repeat""#, 1.1, 0.2), Rgb::BLACK);
        assert_eq!(read(r#", "channel": "r", "wrap": "black", "wrap_v": "repeat""#, 0.2, 1.2), Rgb::splat(0.3));
    }

    #[test]
    fn invalid_fields_are_named() {
        assert_eq!(Image::new("").check().unwrap_err().field, "file");
        assert_eq!(Image { factor: f32::NAN, ..Image::new("a") }.check().unwrap_err().field, "factor");
        assert!(serde_json::from_str::<Image>("{}").unwrap_err().to_string().contains("file"));
    }
}
