//! Local transforms of nodes: translation, rotation and scale, or a matrix (glTF 2.0, section
//! 3.5.3).

use super::clip::NodePose;
use super::curve::UNIT_TOLERANCE;
use super::matrix::{MatrixError, affine_from_columns};
use glam::{DAffine3, DQuat, DVec3};
use juggler_math::quaternion;

/// Error of the transform of a node.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NodeError {
    /// The matrix is not affine.
    #[error(transparent)]
    Matrix(#[from] MatrixError),
    /// The rotation is the zero quaternion or not finite.
    #[error("the rotation is {rotation:?}, which is no rotation")]
    Rotation {
        /// The quaternion x, y, z, w.
        rotation: [f64; 4],
    },
    /// The translation or the scale is not finite.
    #[error("`{property}` is {value:?}; all numbers must be finite")]
    NotFinite {
        /// Name of the property.
        property: &'static str,
        /// The numbers.
        value: [f64; 3],
    },
}

/// Transform of a node to the space of its parent, as the file has it.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeTransform(Local);

#[derive(Clone, Debug, PartialEq)]
enum Local {
    Matrix(DAffine3),
    Parts { translation: DVec3, rotation: DQuat, scale: DVec3 },
}

impl Default for NodeTransform {
    /// The identity transform, of which animations can replace each part.
    fn default() -> Self {
        Self(Local::Parts { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE })
    }
}

impl NodeTransform {
    /// Transform by a 4×4 matrix in column-major order, whose last row must be 0 0 0 1.
    pub fn from_matrix(columns: &[f64; 16]) -> Result<Self, NodeError> {
        Ok(Self(Local::Matrix(affine_from_columns(columns)?)))
    }

    /// Transform that scales, then rotates by the quaternion x, y, z, w, then translates. The
    /// quaternion is normalized; see [`NodeTransform::has_unit_length`].
    pub fn from_parts(translation: [f64; 3], rotation: [f64; 4], scale: [f64; 3]) -> Result<Self, NodeError> {
        for (property, value) in [("translation", translation), ("scale", scale)] {
            if !value.iter().all(|number| number.is_finite()) {
                return Err(NodeError::NotFinite { property, value });
            }
        }
        let unit = quaternion::normalized(rotation).ok_or(NodeError::Rotation { rotation })?;
        let [translation, scale] = [translation, scale].map(DVec3::from_array);
        Ok(Self(Local::Parts { translation, rotation: unit, scale }))
    }

    /// Whether the length of a quaternion deviates from 1 by at most 1e-3. A rotation that fails
    /// this test deserves a warning.
    pub fn has_unit_length(rotation: [f64; 4]) -> bool {
        let length = rotation.iter().map(|number| number * number).sum::<f64>().sqrt();
        (length - 1.0).abs() <= UNIT_TOLERANCE
    }

    /// Affine map to the parent's space. Animated properties replace those of the node; a node with
    /// a matrix [ignores](Self::ignores) them.
    pub fn to_parent(&self, pose: Option<&NodePose>) -> DAffine3 {
        match &self.0 {
            Local::Matrix(matrix) => *matrix,
            Local::Parts { translation, rotation, scale } => DAffine3::from_scale_rotation_translation(
                pose.and_then(|pose| pose.scale).unwrap_or(*scale),
                pose.and_then(|pose| pose.rotation).unwrap_or(*rotation),
                pose.and_then(|pose| pose.translation).unwrap_or(*translation),
            ),
        }
    }

