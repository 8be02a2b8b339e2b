//! Rounding error bounds and ray origins that avoid self-intersection.

use glam::Vec3;

/// Bound on the relative error of `n` successive rounded operations (Higham 2002, section 3.1).
pub const fn gamma(n: u32) -> f32 {
    let e = n as f32 * (f32::EPSILON * 0.5);
    e / (1.0 - e)
}

/// Offsets the origin of a ray that leaves a surface, along the unit `normal` and to the side of
/// `direction`. `error` bounds the error of each coordinate of `point` (Pharr, Jakob, Humphreys,
/// PBR 4th ed., section 6.8.6).
#[inline]
pub fn offset_origin(point: Vec3, error: f32, normal: Vec3, direction: Vec3) -> Vec3 {
    let n = normal.abs();
    // Each coordinate of the sum is rounded by half an ulp: gamma(2) keeps that from undoing the
    // offset.
    let distance = error * (n.x + n.y + n.z) + gamma(2) * point.abs().dot(n);
    let signed = if direction.dot(normal) < 0.0 { -distance } else { distance };
    point + normal * signed
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Random;

    #[test]
    fn ray_origins_are_offset_beyond_the_error_on_the_side_of_the_ray() {
        let mut random = Random::new(71);
        for scale in [1e-3, 1.0, 1e4] {
            for _ in 0..5_000 {
                let (point, normal, direction) = (random.point(scale), random.unit_vector(), random.unit_vector());
                let error = random.range(0.0, 1e-5) * scale;
                let moved = offset_origin(point, error, normal, direction);
                // The surface may lie anywhere in the error box: measure to its farthest corner
                // along the normal.
                let side = f64::from(direction.dot(normal)).signum();
                let distance = (moved.as_dvec3() - point.as_dvec3()).dot(normal.as_dvec3()) * side;
                let n = normal.abs().as_dvec3();
                assert!(distance >= f64::from(error) * (n.x + n.y + n.z) * (1.0 - 1e-6), "{point} {normal}");
                // The offset must stay small, or light leaks through thin walls.
                let far = 3.0 * (f64::from(error) + f64::from(scale) * f64::from(f32::EPSILON));
                assert!(distance <= far, "{distance} {far}");
            }
        }
    }

    #[test]
    fn exact_points_are_offset_by_about_one_rounding_step() {
        let on_plane = offset_origin(Vec3::new(1e6, 0.0, -3e5), 1e-30, Vec3::Y, Vec3::ONE);
        assert!(on_plane == Vec3::new(1e6, 1e-30, -3e5), "a point on the ground: {on_plane}");
        let moved = offset_origin(Vec3::new(1.0, 2.0, 3.0), 0.0, Vec3::Y, -Vec3::ONE);
        assert!(moved.y < 2.0 && moved.y > 1.999_999, "{moved}");
    }

    #[test]
    fn gamma_bounds_a_chain_of_rounded_products() {
        let mut random = Random::new(72);
        for _ in 0..1000 {
            let (mut single, mut exact) = (1f32, 1f64);
            for _ in 0..20 {
                let factor = random.range(0.5, 2.0);
                single *= factor;
                exact *= f64::from(factor);
            }
            assert!((f64::from(single) / exact - 1.0).abs() <= f64::from(gamma(20)));
        }
    }
}
