//! Typed documents: the whole core schema of glTF 2.0 and the extensions of
//! [`extensions`](super::extensions).
//!
//! The types mirror the JSON. In the document of a [`Gltf`](super::Gltf), all indices exist and all
//! numbers are in their ranges. `extras` and unknown extensions are not kept.

mod accessor;
mod animation;
mod asset;
mod attributes;
mod buffer;
mod camera;
mod image;
mod light;
mod material;
mod mesh;
mod node;
mod number;
#[cfg(test)]
mod tests;

pub use accessor::{Accessor, ComponentType, ElementType, Sparse, SparseIndices, SparseValues};
pub use animation::{
    Animation, Channel, ChannelTarget, ChannelTargetExtensions, Interpolation, KeySampler, PointerTarget, Skin,
};
pub use asset::Asset;
pub use attributes::{Attributes, Semantic};
pub use buffer::{
    Buffer, BufferExtensions, BufferView, BufferViewExtensions, CompressedView, FallbackBuffer, FilterName, ModeName,
};
pub use camera::{Camera, CameraType, Orthographic, Perspective};
pub use image::{
    AlternativeSource, Image, MagFilter, MinFilter, Sampler, Texture, TextureExtensions, TextureInfo,
    TextureInfoExtensions, TextureTransform, Wrap,
};
pub use light::{
    IesLights, IesProfile, ImageBasedLight, ImageBasedLights, LightType, PunctualLight, PunctualLights, SpotCone,
};
pub use material::{
    AlphaMode, Anisotropy, Clearcoat, DiffuseTransmission, Dispersion, EmissiveStrength, Ior, Iridescence, Material,
    MaterialExtensions, MetallicRoughness, Sheen, Specular, SpecularGlossiness, Transmission, Unlit, Volume,
};
pub use mesh::{DracoExtension, Mesh, Mode, Primitive, PrimitiveExtensions, VariantMapping, VariantMappings};
pub use node::{IesReference, Instancing, LightReference, Node, NodeExtensions, Scene, SceneExtensions, Visibility};
pub use number::{Index, Size};

use serde::Deserialize;

/// A glTF document.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Document {
    /// Version and origin of the document.
    pub asset: Asset,
    /// Names of the extensions that the document uses.
    #[serde(default)]
    pub extensions_used: Vec<String>,
    /// Names of the extensions without which the document cannot be read.
    #[serde(default)]
    pub extensions_required: Vec<String>,
    /// Arrays of numbers.
    #[serde(default)]
    pub accessors: Vec<Accessor>,
    /// Animations.
    #[serde(default)]
    pub animations: Vec<Animation>,
    /// Binary data.
    #[serde(default)]
    pub buffers: Vec<Buffer>,
    /// Ranges of buffers.
    #[serde(default)]
    pub buffer_views: Vec<BufferView>,
    /// Cameras.
    #[serde(default)]
    pub cameras: Vec<Camera>,
    /// Images.
    #[serde(default)]
    pub images: Vec<Image>,
    /// Materials.
    #[serde(default)]
    pub materials: Vec<Material>,
    /// Meshes.
    #[serde(default)]
    pub meshes: Vec<Mesh>,
    /// Nodes.
    #[serde(default)]
    pub nodes: Vec<Node>,
    /// Filters and wrap modes of textures.
    #[serde(default)]
    pub samplers: Vec<Sampler>,
    /// Index of the default scene.
    #[serde(default)]
    pub scene: Option<Index>,
    /// Scenes.
    #[serde(default)]
    pub scenes: Vec<Scene>,
    /// Skins.
    #[serde(default)]
    pub skins: Vec<Skin>,
    /// Textures: images with samplers.
    #[serde(default)]
    pub textures: Vec<Texture>,
    /// Extensions of the document.
    #[serde(default)]
    pub extensions: DocumentExtensions,
}

impl Document {
    /// Whether a buffer view uses a buffer.
    pub fn uses_buffer(&self, buffer: usize) -> bool {
        self.buffer_views.iter().any(|view| {
            let compressed = view.compressed().map(|(_, compressed)| compressed.buffer);
            view.buffer.get() == buffer || compressed.is_some_and(|index| index.get() == buffer)
        })
    }
}

/// Extensions of a document.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct DocumentExtensions {
    /// Point, spot and directional lights.
    #[serde(rename = "KHR_lights_punctual")]
    pub lights_punctual: Option<PunctualLights>,
    /// Variants of materials.
    #[serde(rename = "KHR_materials_variants")]
    pub variants: Option<Variants>,
    /// Environment lights.
    #[serde(rename = "EXT_lights_image_based")]
    pub lights_image_based: Option<ImageBasedLights>,
    /// Light profiles.
    #[serde(rename = "EXT_lights_ies")]
    pub lights_ies: Option<IesLights>,
}

/// Variants of materials (KHR_materials_variants).
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Variants {
    /// The variants, which the primitives of meshes map to materials.
    pub variants: Vec<Variant>,
}

/// A variant of materials.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Variant {
    /// Name of the variant.
    pub name: String,
}
