//! Compiled materials: descriptions with all names resolved.

use super::bump_map::CompiledBumpMap;
use super::checkerboard::CompiledCheckerboard;
use super::emissive::CompiledEmissive;
use super::mask::CompiledMask;
use super::mix::CompiledMix;
use super::normal_map::CompiledNormalMap;
use super::one_sided::CompiledOneSided;
use super::phong::CompiledPhong;
use super::unlit::CompiledUnlit;
use super::{MaterialId, Shading, ShadingView};
use crate::medium::Interior;
use juggler_bsdf::Bsdf;
use juggler_math::Frame;
use juggler_texture::TextureTable;
use std::fmt::Debug;
use std::sync::Arc;

/// Material with all its names resolved.
#[derive(Clone, Debug)]
pub enum CompiledMaterial {
    /// The classic model.
    Phong(CompiledPhong),
    /// A BSDF alone.
    Scattering(Arc<dyn ScatteringMaterial>),
    /// Two materials in alternating cells.
    Checkerboard(CompiledCheckerboard),
    /// Two materials, of which each sample chooses one at random.
    Mix(CompiledMix),
    /// Another material with an opacity.
    Mask(CompiledMask),
    /// Another material, on the front only.
    OneSided(CompiledOneSided),
    /// Another material with normals from a texture.
    NormalMap(CompiledNormalMap),
    /// Another material with a bump map.
    BumpMap(CompiledBumpMap),
    /// Emission over another material.
    Emissive(CompiledEmissive),
    /// Color without lighting.
    Unlit(CompiledUnlit),
    /// Interface without a BSDF.
    Boundary(Interior),
}

/// Material that consists of a BSDF alone, with its names resolved.
pub trait ScatteringMaterial: Debug + Send + Sync {
    /// Adds the lobes at a point to `bsdf`, in place, because a BSDF is large to return. `frame` is
    /// the frame of the lobes.
    fn add_lobes(&self, textures: &TextureTable, view: &ShadingView, frame: &Frame, bsdf: &mut Bsdf);

    /// Whether the lobes vary over the surface.
    fn is_textured(&self) -> bool;

    /// Whether light passes through the surface.
    fn is_transmissive(&self) -> bool {
        false
    }

    /// Interior of the solid behind the surface; `None` if the surface has no inside.
    fn interior(&self) -> Option<Interior> {
        None
    }

    /// Rotation of the shading frame from u towards v, in full turns; `None` if the rotation has no
    /// effect.
    fn rotation_turns(&self, _textures: &TextureTable, _view: &ShadingView) -> Option<f32> {
        None
    }

    /// Whether scattering depends on the directions of u and v.
    fn is_anisotropic(&self) -> bool {
        false
    }

    /// Whether the lobes have normals from a texture.
    fn has_normal_map(&self) -> bool {
        false
    }
}

impl CompiledMaterial {
    /// Wraps a BSDF.
    pub fn scattering(scattering: impl ScatteringMaterial + 'static) -> Self {
        Self::Scattering(Arc::new(scattering))
    }

    /// Whether shading needs the surface's tangents, nested materials not counted.
    pub fn needs_tangents(&self) -> bool {
        match self {
            Self::Scattering(scattering) => scattering.is_anisotropic() || scattering.has_normal_map(),
            Self::NormalMap(_) | Self::BumpMap(_) => true,
            _ => false,
        }
    }

    /// Whether shading varies over the surface, nested materials not counted.
    pub fn is_textured(&self) -> bool {
        match self {
            Self::NormalMap(_) | Self::BumpMap(_) => true,
            Self::Phong(phong) => phong.is_textured(),
            Self::Scattering(scattering) => scattering.is_textured(),
            Self::Checkerboard(_) | Self::Mix(_) => true,
            Self::Mask(mask) => mask.is_textured(),
            Self::Emissive(emissive) => emissive.is_textured(),
            Self::Unlit(unlit) => unlit.is_textured(),
            Self::Boundary(_) | Self::OneSided(_) => false,
        }
    }

    /// Sets the emission and opacity of a material with neither a BSDF nor a nested material, or of
    /// the back of a one-sided one.
    pub fn end(&self, textures: &TextureTable, view: &ShadingView, shading: &mut Shading) {
        match self {
            Self::Unlit(unlit) => {
                shading.emission += unlit.color(textures, view);
                shading.is_unlit = true;
            }
            Self::OneSided(one_sided) if !one_sided.is_absent_behind => {}
            _ => shading.opacity = 0.0,
        }
    }

    /// Whether the surface is absent for some shadow rays, nested materials not counted.
    pub fn has_absence(&self) -> bool {
        match self {
            Self::Unlit(_) => true,
            Self::OneSided(one_sided) => one_sided.is_absent_behind,
            _ => false,
        }
    }

    /// Interior behind the surface, nested materials not counted.
    pub fn interior(&self) -> Option<Interior> {
        match self {
            Self::Boundary(interior) => Some(*interior),
            Self::Scattering(scattering) => scattering.interior(),
            _ => None,
        }
    }

    /// Nested materials.
    pub fn nested_materials(&self) -> Vec<MaterialId> {
        match self {
            Self::Phong(_) | Self::Scattering(_) | Self::Unlit(_) | Self::Boundary(_) => Vec::new(),
            Self::Checkerboard(board) => board.choices().to_vec(),
            Self::Mix(mix) => mix.choices().to_vec(),
            Self::Mask(mask) => vec![mask.material],
            Self::OneSided(one_sided) => vec![one_sided.material],
            Self::NormalMap(map) => vec![map.material],
            Self::BumpMap(map) => vec![map.material],
            Self::Emissive(emissive) => vec![emissive.material],
        }
    }
}
