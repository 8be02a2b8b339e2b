//! Scenes and nodes (glTF 2.0, section 3.5), and extensions of nodes.

use super::attributes::Attributes;
use super::number::Index;
use serde::Deserialize;

/// A scene.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Scene {
    /// Indices of the root nodes.
    #[serde(default)]
    pub nodes: Vec<Index>,
    /// Name for people.
    pub name: Option<String>,
    /// Extensions.
    #[serde(default)]
    pub extensions: SceneExtensions,
}

/// Extensions of a scene.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct SceneExtensions {
    /// Environment light.
    #[serde(rename = "EXT_lights_image_based")]
    pub light_image_based: Option<LightReference>,
}

/// Index of a light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub struct LightReference {
    /// Index into the lights of the extension.
    pub light: Index,
}

/// A node: a transform, with children, and optionally a mesh, camera or light.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Node {
    /// Indices of the children.
    #[serde(default)]
    pub children: Vec<Index>,
    /// Index of the camera.
    pub camera: Option<Index>,
    /// Index of the mesh.
    pub mesh: Option<Index>,
    /// Index of the skin of the mesh.
    pub skin: Option<Index>,
    /// 4×4 matrix to the space of the parent, by columns.
    pub matrix: Option<Box<[f64; 16]>>,
    /// Rotation as a quaternion x, y, z, w.
    pub rotation: Option<[f64; 4]>,
    /// Scale factors along the axes.
    pub scale: Option<[f64; 3]>,
    /// Translation.
    pub translation: Option<[f64; 3]>,
    /// Weights of the morph targets of the mesh.
    #[serde(default)]
    pub weights: Vec<f64>,
    /// Name for people.
    pub name: Option<String>,
    /// Extensions.
    pub extensions: Option<Box<NodeExtensions>>,
}

/// Extensions of a node.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct NodeExtensions {
    /// Point, spot or directional light.
    #[serde(rename = "KHR_lights_punctual")]
    pub light_punctual: Option<LightReference>,
    /// Visibility of the node and its descendants.
    #[serde(rename = "KHR_node_visibility")]
    pub visibility: Option<Visibility>,
    /// Instances of the mesh.
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    pub instancing: Option<Instancing>,
    /// Light with a profile.
    #[serde(rename = "EXT_lights_ies")]
    pub light_ies: Option<IesReference>,
}

/// Visibility of a node (KHR_node_visibility).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(default)]
pub struct Visibility {
    /// Whether the node and its descendants are visible.
    pub visible: bool,
}

impl Default for Visibility {
    fn default() -> Self {
        Self { visible: true }
    }
}

/// Instances of a node's mesh (EXT_mesh_gpu_instancing).
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Instancing {
    /// Accessors of `TRANSLATION`, `ROTATION`, `SCALE` and attributes of applications.
    #[serde(default)]
    pub attributes: Attributes,
}

/// Light with a profile (EXT_lights_ies).
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct IesReference {
    /// Index into the light profiles.
    pub light: Index,
    /// Factor of the intensities.
    #[serde(default = "one")]
    pub multiplier: f64,
    /// Linear color.
    #[serde(default = "white")]
    pub color: [f64; 3],
}

fn one() -> f64 {
    1.0
}

fn white() -> [f64; 3] {
    [1.0; 3]
}
