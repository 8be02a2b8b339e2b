//! Properties and extensions of a material as a `principled` material.

use super::PrimitiveSurface;
use super::surface;
use super::textures::{Reading, TextureSet};
use crate::gltf::document::{
    Anisotropy, Clearcoat, DiffuseTransmission, Iridescence, Material, MaterialExtensions, MetallicRoughness, Sheen,
    Specular, SpecularGlossiness, Transmission, Volume,
};
use crate::gltf::error::Fault;
use crate::textures::with_vertex_colors;
use juggler_material::medium::Medium;
use juggler_material::{AnyMaterial, Principled};
use juggler_math::Rgb;
use juggler_texture::Channel;
use std::f64::consts::TAU;

/// Largest thickness of a thin film, in nanometers.
const MAX_FILM_NM: f64 = 1e6;
/// Largest factor of emitted light.
const MAX_STRENGTH: f64 = 1e30;

/// Translates a material at a JSON pointer, for primitives with this surface.
pub fn material(
    textures: &mut TextureSet<'_>,
    material: &Material,
    surface: &PrimitiveSurface,
    at: &str,
) -> Result<AnyMaterial, Fault> {
    let none = MaterialExtensions::default();
    let extensions = material.extensions.as_deref().unwrap_or(&none);
    // Specular and glossiness replace metallic and roughness, which are a fallback for other readers.
    let glossiness = extensions.specular_glossiness.as_ref();
    let base = Base::new(material, glossiness);
    if extensions.unlit.is_some() || !surface.is_lit {
        return surface::unlit(textures, material, &base, surface);
    }
    let mut principled = match glossiness {
        Some(model) => from_glossiness(textures, model)?,
        None => from_metallic_roughness(textures, &material.pbr_metallic_roughness)?,
    };
    principled.base_color = base.color(textures, surface)?;
    layers(textures, &mut principled, extensions)?;
    let is_replaced = glossiness.is_some() && extensions.specular.is_some();
    let warning = "its KHR_materials_specular has no effect beside KHR_materials_pbrSpecularGlossiness";
    textures.warnings.add(at, warning, u64::from(is_replaced));
    glass(textures, &mut principled, extensions)?;
    if let Some(model) = &extensions.dispersion {
        surface::set_dispersion(textures, &mut principled, model.dispersion, at);
    }
    // A lost picture would make all of the surface emit.
    let emissive_texture = material.emissive_texture.as_ref();
    let is_lost = emissive_texture.is_some_and(|info| textures.is_lost(info));
    let emissive_factor = if is_lost { [0.0; 3] } else { material.emissive_factor };
    principled.emissive = textures.color(emissive_factor, emissive_texture)?;
    let strength = extensions.emissive_strength.as_ref().map_or(1.0, |strength| strength.emissive_strength);
    principled.emissive_strength = strength.min(MAX_STRENGTH) as f32;
    (principled.opacity, principled.alpha_cutoff) = base.opacity(textures, material, surface)?;
    principled.sides = surface::sides(material, extensions);
    surface::with_normals(textures, principled, material, extensions.clearcoat.as_ref())
}

/// Base color and alpha of a material.
#[derive(Clone, Copy, Debug)]
pub struct Base<'m> {
    factor: [f64; 4],
    texture: Option<&'m crate::gltf::document::TextureInfo>,
}

impl<'m> Base<'m> {
    fn new(material: &'m Material, glossiness: Option<&'m SpecularGlossiness>) -> Self {
        let model = &material.pbr_metallic_roughness;
        match glossiness {
            Some(model) => Self { factor: model.diffuse_factor, texture: model.diffuse_texture.as_ref() },
            None => Self { factor: model.base_color_factor, texture: model.base_color_texture.as_ref() },
        }
    }

    /// Base color, multiplied by vertex colors.
    pub fn color(
        &self,
        textures: &mut TextureSet<'_>,
        surface: &PrimitiveSurface,
    ) -> Result<juggler_texture::Input<Rgb>, Fault> {
        let [r, g, b, _] = self.factor;
        let color = textures.color([r, g, b], self.texture)?;
        Ok(if surface.has_color { with_vertex_colors(color) } else { color })
    }

    /// Opacity and its threshold.
    pub fn opacity(
        &self,
        textures: &mut TextureSet<'_>,
        material: &Material,
        surface: &PrimitiveSurface,
    ) -> Result<(juggler_texture::Input<f32>, Option<f32>), Fault> {
        surface::opacity(textures, self.factor[3], self.texture, material, surface)
    }
}

fn from_metallic_roughness(textures: &mut TextureSet<'_>, model: &MetallicRoughness) -> Result<Principled, Fault> {
    let texture = model.metallic_roughness_texture.as_ref();
    Ok(Principled {
        metallic: textures.number(model.metallic_factor, texture, Reading::number(Channel::B))?,
        roughness: textures.number(model.roughness_factor, texture, Reading::number(Channel::G))?,
        ..Principled::default()
    })
}

fn from_glossiness(textures: &mut TextureSet<'_>, model: &SpecularGlossiness) -> Result<Principled, Fault> {
    let texture = model.specular_glossiness_texture.as_ref();
    let roughness = 1.0 - model.glossiness_factor;
    let textured = textures.between(1.0, roughness, texture, Reading::alpha(false))?;
    Ok(Principled {
        metallic: 0.0.into(),
        roughness: textured.unwrap_or_else(|| (roughness as f32).into()),
        // The specular color is the reflectance at normal incidence.
        ior: 0.0,
        specular_color: textures.color(model.specular_factor, texture)?,
        ..Principled::default()
    })
}

