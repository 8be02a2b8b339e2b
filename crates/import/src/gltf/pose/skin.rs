//! Skins: linear blend skinning (glTF 2.0, section 3.7.3).
//!
//! A vertex is transformed by M = Σ weight · W(joint) · IBM(joint), where W is a joint's transform
//! to world space and IBM its inverse bind matrix, so the result is in world space. The transform
//! of the node that draws the mesh has no effect. Normals are transformed by the inverse transpose
//! of M, tangents by M; the sign of the bitangent is kept. As in the specification, normals do not
//! account for the change of weights along the surface.

use super::matrix::{MatrixError, affine_from_columns, normal_matrix};
use super::morph::MorphedVertices;
use glam::{DAffine3, DMat3, DVec3};

/// Largest deviation of the sum of a vertex's weights from 1 that needs no warning.
const SUM_TOLERANCE: f64 = 1e-3;

/// Error of a skin or of its influences on vertices.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SkinError {
    /// There are fewer inverse bind matrices than joints.
    #[error("there are {found} inverse bind matrices for {joints} joints")]
    InverseBindCount {
        /// Number of matrices.
        found: usize,
        /// Number of joints.
        joints: usize,
    },
    /// An inverse bind matrix is not affine.
    #[error("inverse bind matrix {joint}: {error}")]
    InverseBind {
        /// Index of the joint in the skin.
        joint: usize,
        /// The error.
        error: MatrixError,
    },
    /// A joint is not a node.
    #[error("joint {joint} is node {node}; there are {nodes} nodes")]
    Node {
        /// Index of the joint in the skin.
        joint: usize,
        /// Index of the node.
        node: usize,
        /// Number of nodes.
        nodes: usize,
    },
    /// An array of influences has another length than the mesh.
    #[error("set {set} has {found} influences; the mesh has {expected} vertices")]
    Count {
        /// Index of the set.
        set: usize,
        /// Number of elements of the shorter array.
        found: usize,
        /// Number of vertices.
        expected: usize,
    },
    /// A vertex has an influence of a joint that the skin lacks.
    #[error("vertex {vertex} has joint {joint}; the skin has {joints} joints")]
    Joint {
        /// Index of the vertex.
        vertex: usize,
        /// Index of the joint in the skin.
        joint: u16,
        /// Number of joints.
        joints: usize,
    },
    /// A weight is infinite or not a number.
    #[error("vertex {vertex} has the weight {weight}; weights must be finite")]
    Weight {
        /// Index of the vertex.
        vertex: usize,
        /// The weight.
        weight: f32,
    },
}

/// A skin: joints, which are nodes, and their inverse bind matrices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skin {
    /// Index of each joint's node, and inverse bind matrix.
    joints: Vec<(usize, DAffine3)>,
}

/// Up to four influences on each vertex: a pair of attributes `JOINTS_n` and `WEIGHTS_n`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InfluenceSet<'a> {
    /// Indices into the joints of the skin.
    pub joints: &'a [[u16; 4]],
    /// Weights. Influences of weight 0 have no effect, whatever their joint.
    pub weights: &'a [[f32; 4]],
}

/// A skin in a pose, and its influences on the vertices of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkinBinding<'a> {
    /// Matrices of [`Skin::joint_matrices`].
    pub joint_matrices: &'a [DAffine3],
    /// Sets of influences, any number.
    pub influences: &'a [InfluenceSet<'a>],
}

/// Numbers of vertices that a skin treats in a special way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct SkinCounts {
    pub renormalized: usize,
    pub unweighted: usize,
    pub mirrored: usize,
}

/// Weighted sum of the matrices of a vertex.
struct Blend {
    map: DAffine3,
    weight_sum: f64,
}

impl Skin {
    /// Constructs a skin from the nodes of its joints and the inverse bind matrices, column-major;
    /// without matrices they are the identity.
    pub fn new(joints: &[usize], inverse_bind_matrices: Option<&[[f32; 16]]>) -> Result<Self, SkinError> {
        let Some(matrices) = inverse_bind_matrices else {
            return Ok(Self { joints: joints.iter().map(|node| (*node, DAffine3::IDENTITY)).collect() });
        };
        if matrices.len() < joints.len() {
            return Err(SkinError::InverseBindCount { found: matrices.len(), joints: joints.len() });
        }
        let affine = |(joint, (node, columns)): (usize, (&usize, &[f32; 16]))| {
            let matrix = affine_from_columns(&columns.map(f64::from));
            matrix.map(|matrix| (*node, matrix)).map_err(|error| SkinError::InverseBind { joint, error })
        };
        let joints: Result<_, _> = joints.iter().zip(matrices).enumerate().map(affine).collect();
        Ok(Self { joints: joints? })
    }

