//! What descriptions become: all names looked up.

use super::checkerboard::CompiledCheckerboard;
use super::conductor::CompiledConductor;
use super::dielectric::CompiledDielectric;
use super::diffuse::CompiledDiffuse;
use super::emissive::CompiledEmissive;
use super::mask::CompiledMask;
use super::mix::CompiledMix;
use super::phong::CompiledPhong;
use super::{MaterialId, View};
use crate::bsdf::Bsdf;
use crate::medium::Interior;
use crate::texture::TextureTable;

/// A material with all its names looked up.
#[derive(Clone, Debug)]
pub enum Compiled {
    /// The classic model.
    Phong(CompiledPhong),
    /// Scatters as physics says.
    Physical(Physical),
    /// Two materials in alternating cells.
    Checkerboard(CompiledCheckerboard),
    /// One of two by chance.
    Mix(CompiledMix),
    /// Another one with holes.
    Mask(CompiledMask),
    /// Gives off light.
    Emissive(CompiledEmissive),
    /// No surface, only what is behind it.
    Boundary(Interior),
}

/// A material that is nothing but a scattering function.
#[derive(Clone, Debug)]
pub enum Physical {
    /// Matte.
    Diffuse(CompiledDiffuse),
    /// Metal.
    Conductor(CompiledConductor),
    /// Glass.
    Dielectric(CompiledDielectric),
}

impl From<Physical> for Compiled {
    fn from(physical: Physical) -> Self {
        Self::Physical(physical)
    }
}

impl Physical {
    /// How it scatters at a point.
    #[inline]
    pub fn bsdf(&self, textures: &TextureTable, view: &View) -> Bsdf {
        match self {
            Self::Diffuse(diffuse) => diffuse.bsdf(textures, view),
            Self::Conductor(conductor) => conductor.bsdf(textures, view),
            Self::Dielectric(dielectric) => dielectric.bsdf(textures, view),
        }
    }

    /// Whether light goes through it, so that its inside and its outside differ.
    pub fn is_transmissive(&self) -> bool {
        matches!(self, Self::Dielectric(_))
    }

    /// What is behind its surface.
    fn interior(&self) -> Option<Interior> {
        match self {
            Self::Diffuse(_) | Self::Conductor(_) => None,
            Self::Dielectric(dielectric) => dielectric.interior,
        }
    }

    fn is_textured(&self) -> bool {
        match self {
            Self::Diffuse(diffuse) => diffuse.is_textured(),
            Self::Conductor(conductor) => conductor.is_textured(),
            Self::Dielectric(dielectric) => dielectric.is_textured(),
        }
    }
}

impl Compiled {
    /// Whether it differs from place to place, the materials in it not counted.
    pub fn is_textured(&self) -> bool {
        match self {
            Self::Phong(phong) => phong.is_textured(),
            Self::Physical(physical) => physical.is_textured(),
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
            Self::Physical(physical) => physical.interior(),
            _ => None,
        }
    }

    /// The materials that it is made of.
    pub fn parts(&self) -> Vec<MaterialId> {
        match self {
            Self::Phong(_) | Self::Physical(_) | Self::Boundary(_) => Vec::new(),
            Self::Checkerboard(board) => board.choices().to_vec(),
            Self::Mix(mix) => mix.choices().to_vec(),
            Self::Mask(mask) => vec![mask.material],
            Self::Emissive(emissive) => vec![emissive.material],
        }
    }
}
