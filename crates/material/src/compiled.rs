//! What descriptions become: all names looked up.

use super::bump_map::CompiledBumpMap;
use super::checkerboard::CompiledCheckerboard;
use super::emissive::CompiledEmissive;
use super::mask::CompiledMask;
use super::mix::CompiledMix;
use super::normal_map::CompiledNormalMap;
use super::phong::CompiledPhong;
use super::{MaterialId, View};
use crate::medium::Interior;
use juggler_bsdf::Bsdf;
use juggler_texture::TextureTable;
use std::fmt::Debug;
use std::sync::Arc;

/// A material with all its names looked up.
#[derive(Clone, Debug)]
pub enum Compiled {
    /// The classic model.
    Phong(CompiledPhong),
    /// A scattering function alone.
    Scattering(Arc<dyn ScatteringMaterial>),
    /// Two materials in alternating cells.
    Checkerboard(CompiledCheckerboard),
    /// One of two by chance.
    Mix(CompiledMix),
    /// Another one with holes.
    Mask(CompiledMask),
    /// Another one with normals from a texture.
    NormalMap(CompiledNormalMap),
    /// Another one raised by a texture.
    BumpMap(CompiledBumpMap),
    /// Gives off light.
    Emissive(CompiledEmissive),
    /// No surface, only what is behind it.
    Boundary(Interior),
}

/// A material that is nothing but a scattering function, with its names looked up.
pub trait ScatteringMaterial: Debug + Send + Sync {
    /// Adds the lobes at a point to `bsdf`: in place, because a scattering function is large to
    /// return.
    fn add_lobes(&self, textures: &TextureTable, view: &View, bsdf: &mut Bsdf);

    /// Whether the lobes differ from point to point.
    fn is_textured(&self) -> bool;

    /// Whether light passes through the surface.
    fn is_transmissive(&self) -> bool {
        false
    }

    /// Medium behind the surface, whose inside and outside then differ.
    fn interior(&self) -> Option<Interior> {
        None
    }

    /// Rotation of the shading frame from u towards v, in whole turns; `None` where the rotation
    /// makes no difference.
    fn turns(&self, _textures: &TextureTable, _view: &View) -> Option<f32> {
        None
    }

    /// Whether scattering depends on the directions of u and v.
    fn is_stretched(&self) -> bool {
        false
    }
}

impl Compiled {
    /// Wraps a scattering function.
    pub fn scattering(scattering: impl ScatteringMaterial + 'static) -> Self {
        Self::Scattering(Arc::new(scattering))
    }

    /// Whether it must know how the surface runs along its coordinates, the materials in it not counted.
    pub fn needs_tangents(&self) -> bool {
        match self {
            Self::Scattering(scattering) => scattering.is_stretched(),
            Self::NormalMap(_) | Self::BumpMap(_) => true,
            _ => false,
        }
    }

    /// Whether it differs from place to place, the materials in it not counted.
    pub fn is_textured(&self) -> bool {
        match self {
            Self::NormalMap(_) | Self::BumpMap(_) => true,
            Self::Phong(phong) => phong.is_textured(),
            Self::Scattering(scattering) => scattering.is_textured(),
            Self::Checkerboard(_) | Self::Mix(_) => true,
            Self::Mask(mask) => mask.is_textured(),
            Self::Emissive(emissive) => emissive.is_textured(),
            Self::Boundary(_) => false,
        }
    }

    /// What is behind its surface, the materials in it not counted.
    pub fn interior(&self) -> Option<Interior> {
        match self {
            Self::Boundary(interior) => Some(*interior),
            Self::Scattering(scattering) => scattering.interior(),
            _ => None,
        }
    }

    /// The materials that it is made of.
    pub fn parts(&self) -> Vec<MaterialId> {
        match self {
            Self::Phong(_) | Self::Scattering(_) | Self::Boundary(_) => Vec::new(),
            Self::Checkerboard(board) => board.choices().to_vec(),
            Self::Mix(mix) => mix.choices().to_vec(),
            Self::Mask(mask) => vec![mask.material],
            Self::NormalMap(map) => vec![map.material],
            Self::BumpMap(map) => vec![map.material],
            Self::Emissive(emissive) => vec![emissive.material],
        }
    }
}
