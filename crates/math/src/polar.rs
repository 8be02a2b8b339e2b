//! Polar decomposition of transforms into stretch, rotation and translation (Higham 1986; Shoemake
//! and Duff 1992, "Matrix Animation and Polar Decomposition").

use crate::quaternion::slerp;
use crate::{Transform, portable};
use glam::{DMat3, DQuat, DVec3};

/// Minimum rotation between two keys, in radians, of which the center is determined.
const MIN_ANGLE: f64 = 1e-4;

/// Polar decomposition of a transform: stretch, then rotation (and reflection), then translation.
pub struct PolarDecomposition {
    stretch: DMat3,
    /// −1 for a reflection, else 1.
    sign: f64,
    rotation: DQuat,
    translation: DVec3,
}

impl PolarDecomposition {
    /// Decomposes a transform; `None` if the iteration overflows.
    pub fn from_transform(transform: &Transform) -> Option<Self> {
        let matrix = transform.matrix().as_dmat3();
        let sign = if matrix.determinant() < 0.0 { -1.0 } else { 1.0 };
        let mut rotation = matrix * sign;
        // Newton iteration for the polar factor: converges linearly at first, then quadratically.
        for _ in 0..64 {
            let next = (rotation + rotation.transpose().inverse()) * 0.5;
            let change = (next - rotation).to_cols_array().iter().fold(0.0, |m: f64, v| v.abs().max(m));
            rotation = next;
            if change < 1e-14 {
                break;
            }
        }
        rotation.is_finite().then(|| Self {
            stretch: rotation.transpose() * matrix * sign,
            sign,
            rotation: DQuat::from_mat3(&rotation).normalize(),
            translation: transform.origin().as_dvec3(),
        })
    }

    /// Angle in radians between two rotations, along the shorter arc; 0 if only one of them has a
    /// reflection.
    pub fn angle_to(&self, other: &Self) -> f64 {
        if self.sign == other.sign {
            2.0 * portable::acos_f64(self.rotation.dot(other.rotation).abs().min(1.0))
        } else {
            0.0
        }
    }

    /// Interpolates from `self` (`fraction = 0`) to `other` (1). The origin moves on a helix about the
    /// `center` of the rotation, or straight without one.
    pub fn lerp(&self, other: &Self, center: Option<DVec3>, fraction: f64) -> Self {
        let rotation = slerp(self.rotation, other.rotation, fraction);
        let straight = self.translation.lerp(other.translation, fraction);
        let on_helix = |center: DVec3| {
            let (axis, path) =
                (self.rotation_to(other).xyz().normalize_or_zero(), other.translation - self.translation);
            let turned = rotation * self.rotation.conjugate() * (self.translation - center);
            center + turned + axis * (axis.dot(path) * fraction)
        };
        Self {
            stretch: self.stretch * (1.0 - fraction) + other.stretch * fraction,
            sign: self.sign,
            rotation,
            translation: center.map_or(straight, on_helix),
        }
    }

    /// Rotation from `self` to `other`, along the shorter arc.
    fn rotation_to(&self, other: &Self) -> DQuat {
        let rotation = other.rotation * self.rotation.conjugate();
        if rotation.w < 0.0 { -rotation } else { rotation }
    }

    /// Center of the rotation that moves the origin from `self` to `other`: the point beside the
    /// origin on the axis of the screw motion. `None` without a rotation.
    fn center(&self, other: &Self) -> Option<DVec3> {
        let rotation = self.rotation_to(other);
        let axis = rotation.xyz().try_normalize().filter(|_| self.angle_to(other) > MIN_ANGLE)?;
        let across = (other.translation - self.translation).reject_from_normalized(axis);
        // The angle at the center between both origins is that of the rotation.
        Some(self.translation + 0.5 * (across + axis.cross(across) * (rotation.w / rotation.xyz().length())))
    }
    /// The composition; `None` if it is singular.
    pub fn transform(&self) -> Option<Transform> {
        let matrix = DMat3::from_quat(self.rotation) * self.stretch * self.sign;
        Transform::new(matrix.as_mat3(), self.translation.as_vec3())
    }
}

/// Center of the rotation in each interval between keys, if it stays where it is in a neighboring
/// interval: its motion is less than half of that of the origin. An object that rotates in flight
/// has no such center.
pub fn lasting_centers(keys: &[PolarDecomposition]) -> Vec<Option<DVec3>> {
    let centers: Vec<Option<DVec3>> = keys.windows(2).map(|pair| pair[0].center(&pair[1])).collect();
    let lasts = |interval: usize, neighbor: Option<usize>| {
        let neighbor = neighbor.and_then(|neighbor| *centers.get(neighbor)?);
        let (Some(center), Some(other), Some([from, to])) =
            (centers.get(interval).copied().flatten(), neighbor, keys.get(interval..interval + 2))
        else {
            return None;
        };
        let axis = from.rotation_to(to).xyz().normalize_or_zero();
        let path = (to.translation - from.translation).reject_from_normalized(axis);
        let shift = (other - center).reject_from_normalized(axis);
        (2.0 * shift.length() < path.length()).then_some(center)
    };
    let center =
        |interval: usize| lasts(interval, Some(interval + 1)).or_else(|| lasts(interval, interval.checked_sub(1)));
    (0..centers.len()).map(center).collect()
}
