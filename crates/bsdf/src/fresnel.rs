//! Reflection and refraction at a smooth interface between two media.
//!
//! Directions point away from the surface and are unit vectors, as is the normal. `ratio` is the
//! index of refraction on the side of `wo` over that behind the surface; [`dielectric_reflectance`]
//! takes its inverse, the index behind over that in front (Pharr, Jakob, Humphreys, PBR 4th ed.,
//! section 9.3).

use super::lanes::lanes;
use juggler_math::{Rgb, Vec3, portable};

/// Mirror direction of `wo` about `normal`.
#[inline]
pub fn reflect(wo: Vec3, normal: Vec3) -> Vec3 {
    normal * (2.0 * normal.dot(wo)) - wo
}

/// Direction into which `wo` refracts behind the surface (Snell's law); `None` under total internal
/// reflection. `normal` may be on either side. At a ratio of 1, the direction is exactly `-wo`.
#[inline]
pub fn refract(wo: Vec3, normal: Vec3, ratio: f32) -> Option<Vec3> {
    if ratio == 1.0 {
        return Some(-wo);
    }
    let signed_cos = normal.dot(wo);
    let (normal, cos) = if signed_cos < 0.0 { (-normal, -signed_cos) } else { (normal, signed_cos) };
    let sin_squared = ratio * ratio * (1.0 - cos * cos).max(0.0);
    if sin_squared >= 1.0 {
        return None;
    }
    let cos_behind = (1.0 - sin_squared).sqrt();
    Some((normal * (ratio * cos - cos_behind) - wo * ratio).normalize())
}

/// Fresnel reflectance of unpolarized light at a dielectric interface, 0 to 1; `cos` is the cosine
/// of the angle of incidence, 0 to 1, and `relative_ior` the index of refraction behind the surface
/// over that in front. 1 under total internal reflection; the rest is transmitted.
#[inline]
pub fn dielectric_reflectance(cos: f32, relative_ior: f32) -> f32 {
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

/// [`dielectric_reflectance`] at several cosines, without branches.
#[inline(always)]
pub(crate) fn dielectric_reflectances<const N: usize>(cos: [f32; N], relative_ior: f32) -> [f32; N] {
    lanes(|lane| {
        let cos = cos[lane].clamp(0.0, 1.0);
        let sin_squared = (1.0 - cos * cos) / (relative_ior * relative_ior);
        // NaN under total internal reflection.
        let cos_behind = (1.0 - sin_squared).sqrt();
        let parallel = (relative_ior * cos - cos_behind) / (relative_ior * cos + cos_behind);
        let perpendicular = (cos - relative_ior * cos_behind) / (cos + relative_ior * cos_behind);
        let partial = (parallel * parallel + perpendicular * perpendicular) * 0.5;
        if sin_squared >= 1.0 { 1.0 } else { partial }
    })
}

/// Cosine-weighted mean of [`dielectric_reflectance`] over all directions: the reflectance of
/// uniform light (Walsh 1926; Egan and Hilgeman 1973), to 1e-4.
pub fn mean_dielectric_reflectance(relative_ior: f32) -> f32 {
    let n = f64::from(relative_ior);
    if n < 1.0 {
        // By reciprocity, uniform light is transmitted alike in both directions, up to the ratio of
        // solid angles.
        return (1.0 - (1.0 - mean_dielectric_reflectance(1.0 / relative_ior)) * relative_ior * relative_ior)
            .clamp(0.0, 1.0);
    }
    if n < 1.02 {
        // Near 1, where the formula cancels, the mean is linear.
        return ((n - 1.0) * 0.305) as f32;
    }
    let (n2, n4) = (n * n, n * n * n * n);
    let logarithm = portable::ln_f64((n - 1.0) / (n + 1.0));
    let mean = 0.5
        + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0))
        + n2 * (n2 - 1.0) * (n2 - 1.0) / ((n2 + 1.0) * (n2 + 1.0) * (n2 + 1.0)) * logarithm
        - 2.0 * n * n2 * (n2 + 2.0 * n - 1.0) / ((n2 + 1.0) * (n4 - 1.0))
        + 8.0 * n4 * (n4 + 1.0) / ((n2 + 1.0) * (n4 - 1.0) * (n4 - 1.0)) * portable::ln_f64(n);
    mean.clamp(0.0, 1.0) as f32
}

