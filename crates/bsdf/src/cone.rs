//! Directions distributed uniformly over a cone, for glossy reflection and blurry transmission in
//! classic ray tracing (Cook, Porter and Carpenter, Distributed Ray Tracing, 1984).

use juggler_math::{Frame, Vec2, Vec3, warp};

/// Samples a direction within `half_angle_radians` (0 to π) of the unit vector `axis`, uniformly by
/// solid angle, for `u` in the unit square.
///
/// The direction stays on the side of the surface that `axis` is on; the unit vector `normal` may
/// be on either side. Directions beyond the surface are reflected at its plane, so no ray is lost
/// and a grazing cone is folded, not thinned.
#[inline]
pub fn direction(axis: Vec3, normal: Vec3, half_angle_radians: f32, u: Vec2) -> Vec3 {
    let local = warp::uniform_cone(u, warp::cone_size(half_angle_radians));
    let spread = Frame::around(axis).to_world(local);
    let (above, below) = (axis.dot(normal), spread.dot(normal));
    if (above < 0.0) != (below < 0.0) { spread - normal * (2.0 * below) } else { spread }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::portable;
    use juggler_math::testing::{Random, chi_squared_directions, close};
    use std::f32::consts::{FRAC_PI_2, TAU};

    #[test]
    fn cone_samples_stay_in_the_cone_and_on_its_side_of_the_surface() {
        let mut random = Random::new(61);
        for _ in 0..20_000 {
            let (axis, normal, angle) = (random.unit_vector(), random.unit_vector(), random.range(0.0, FRAC_PI_2));
            let w = direction(axis, normal, angle, random.vec2());
            assert!(close(w.length(), 1.0, 1e-6));
            assert!(w.dot(normal) * axis.dot(normal) >= -1e-7, "{w} {axis} {normal}");
            let reflected = w - normal * (2.0 * w.dot(normal));
            let cos = w.dot(axis).max(reflected.dot(axis));
            assert!(cos >= portable::cos(angle) - 1e-6, "{w} {axis} {angle}");
        }
        assert_eq!(direction(Vec3::Y, Vec3::Y, 0.0, Vec2::new(0.3, 0.6)), Vec3::Y);
    }

    #[test]
    fn cone_samples_are_uniform_over_the_cap() {
        let axis = Vec3::new(2.0, -1.0, 2.0) / 3.0;
        // With the axis along z, the cone's rim falls on a cell boundary of the test.
        let frame = Frame::around(axis);
        let sample = |u| Some(frame.to_local(direction(axis, axis, FRAC_PI_2 * 2.0 / 3.0, u)));
        let pdf = |w: Vec3| if w.z >= 0.5 { 1.0 / (TAU * 0.5) } else { 0.0 };
        chi_squared_directions(sample, pdf, 1_000_000, 1e-3).unwrap();
    }

    #[test]
    fn cone_samples_below_the_surface_are_reflected_above_it() {
        // The axis lies in the surface: half of the cap, at twice the density.
        let sample = |u| Some(direction(Vec3::X, Vec3::Z, FRAC_PI_2, u));
        let pdf = |w: Vec3| if w.z >= 0.0 && w.x >= 0.0 { 2.0 / TAU } else { 0.0 };
        chi_squared_directions(sample, pdf, 1_000_000, 1e-3).unwrap();
    }
}
