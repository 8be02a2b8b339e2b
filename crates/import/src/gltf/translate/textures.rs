//! Textures of materials: images with samplers and transforms. Each distinct combination is one
//! texture of the scene.

use super::Names;
use crate::gltf::data::GltfData;
use crate::gltf::document::{MagFilter, MinFilter, Sampler, Texture, TextureInfo, TextureTransform, Wrap};
use crate::gltf::warning::Warnings;
use indexmap::{IndexMap, IndexSet};
use juggler_math::{Rgb, portable};
use juggler_texture::{AnyTexture, Channel, ColorSpace, Filter, Image, Input, Mapping, Mix, MixMode};

/// Textures by name, as the materials of a file use them.
#[derive(Debug)]
pub struct TextureSet<'a> {
    data: &'a GltfData,
    names: &'a Names,
    prefix: &'a str,
    /// Textures by name.
    pub textures: IndexMap<String, AnyTexture>,
    /// Indices of the images that the textures use.
    pub images: IndexSet<usize>,
    /// Warnings about textures.
    pub warnings: Warnings,
}

impl<'a> TextureSet<'a> {
    /// Creates an empty set.
    pub fn new(data: &'a GltfData, names: &'a Names, prefix: &'a str) -> Self {
        let (textures, images, warnings) = Default::default();
        Self { data, names, prefix, textures, images, warnings }
    }

    /// Color of a factor and a texture: their product.
    pub fn color(&mut self, factor: [f64; 3], info: Option<&TextureInfo>) -> Input<Rgb> {
        let [r, g, b] = factor.map(|channel| channel as f32);
        let Some(info) = info.filter(|_| factor != [0.0; 3]) else { return Rgb::new(r, g, b).into() };
        let is_gray = r == g && g == b;
        let image = self.image(info, Channel::Rgb, ColorSpace::Srgb, if is_gray { r } else { 1.0 });
        let Some(image) = image else { return Rgb::new(r, g, b).into() };
        let name = self.add(image, info);
        if is_gray {
            return Input::Texture(name);
        }
        let product = Mix {
            a: Input::Texture(name.clone()),
            b: Rgb::new(r, g, b).into(),
            amount: 1.0.into(),
            mode: MixMode::Multiply,
        };
        Input::Texture(self.insert(format!("{name} times {r} {g} {b}"), product.into()))
    }

    /// Number of a factor and a channel of a texture: their product.
    pub fn number(&mut self, factor: f64, info: Option<&TextureInfo>, channel: Channel) -> Input<f32> {
        let Some(info) = info.filter(|_| factor != 0.0) else { return (factor as f32).into() };
        match self.image(info, channel, ColorSpace::Linear, factor as f32) {
            Some(image) => Input::Texture(self.add(image, info)),
            None => (factor as f32).into(),
        }
    }

    /// 1 minus the product of a factor and a channel of a texture.
    pub fn complement(&mut self, factor: f64, info: Option<&TextureInfo>, channel: Channel) -> Input<f32> {
        match self.number(factor, info, channel) {
            Input::Value(value) => (1.0 - value).into(),
            Input::Texture(name) => {
                let (a, b) = (Rgb::WHITE.into(), Rgb::BLACK.into());
                let mix = Mix { a, b, amount: Input::Texture(name.clone()), mode: MixMode::Mix };
                Input::Texture(self.insert(format!("1 - {name}"), mix.into()))
            }
        }
    }

    /// Name of a texture of numbers from `low`, where another texture is 0, to `high`, where it is 1.
    pub fn between(&mut self, low: f32, high: f32, amount: String) -> String {
        let name = format!("{amount} from {low} to {high}");
        let [a, b] = [low, high].map(|number| Rgb::splat(number).into());
        self.insert(name, Mix { a, b, amount: Input::Texture(amount), mode: MixMode::Mix }.into())
    }

    /// Normals of a texture; `None` without texture.
    pub fn normals(&mut self, info: Option<&TextureInfo>) -> Option<Input<Rgb>> {
        let info = info?;
        let image = self.image(info, Channel::Rgb, ColorSpace::Linear, 1.0)?;
        Some(Input::Texture(self.add(image, info)))
    }