/// Fresnel reflectance of unpolarized light at a conductor (Born and Wolf, Principles of Optics,
/// section 14.2); `cos` is the cosine of the angle of incidence, 0 to 1, `eta` and `k` are the real
/// and the imaginary part of the index of refraction over that of the (clear) medium in front.
#[inline]
pub fn conductor_reflectance(cos: f32, eta: f32, k: f32) -> f32 {
    let cos = cos.clamp(0.0, 1.0);
    let (cos2, sin2) = (cos * cos, 1.0 - cos * cos);
    let difference = eta * eta - k * k - sin2;
    // a² + b² and a of a + ib, the complex index times the complex cosine behind the surface.
    let norm = (difference * difference + 4.0 * eta * eta * k * k).sqrt();
    let real = (0.5 * (norm + difference)).max(0.0).sqrt();
    let (sum, cross) = (norm + cos2, 2.0 * cos * real);
    let perpendicular = (sum - cross) / (sum + cross).max(f32::MIN_POSITIVE);
    let (sum, cross) = (cos2 * norm + sin2 * sin2, cross * sin2);
    let parallel = perpendicular * (sum - cross) / (sum + cross).max(f32::MIN_POSITIVE);
    0.5 * (perpendicular + parallel)
}

/// Schlick's approximation (1994) at `cos`, 0 to 1: `f0` at normal incidence, `f90` at grazing
/// angles.
#[inline]
pub fn schlick(cos: f32, f0: Rgb, f90: Rgb) -> Rgb {
    let m = (1.0 - cos).clamp(0.0, 1.0);
    let m2 = m * m;
    f0 + (f90 - f0) * (m2 * m2 * m)
}

