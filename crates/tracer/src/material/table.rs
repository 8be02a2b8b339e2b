//! All materials of a world, ready to be asked.

use super::{Compiled, MaterialId, lookup, phong::CompiledPhong};
use crate::bsdf::Phong as PhongLobe;
use crate::surface::Surface;
use crate::texture::TextureTable;
use juggler_math::Rgb;
use std::borrow::Cow;

/// All materials of a world by number, with the textures they use. Made by a
/// [`MaterialCompiler`](super::MaterialCompiler).
#[derive(Clone, Debug, Default)]
pub struct MaterialTable {
    /// A material refers only to earlier ones.
    materials: Vec<Compiled>,
    /// Of each material, whether light gets through it anywhere.
    transparent: Vec<bool>,
    textures: TextureTable,
}

impl MaterialTable {
    pub(super) fn new(textures: TextureTable) -> Self {
        Self { textures, ..Self::default() }
    }

    pub(super) fn push(&mut self, compiled: Compiled) -> MaterialId {
        self.transparent.push(match &compiled {
            Compiled::Phong(phong) => phong.is_transparent(),
            Compiled::Checkerboard(board) => board.choices().iter().any(|id| self.is_transparent(*id)),
        });
        self.materials.push(compiled);
        MaterialId(u32::try_from(self.materials.len() - 1).unwrap_or(u32::MAX))
    }

    /// The textures that its materials use.
    pub fn textures(&self) -> &TextureTable {
        &self.textures
    }

    /// The numbers of material `id` at a point of a surface (world space, normals as the shape gives them);
    /// black for a number that is no material.
    #[inline]
    pub fn phong(&self, id: MaterialId, surface: &Surface) -> Cow<'_, PhongLobe> {
        match self.leaf(id, surface) {
            Some(phong) => phong.eval(&self.textures, || lookup(surface)),
            None => Cow::Borrowed(&PhongLobe::BLACK),
        }
    }

    /// What a shadow ray keeps when it crosses material `id` at this point: its transparency.
    pub fn filter(&self, id: MaterialId, surface: &Surface) -> Rgb {
        self.leaf(id, surface).map_or(Rgb::BLACK, |phong| phong.filter(&self.textures, || lookup(surface)))
    }

    /// Whether light gets through material `id` anywhere; if not, [`MaterialTable::filter`] is black everywhere.
    pub fn is_transparent(&self, id: MaterialId) -> bool {
        self.transparent.get(id.0 as usize).copied().unwrap_or(false)
    }

    /// Whether material `id` differs from place to place.
    pub fn is_textured(&self, id: MaterialId) -> bool {
        !matches!(self.materials.get(id.0 as usize), Some(Compiled::Phong(phong)) if !phong.is_textured())
    }

    /// The material that stands at this point once all checkerboards have chosen. Every choice is an
    /// earlier material, so this ends.
    #[inline]
    fn leaf(&self, mut id: MaterialId, surface: &Surface) -> Option<&CompiledPhong> {
        loop {
            match self.materials.get(id.0 as usize)? {
                Compiled::Phong(phong) => return Some(phong),
                Compiled::Checkerboard(board) => id = board.pick(surface),
            }
        }
    }
}
