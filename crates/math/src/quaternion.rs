//! Rotations as unit quaternions [x, y, z, w], as in glTF (Shoemake, *Animating Rotation with
//! Quaternion Curves*, 1985). All functions give the same bits on every platform.

use crate::portable;
use glam::{DMat3, DQuat, DVec3};

/// Rotation about an axis by an angle in degrees; `None` for a zero axis.
pub fn from_axis_degrees(axis: DVec3, degrees: f64) -> Option<DQuat> {
    let axis = axis.try_normalize()?;
    let (sin, cos) = portable::sin_cos_f64(0.5 * degrees.to_radians());
    Some(DQuat::from_xyzw(axis.x * sin, axis.y * sin, axis.z * sin, cos))
}

/// Normalizes four numbers to a unit quaternion; `None` if all are 0 or one is not finite.
pub fn normalized(numbers: [f64; 4]) -> Option<DQuat> {
    // Divide by the largest magnitude first: the squares must neither underflow nor overflow.
    let largest = numbers.iter().fold(0.0_f64, |largest, number| largest.max(number.abs()));
    if largest <= 0.0 || !numbers.iter().all(|number| number.is_finite()) {
        return None;
    }
    let [x, y, z, w] = numbers.map(|number| number / largest);
    let length = (x * x + y * y + z * z + w * w).sqrt();
    Some(DQuat::from_xyzw(x / length, y / length, z / length, w / length))
}

/// Rotation matrix of a quaternion of any length; `None` if all numbers are 0 or one is not finite.
pub fn matrix(numbers: [f64; 4]) -> Option<DMat3> {
    normalized(numbers).map(DMat3::from_quat)
}

/// Spherical linear interpolation along the shorter arc, at constant angular speed: `from` at
/// `fraction = 0`, `to` at 1.
pub fn slerp(from: DQuat, to: DQuat, fraction: f64) -> DQuat {
    let to = if from.dot(to) < 0.0 { -to } else { to };
    let angle = 2.0 * portable::atan2_f64((to - from).length(), (to + from).length());
    let sine = portable::sin_f64(angle);
    let [a, b] = if sine < 1e-9 {
        [1.0 - fraction, fraction]
    } else {
        [portable::sin_f64((1.0 - fraction) * angle) / sine, portable::sin_f64(fraction * angle) / sine]
    };
    let between = from * a + to * b;
    normalized(between.to_array()).unwrap_or(from)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn angle(a: DQuat, b: DQuat) -> f64 {
        2.0 * a.dot(b).abs().min(1.0).acos().to_degrees()
    }

    #[test]
    fn slerp_angle_grows_linearly_along_the_shorter_arc() {
        let axis = DVec3::new(1.0, 2.0, -3.0);
        for (degrees, shorter) in [(90.0, 90.0), (170.0, 170.0), (190.0, 170.0), (350.0, 10.0)] {
            let (from, to) = (from_axis_degrees(axis, 0.0).unwrap(), from_axis_degrees(axis, degrees).unwrap());
            for step in 0..=10 {
                let fraction = f64::from(step) / 10.0;
                let found = angle(from, slerp(from, to, fraction));
                assert!((found - fraction * shorter).abs() < 1e-5, "{degrees} {fraction}: {found}");
                assert!((slerp(from, to, fraction).length() - 1.0).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn nearly_equal_and_opposite_rotations_interpolate() {
        let (a, b) = (from_axis_degrees(DVec3::Y, 10.0).unwrap(), from_axis_degrees(DVec3::Y, 10.000_000_01).unwrap());
        assert!(angle(a, slerp(a, b, 0.5)) < 1e-5 && slerp(a, a, 0.3).abs_diff_eq(a, 1e-15));
        let half = from_axis_degrees(DVec3::X, 180.0).unwrap();
        let between = slerp(DQuat::IDENTITY, half, 0.5);
        assert!((angle(DQuat::IDENTITY, between) - 90.0).abs() < 1e-5);
    }

    #[test]
    fn matrices_rotate_about_the_axis() {
        let quaternion = from_axis_degrees(DVec3::Z, 90.0).unwrap().to_array().map(|number| 1e-200 * number);
        assert!((matrix(quaternion).unwrap() * DVec3::X).abs_diff_eq(DVec3::Y, 1e-12));
        assert!(matrix([0.0; 4]).is_none() && from_axis_degrees(DVec3::ZERO, 1.0).is_none());
        assert!([f64::INFINITY, f64::NAN].iter().all(|wrong| normalized([*wrong, 1.0, 0.0, 0.0]).is_none()));
    }
}
