//! Two bones that meet in a joint (Birken 2010, step 16): inverse kinematics of limbs and of the
//! value form `joint`.

use super::PlacementError;
use juggler_math::DVec3;
use schemars::Schema;

/// Two bones between two end points.
#[derive(Clone, Copy, Debug)]
pub struct Bones {
    /// End of the first bone: a hand or a foot.
    pub from: DVec3,
    /// End of the second bone: a shoulder or a hip.
    pub to: DVec3,
    /// Lengths of the bones at `from` and at `to`.
    pub lengths: [f64; 2],
    /// Normal of the plane in which the bones bend, of any length except zero.
    pub plane_normal: DVec3,
    /// Whether the bones keep their lengths if the normal is not perpendicular to `to − from`.
    pub keep_lengths: bool,
}

impl Bones {
    /// Position of the joint: with D = |to − from|, V = (to − from) / D, the unit normal n and
    /// U = V × n, the joint is from + x U + y V for y = (A² − B² + D²) / 2D and x = √(A² − y²).
    /// |U| < 1 if n is not perpendicular to V; `keep_lengths` normalizes U.
    ///
    /// Returns an error if the ends coincide, are too far apart or too close together, or if the
    /// normal is zero or parallel to V.
    pub fn joint(&self) -> Result<DVec3, PlacementError> {
        let whole = |message: String| PlacementError::new("", message);
        let Self { from, to, lengths: [a, b], .. } = *self;
        let distance = (to - from).length();
        if distance.is_nan() || distance <= 0.0 {
            return Err(PlacementError::new("to", "`from` and `to` must not be the same point"));
        }
        if distance > (a + b) * (1.0 + 1e-6) {
            return Err(whole(format!(
                "out of reach: the ends are {distance} apart, but the bones are only {} long",
                a + b
            )));
        }
        if distance < (a - b).abs() * (1.0 - 1e-6) {
            return Err(whole(format!(
                "the ends are only {distance} apart, but bones of {a} and {b} cannot bend that far"
            )));
        }
        let v = (to - from) / distance;
        let normal = self.plane_normal.try_normalize();
        let u = normal.map(|normal| v.cross(normal)).filter(|u| u.length_squared() > 1e-12);
        let wrong = || {
            PlacementError::new(
                "plane_normal",
                "`plane_normal` must not be zero or parallel to the line from `from` to `to`",
            )
        };
        let u = u.ok_or_else(wrong)?;
        let u = if self.keep_lengths { u.normalize() } else { u };
        let y = (a * a - b * b + distance * distance) / (2.0 * distance);
        let x = (a * a - y * y).max(0.0).sqrt();
        Ok(from + u * x + v * y)
    }
}

/// Adds the constraint to an array's schema that every element is greater than 0.
pub(crate) fn positive_items(schema: &mut Schema) {
    if let Some(items) = schema.get_mut("items").and_then(|items| items.as_object_mut()) {
        items.insert("exclusiveMinimum".into(), 0.into());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bones(to: [f64; 3], plane_normal: [f64; 3], keep_lengths: bool) -> Bones {
        let from = DVec3::new(1.0, 2.0, 3.0);
        Bones { from, to: to.into(), lengths: [3.0, 2.0], plane_normal: plane_normal.into(), keep_lengths }
    }

    #[test]
    fn distances_from_joint_to_ends_equal_bone_lengths() {
        for (to, normal) in [([1.0, 6.0, 3.0], [0.0, 0.0, 1.0]), ([3.0, 4.0, 4.0], [1.0, 0.3, -2.0])] {
            let bones = bones(to, normal, true);
            let joint = bones.joint().unwrap();
            assert!((joint.distance(bones.from) - 3.0).abs() < 1e-12);
            assert!((joint.distance(bones.to) - 2.0).abs() < 1e-12);
            let side = (bones.to - bones.from).cross(bones.plane_normal);
            assert!((joint - bones.from).dot(side) > 0.0, "on the side of the cross product");
        }
        let shorter = bones([3.0, 4.0, 4.0], [1.0, 0.3, -2.0], false);
        assert!(shorter.joint().unwrap().distance(shorter.from) < 3.0);
    }

    #[test]
    fn impossible_joints_are_rejected_by_field() {
        let fails = |to, normal| bones(to, normal, true).joint().unwrap_err();
        assert_eq!(fails([1.0, 2.0, 3.0], [0.0, 0.0, 1.0]).field, "to");
        assert_eq!(fails([1.0, 6.0, 3.0], [0.0, 1.0, 0.0]).field, "plane_normal");
        assert_eq!(fails([1.0, 6.0, 3.0], [0.0, 0.0, 0.0]).field, "plane_normal");
        assert!(fails([1.0, 9.0, 3.0], [0.0, 0.0, 1.0]).message.contains("out of reach"));
        assert!(fails([1.0, 2.5, 3.0], [0.0, 0.0, 1.0]).message.contains("cannot bend"));
    }
}
