//! Primitives that a skin or morph targets deform in a pose.

use super::meshes::mesh;
use crate::gltf::data::GltfData;
use crate::gltf::document::Document;
use crate::gltf::error::Fault;
use crate::gltf::pose::{Deformed, MorphBinding, Pose, Skin, SkinBinding, WeightSources, deform};
use crate::gltf::primitive::{Faces, JointSet, PrimitiveArrays};
use glam::DAffine3;
use juggler_shape::Mesh;
use std::sync::OnceLock;

/// Skins of a file, each decoded at its first use.
#[derive(Debug, Default)]
pub struct Skins(Vec<OnceLock<Result<Skin, Fault>>>);

impl Skins {
    /// Skins of a document, none of them decoded.
    pub fn new(document: &Document) -> Self {
        Self(document.skins.iter().map(|_| OnceLock::new()).collect())
    }

    /// Matrices of the joints of a skin, from the transforms of all nodes to world space.
    ///
    /// # Errors
    ///
    /// The inverse bind matrices are not valid.
    pub fn joint_matrices(&self, data: &GltfData, skin: usize, worlds: &[DAffine3]) -> Result<Vec<DAffine3>, Fault> {
        let missing = || Fault::at(format_args!("/skins/{skin}"), "there is no such skin");
        let cell = self.0.get(skin).ok_or_else(missing)?;
        let decoded = cell.get_or_init(|| decode(data, skin)).as_ref().map_err(Clone::clone)?;
        decoded.joint_matrices(worlds).map_err(|error| Fault::at(format_args!("/skins/{skin}"), error))
    }
}

fn decode(data: &GltfData, index: usize) -> Result<Skin, Fault> {
    let at = format!("/skins/{index}");
    let skin = data.gltf.document.skins.get(index).ok_or_else(|| Fault::at(&at, "there is no such skin"))?;
    let matrices = skin.inverse_bind_matrices.map(|accessor| data.mat4(accessor)).transpose()?;
    let joints: Vec<usize> = skin.joints.iter().map(|joint| joint.get()).collect();
    Skin::new(&joints, matrices.as_deref()).map_err(|error| Fault::at(at, error))
}

/// How a node deforms its mesh in a pose.
#[derive(Clone, Debug, Default)]
pub struct Deformation {
    /// Matrices of the joints, with a skin.
    pub joints: Option<Vec<DAffine3>>,
    /// Weights of the morph targets.
    pub weights: Vec<f64>,
}

impl Deformation {
    /// Whether vertices of a primitive may move. Weights of 0 leave a mesh without skin as it is.
    pub fn moves(&self, arrays: &PrimitiveArrays) -> bool {
        let is_skinned = self.joints.is_some() && !arrays.joints.is_empty();
        is_skinned || (!arrays.targets.is_empty() && self.weights.iter().any(|weight| *weight != 0.0))
    }

    /// Deformed vertices of a primitive: in the space of the node, or of the world with a skin.
    ///
    /// # Errors
    ///
    /// The deformation does not fit the arrays.
    pub fn apply(&self, arrays: &PrimitiveArrays, at: &str) -> Result<Deformed, Fault> {
        let influences: Vec<_> = arrays.joints.iter().map(JointSet::influences).collect();
        let joints = self.joints.as_deref().filter(|_| !influences.is_empty());
        let skin = joints.map(|joint_matrices| SkinBinding { joint_matrices, influences: &influences });
        let morphs = MorphBinding { targets: &arrays.targets, weights: &self.weights };
        let triangles = match &arrays.faces {
            Faces::Triangles(triangles) => triangles.as_slice(),
            Faces::Points(_) | Faces::Lines(_) => &[],
        };
        deform(&arrays.vertices, triangles, morphs, skin.as_ref()).map_err(|error| Fault::at(at, error))
    }
}

/// Mesh of deformed triangles. Where the skin reflects all vertices, the corners change their order,
/// so the front stays the outside.
pub fn deformed_mesh(mut deformed: Deformed, triangles: &[[u32; 3]]) -> Mesh {
    let is_mirrored = deformed.mirrored > 0 && deformed.mirrored == deformed.vertices.positions.len();
    if !is_mirrored {
        return mesh(deformed.vertices, triangles.to_vec());
    }
    deformed.vertices.tangents.iter_mut().for_each(|[.., sign]| *sign = -*sign);
    mesh(deformed.vertices, triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect())
}

/// Weights of the morph targets of a node's mesh in a pose.
pub fn morph_weights(document: &Document, node: usize, mesh: usize, pose: &Pose) -> Vec<f64> {
    let Some(found) = document.meshes.get(mesh) else { return Vec::new() };
    let sources = WeightSources {
        node_animation: pose.nodes.get(&node).map(|pose| &pose.weights),
        node: document.nodes.get(node).map(|node| node.weights.as_slice()).unwrap_or_default(),
        mesh_animation: pose.meshes.get(&mesh),
        mesh: &found.weights,
    };
    sources.resolve(found.targets())
}
