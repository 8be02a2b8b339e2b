//! Materials of a file with their textures and pictures, each added at its first use.
//!
//! | module | holds |
//! |---|---|
//! | `convert` | properties and extensions of a material as `principled` |
//! | `surface` | what a material shows: sides, normals, alpha, no lighting |
//! | `textures` | images with samplers and transforms, products of textures and factors |
//! | `pictures` | choice and decoding of images |
//! | `tangents` | tangents of meshes without them |

mod convert;
mod pictures;
mod surface;
mod tangents;
#[cfg(test)]
mod tests;
mod textures;

use crate::gltf::data::GltfData;
use crate::gltf::document::{Document, Material, TextureInfo};
use crate::gltf::error::Fault;
use crate::gltf::warning::Warnings;
use crate::textures::NamedTextures;
use indexmap::{IndexMap, IndexSet};
use juggler_material::AnyMaterial;
use juggler_scene::Asset;
use juggler_texture::AnyTexture;
pub use tangents::add_tangents;
use textures::TextureSet;

/// What the material of a primitive depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct PrimitiveSurface {
    /// Whether the vertices have colors.
    pub has_color: bool,
    /// Whether light has an effect: not on points and lines without normals.
    pub is_lit: bool,
}

/// Materials with what they use.
#[derive(Clone, Debug, Default)]
pub struct MaterialParts {
    /// Textures by name.
    pub textures: IndexMap<String, AnyTexture>,
    /// Materials by name.
    pub materials: IndexMap<String, AnyMaterial>,
    /// Pictures by the names that textures use as `file`.
    pub assets: IndexMap<String, Asset>,
    /// Warnings about approximated content.
    pub warnings: Warnings,
}

/// Materials that were used so far.
#[derive(Debug)]
pub struct MaterialSet<'a> {
    document: &'a Document,
    prefix: &'a str,
    /// Names of the materials in the document, without the prefix.
    names: IndexSet<String>,
    materials: IndexMap<String, AnyMaterial>,
    textures: TextureSet<'a>,
}

impl<'a> MaterialSet<'a> {
    /// No materials yet. All names will begin with `prefix`.
    pub fn new(document: &'a Document, data: &'a GltfData, prefix: &'a str) -> Self {
        let names = unique_names("material", document.materials.iter().map(|material| material.name.as_deref()));
        let textures = TextureSet::new(document, data, prefix);
        Self { document, prefix, names, materials: IndexMap::new(), textures }
    }

    /// Name of a material, which is added at its first use. `None` is the default material.
    ///
    /// # Errors
    ///
    /// A picture of the material cannot be read.
    pub fn material(&mut self, index: Option<usize>, surface: &PrimitiveSurface) -> Result<String, Fault> {
        let known = index.and_then(|index| self.names.get_index(index)).map_or("default material", String::as_str);
        let mut name = format!("{}{known}", self.prefix);
        // One material of the file may become up to four.
        name.push_str(if surface.has_color { " with colors" } else { "" });
        name.push_str(if surface.is_lit { "" } else { " without light" });
        if !self.materials.contains_key(&name) {
            let at = index.map_or_else(|| "/materials".to_owned(), |index| format!("/materials/{index}"));
            let standard = Material::default();
            let found = index.and_then(|index| self.document.materials.get(index)).unwrap_or(&standard);
            let material = convert::material(&mut self.textures, found, surface, &at)?;
            self.materials.insert(name.clone(), material);
        }
        Ok(name)
    }

    /// All materials so far.
    pub fn finish(self) -> MaterialParts {
        let TextureSet { textures: NamedTextures { by_name: textures, .. }, pictures, warnings, .. } = self.textures;
        MaterialParts { textures, materials: self.materials, assets: pictures.assets, warnings }
    }
}

/// Set of texture coordinates whose tangents a material needs: that of the normal map, else that of
/// the clearcoat's normal map, else that of the anisotropy.
pub fn tangent_uv_set(document: &Document, index: usize) -> Option<u32> {
    let material = document.materials.get(index)?;
    let extensions = material.extensions.as_deref();
    if extensions.is_some_and(|extensions| extensions.unlit.is_some()) {
        return None;
    }
    let coat = extensions.and_then(|extensions| extensions.clearcoat.as_ref());
    let anisotropy = extensions.and_then(|extensions| extensions.anisotropy.as_ref());
    let anisotropy = anisotropy.filter(|anisotropy| anisotropy.anisotropy_strength > 0.0);
    let set = |info: &TextureInfo| u32::try_from(info.set().get()).unwrap_or_default();
    let normals = material.normal_texture.as_ref();
    let normals = normals.or_else(|| coat?.clearcoat_normal_texture.as_ref()).map(set);
    normals.or_else(|| anisotropy.map(|anisotropy| anisotropy.anisotropy_texture.as_ref().map_or(0, set)))
}

/// Unique names: as in the file, `kind 3` for the fourth if it has none, `Name#2` for the second of
/// a name.
fn unique_names<'n>(kind: &str, names: impl Iterator<Item = Option<&'n str>>) -> IndexSet<String> {
    let mut unique = IndexSet::new();
    for (index, name) in names.enumerate() {
        let name = name.filter(|name| !name.is_empty()).map_or_else(|| format!("{kind} {index}"), str::to_owned);
        let mut candidate = name.clone();
        let mut number = 2u64;
        while !unique.insert(candidate) {
            candidate = format!("{name}#{number}");
            number = number.saturating_add(1);
        }
    }
    unique
}
