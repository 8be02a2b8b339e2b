//! Textures of materials: images with samplers and texture transforms, and their products with
//! factors and vertex colors. Equal textures are added once.

use super::pictures::Pictures;
use crate::gltf::data::GltfData;
use crate::gltf::document::{Document, MagFilter, MinFilter, Sampler, TextureInfo, TextureTransform, Wrap};
use crate::gltf::error::Fault;
use crate::gltf::warning::Warnings;
use crate::textures::{LOST_PICTURE, NamedTextures, channel_suffix};
use juggler_math::{Rgb, portable};
use juggler_texture::{
    Channel, ColorSpace, Direction, Filter, Image, Input, Mapping, Mix, MixMode, Wrap as Continuation,
};

/// Textures by name, as the materials of a file use them.
#[derive(Debug)]
pub struct TextureSet<'a> {
    document: &'a Document,
    prefix: &'a str,
    /// Textures by name.
    pub textures: NamedTextures,
    /// Pictures that the textures use.
    pub pictures: Pictures<'a>,
    /// Warnings.
    pub warnings: Warnings,
}

/// Channels of an image that a texture uses, and how it reads them.
#[derive(Clone, Copy, Debug)]
pub struct Reading {
    /// Channels that the texture uses.
    pub channel: Channel,
    /// Color space of the image's values.
    pub space: ColorSpace,
    /// Whether the texture is never averaged over MIP map levels, so that an alpha cut-off leaves
    /// the same area at any distance.
    pub is_sharp: bool,
}

impl Reading {
    /// Colors, encoded in sRGB.
    pub const COLOR: Self = Self { channel: Channel::Rgb, space: ColorSpace::Srgb, is_sharp: false };

    /// Linear numbers in one channel.
    pub const fn number(channel: Channel) -> Self {
        Self { channel, space: ColorSpace::Linear, is_sharp: false }
    }

    /// Alpha of colors. The color space does not apply to alpha; it equals that of [`Self::COLOR`],
    /// so that color and alpha share one decoded image.
    pub const fn alpha(is_sharp: bool) -> Self {
        Self { channel: Channel::A, space: ColorSpace::Srgb, is_sharp }
    }
}

impl<'a> TextureSet<'a> {
    /// Creates an empty set; the names of its textures will begin with `prefix`.
    pub fn new(document: &'a Document, data: &'a GltfData, prefix: &'a str) -> Self {
        let (textures, warnings) = Default::default();
        Self { document, prefix, textures, pictures: Pictures::new(document, data, prefix), warnings }
    }

    /// Whether the picture of a texture is missing or broken and lenient files allow it.
    pub fn is_lost(&self, info: &TextureInfo) -> bool {
        self.document.textures.get(info.index.get()).is_some_and(|texture| self.pictures.is_lost(texture))
    }

    /// Product of a color and a texture; the color alone without a texture. A lost picture counts
    /// as gray.
    ///
    /// # Errors
    ///
    /// The picture cannot be read.
    pub fn color(&mut self, factor: [f64; 3], info: Option<&TextureInfo>) -> Result<Input<Rgb>, Fault> {
        let factor = factor.map(number);
        let constant = Rgb::new(factor[0], factor[1], factor[2]);
        let Some(info) = info.filter(|_| constant != Rgb::BLACK) else { return Ok(constant.into()) };
        let [r, g, b] = factor;
        let gray = if r == g && g == b { r } else { 1.0 };
        let Some(texture) = self.image(info, Reading::COLOR, gray)? else {
            return Ok((constant * if self.is_lost(info) { LOST_PICTURE } else { 1.0 }).into());
        };
        Ok(if r == g && g == b { Input::Texture(texture) } else { Input::product(texture, constant) })
    }

    /// Product of a number and a channel of a texture; the number alone without a texture.
    ///
    /// # Errors
    ///
    /// The picture cannot be read.
    pub fn number(&mut self, factor: f64, info: Option<&TextureInfo>, reading: Reading) -> Result<Input<f32>, Fault> {
        let factor = number(factor);
        let Some(info) = info.filter(|_| factor != 0.0) else { return Ok(factor.into()) };
        let texture = self.image(info, reading, factor)?;
        Ok(texture.map_or(factor.into(), Input::Texture))
    }

    /// Linear interpolation from `low`, where a texture is 0, to `high`, where it is 1. `None`
    /// without a texture.
    ///
    /// # Errors
    ///
    /// The picture cannot be read.
    pub fn between(
        &mut self,
        low: f64,
        high: f64,
        info: Option<&TextureInfo>,
        reading: Reading,
    ) -> Result<Option<Input<f32>>, Fault> {
        let Input::Texture(name) = self.number(1.0, info, reading)? else { return Ok(None) };
        let [a, b] = [low, high].map(|bound| Rgb::splat(number(bound)).into());
        let amount = Input::Texture(name.clone());
        Ok(Some(Input::Texture(self.textures.add(&format!("{name} scaled"), Mix { a, b, amount, mode: MixMode::Mix }))))
    }