/// Reflectance at normal incidence of an interface of this relative index of refraction.
#[inline]
pub fn f0_from_ior(relative_ior: f32) -> f32 {
    let r = (relative_ior - 1.0) / (relative_ior + 1.0);
    r * r
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::{Random, close, close3};

    #[test]
    fn reflection_preserves_angle_and_plane_of_incidence() {
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
            // Refraction is reversible.
            let back = refract(wt, normal, 1.0 / ratio);
            assert!(back.is_none_or(|b| close3(b, wo, 1e-3)), "{back:?} {wo}");
        }
        let wo = random.unit_vector();
        assert_eq!(refract(wo, random.unit_vector(), 1.0), Some(-wo));
    }

    #[test]
    fn light_beyond_the_critical_angle_stays_inside() {
        // Published critical angles against air: water 48.6°, crown glass (1.52) 41.1°, diamond
        // (2.42) 24.4°.
        for (ior, degrees) in [(1.333f32, 48.6f32), (1.52, 41.1), (2.42, 24.4)] {
            let at = |degrees: f32| {
                let (sin, cos) = portable::sin_cos(degrees.to_radians());
                (refract(Vec3::new(sin, cos, 0.0), Vec3::Y, ior), dielectric_reflectance(cos, 1.0 / ior))
            };
            let ((below, r_below), (above, r_above)) = (at(degrees - 0.1), at(degrees + 0.1));
            assert!(below.is_some() && r_below < 1.0 && above.is_none() && r_above == 1.0, "{ior}");
        }
    }

    #[test]
    fn reflectance_agrees_with_published_numbers() {
        // ((n - 1) / (n + 1))² at normal incidence: window glass 4 %, water 2 %, diamond 17.2 %;
        // the same from within.
        for (ior, share) in [(1.5f32, 0.04f32), (1.333, 0.020_37), (2.417, 0.171_97)] {
            assert!(
                close(dielectric_reflectance(1.0, ior), share, 2e-5)
                    && close(dielectric_reflectance(1.0, 1.0 / ior), share, 2e-5)
            );
            assert_eq!(dielectric_reflectance(0.0, ior), 1.0);
            assert!(close(dielectric_reflectance(1.0, ior), ((ior - 1.0) / (ior + 1.0)).powi(2), 1e-6));
        }
        // Hecht, Optics, section 4.6: n = 1.5 at 30° and 60°: (r⊥, r∥) = (-0.2404, 0.1589),
        // (-0.4202, -0.0424).
        for (degrees, perpendicular, parallel) in [(30f32, -0.2404f32, 0.1589f32), (60.0, -0.4202, -0.0424)] {
            let mean = (perpendicular * perpendicular + parallel * parallel) * 0.5;
            assert!(close(dielectric_reflectance(portable::cos(degrees.to_radians()), 1.5), mean, 1e-4), "{degrees}");
        }
        assert!(dielectric_reflectance(0.3, 1.0) < 1e-12);
    }

    #[test]
    fn parallel_polarization_is_not_reflected_at_brewsters_angle() {
        // There the reflectance of unpolarized light is half of ((n² - 1) / (n² + 1))².
        for ior in [1.333f32, 1.5, 2.417] {
            let cos = 1.0 / (1.0 + ior * ior).sqrt();
            let perpendicular = ((ior * ior - 1.0) / (ior * ior + 1.0)).powi(2);
            assert!(close(dielectric_reflectance(cos, ior), perpendicular * 0.5, 1e-6), "{ior}");
        }
    }

    #[test]
    fn fresnel_reflectance_is_equal_from_both_sides() {
        let mut random = Random::new(53);
        for _ in 0..1000 {
            let (cos, ior) = (random.range(0.05, 1.0), random.range(1.01, 3.0));
            let cos_behind = (1.0 - (1.0 - cos * cos) / (ior * ior)).sqrt();
            assert!(
                close(dielectric_reflectance(cos, ior), dielectric_reflectance(cos_behind, 1.0 / ior), 1e-4),
                "{cos} {ior}"
            );
        }
    }

    #[test]
    fn a_conductor_without_extinction_is_a_dielectric() {
        let mut random = Random::new(54);
        for _ in 0..1000 {
            let (cos, ior) = (random.range(0.0, 1.0), random.range(1.01, 3.0));
            assert!(close(conductor_reflectance(cos, ior, 0.0), dielectric_reflectance(cos, ior), 1e-4), "{cos} {ior}");
        }
    }

    #[test]
    fn conductors_agree_with_closed_forms() {
        // ((η - 1)² + k²) / ((η + 1)² + k²) at normal incidence, 1 at grazing angles.
        for (eta, k) in [(0.156f32, 3.602f32), (1.383, 1.915), (2.95, 2.932)] {
            let expected = ((eta - 1.0).powi(2) + k * k) / ((eta + 1.0).powi(2) + k * k);
            assert!(close(conductor_reflectance(1.0, eta, k), expected, 1e-6));
            assert!(close(conductor_reflectance(0.0, eta, k), 1.0, 1e-6));
        }
        for cos in [0.1f32, 0.3, 0.5, 0.8] {
            let expected = by_complex_numbers(f64::from(cos), 0.2, 3.44) as f32;
            assert!(close(conductor_reflectance(cos, 0.2, 3.44), expected, 1e-5), "{cos}");
        }
    }

    /// Fresnel's equations in the textbooks' form, with complex numbers as pairs.
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
    fn mean_fresnel_reflectance_equals_the_integral() {
        for ior in [0.4f32, 0.66, 0.75, 0.99, 1.0, 1.005, 1.02, 1.1, 1.33, 1.5, 2.4, 4.0] {
            let steps = 20_000;
            let at = |i| {
                let cos = (f64::from(i) + 0.5) / f64::from(steps);
                2.0 * cos * f64::from(dielectric_reflectance(cos as f32, ior)) / f64::from(steps)
            };
            let (sum, mean) = ((0..steps).map(at).sum::<f64>() as f32, mean_dielectric_reflectance(ior));
            assert!(close(mean, sum, 1e-3), "{ior}: {mean} {sum}");
        }
    }
}