    /// Image texture; `None` for a texture without a readable image.
    fn image(&mut self, info: &TextureInfo, channel: Channel, color_space: ColorSpace, factor: f32) -> Option<Image> {
        let document = &self.data.gltf.document;
        let texture = document.textures.get(info.index.get())?;
        let at = format!("/textures/{}", info.index);
        let index = self.image_index(texture, &at)?;
        self.images.insert(index);
        if info.set().get() > 0 {
            self.warnings.add(&at, "its second set of texture coordinates is not used; the first is", 1);
        }
        let sampler = texture.sampler.and_then(|sampler| document.samplers.get(sampler.get()));
        let sampler = sampler.cloned().unwrap_or_default();
        let [wrap, wrap_v] = [sampler.wrap_s, sampler.wrap_t].map(wrap);
        Some(Image {
            color_space,
            channel,
            factor,
            wrap,
            wrap_v: Some(wrap_v).filter(|wrap_v| *wrap_v != wrap),
            filter: filter(&sampler),
            mapping: self.mapping(info, &at),
            ..Image::new(asset_name(self.prefix, index))
        })
    }

    /// Image of a texture that the program can read.
    fn image_index(&mut self, texture: &Texture, at: &str) -> Option<usize> {
        let webp = texture.extensions.webp.and_then(|webp| webp.source);
        let basisu = texture.extensions.basisu.and_then(|basisu| basisu.source);
        if basisu.is_some() {
            self.warnings.add(at, "its KTX2 image is not read; the plain image is used, if there is one", 1);
        }
        webp.or(texture.source).map(|image| image.get())
    }

    fn mapping(&mut self, info: &TextureInfo, at: &str) -> Mapping {
        let Some(transform) = info.extensions.transform.as_deref() else { return Mapping::default() };
        if *transform == (TextureTransform { tex_coord: transform.tex_coord, ..TextureTransform::default() }) {
            return Mapping::default();
        }
        let matrix = matrix(transform);
        let [a, b, _, d, e, _] = matrix;
        if a * e - b * d == 0.0 {
            self.warnings.add(at, "its transform has a scale of 0 and is ignored", 1);
            return Mapping::default();
        }
        Mapping { matrix: Some(matrix.map(|number| number as f32)), ..Mapping::default() }
    }

    fn add(&mut self, image: Image, info: &TextureInfo) -> String {
        let texture = AnyTexture::from(image);
        // An equal texture is used again.
        if let Some((name, _)) = self.textures.iter().find(|(_, known)| **known == texture) {
            return name.clone();
        }
        let index = self.data.gltf.document.textures.get(info.index.get()).and_then(|texture| texture.source);
        let image = index.and_then(|index| self.names.images.get(index.get())).map_or("image", String::as_str);
        self.insert(format!("{}{image}", self.prefix), texture)
    }

    /// Adds a texture under this name, or under this name with a number.
    fn insert(&mut self, name: String, texture: AnyTexture) -> String {
        let mut candidate = name.clone();
        let mut number = 1u64;
        // The loop ends: the number rises, and there are finitely many textures.
        while self.textures.get(&candidate).is_some_and(|known| *known != texture) {
            number += 1;
            candidate = format!("{name}#{number}");
        }
        self.textures.insert(candidate.clone(), texture);
        candidate
    }
}

/// Name of an image as an asset of the scene.
pub fn asset_name(prefix: &str, image: usize) -> String {
    format!("{prefix}images/{image}")
}

fn wrap(mode: Wrap) -> juggler_texture::Wrap {
    match mode {
        Wrap::ClampToEdge => juggler_texture::Wrap::Clamp,
        Wrap::MirroredRepeat => juggler_texture::Wrap::Mirror,
        Wrap::Repeat => juggler_texture::Wrap::Repeat,
    }
}

fn filter(sampler: &Sampler) -> Filter {
    match (sampler.mag_filter, sampler.min_filter) {
        (Some(MagFilter::Nearest), _) => Filter::Nearest,
        (_, Some(MinFilter::Nearest | MinFilter::Linear)) => Filter::Bilinear,
        _ => Filter::Trilinear,
    }
}

/// Matrix of a texture transform (offset o, rotation r, scale s, all with v downwards) for texture
/// coordinates with v upwards: [sx cos r, -sy sin r, ox + sy sin r; sx sin r, sy cos r, 1 - oy - sy
/// cos r].
fn matrix(transform: &TextureTransform) -> [f64; 6] {
    let TextureTransform { offset: [ox, oy], rotation, scale: [sx, sy], .. } = *transform;
    let (sin, cos) = portable::sin_cos_f64(rotation);
    [sx * cos, -sy * sin, ox + sy * sin, sx * sin, sy * cos, 1.0 - oy - sy * cos]
}
