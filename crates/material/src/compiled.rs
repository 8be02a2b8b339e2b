//! What descriptions become: all names looked up.

use super::bump_map::CompiledBumpMap;
use super::checkerboard::CompiledCheckerboard;
use super::conductor::CompiledConductor;
use super::dielectric::CompiledDielectric;
use super::diffuse::CompiledDiffuse;
use super::emissive::CompiledEmissive;
use super::mask::CompiledMask;
use super::mix::CompiledMix;
use super::normal_map::CompiledNormalMap;
use super::phong::CompiledPhong;
use super::plastic::CompiledPlastic;
use super::principled::CompiledPrincipled;
use super::translucent::CompiledTranslucent;
use super::velvet::CompiledVelvet;
use super::{MaterialId, View};
use crate::medium::Interior;
use juggler_bsdf::Bsdf;
use juggler_texture::TextureTable;

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
    /// Another one with normals from a texture.
    NormalMap(CompiledNormalMap),
    /// Another one raised by a texture.
    BumpMap(CompiledBumpMap),
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
    /// Coated.
    Plastic(CompiledPlastic),
    /// Cloth.
    Velvet(CompiledVelvet),
    /// Paper.
    Translucent(CompiledTranslucent),
    /// What glTF describes.
    Principled(Box<CompiledPrincipled>),
}

impl From<Physical> for Compiled {
    fn from(physical: Physical) -> Self {
        Self::Physical(physical)
    }
}

impl Physical {
    /// Adds the lobes at a point to `bsdf`: in place, for a scattering function is large to return.
    #[inline]
    pub fn add_lobes(&self, textures: &TextureTable, view: &View, bsdf: &mut Bsdf) {
        match self {
            Self::Diffuse(diffuse) => diffuse.add_lobes(textures, view, bsdf),
            Self::Conductor(conductor) => conductor.add_lobes(textures, view, bsdf),
            Self::Dielectric(dielectric) => dielectric.add_lobes(textures, view, bsdf),
            Self::Plastic(plastic) => plastic.add_lobes(textures, view, bsdf),
            Self::Velvet(velvet) => velvet.add_lobes(textures, view, bsdf),
            Self::Translucent(translucent) => translucent.add_lobes(textures, view, bsdf),
            Self::Principled(principled) => principled.add_lobes(textures, view, bsdf),
        }
    }

    /// Whether light goes through it.
    pub fn is_transmissive(&self) -> bool {
        match self {
            Self::Dielectric(_) | Self::Translucent(_) => true,
            Self::Principled(principled) => principled.is_transmissive(),
            Self::Diffuse(_) | Self::Conductor(_) | Self::Plastic(_) | Self::Velvet(_) => false,
        }
    }

    /// What is behind its surface, whose inside and outside then differ.
    pub fn interior(&self) -> Option<Interior> {
        match self {
            Self::Dielectric(dielectric) => dielectric.interior,
            Self::Principled(principled) => principled.interior,
            Self::Diffuse(_) | Self::Conductor(_) | Self::Plastic(_) | Self::Velvet(_) | Self::Translucent(_) => None,
        }
    }

    /// How far its frame is turned from u towards v, in whole turns; `None` where that makes no difference.
    pub fn turns(&self, textures: &TextureTable, view: &View) -> Option<f32> {
        match self {
            Self::Conductor(conductor) => conductor.roughness.turns(textures, view),
            Self::Dielectric(dielectric) => dielectric.roughness.turns(textures, view),
            Self::Plastic(plastic) => plastic.roughness.turns(textures, view),
            Self::Principled(principled) => principled.turns(textures, view),
            Self::Diffuse(_) | Self::Velvet(_) | Self::Translucent(_) => None,
        }
    }

    /// Whether it matters which way along the surface is which.
    fn is_stretched(&self) -> bool {
        match self {
            Self::Conductor(conductor) => conductor.roughness.is_stretched(),
            Self::Dielectric(dielectric) => dielectric.roughness.is_stretched(),
            Self::Plastic(plastic) => plastic.roughness.is_stretched(),
            Self::Principled(principled) => principled.is_stretched(),
            Self::Diffuse(_) | Self::Velvet(_) | Self::Translucent(_) => false,
        }
    }

    fn is_textured(&self) -> bool {
        match self {
            Self::Diffuse(diffuse) => diffuse.is_textured(),
            Self::Conductor(conductor) => conductor.is_textured(),
            Self::Dielectric(dielectric) => dielectric.is_textured(),
            Self::Plastic(plastic) => plastic.is_textured(),
            Self::Velvet(velvet) => velvet.is_textured(),
            Self::Translucent(translucent) => translucent.is_textured(),
            Self::Principled(principled) => principled.is_textured(),
        }
    }
}

impl Compiled {
    /// Whether it must know how the surface runs along its coordinates, the materials in it not counted.
    pub fn needs_tangents(&self) -> bool {
        match self {
            Self::Physical(physical) => physical.is_stretched(),
            Self::NormalMap(_) | Self::BumpMap(_) => true,
            _ => false,
        }
    }

    /// Whether it differs from place to place, the materials in it not counted.
    pub fn is_textured(&self) -> bool {
        match self {
            Self::NormalMap(_) | Self::BumpMap(_) => true,
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
            Self::NormalMap(map) => vec![map.material],
            Self::BumpMap(map) => vec![map.material],
            Self::Emissive(emissive) => vec![emissive.material],
        }
    }
}
