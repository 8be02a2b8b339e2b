//! Materials of MTL libraries as `principled` materials with `image` textures.

use super::library::{Loaded, Picture};
use super::mtl::{MtlMap, MtlMaterial};
use crate::gltf::Warnings;
use crate::textures::{NamedTextures, channel_suffix, with_vertex_colors};
use juggler_material::{AnyMaterial, BumpMap, MaterialRef, NormalMap, Principled};
use juggler_math::Rgb;
use juggler_texture::{Channel, ColorSpace, Image, Input, InputProduct, Mapping, Mix, MixMode, Wrap};

/// Gray of materials and faces whose color the file does not state.
const GRAY: [f32; 3] = [0.8; 3];
/// Roughness where the file does not state it.
const ROUGHNESS: f32 = 0.5;
/// Height of a bump map of strength 1, as a fraction of the diagonal of the model's bounding box:
/// the format states no unit.
const BUMP_HEIGHT: f32 = 0.01;
/// Words for physically based materials; they replace `Ns` and `Ks`.
const PHYSICAL: [&str; 7] = ["pr", "pm", "ps", "pc", "pcr", "aniso", "anisor"];

/// Translates materials, and collects their textures.
pub struct Materials<'a> {
    /// Beginning of the names of all parts.
    pub prefix: &'a str,
    /// Pictures of all materials.
    pub pictures: &'a [Picture],
    /// Whether meshes have vertex colors.
    pub has_colors: bool,
    /// Diagonal of the model's bounding box, in scene units.
    pub diagonal: f32,
    /// Textures by name.
    pub textures: NamedTextures,
    /// Warnings about approximated content.
    pub warnings: Warnings,
}

/// Gray material of faces without a known material: `principled`, visible from both sides.
pub fn gray(has_colors: bool) -> AnyMaterial {
    let [r, g, b] = if has_colors { [1.0; 3] } else { GRAY };
    let base_color = colored(Rgb::new(r, g, b).into(), has_colors);
    Principled { base_color, roughness: ROUGHNESS.into(), ..Principled::default() }.into()
}

/// Color, times the colors of vertices if meshes have them.
fn colored(color: Input<Rgb>, has_colors: bool) -> Input<Rgb> {
    if has_colors { with_vertex_colors(color) } else { color }
}

/// Mean of the channels of a color.
fn mean([r, g, b]: [f32; 3]) -> f32 {
    (r + g + b) / 3.0
}

/// Number of a material.
fn number(mtl: &MtlMaterial, word: &str) -> Option<f32> {
    mtl.numbers.get(word).copied()
}

