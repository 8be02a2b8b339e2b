//! Materials of a file with their textures, each added at its first use.

use crate::gltf::data::GltfData;
use crate::gltf::document::Document;
use crate::gltf::error::Fault;
use crate::gltf::warning::Warnings;
use indexmap::IndexMap;
use juggler_material::{AnyMaterial, Principled};
use juggler_scene::Asset;
use juggler_texture::AnyTexture;

/// What the material of a primitive depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct PrimitiveSurface {
    /// Whether the vertices have colors.
    pub has_color: bool,
    /// Whether light has an effect: not on points and lines without normals.
    pub is_lit: bool,
}

/// Materials with what they use.
#[derive(Debug, Default)]
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
    parts: MaterialParts,
}

impl<'a> MaterialSet<'a> {
    /// No materials yet.
    pub fn new(document: &'a Document, _data: &'a GltfData, prefix: &'a str) -> Self {
        Self { document, prefix, parts: MaterialParts::default() }
    }

    /// Name of a material, which is added at its first use. `None` is the default material.
    ///
    /// # Errors
    ///
    /// A picture of the material cannot be read.
    pub fn material(&mut self, index: Option<usize>, _surface: &PrimitiveSurface) -> Result<String, Fault> {
        let name = match index {
            Some(index) => format!("{}material {index}", self.prefix),
            None => format!("{}default material", self.prefix),
        };
        if !self.parts.materials.contains_key(&name) {
            let known = index.and_then(|index| self.document.materials.get(index));
            let roughness = known.map_or(1.0, |material| material.pbr_metallic_roughness.roughness_factor as f32);
            let material = Principled { roughness: roughness.into(), ..Principled::default() };
            self.parts.materials.insert(name.clone(), material.into());
        }
        Ok(name)
    }

    /// All materials so far.
    pub fn finish(self) -> MaterialParts {
        self.parts
    }
}
