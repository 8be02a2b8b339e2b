//! What the surface of a material shows: its sides, normals, alpha, and color without lighting.
//!
//! Each function stands for one setting of a material, so that a closer setting takes its place.

use super::PrimitiveSurface;
use super::convert::Base;
use super::textures::{Reading, TextureSet};
use crate::gltf::document::{AlphaMode, Clearcoat, Material, MaterialExtensions, TextureInfo};
use crate::gltf::error::Fault;
use crate::textures::with_vertex_colors;
use juggler_material::medium::MAX_DISPERSION;
use juggler_material::{AnyMaterial, Mask, MaterialRef, NormalMap, Principled, SurfaceSides, Unlit};
use juggler_math::Rgb;
use juggler_texture::Input;

/// Encoding of the unchanged normal in a normal map.
const UNCHANGED_NORMAL: Rgb = Rgb::new(0.5, 0.5, 1.0);
/// Largest strength of a normal map.
const MAX_NORMAL_SCALE: f64 = 1000.0;

/// Sets the dispersion of the light that a material refracts.
pub fn set_dispersion(textures: &mut TextureSet<'_>, principled: &mut Principled, dispersion: f64, at: &str) {
    if principled.thin || principled.transmission.constant() == Some(0.0) {
        let warning = "its dispersion has no effect, because it refracts no light";
        return textures.warnings.add(at, warning, u64::from(dispersion > 0.0));
    }
    principled.dispersion = dispersion.clamp(0.0, MAX_DISPERSION.into()) as f32;
}

/// Rotation of the anisotropy in turns, with the directions of a texture.
///
/// # Errors
///
/// The picture cannot be read.
pub fn direction(
    textures: &mut TextureSet<'_>,
    turns: f64,
    texture: Option<&TextureInfo>,
) -> Result<Input<f32>, Fault> {
    let turns = turns as f32;
    let Some(info) = texture else { return Ok(turns.into()) };
    Ok(textures.directions(info, turns)?.unwrap_or_else(|| turns.into()))
}

/// Sides of the surface that are visible. The back is absent unless the material is double-sided or
/// light passes through it.
pub fn sides(material: &Material, extensions: &MaterialExtensions) -> SurfaceSides {
    let is_thick = extensions.volume.as_ref().is_some_and(|volume| volume.thickness_factor > 0.0);
    let transmission = extensions.transmission.as_ref().map_or(0.0, |model| model.transmission_factor);
    let diffuse = extensions.diffuse_transmission.as_ref().map_or(0.0, |model| model.diffuse_transmission_factor);
    let is_visible_behind = material.double_sided || is_thick || transmission > 0.0 || diffuse > 0.0;
    if is_visible_behind { SurfaceSides::Both } else { SurfaceSides::Front }
}

/// Material with its normal maps.
pub fn with_normals(
    textures: &mut TextureSet<'_>,
    mut principled: Principled,
    material: &Material,
    coat: Option<&Clearcoat>,
) -> Result<AnyMaterial, Fault> {
    if let Some(coat) = coat.filter(|coat| coat.clearcoat_factor > 0.0)
        && coat.clearcoat_normal_texture != material.normal_texture
    {
        let mapped = normals(textures, coat.clearcoat_normal_texture.as_ref())?;
        let (normal, scale) = mapped.unwrap_or((UNCHANGED_NORMAL.into(), 1.0));
        principled.clearcoat_normal = Some(normal);
        principled.clearcoat_normal_scale = scale;
    }
    let Some((texture, strength)) = normals(textures, material.normal_texture.as_ref())? else {
        return Ok(principled.into());
    };
    Ok(NormalMap { texture, strength: strength.into(), material: MaterialRef::from(principled) }.into())
}

/// Texture and strength of a normal map.
fn normals(textures: &mut TextureSet<'_>, info: Option<&TextureInfo>) -> Result<Option<(Input<Rgb>, f32)>, Fault> {
    let Some(info) = info else { return Ok(None) };
    let texture = textures.normals(info, info.scale < 0.0)?;
    Ok(texture.map(|texture| (texture, info.scale.abs().min(MAX_NORMAL_SCALE) as f32)))
}

/// Opacity and its threshold by the alpha mode.
pub fn opacity(
    textures: &mut TextureSet<'_>,
    factor: f64,
    texture: Option<&TextureInfo>,
    material: &Material,
    surface: &PrimitiveSurface,
) -> Result<(Input<f32>, Option<f32>), Fault> {
    let is_mask = match material.alpha_mode {
        AlphaMode::Opaque => return Ok((1.0.into(), None)),
        AlphaMode::Mask if material.alpha_cutoff > 1.0 => return Ok((0.0.into(), None)),
        AlphaMode::Mask => true,
        AlphaMode::Blend => false,
    };
    let mut opacity = textures.number(factor, texture, Reading::alpha(is_mask))?;
    if surface.has_color {
        opacity = with_vertex_colors(opacity);
    }
    Ok((opacity, is_mask.then_some(material.alpha_cutoff as f32)))
}

/// Material that shows its base color without lighting.
pub fn unlit(
    textures: &mut TextureSet<'_>,
    material: &Material,
    base: &Base<'_>,
    surface: &PrimitiveSurface,
) -> Result<AnyMaterial, Fault> {
    let color = base.color(textures, surface)?;
    let (opacity, cutoff) = base.opacity(textures, material, surface)?;
    if cutoff.is_none() {
        return Ok(Unlit { color, opacity }.into());
    }
    let shown = MaterialRef::from(Unlit { color, ..Unlit::default() });
    Ok(Mask { opacity, cutoff, material: shown }.into())
}
