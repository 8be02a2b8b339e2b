//! Meshes that a skin or morph targets deform in a pose.

use super::Source;
use super::geometry::{Geometry, mesh_data};
use crate::gltf::document::{Document, Node};
use crate::gltf::error::Fault;
use crate::gltf::pose::{MorphBinding, Pose, Skin as PoseSkin, SkinBinding, WeightSources, deform};
use glam::DAffine3;
use juggler_shape::Mesh;
use std::sync::Arc;

/// Matrices of the joints of the skin of a node; `None` for a node without skin.
///
/// # Errors
///
/// The skin is not valid.
pub fn joint_matrices(source: &Source<'_>, node: &Node, worlds: &[DAffine3]) -> Result<Option<Vec<DAffine3>>, Fault> {
    let Some(index) = node.skin else { return Ok(None) };
    let at = || format!("/skins/{index}");
    let Some(skin) = source.data.gltf.document.skins.get(index.get()) else { return Ok(None) };
    let inverse = skin.inverse_bind_matrices.map(|accessor| source.data.mat4(accessor)).transpose()?;
    let joints: Vec<usize> = skin.joints.iter().map(|joint| joint.get()).collect();
    let skin = PoseSkin::new(&joints, inverse.as_deref()).map_err(|error| Fault::at(at(), error))?;
    skin.joint_matrices(worlds).map(Some).map_err(|error| Fault::at(at(), error))
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

/// Mesh of a primitive in a pose: in the space of the node, or of the world if a skin deforms it.
///
/// # Errors
///
/// The deformation is not valid.
pub fn deformed_mesh(
    geometry: &Geometry,
    weights: &[f64],
    joints: Option<&[DAffine3]>,
    at: &str,
) -> Result<Mesh, Fault> {
    let arrays = &geometry.arrays;
    let influences: Vec<_> = arrays.joints.iter().map(crate::gltf::primitive::JointSet::influences).collect();
    let skin = joints.filter(|_| !influences.is_empty());
    let skin = skin.map(|joint_matrices| SkinBinding { joint_matrices, influences: &influences });
    let morphs = MorphBinding { targets: &arrays.targets, weights };
    let deformed = deform(&arrays.vertices, geometry.triangles(), morphs, skin.as_ref());
    let deformed = deformed.map_err(|error| Fault::at(at, error))?;
    Ok(Arc::new(mesh_data(&deformed.vertices, geometry.triangles())).into())
}
