//! Reflection and refraction at a smooth border between two materials.
//!
//! Directions point away from the surface and are unit vectors, as is the normal. `ratio` is the index of
//! refraction on the side of `wo` over the one behind the surface; [`dielectric`] takes its inverse, the
//! index behind relative to the one in front (Pharr, Jakob, Humphreys, PBR 4th ed., section 9.3).

use juggler_math::Vec3;

/// The direction in which light from `wo` is mirrored.
#[inline]
pub fn reflect(wo: Vec3, normal: Vec3) -> Vec3 {
    normal * (2.0 * normal.dot(wo)) - wo
}

/// The direction in which light from `wo` goes on behind the surface (Snell's law); `None` where it cannot:
/// total internal reflection. `normal` may stand on either side. At a ratio of 1 it goes straight on, exactly.
#[inline]
pub fn refract(wo: Vec3, normal: Vec3, ratio: f32) -> Option<Vec3> {
    if ratio == 1.0 {
        return Some(-wo);
    }
    let facing = normal.dot(wo);
    let (normal, cos) = if facing < 0.0 { (-normal, -facing) } else { (normal, facing) };
    let sin_squared = ratio * ratio * (1.0 - cos * cos).max(0.0);
    if sin_squared >= 1.0 {
        return None;
    }
    let cos_behind = (1.0 - sin_squared).sqrt();
    Some((normal * (ratio * cos - cos_behind) - wo * ratio).normalize())
}

/// The share of unpolarised light that is mirrored (Fresnel's equations), 0 to 1, for light that meets the
/// surface at an angle of cosine `cos`, 0 to 1; `relative_ior` is the index of refraction behind the surface
/// over the one in front. 1 under total internal reflection; the rest goes through.
#[inline]
pub fn dielectric(cos: f32, relative_ior: f32) -> f32 {
    let cos = cos.clamp(0.0, 1.0);
    let sin_squared = (1.0 - cos * cos) / (relative_ior * relative_ior);
    if sin_squared >= 1.0 {
        return 1.0;
    }
    let cos_behind = (1.0 - sin_squared).sqrt();
    let parallel = (relative_ior * cos - cos_behind) / (relative_ior * cos + cos_behind);
    let perpendicular = (cos - relative_ior * cos_behind) / (cos + relative_ior * cos_behind);
    (parallel * parallel + perpendicular * perpendicular) * 0.5
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::fun;
    use juggler_math::testing::{Random, close, close3};

    #[test]
    fn mirrors_keep_the_angle_and_the_plane() {
        let mut random = Random::new(51);
        for _ in 0..1000 {
            let (wo, normal) = (random.unit_vector(), random.unit_vector());
            let wi = reflect(wo, normal);
            assert!(close(wi.length(), 1.0, 1e-6) && close(wi.dot(normal), wo.dot(normal), 1e-6));
            assert!(close3(wi.cross(normal), -wo.cross(normal), 1e-6));
            assert!(close3(reflect(wi, normal), wo, 1e-6));
        }
    }

    #[test]
    fn refraction_keeps_snells_law_and_the_plane() {
        let mut random = Random::new(52);
        for _ in 0..5000 {
            let (wo, normal, ratio) = (random.unit_vector(), random.unit_vector(), random.range(0.3, 3.0));
            let sin = wo.cross(normal).length();
            let Some(wt) = refract(wo, normal, ratio) else {
                assert!(ratio * sin > 1.0 - 1e-5, "{ratio} {sin}");
                continue;
            };
            assert!(close(wt.length(), 1.0, 1e-6) && wt.dot(normal) * wo.dot(normal) <= 1e-6);
            assert!(close3(wt.cross(normal), -wo.cross(normal) * ratio, 3e-6), "{wo} {normal} {ratio}");
            // The way back.
            let back = refract(wt, normal, 1.0 / ratio);
            assert!(back.is_none_or(|b| close3(b, wo, 1e-3)), "{back:?} {wo}");
        }
        let wo = random.unit_vector();
        assert_eq!(refract(wo, random.unit_vector(), 1.0), Some(-wo));
    }

    #[test]
    fn light_beyond_the_critical_angle_stays_inside() {
        // Published critical angles against air: water 48.6°, crown glass (1.52) 41.1°, diamond (2.42) 24.4°.
        for (ior, degrees) in [(1.333f32, 48.6f32), (1.52, 41.1), (2.42, 24.4)] {
            let at = |degrees: f32| {
                let (sin, cos) = fun::sin_cos(degrees.to_radians());
                (refract(Vec3::new(sin, cos, 0.0), Vec3::Y, ior), dielectric(cos, 1.0 / ior))
            };
            let ((below, r_below), (above, r_above)) = (at(degrees - 0.1), at(degrees + 0.1));
            assert!(below.is_some() && r_below < 1.0 && above.is_none() && r_above == 1.0, "{ior}");
        }
    }

    #[test]
    fn reflectance_agrees_with_published_numbers() {
        // ((n - 1) / (n + 1))² head on: window glass 4 %, water 2 %, diamond 17.2 %; the same from within.
        for (ior, share) in [(1.5f32, 0.04f32), (1.333, 0.020_37), (2.417, 0.171_97)] {
            assert!(close(dielectric(1.0, ior), share, 2e-5) && close(dielectric(1.0, 1.0 / ior), share, 2e-5));
            assert_eq!(dielectric(0.0, ior), 1.0);
            assert!(close(dielectric(1.0, ior), ((ior - 1.0) / (ior + 1.0)).powi(2), 1e-6));
        }
        // Hecht, Optics, section 4.6: n = 1.5 at 30° and 60°: (r⊥, r∥) = (-0.2404, 0.1589), (-0.4202, -0.0424).
        for (degrees, perpendicular, parallel) in [(30f32, -0.2404f32, 0.1589f32), (60.0, -0.4202, -0.0424)] {
            let mean = (perpendicular * perpendicular + parallel * parallel) * 0.5;
            assert!(close(dielectric(fun::cos(degrees.to_radians()), 1.5), mean, 1e-4), "{degrees}");
        }
        assert!(dielectric(0.3, 1.0) < 1e-12);
    }

    #[test]
    fn nothing_of_the_parallel_part_is_mirrored_at_brewsters_angle() {
        // There the unpolarised share is half of ((n² - 1) / (n² + 1))².
        for ior in [1.333f32, 1.5, 2.417] {
            let cos = 1.0 / (1.0 + ior * ior).sqrt();
            let perpendicular = ((ior * ior - 1.0) / (ior * ior + 1.0)).powi(2);
            assert!(close(dielectric(cos, ior), perpendicular * 0.5, 1e-6), "{ior}");
        }
    }

    #[test]
    fn both_ways_through_the_border_mirror_the_same() {
        let mut random = Random::new(53);
        for _ in 0..1000 {
            let (cos, ior) = (random.range(0.05, 1.0), random.range(1.01, 3.0));
            let cos_behind = (1.0 - (1.0 - cos * cos) / (ior * ior)).sqrt();
            assert!(close(dielectric(cos, ior), dielectric(cos_behind, 1.0 / ior), 1e-4), "{cos} {ior}");
        }
    }
}