    /// Normal map; `is_negated` negates the tangential components of its normals.
    ///
    /// # Errors
    ///
    /// The picture cannot be read.
    pub fn normals(&mut self, info: &TextureInfo, is_negated: bool) -> Result<Option<Input<Rgb>>, Fault> {
        let reading = Reading { space: ColorSpace::Linear, ..Reading::COLOR };
        let Some(name) = self.image(info, reading, 1.0)? else { return Ok(None) };
        let texture = Input::Texture(name.clone());
        if !is_negated {
            return Ok(Some(texture));
        }
        // The encoded normal (1 - r, 1 - g, b) is the difference to (1, 1, 0).
        let b = Rgb::new(1.0, 1.0, 0.0).into();
        let negated = Mix { a: texture, b, amount: 1.0.into(), mode: MixMode::Difference };
        Ok(Some(Input::Texture(self.textures.add(&format!("{name} negated"), negated))))
    }

    /// Angles of the directions that a texture encodes, plus the constant `turns`; both in turns.
    ///
    /// # Errors
    ///
    /// The picture cannot be read.
    pub fn directions(&mut self, info: &TextureInfo, turns: f32) -> Result<Option<Input<f32>>, Fault> {
        let reading = Reading { space: ColorSpace::Linear, ..Reading::COLOR };
        let Some(name) = self.image(info, reading, 1.0)? else { return Ok(None) };
        let direction = Direction { of: Input::Texture(name.clone()), turns };
        Ok(Some(Input::Texture(self.textures.add(&format!("{name} directions"), direction))))
    }

    /// Adds an image texture and returns its name; `None` for a texture without an image.
    fn image(&mut self, info: &TextureInfo, reading: Reading, factor: f32) -> Result<Option<String>, Fault> {
        let document = self.document;
        let Some(texture) = document.textures.get(info.index.get()) else { return Ok(None) };
        let at = format!("/textures/{}", info.index);
        let Some(picture) = self.pictures.picture(texture, &mut self.warnings)? else {
            let is_lost = self.pictures.is_lost(texture);
            self.warnings.add(at, "has no image and counts as white", u64::from(!is_lost));
            return Ok(None);
        };
        let sampler = texture.sampler.and_then(|sampler| document.samplers.get(sampler.get()));
        let sampler = sampler.cloned().unwrap_or_default();
        let [wrap, wrap_v] = [sampler.wrap_s, sampler.wrap_t].map(continuation);
        let image = Image {
            color_space: reading.space,
            channel: reading.channel,
            factor,
            wrap,
            wrap_v: Some(wrap_v).filter(|wrap_v| *wrap_v != wrap),
            filter: filter(&sampler, reading.is_sharp),
            mapping: self.mapping(info, &at),
            ..Image::new(picture.file)
        };
        let channel = channel_suffix(reading.channel);
        Ok(Some(self.textures.add(&format!("{}{}{channel}", self.prefix, picture.name), image)))
    }

    /// Mapping of a texture reference: its set of texture coordinates and its transform.
    fn mapping(&mut self, info: &TextureInfo, at: &str) -> Mapping {
        let set = info.set().get();
        self.warnings.add(at, "uses texture coordinates beyond the second set; the first is used", u64::from(set > 1));
        let matrix = info.extensions.transform.as_deref().map(matrix);
        let matrix = matrix.filter(|matrix| *matrix != [1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        let matrix = matrix.map(|matrix| matrix.map(|number| number as f32));
        Mapping { uv_set: u32::from(set == 1), matrix, ..Mapping::default() }
    }
}

/// Clamps a factor of a document to the range that the scene format allows.
fn number(factor: f64) -> f32 {
    factor.clamp(-1e6, 1e6) as f32
}

fn continuation(wrap: Wrap) -> Continuation {
    match wrap {
        Wrap::ClampToEdge => Continuation::Clamp,
        Wrap::MirroredRepeat => Continuation::Mirror,
        Wrap::Repeat => Continuation::Repeat,
    }
}

fn filter(sampler: &Sampler, is_sharp: bool) -> Filter {
    match (sampler.mag_filter, sampler.min_filter) {
        (Some(MagFilter::Nearest), _) => Filter::Nearest,
        (_, Some(MinFilter::Nearest | MinFilter::Linear)) => Filter::Bilinear,
        _ if is_sharp => Filter::Bilinear,
        _ => Filter::Trilinear,
    }
}

/// Matrix of a texture transform (offset o, rotation r, scale s, with v downwards) for texture
/// coordinates with v upwards: [sx cos r, -sy sin r, ox + sy sin r; sx sin r, sy cos r, 1 - oy - sy
/// cos r].
pub(super) fn matrix(transform: &TextureTransform) -> [f64; 6] {
    let TextureTransform { offset: [ox, oy], rotation, scale: [sx, sy], .. } = *transform;
    let (sin, cos) = portable::sin_cos_f64(rotation);
    [sx * cos, -sy * sin, ox + sy * sin, sx * sin, sy * cos, 1.0 - oy - sy * cos]
}