/// Specular reflection, clear coat, sheen, thin film and anisotropy.
fn layers(
    textures: &mut TextureSet<'_>,
    principled: &mut Principled,
    extensions: &MaterialExtensions,
) -> Result<(), Fault> {
    let is_metallic_roughness = extensions.specular_glossiness.is_none();
    if let Some(model) = extensions.specular.as_ref().filter(|_| is_metallic_roughness) {
        specular(textures, principled, model)?;
    }
    if let Some(ior) = extensions.ior.as_ref().filter(|_| is_metallic_roughness) {
        principled.ior = if ior.ior == 0.0 { 0.0 } else { index(ior.ior) };
    }
    if let Some(model) = &extensions.clearcoat {
        clearcoat(textures, principled, model)?;
    }
    if let Some(model) = &extensions.sheen {
        sheen(textures, principled, model)?;
    }
    if let Some(model) = &extensions.iridescence {
        iridescence(textures, principled, model)?;
    }
    if let Some(model) = &extensions.anisotropy {
        anisotropy(textures, principled, model)?;
    }
    Ok(())
}

/// Index of refraction in the range of the materials.
fn index(ior: f64) -> f32 {
    ior.clamp(1.0, 10.0) as f32
}

fn specular(textures: &mut TextureSet<'_>, principled: &mut Principled, model: &Specular) -> Result<(), Fault> {
    principled.specular =
        textures.number(model.specular_factor, model.specular_texture.as_ref(), Reading::number(Channel::A))?;
    principled.specular_color = textures.color(model.specular_color_factor, model.specular_color_texture.as_ref())?;
    Ok(())
}

fn clearcoat(textures: &mut TextureSet<'_>, principled: &mut Principled, model: &Clearcoat) -> Result<(), Fault> {
    principled.clearcoat =
        textures.number(model.clearcoat_factor, model.clearcoat_texture.as_ref(), Reading::number(Channel::R))?;
    let texture = model.clearcoat_roughness_texture.as_ref();
    principled.clearcoat_roughness =
        textures.number(model.clearcoat_roughness_factor, texture, Reading::number(Channel::G))?;
    Ok(())
}

fn sheen(textures: &mut TextureSet<'_>, principled: &mut Principled, model: &Sheen) -> Result<(), Fault> {
    principled.sheen_color = textures.color(model.sheen_color_factor, model.sheen_color_texture.as_ref())?;
    let texture = model.sheen_roughness_texture.as_ref();
    principled.sheen_roughness = textures.number(model.sheen_roughness_factor, texture, Reading::number(Channel::A))?;
    Ok(())
}

fn iridescence(textures: &mut TextureSet<'_>, principled: &mut Principled, model: &Iridescence) -> Result<(), Fault> {
    principled.iridescence =
        textures.number(model.iridescence_factor, model.iridescence_texture.as_ref(), Reading::number(Channel::R))?;
    principled.iridescence_ior = index(model.iridescence_ior);
    let [low, high] =
        [model.iridescence_thickness_minimum, model.iridescence_thickness_maximum].map(|nm| nm.min(MAX_FILM_NM));
    let texture = model.iridescence_thickness_texture.as_ref();
    let textured = textures.between(low, high, texture, Reading::number(Channel::G))?;
    principled.iridescence_thickness = textured.unwrap_or_else(|| (high as f32).into());
    Ok(())
}

fn anisotropy(textures: &mut TextureSet<'_>, principled: &mut Principled, model: &Anisotropy) -> Result<(), Fault> {
    let texture = model.anisotropy_texture.as_ref();
    principled.anisotropy = textures.number(model.anisotropy_strength, texture, Reading::number(Channel::B))?;
    let turns = (model.anisotropy_rotation / TAU) % 1.0;
    principled.anisotropy_rotation = surface::direction(textures, turns, texture)?;
    Ok(())
}

/// Transmission, diffuse transmission and volume.
fn glass(
    textures: &mut TextureSet<'_>,
    principled: &mut Principled,
    extensions: &MaterialExtensions,
) -> Result<(), Fault> {
    if let Some(Transmission { transmission_factor, transmission_texture }) = &extensions.transmission {
        principled.transmission =
            textures.number(*transmission_factor, transmission_texture.as_ref(), Reading::number(Channel::R))?;
    }
    if let Some(model) = &extensions.diffuse_transmission {
        diffuse_transmission(textures, principled, model)?;
    }
    if extensions.transmission.is_none() && extensions.diffuse_transmission.is_none() {
        return Ok(());
    }
    let volume = extensions.volume.as_ref().filter(|volume| volume.thickness_factor > 0.0);
    principled.thin = volume.is_none();
    principled.medium = volume.and_then(medium).unwrap_or_default();
    Ok(())
}

fn diffuse_transmission(
    textures: &mut TextureSet<'_>,
    principled: &mut Principled,
    model: &DiffuseTransmission,
) -> Result<(), Fault> {
    let texture = model.diffuse_transmission_texture.as_ref();
    principled.diffuse_transmission =
        textures.number(model.diffuse_transmission_factor, texture, Reading::number(Channel::A))?;
    let texture = model.diffuse_transmission_color_texture.as_ref();
    principled.diffuse_transmission_color = textures.color(model.diffuse_transmission_color_factor, texture)?;
    Ok(())
}

/// Absorbing medium; `None` if it is clear.
fn medium(volume: &Volume) -> Option<Medium> {
    let distance = volume.attenuation_distance.map(|distance| distance as f32)?;
    let [r, g, b] = volume.attenuation_color.map(|channel| channel as f32);
    let color = Rgb::new(r, g, b);
    let is_clear = !distance.is_finite() || color == Rgb::WHITE;
    (!is_clear).then(|| Medium { color, distance: distance.max(1e-12), ..Medium::default() })
}