    /// Whether the pose moves a node that has a matrix, which glTF forbids. The transform of such a
    /// node stays its matrix.
    pub fn ignores(&self, pose: &NodePose) -> bool {
        let moves = pose.translation.is_some() || pose.rotation.is_some() || pose.scale.is_some();
        moves && matches!(self.0, Local::Matrix(_))
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{difference, random_rotation, random_vector};
    use super::*;
    use glam::DMat3;
    use juggler_math::testing::Random;

    #[test]
    fn points_are_scaled_then_rotated_then_translated() {
        let mut random = Random::new(31);
        for _ in 0..200 {
            let (translation, rotation) = (random_vector(&mut random, 5.0), random_rotation(&mut random));
            let (scale, point) = (random_vector(&mut random, 2.0), random_vector(&mut random, 3.0));
            let node = NodeTransform::from_parts(translation.into(), rotation.into(), scale.into()).unwrap();
            let expected = rotation * (scale * point) + translation;
            assert!(node.to_parent(None).transform_point3(point).abs_diff_eq(expected, 1e-13));
        }
    }

    #[test]
    fn matrices_keep_their_shear() {
        let sheared = [1.0, 0.5, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.25, 0.0, -3.0, 0.0, 7.0, 8.0, 9.0, 1.0];
        let transform = NodeTransform::from_matrix(&sheared).unwrap().to_parent(None);
        assert_eq!(transform.transform_point3(DVec3::ONE), DVec3::new(8.25, 10.5, 6.0));
        assert!(transform.matrix3.determinant() < 0.0);
        let projective = NodeTransform::from_matrix(&[1.0; 16]).unwrap_err();
        assert_eq!(
            projective.to_string(),
            "the last row of the matrix is [1.0, 1.0, 1.0, 1.0]; it must be [0, 0, 0, 1]"
        );
    }

    #[test]
    fn quaternions_are_normalized() {
        let half = NodeTransform::from_parts([0.0; 3], [0.0, 0.0, 0.5, 0.5], [1.0; 3]).unwrap();
        assert!(half.to_parent(None).transform_vector3(DVec3::X).abs_diff_eq(DVec3::Y, 1e-15));
        assert!(
            !NodeTransform::has_unit_length([0.0, 0.0, 0.5, 0.5])
                && NodeTransform::has_unit_length([0.0, 0.0, 0.0, 1.0009])
        );
        for wrong in [[0.0; 4], [f64::NAN, 0.0, 0.0, 1.0], [f64::INFINITY; 4]] {
            assert!(matches!(NodeTransform::from_parts([0.0; 3], wrong, [1.0; 3]), Err(NodeError::Rotation { .. })));
            assert!(!NodeTransform::has_unit_length(wrong));
        }
    }

    #[test]
    fn numbers_that_are_not_finite_are_errors() {
        let identity = [0.0, 0.0, 0.0, 1.0];
        let error = NodeTransform::from_parts([0.0, f64::NAN, 0.0], identity, [1.0; 3]).unwrap_err();
        assert_eq!(error.to_string(), "`translation` is [0.0, NaN, 0.0]; all numbers must be finite");
        assert!(NodeTransform::from_parts([0.0; 3], identity, [1.0, 1.0, f64::INFINITY]).is_err());
    }

    #[test]
    fn animated_properties_replace_those_of_the_node() {
        let node = NodeTransform::from_parts([1.0, 2.0, 3.0], [0.0, 0.0, 0.0, 1.0], [2.0; 3]).unwrap();
        let pose = NodePose { rotation: Some(DQuat::from_xyzw(0.0, 1.0, 0.0, 0.0)), ..NodePose::default() };
        let half_turn = DMat3::from_diagonal(DVec3::new(-2.0, 2.0, -2.0));
        let expected = DAffine3::from_mat3_translation(half_turn, DVec3::new(1.0, 2.0, 3.0));
        assert!(difference(&node.to_parent(Some(&pose)), &expected) < 1e-15 && !node.ignores(&pose));
        let pose = NodePose { scale: Some(DVec3::ONE), translation: Some(DVec3::ZERO), ..pose };
        assert_eq!(node.to_parent(Some(&pose)).translation, DVec3::ZERO);
        assert_eq!(node.to_parent(Some(&NodePose::default())), node.to_parent(None));

        let fixed = NodeTransform::from_matrix(&glam::DMat4::from_scale(DVec3::splat(3.0)).to_cols_array()).unwrap();
        assert!(fixed.ignores(&pose) && fixed.to_parent(Some(&pose)) == fixed.to_parent(None));
        assert!(!fixed.ignores(&NodePose { visible: Some(false), ..NodePose::default() }));
    }
}
