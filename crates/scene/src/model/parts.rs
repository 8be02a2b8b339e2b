//! Parts of a scene that a model file is translated to.

use crate::{Asset, Item, Object};
use indexmap::IndexMap;
use juggler_camera::AnyCamera;
use juggler_light::AnyLight;
use juggler_light::background::AnyBackground;
use juggler_material::AnyMaterial;
use juggler_texture::AnyTexture;

/// Parts of a scene, at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModelParts {
    /// Pictures by the names that textures and backgrounds use as `file`.
    pub assets: IndexMap<String, Asset>,
    /// Textures by name.
    pub textures: IndexMap<String, AnyTexture>,
    /// Materials by name.
    pub materials: IndexMap<String, AnyMaterial>,
    /// Groups of objects by name: meshes that several nodes place.
    pub groups: IndexMap<String, Vec<Object>>,
    /// Cameras by name, in world space of the model.
    pub cameras: IndexMap<String, AnyCamera>,
    /// Lights with the names of their nodes, in world space of the model.
    pub lights: Vec<(String, AnyLight)>,
    /// Objects, one for each drawn node, in depth-first order. Their names are paths of node names,
    /// such as "Root/Body/Head". A hidden node's objects are there and not visible.
    pub objects: Vec<Item<Object>>,
    /// Whether the objects depend on the size of the picture.
    pub depends_on_size: bool,
    /// Image-based light of the file.
    pub background: Option<AnyBackground>,
    /// Warnings about approximated, repaired and ignored content, one per kind with a count.
    pub warnings: Vec<String>,
}