impl Materials<'_> {
    /// Translates a material.
    pub fn material(&mut self, loaded: &Loaded) -> AnyMaterial {
        let mtl = &loaded.mtl;
        let mut principled = Principled {
            base_color: self.base_color(loaded),
            emissive: self.color(loaded, "ke", "map_ke", [0.0; 3], f32::MAX),
            opacity: self.opacity(loaded),
            ..Principled::default()
        };
        self.reflection(&mut principled, loaded);
        self.layers(&mut principled, loaded);
        self.glass(&mut principled, mtl, &loaded.place());
        self.relief(principled, loaded)
    }

    fn base_color(&mut self, loaded: &Loaded) -> Input<Rgb> {
        let color = self.color(loaded, "kd", "map_kd", GRAY, 1.0);
        colored(color, self.has_colors)
    }

    /// Color of a factor and a texture: their product. With a texture, a missing or black factor
    /// counts as white, because programs write it so. A texture without its picture is as if the
    /// material stated nothing.
    fn color(&mut self, loaded: &Loaded, word: &str, map: &str, missing: [f32; 3], limit: f32) -> Input<Rgb> {
        let stated = loaded.mtl.colors.get(word).copied();
        let texture = self.image(loaded, map, Channel::Rgb, ColorSpace::Auto);
        let factor = match &texture {
            Some(_) => stated.filter(|color| *color != [0.0; 3]).unwrap_or([1.0; 3]),
            None if loaded.mtl.maps.contains_key(map) => missing,
            None => stated.unwrap_or(missing),
        };
        let is_clamped = factor.iter().any(|channel| *channel > limit);
        self.warnings.add(loaded.place(), format!("`{word}` is above 1 and clamped"), u64::from(is_clamped));
        let [r, g, b] = factor.map(|channel| channel.clamp(0.0, limit));
        let factor = Rgb::new(r, g, b);
        match texture {
            Some(name) if factor == Rgb::WHITE => Input::Texture(name),
            Some(name) => Input::product(name, factor),
            None => factor.into(),
        }
    }

    /// Number from 0 to 1 of a factor and a texture: their product. With a texture, a missing
    /// factor or 0 counts as 1.
    fn number(&mut self, loaded: &Loaded, map: &str, stated: Option<f32>, missing: f32) -> Input<f32> {
        let texture = self.image(loaded, map, Channel::Luminance, ColorSpace::Linear);
        match texture {
            Some(name) => match stated.filter(|factor| *factor > 0.0).unwrap_or(1.0).min(1.0) {
                1.0 => Input::Texture(name),
                factor => Input::product(name, factor),
            },
            None => stated.unwrap_or(missing).clamp(0.0, 1.0).into(),
        }
    }

    /// Roughness, specular reflection and metal.
    fn reflection(&mut self, principled: &mut Principled, loaded: &Loaded) {
        let mtl = &loaded.mtl;
        let is_physical = PHYSICAL.iter().any(|word| mtl.numbers.contains_key(word))
            || ["map_pr", "map_pm", "map_ps"].iter().any(|map| mtl.maps.contains_key(map));
        let shininess = number(mtl, "ns").map(|shininess| 1.0 - (shininess.clamp(0.0, 1000.0) / 1000.0).sqrt());
        let roughness = number(mtl, "pr").or(shininess.filter(|_| !mtl.maps.contains_key("map_pr")));
        principled.roughness = self.number(loaded, "map_pr", roughness, ROUGHNESS);
        if !is_physical {
            let specular = mtl.colors.get("ks").map(|color| mean(*color));
            principled.specular = self.number(loaded, "map_ks", specular, 1.0);
        }
        let is_mirror = number(mtl, "illum") == Some(3.0);
        let metal = mtl.colors.get("ka").filter(|_| is_mirror).map(|color| mean(*color));
        principled.metallic = self.number(loaded, "map_pm", number(mtl, "pm").or(metal), 0.0);
    }

    /// Sheen, clearcoat and anisotropy.
    fn layers(&mut self, principled: &mut Principled, loaded: &Loaded) {
        let mtl = &loaded.mtl;
        let sheen = self.number(loaded, "map_ps", number(mtl, "ps"), 0.0);
        principled.sheen_color = match sheen {
            Input::Value(value) => Rgb::splat(value).into(),
            Input::Texture(name) => Input::Texture(name),
            Input::Product(product) => Input::Product(Box::new(InputProduct {
                texture: product.texture,
                factor: product.factor.map(Rgb::splat),
                attribute: None,
            })),
        };
        if number(mtl, "ps").is_some() || mtl.maps.contains_key("map_ps") {
            principled.sheen_roughness = ROUGHNESS.into();
        }
        let unit = |word: &str| number(mtl, word).unwrap_or_default().clamp(0.0, 1.0);
        principled.clearcoat = unit("pc").into();
        principled.clearcoat_roughness = unit("pcr").into();
        principled.anisotropy = unit("aniso").into();
        let turns = number(mtl, "anisor").unwrap_or_default() % 1.0;
        principled.anisotropy_rotation = turns.into();
    }

    /// Opacity: `d`, else 1 - `Tr`, times the texture.
    fn opacity(&mut self, loaded: &Loaded) -> Input<f32> {
        let (mtl, place) = (&loaded.mtl, loaded.place());
        let transparency = number(mtl, "tr");
        let opacity = match (number(mtl, "d"), transparency) {
            (Some(opacity), Some(transparency)) => {
                let differs = (1.0 - transparency - opacity).abs() > 1e-3;
                self.warnings.add(&place, "`d` and `Tr` disagree; `d` is used", u64::from(differs));
                opacity
            }
            (Some(opacity), None) => opacity,
            (None, Some(transparency)) if transparency >= 1.0 => {
                self.warnings.add(&place, "`Tr 1` without `d` would hide the surface; it is shown opaque", 1);
                1.0
            }
            (None, transparency) => 1.0 - transparency.unwrap_or_default(),
        };
        let opacity = opacity.clamp(0.0, 1.0);
        let has_alpha = self.picture(loaded, "map_d").is_some_and(|(_, picture)| picture.has_alpha);
        let channel = if has_alpha { Channel::A } else { Channel::Luminance };
        let space = if has_alpha { ColorSpace::Auto } else { ColorSpace::Linear };
        match self.image(loaded, "map_d", channel, space) {
            Some(name) if opacity == 1.0 => Input::Texture(name),
            Some(name) => Input::product(name, opacity),
            None => opacity.into(),
        }
    }

    /// Glass by the model of illumination. Its opacity is that of a texture only: `d` describes the
    /// same transparency.
    fn glass(&mut self, principled: &mut Principled, mtl: &MtlMaterial, place: &str) {
        let ior = number(mtl, "ni");
        let is_glass = match number(mtl, "illum") {
            Some(model) if [6.0, 7.0, 9.0].contains(&model) => true,
            Some(4.0) => ior.is_some_and(|ior| ior != 1.0),
            _ => false,
        };
        if !is_glass {
            return;
        }
        let [r, g, b] = mtl.colors.get("tf").copied().unwrap_or([1.0; 3]).map(|channel| channel.clamp(0.0, 1.0));
        principled.transmission = 1.0.into();
        principled.specular = 1.0.into();
        principled.ior = ior.unwrap_or(1.5).clamp(1.0, 10.0);
        principled.base_color = Rgb::new(r, g, b).into();
        if let Input::Value(opacity) = principled.opacity
            && opacity < 1.0
        {
            self.warnings.add(place, "glass ignores `d` and `Tr`", 1);
            principled.opacity = 1.0.into();
        }
    }

    /// Material with its normal map or bump map.
    fn relief(&mut self, principled: Principled, loaded: &Loaded) -> AnyMaterial {
        let (maps, place) = (&loaded.mtl.maps, loaded.place());
        let is_normal_map = self.picture(loaded, "bump").is_some_and(|(_, picture)| picture.is_normal_map);
        let word = if maps.contains_key("norm") { "norm" } else { "bump" };
        let Some((map, _)) = self.picture(loaded, word) else { return principled.into() };
        let strength = map.strength;
        if word == "norm" {
            self.warnings.add(&place, "has `norm` and `bump`; `norm` is used", u64::from(maps.contains_key("bump")));
        } else {
            self.warnings.add(&place, "`bump` names a normal map and is read as one", u64::from(is_normal_map));
        }
        if word == "norm" || is_normal_map {
            let Some(name) = self.image(loaded, word, Channel::Rgb, ColorSpace::Linear) else {
                return principled.into();
            };
            let strength = strength.clamp(0.0, 1000.0).into();
            return NormalMap { texture: Input::Texture(name), strength, material: MaterialRef::from(principled) }
                .into();
        }
        let Some(name) = self.image(loaded, word, Channel::Luminance, ColorSpace::Linear) else {
            return principled.into();
        };
        let distance = (strength * BUMP_HEIGHT * self.diagonal).clamp(-1e6, 1e6);
        BumpMap { height: Input::Texture(name), distance, material: MaterialRef::from(principled) }.into()
    }

    /// Texture of a material with its picture.
    fn picture<'l>(&self, loaded: &'l Loaded, map: &str) -> Option<(&'l MtlMap, &Picture)> {
        let index = loaded.pictures.get(map)?;
        Some((loaded.mtl.maps.get(map)?, self.pictures.get(*index)?))
    }

    /// Name of the texture of a map; `None` without one. The option `-imfchan` replaces `channel`.
    fn image(&mut self, loaded: &Loaded, map: &str, channel: Channel, space: ColorSpace) -> Option<String> {
        let (map, picture) = self.picture(loaded, map)?;
        let channel = match map.channel {
            Some('r') => Channel::R,
            Some('g') => Channel::G,
            Some('b') => Channel::B,
            Some('m') => Channel::A,
            Some('l') => Channel::Luminance,
            _ => channel,
        };
        let [[su, sv], [ou, ov]] = [map.scale, map.offset];
        let matrix = Some([su, 0.0, ou, 0.0, sv, ov]).filter(|matrix| *matrix != [1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        let [base, gain] = map.range;
        let image = Image {
            color_space: space,
            channel,
            factor: gain,
            wrap: if map.is_clamped { Wrap::Clamp } else { Wrap::Repeat },
            mapping: Mapping { matrix, ..Mapping::default() },
            ..Image::new(format!("{}{}", self.prefix, picture.asset_name))
        };
        let suffix = channel_suffix(channel);
        let name = self.textures.add(&format!("{}{}{suffix}", self.prefix, picture.file), image);
        if base == 0.0 {
            return Some(name);
        }
        let b = Rgb::splat(base).into();
        let raised = Mix { a: Input::Texture(name.clone()), b, amount: 1.0.into(), mode: MixMode::Add };
        Some(self.textures.add(&format!("{name} raised"), raised))
    }
}
