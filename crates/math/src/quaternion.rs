//! Rotations as unit quaternions [x, y, z, w], as in glTF. Shoemake, *Animating Rotation with Quaternion Curves*
//! (1985). All functions give the same bits everywhere.

use crate::fun;
use glam::{DMat3, DQuat, DVec3};

/// A turn about an axis; nothing when the axis has no length.
pub fn turn(axis: DVec3, degrees: f64) -> Option<DQuat> {
    let axis = axis.try_normalize()?;
    let (sin, cos) = fun::sin_cos_f64(0.5 * degrees.to_radians());
    Some(DQuat::from_xyzw(axis.x * sin, axis.y * sin, axis.z * sin, cos))
}

/// The rotation of four numbers, made a unit quaternion; nothing when they are all 0.
pub fn unit(numbers: [f64; 4]) -> Option<DQuat> {
    // Numbers of any size: their squares must neither vanish nor overflow.
    let largest = numbers.iter().fold(0.0_f64, |largest, number| largest.max(number.abs()));
    if largest.is_nan() || largest <= 0.0 || largest.is_infinite() {
        return None;
    }
    let [x, y, z, w] = numbers.map(|number| number / largest);
    let length = (x * x + y * y + z * z + w * w).sqrt();
    Some(DQuat::from_xyzw(x / length, y / length, z / length, w / length))
}

/// The images of the three axes; nothing when the numbers are all 0.
pub fn matrix(numbers: [f64; 4]) -> Option<DMat3> {
    unit(numbers).map(DMat3::from_quat)
}

/// The rotation at a share of the shorter way between two, at an even angular speed.
pub fn slerp(from: DQuat, to: DQuat, share: f64) -> DQuat {
    let to = if from.dot(to) < 0.0 { -to } else { to };
    let angle = 2.0 * fun::atan2_f64((to - from).length(), (to + from).length());
    let sine = fun::sin_f64(angle);
    let [a, b] = if sine < 1e-9 {
        [1.0 - share, share]
    } else {
        [fun::sin_f64((1.0 - share) * angle) / sine, fun::sin_f64(share * angle) / sine]
    };
    let between = from * a + to * b;
    unit(between.to_array()).unwrap_or(from)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn angle(a: DQuat, b: DQuat) -> f64 {
        2.0 * a.dot(b).abs().min(1.0).acos().to_degrees()
    }

    #[test]
    fn the_angle_grows_evenly_on_the_shorter_way() {
        let axis = DVec3::new(1.0, 2.0, -3.0);
        for (degrees, shorter) in [(90.0, 90.0), (170.0, 170.0), (190.0, 170.0), (350.0, 10.0)] {
            let (from, to) = (turn(axis, 0.0).unwrap(), turn(axis, degrees).unwrap());
            for step in 0..=10 {
                let share = f64::from(step) / 10.0;
                let found = angle(from, slerp(from, to, share));
                assert!((found - share * shorter).abs() < 1e-5, "{degrees} {share}: {found}");
                assert!((slerp(from, to, share).length() - 1.0).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn nearly_equal_and_opposite_rotations_have_a_way() {
        let (a, b) = (turn(DVec3::Y, 10.0).unwrap(), turn(DVec3::Y, 10.000_000_01).unwrap());
        assert!(angle(a, slerp(a, b, 0.5)) < 1e-5 && slerp(a, a, 0.3).abs_diff_eq(a, 1e-15));
        let half = turn(DVec3::X, 180.0).unwrap();
        let between = slerp(DQuat::IDENTITY, half, 0.5);
        assert!((angle(DQuat::IDENTITY, between) - 90.0).abs() < 1e-5);
    }

    #[test]
    fn matrices_turn_as_the_axis_says() {
        let quaternion = turn(DVec3::Z, 90.0).unwrap().to_array().map(|number| 1e-200 * number);
        assert!((matrix(quaternion).unwrap() * DVec3::X).abs_diff_eq(DVec3::Y, 1e-12));
        assert!(matrix([0.0; 4]).is_none() && unit([f64::INFINITY; 4]).is_none() && turn(DVec3::ZERO, 1.0).is_none());
    }
}