    /// Matrices W · IBM of all joints, from the transforms of all nodes to world space.
    pub fn joint_matrices(&self, world_transforms: &[DAffine3]) -> Result<Vec<DAffine3>, SkinError> {
        let nodes = world_transforms.len();
        let matrix = |(joint, (node, inverse_bind)): (usize, &(usize, DAffine3))| {
            let world = world_transforms.get(*node).ok_or(SkinError::Node { joint, node: *node, nodes })?;
            Ok(*world * *inverse_bind)
        };
        self.joints.iter().enumerate().map(matrix).collect()
    }
}

impl SkinBinding<'_> {
    /// Transforms morphed vertices to world space.
    pub(super) fn skin(&self, mut vertices: MorphedVertices) -> Result<(MorphedVertices, SkinCounts), SkinError> {
        self.check(vertices.positions.len())?;
        let mut counts = SkinCounts::default();
        let mut normals = vertices.normals.iter_mut();
        let mut tangents = vertices.tangents.iter_mut();
        for (vertex, position) in vertices.positions.iter_mut().enumerate() {
            let blend = self.blend(vertex)?;
            counts.add(&blend);
            *position = blend.map.transform_point3(*position);
            if let Some(normal) = normals.next() {
                *normal = (normal_matrix(&blend.map.matrix3) * *normal).normalize_or_zero();
            }
            if let Some(tangent) = tangents.next() {
                *tangent = blend.map.transform_vector3(*tangent).normalize_or_zero();
            }
        }
        Ok((vertices, counts))
    }

    fn check(&self, vertices: usize) -> Result<(), SkinError> {
        for (set, influences) in self.influences.iter().enumerate() {
            let shorter = influences.joints.len().min(influences.weights.len());
            let longer = influences.joints.len().max(influences.weights.len());
            if (shorter, longer) != (vertices, vertices) {
                return Err(SkinError::Count { set, found: shorter, expected: vertices });
            }
        }
        Ok(())
    }

    /// Blends the matrices of a vertex; the weights are divided by their sum. A vertex whose
    /// weights do not have a positive sum stays in place.
    fn blend(&self, vertex: usize) -> Result<Blend, SkinError> {
        let (mut linear, mut translation, mut weight_sum) = (DMat3::ZERO, DVec3::ZERO, 0.0);
        let sets = self.influences.iter().filter_map(|set| set.joints.get(vertex).zip(set.weights.get(vertex)));
        let influences = sets.flat_map(|(joints, weights)| joints.iter().copied().zip(weights.iter().copied()));
        for (joint, weight) in influences.filter(|(_, weight)| *weight != 0.0) {
            if !weight.is_finite() {
                return Err(SkinError::Weight { vertex, weight });
            }
            let joints = self.joint_matrices.len();
            let matrix =
                self.joint_matrices.get(usize::from(joint)).ok_or(SkinError::Joint { vertex, joint, joints })?;
            let weight = f64::from(weight);
            linear += matrix.matrix3 * weight;
            translation += matrix.translation * weight;
            weight_sum += weight;
        }
        if weight_sum <= 0.0 {
            return Ok(Blend { map: DAffine3::IDENTITY, weight_sum });
        }
        let map = DAffine3::from_mat3_translation(linear / weight_sum, translation / weight_sum);
        Ok(Blend { map, weight_sum })
    }
}

impl SkinCounts {
    fn add(&mut self, blend: &Blend) {
        let is_unweighted = blend.weight_sum <= 0.0;
        let is_off = !is_unweighted && (blend.weight_sum - 1.0).abs() > SUM_TOLERANCE;
        self.unweighted += usize::from(is_unweighted);
        self.renormalized += usize::from(is_off);
        self.mirrored += usize::from(blend.map.matrix3.determinant() < 0.0);
    }
}

#[cfg(test)]
mod tests;
