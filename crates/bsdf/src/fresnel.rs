//! Reflection and refraction at a smooth border between two materials.
//!
//! Directions point away from the surface and are unit vectors, as is the normal. `ratio` is the index of
//! refraction on the side of `wo` over the one behind the surface; [`dielectric`] takes its inverse, the
//! index behind relative to the one in front (Pharr, Jakob, Humphreys, PBR 4th ed., section 9.3).

use juggler_math::{Rgb, Vec3, fun};

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

/// The mean of [`dielectric`] over all directions, each weighted by its cosine: what is mirrored of even light (Walsh
/// 1926; Egan and Hilgeman 1973), to 1e-4.
pub fn dielectric_average(relative_ior: f32) -> f32 {
    let n = f64::from(relative_ior);
    if n < 1.0 {
        // What is even within goes both ways through the border alike, but for the size of the cones.
        return (1.0 - (1.0 - dielectric_average(1.0 / relative_ior)) * relative_ior * relative_ior).clamp(0.0, 1.0);
    }
    if n < 1.02 {
        // The formula cancels itself out; near 1 the mean is that of its slope.
        return ((n - 1.0) * 0.305) as f32;
    }
    let (n2, n4) = (n * n, n * n * n * n);
    let logarithm = fun::ln_f64((n - 1.0) / (n + 1.0));
    let mean = 0.5
        + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0))
        + n2 * (n2 - 1.0) * (n2 - 1.0) / ((n2 + 1.0) * (n2 + 1.0) * (n2 + 1.0)) * logarithm
        - 2.0 * n * n2 * (n2 + 2.0 * n - 1.0) / ((n2 + 1.0) * (n4 - 1.0))
        + 8.0 * n4 * (n4 + 1.0) / ((n2 + 1.0) * (n4 - 1.0) * (n4 - 1.0)) * fun::ln_f64(n);
    mean.clamp(0.0, 1.0) as f32
}

/// The share of unpolarised light that a conductor mirrors (Born and Wolf, Principles of Optics, section 14.2), for
/// light at an angle of cosine `cos`, 0 to 1; `eta` and `k` are real and imaginary part of its index of refraction
/// over that of the (clear) medium in front.
#[inline]
pub fn conductor(cos: f32, eta: f32, k: f32) -> f32 {
    let cos = cos.clamp(0.0, 1.0);
    let (cos2, sin2) = (cos * cos, 1.0 - cos * cos);
    let difference = eta * eta - k * k - sin2;
    // a² + b² and a of the complex cosine behind the surface, times its index: a + ib.
    let norm = (difference * difference + 4.0 * eta * eta * k * k).sqrt();
    let real = (0.5 * (norm + difference)).max(0.0).sqrt();
    let (sum, cross) = (norm + cos2, 2.0 * cos * real);
    let perpendicular = (sum - cross) / (sum + cross).max(f32::MIN_POSITIVE);
    let (sum, cross) = (cos2 * norm + sin2 * sin2, cross * sin2);
    let parallel = perpendicular * (sum - cross) / (sum + cross).max(f32::MIN_POSITIVE);
    0.5 * (perpendicular + parallel)
}

/// Schlick's approximation (1994) at `cos`, 0 to 1: `f0` head on, `f90` at a grazing angle.
#[inline]
pub fn schlick(cos: f32, f0: Rgb, f90: Rgb) -> Rgb {
    let m = (1.0 - cos).clamp(0.0, 1.0);
    let m2 = m * m;
    f0 + (f90 - f0) * (m2 * m2 * m)
}

/// Share of light head on at a border of that relative index of refraction.
#[inline]
pub fn head_on(relative_ior: f32) -> f32 {
    let r = (relative_ior - 1.0) / (relative_ior + 1.0);
    r * r
}

#[cfg(test)]
mod tests {
    use super::*;
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

    #[test]
    fn a_conductor_without_extinction_is_a_dielectric() {
        let mut random = Random::new(54);
        for _ in 0..1000 {
            let (cos, ior) = (random.range(0.0, 1.0), random.range(1.01, 3.0));
            assert!(close(conductor(cos, ior, 0.0), dielectric(cos, ior), 1e-4), "{cos} {ior}");
        }
    }

    #[test]
    fn conductors_agree_with_closed_forms() {
        // Head on: ((η - 1)² + k²) / ((η + 1)² + k²), everything at a grazing angle.
        for (eta, k) in [(0.156f32, 3.602f32), (1.383, 1.915), (2.95, 2.932)] {
            let expected = ((eta - 1.0).powi(2) + k * k) / ((eta + 1.0).powi(2) + k * k);
            assert!(close(conductor(1.0, eta, k), expected, 1e-6));
            assert!(close(conductor(0.0, eta, k), 1.0, 1e-6));
        }
        for cos in [0.1f32, 0.3, 0.5, 0.8] {
            let expected = by_complex_numbers(f64::from(cos), 0.2, 3.44) as f32;
            assert!(close(conductor(cos, 0.2, 3.44), expected, 1e-5), "{cos}");
        }
    }

    /// Fresnel's equations as they stand in textbooks, with complex numbers as pairs.
    fn by_complex_numbers(cos: f64, eta: f64, k: f64) -> f64 {
        type C = (f64, f64);
        let mul = |a: C, b: C| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
        let norm = |a: C| a.0 * a.0 + a.1 * a.1;
        let n = (eta, k);
        let n2 = mul(n, n);
        // n cos θt = √(n² - sin² θ)
        let inner = (n2.0 - (1.0 - cos * cos), n2.1);
        let length = norm(inner).sqrt();
        let root = (((length + inner.0) / 2.0).sqrt(), ((length - inner.0) / 2.0).sqrt());
        let s = norm((cos - root.0, -root.1)) / norm((cos + root.0, root.1));
        let n2cos = (n2.0 * cos, n2.1 * cos);
        let p = norm((n2cos.0 - root.0, n2cos.1 - root.1)) / norm((n2cos.0 + root.0, n2cos.1 + root.1));
        0.5 * (s + p)
    }

    #[test]
    fn the_mean_at_a_border_is_that_of_its_curve() {
        for ior in [0.4f32, 0.66, 0.75, 0.99, 1.0, 1.005, 1.02, 1.1, 1.33, 1.5, 2.4, 4.0] {
            let steps = 20_000;
            let at = |i| {
                let cos = (f64::from(i) + 0.5) / f64::from(steps);
                2.0 * cos * f64::from(dielectric(cos as f32, ior)) / f64::from(steps)
            };
            let (sum, mean) = ((0..steps).map(at).sum::<f64>() as f32, dielectric_average(ior));
            assert!(close(mean, sum, 1e-3), "{ior}: {mean} {sum}");
        }
    }
}
