//! A picture laid over a surface.
//!
//! ```json
//! {"image": {"file": "textures/wood.png", "scale": [2, 3, 1], "wrap": "mirror"}}
//! ```
//!
//! The picture fills x and y of its pattern from 0 to 1, its lower left corner at the origin; over (u, v) that is once over the
//! surface. Elsewhere it is seen along z.

use super::CompiledTexture;
use super::mapping::Map;
use super::pixels::{Filter, Pyramid, Wrap};
use super::{Compiled, InvalidTexture, Lookup, Mapping, Resolver, Space, Texture, TextureError, TextureTable, check};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A picture laid over a surface: PNG, JPEG, WebP, OpenEXR, Radiance HDR or PFM.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Image {
    /// The picture, relative to the scene file.
    pub file: String,
    /// What its numbers mean. Data that is no colour, such as roughness, heights and normals, is `linear` most often.
    #[serde(default)]
    pub color_space: ColorSpace,
    /// Which of its channels count.
    #[serde(default)]
    pub channel: Channel,
    /// Takes 1 − what is there, before `factor`.
    #[serde(default)]
    pub invert: bool,
    /// A factor on what is there.
    #[serde(default = "one")]
    pub factor: f32,
    /// What lies beyond its borders.
    #[serde(default)]
    pub wrap: Wrap,
    /// The same for its upper and lower border, where that differs.
    #[serde(default)]
    pub wrap_v: Option<Wrap>,
    /// How a place between texels gets its colour.
    #[serde(default)]
    pub filter: Filter,
    /// Where the pattern lies.
    #[serde(flatten)]
    pub mapping: Mapping,
}

/// What a picture's numbers mean. Alpha is a plain share always.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ColorSpace {
    /// What the file says; if it says nothing, levels (PNG, JPEG, WebP) are sRGB and floats (EXR, HDR, PFM) linear light.
    #[default]
    Auto,
    /// Colours by the curve of sRGB.
    Srgb,
    /// The numbers themselves: linear light, or no light at all.
    Linear,
}

/// Which of a picture's channels count; one alone gives a grey.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Channel {
    /// The colour.
    #[default]
    Rgb,
    /// Red.
    R,
    /// Green.
    G,
    /// Blue.
    B,
    /// Alpha; 1 in pictures without.
    A,
    /// The colour's luminance.
    Luminance,
}

fn one() -> f32 {
    1.0
}

impl Image {
    /// The picture in that file, all else by default.
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

    fn compile(&self, resolver: &mut Resolver<'_>) -> Result<Compiled, TextureError> {
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
}

/// An [`Image`] with its pixels.
#[derive(Clone, Debug)]
pub struct CompiledImage {
    pixels: Arc<Pyramid>,
    channel: Channel,
    invert: bool,
    factor: f32,
    wrap: [Wrap; 2],
    filter: Filter,
    map: Map,
}

impl CompiledTexture for CompiledImage {
    fn eval(&self, _textures: &TextureTable, at: &Lookup) -> Rgb {
        let place = self.map.wide_place(at);
        // Rows count from the top.
        let [r, g, b, a] =
            self.pixels.sample([place.point.x, 1.0 - place.point.y], place.width, self.wrap, self.filter);
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

    fn pixels(&self) -> Option<&Arc<Pyramid>> {
        Some(&self.pixels)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Image {
    /// For the contract tests, which have a picture of that name.
    pub fn examples() -> Vec<Self> {
        let other = Self { wrap_v: Some(Wrap::Black), channel: Channel::A, invert: true, ..Self::new("test") };
        let planar = Self { mapping: Mapping::of(Space::Local), filter: Filter::Bilinear, ..Self::new("test") };
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
        reader(&json)(&Lookup { uv: Vec2::new(u, v), ..Lookup::default() })
    }

    /// The test picture, from the top: 0.1 0.2 | 0.3 0.4 in red; green is twice, blue 1 minus, alpha half of it.
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
        // A quarter turn: what was right is up.
        assert_eq!(
            read(r#", "channel": "r", "rotate_degrees": [0, 0, 90], "offset": [1, 0, 0]"#, 0.2, 0.2),
            Rgb::splat(0.1)
        );
        assert_eq!(read(r#", "channel": "r", "wrap": "black", "wrap_v": "repeat""#, 1.1, 0.2), Rgb::BLACK);
        assert_eq!(read(r#", "channel": "r", "wrap": "black", "wrap_v": "repeat""#, 0.2, 1.2), Rgb::splat(0.3));
    }

    #[test]
    fn says_what_is_wrong() {
        assert_eq!(Image::new("").check().unwrap_err().field, "file");
        assert_eq!(Image { factor: f32::NAN, ..Image::new("a") }.check().unwrap_err().field, "factor");
        assert!(serde_json::from_str::<Image>("{}").unwrap_err().to_string().contains("file"));
    }
}
