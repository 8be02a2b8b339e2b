//! Sampling of disks, hemispheres, spheres, cones and triangles: mappings from the unit square,
//! each with its density and its inverse (Shirley and Chiu 1997 for the disk; Pharr, Jakob,
//! Humphreys, PBR 4th ed., appendix A.5).
//!
//! Arguments `u` lie in [0, 1)². Directions are unit vectors around +z. Densities are per unit area
//! or per steradian, and zero outside the mapping's range unless stated otherwise. Inverses return
//! `u` up to rounding.

use crate::{Vec2, Vec3, portable};
use std::f32::consts::{FRAC_1_PI, PI, TAU};

/// Azimuth of (x, y) in turns, in [0, 1).
fn azimuth_turns(x: f32, y: f32) -> f32 {
    let turn = portable::atan2(y, x) * (1.0 / TAU);
    if turn < 0.0 { (turn + 1.0).min(1f32.next_down()) } else { turn }
}

/// Samples the unit disk uniformly by the concentric mapping, whose low distortion preserves the
/// stratification of `u` (Shirley and Chiu 1997).
pub fn concentric_disk(u: Vec2) -> Vec2 {
    let p = u * 2.0 - 1.0;
    if p == Vec2::ZERO {
        return p;
    }
    let (radius, turns) =
        if p.x.abs() > p.y.abs() { (p.x, p.y / p.x * 0.125) } else { (p.y, 0.25 - p.x / p.y * 0.125) };
    let (sin, cos) = portable::sin_cos_turns(turns);
    Vec2::new(radius * cos, radius * sin)
}

/// Inverse of [`concentric_disk`].
pub fn concentric_disk_inverse(p: Vec2) -> Vec2 {
    let radius = p.length();
    let eighths = portable::atan2(p.y, p.x) * (8.0 / TAU);
    let square = if eighths.abs() <= 1.0 {
        Vec2::new(radius, radius * eighths)
    } else if eighths.abs() >= 3.0 {
        let rest = if eighths > 0.0 { eighths - 4.0 } else { eighths + 4.0 };
        Vec2::new(-radius, -radius * rest)
    } else if eighths > 0.0 {
        Vec2::new(radius * (2.0 - eighths), radius)
    } else {
        Vec2::new(radius * (2.0 + eighths), -radius)
    };
    square * 0.5 + 0.5
}

/// Samples the unit disk uniformly in polar coordinates: `u.x` gives the radius, `u.y` the angle.
pub fn polar_disk(u: Vec2) -> Vec2 {
    let radius = u.x.sqrt();
    let (sin, cos) = portable::sin_cos_turns(u.y);
    Vec2::new(radius * cos, radius * sin)
}

/// Inverse of [`polar_disk`].
pub fn polar_disk_inverse(p: Vec2) -> Vec2 {
    Vec2::new(p.length_squared(), azimuth_turns(p.x, p.y))
}

/// Density per unit area of [`concentric_disk`] and [`polar_disk`].
pub fn disk_pdf(p: Vec2) -> f32 {
    if p.length_squared() <= 1.0 { FRAC_1_PI } else { 0.0 }
}

/// Samples a direction with density cos θ / π by projecting [`concentric_disk`] up (Malley's
/// method).
pub fn cosine_hemisphere(u: Vec2) -> Vec3 {
    let p = concentric_disk(u);
    p.extend((1.0 - p.length_squared()).max(0.0).sqrt())
}

/// Density of [`cosine_hemisphere`].
pub fn cosine_hemisphere_pdf(w: Vec3) -> f32 {
    w.z.max(0.0) * FRAC_1_PI
}

/// Inverse of [`cosine_hemisphere`].
pub fn cosine_hemisphere_inverse(w: Vec3) -> Vec2 {
    concentric_disk_inverse(w.truncate())
}

/// Samples the hemisphere z >= 0 uniformly.
pub fn uniform_hemisphere(u: Vec2) -> Vec3 {
    uniform_cone(u, 1.0)
}

/// Density of [`uniform_hemisphere`].
pub fn uniform_hemisphere_pdf(w: Vec3) -> f32 {
    if w.z >= 0.0 { 1.0 / TAU } else { 0.0 }
}

/// Inverse of [`uniform_hemisphere`].
pub fn uniform_hemisphere_inverse(w: Vec3) -> Vec2 {
    uniform_cone_inverse(w, 1.0)
}

/// Samples the sphere of directions uniformly.
pub fn uniform_sphere(u: Vec2) -> Vec3 {
    uniform_cone(u, 2.0)
}

/// Density of [`uniform_sphere`].
pub const UNIFORM_SPHERE_PDF: f32 = 1.0 / (4.0 * PI);

/// Inverse of [`uniform_sphere`].
pub fn uniform_sphere_inverse(w: Vec3) -> Vec2 {
    uniform_cone_inverse(w, 2.0)
}

/// Cone size, as the `uniform_cone` functions take it: 1 - cos of the half angle, which is given in
/// radians. Accurate also for the sun's quarter of a degree, where 1 - cos would cancel.
pub fn cone_size(half_angle: f32) -> f32 {
    let sin = portable::sin(half_angle * 0.5);
    2.0 * sin * sin
}

/// Samples a cone around +z uniformly by solid angle; `size` is 1 - cos of the half angle, 0 to 2.
pub fn uniform_cone(u: Vec2, size: f32) -> Vec3 {
    let below_one = u.x * size;
    let radius = (below_one * (2.0 - below_one)).max(0.0).sqrt();
    let (sin, cos) = portable::sin_cos_turns(u.y);
    Vec3::new(radius * cos, radius * sin, 1.0 - below_one)
}

/// Density of [`uniform_cone`] for directions inside the cone.
pub fn uniform_cone_pdf(size: f32) -> f32 {
    1.0 / (TAU * size)
}

/// Inverse of [`uniform_cone`] for a direction inside the cone.
pub fn uniform_cone_inverse(w: Vec3, size: f32) -> Vec2 {
    let squared = w.x * w.x + w.y * w.y;
    // Compute 1 - z without cancellation where z is near 1.
    let below_one = if w.z > 0.0 { squared / (1.0 + w.z) } else { 1.0 - w.z };
    Vec2::new(below_one / size, azimuth_turns(w.x, w.y))
}

/// Samples a triangle uniformly and returns barycentric coordinates. The mapping folds the square
/// along its diagonal (Heitz, A Low-Distortion Map Between Triangle and Square, 2019).
pub fn uniform_triangle(u: Vec2) -> Vec3 {
    let (a, b) = if u.y > u.x {
        let a = u.x * 0.5;
        (a, u.y - a)
    } else {
        let b = u.y * 0.5;
        (u.x - b, b)
    };
    Vec3::new(a, b, (1.0 - a - b).max(0.0))
}

/// Density of [`uniform_triangle`] on a triangle of area `area`.
pub fn uniform_triangle_pdf(area: f32) -> f32 {
    1.0 / area
}

/// Inverse of [`uniform_triangle`].
pub fn uniform_triangle_inverse(b: Vec3) -> Vec2 {
    if b.x > b.y { Vec2::new(b.x + b.y, b.y * 2.0) } else { Vec2::new(b.x * 2.0, b.x + b.y) }
}

/// Samples the tent function `(radius - |x|) / radius²` on [-radius, radius].
pub fn tent(u: f32, radius: f32) -> f32 {
    let v = if u < 0.5 { (2.0 * u).sqrt() - 1.0 } else { 1.0 - (2.0 - 2.0 * u).sqrt() };
    v * radius
}

/// Density of [`tent`].
pub fn tent_pdf(x: f32, radius: f32) -> f32 {
    (radius - x.abs()).max(0.0) / (radius * radius)
}

/// Inverse of [`tent`].
pub fn tent_inverse(x: f32, radius: f32) -> f32 {
    let below = 1.0 - (x / radius).abs();
    if x < 0.0 { below * below * 0.5 } else { 1.0 - below * below * 0.5 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Random, chi_squared, chi_squared_directions};

    /// Significance level of each test: about 1e-3 for all tests of this file together.
    const SIGNIFICANCE: f64 = 1e-4;
    const SAMPLES: u32 = 1_000_000;

    fn inverts<T>(name: &str, map: impl Fn(Vec2) -> T, inverse: impl Fn(T) -> Vec2) {
        let mut random = Random::new(21);
        for _ in 0..20_000 {
            let u = random.vec2();
            let back = inverse(map(u));
            // The angle wraps at 1. Near radius 0 the angle is ill-conditioned.
            let difference = (back - u).abs();
            assert!(
                difference.x < 2e-5 && difference.y.min(1.0 - difference.y) < 2e-5 || u.x < 1e-5,
                "{name}: {u} came back as {back}"
            );
        }
    }

    #[test]
    fn inverse_warps_invert_their_warps() {
        inverts("concentric disk", concentric_disk, concentric_disk_inverse);
        inverts("polar disk", polar_disk, polar_disk_inverse);
        inverts("cosine hemisphere", cosine_hemisphere, cosine_hemisphere_inverse);
        inverts("hemisphere", uniform_hemisphere, uniform_hemisphere_inverse);
        inverts("sphere", uniform_sphere, uniform_sphere_inverse);
        inverts("triangle", uniform_triangle, uniform_triangle_inverse);
        for degrees in [0.01f32, 0.25, 30.0, 170.0] {
            let size = cone_size(degrees.to_radians());
            inverts("cone", |u| uniform_cone(u, size), |w| uniform_cone_inverse(w, size));
        }
        for i in 0..1000 {
            let u = i as f32 / 1000.0;
            assert!((tent_inverse(tent(u, 1.5), 1.5) - u).abs() < 1e-6);
        }
    }

    #[test]
    fn directions_follow_their_densities() {
        let test = |sample: &dyn Fn(Vec2) -> Vec3, pdf: &dyn Fn(Vec3) -> f32| {
            chi_squared_directions(|u| Some(sample(u)), pdf, SAMPLES, SIGNIFICANCE).unwrap();
        };
        test(&cosine_hemisphere, &cosine_hemisphere_pdf);
        test(&uniform_hemisphere, &uniform_hemisphere_pdf);
        test(&uniform_sphere, &|_| UNIFORM_SPHERE_PDF);
        // The rim of the cone lies on a cell boundary, so the midpoint rule is exact.
        test(&|u| uniform_cone(u, 0.5), &|w| if w.z >= 0.5 { uniform_cone_pdf(0.5) } else { 0.0 });
    }

    #[test]
    fn directions_have_unit_length_and_stay_inside() {
        let mut random = Random::new(22);
        let corners = [0.0, 1f32.next_down()].map(|x| [0.0, 1f32.next_down()].map(|y| Vec2::new(x, y)));
        for u in (0..10_000).map(|_| random.vec2()).chain(corners.concat()) {
            for w in [cosine_hemisphere(u), uniform_hemisphere(u), uniform_sphere(u), uniform_cone(u, 1e-5)] {
                assert!((w.length() - 1.0).abs() < 3e-7, "{u} {w}");
            }
            assert!(uniform_hemisphere(u).z >= 0.0 && cosine_hemisphere(u).z >= 0.0);
            assert!(polar_disk(u).length() < 1.000_001 && concentric_disk(u).length() < 1.000_001);
            let b = uniform_triangle(u);
            assert!(b.min_element() >= 0.0 && (b.x + b.y + b.z - 1.0).abs() < 1e-6, "{u} {b}");
        }
    }

    #[test]
    fn disks_are_uniform() {
        for map in [concentric_disk, polar_disk] {
            let mut random = Random::new(23);
            // Cells of equal area: 8 rings by 16 sectors.
            let mut observed = [0.0; 128];
            for _ in 0..SAMPLES {
                let p = map(random.vec2());
                let ring = ((p.length_squared() * 8.0) as usize).min(7);
                observed[ring * 16 + (azimuth_turns(p.x, p.y) * 16.0) as usize] += 1.0;
            }
            chi_squared(&observed, &[f64::from(SAMPLES) / 128.0; 128], SIGNIFICANCE).unwrap();
        }
        assert_eq!((disk_pdf(Vec2::new(0.6, 0.79)), disk_pdf(Vec2::new(0.6, 0.81))), (FRAC_1_PI, 0.0));
    }

    #[test]
    fn triangles_are_uniform() {
        let mut random = Random::new(24);
        // Sixteen congruent triangles: a 4 × 4 grid in (x, y), each cell split along its diagonal.
        let mut observed = std::collections::BTreeMap::new();
        for _ in 0..SAMPLES {
            let b = uniform_triangle(random.vec2()) * 4.0;
            let upper = b.x.fract() + b.y.fract() > 1.0;
            *observed.entry((b.x as u32, b.y as u32, upper)).or_insert(0.0) += 1.0;
        }
        let counts: Vec<f64> = observed.into_values().collect();
        assert_eq!(counts.len(), 16);
        chi_squared(&counts, &[f64::from(SAMPLES) / 16.0; 16], SIGNIFICANCE).unwrap();
        assert_eq!(uniform_triangle_pdf(0.5), 2.0);
    }

    #[test]
    fn tents_follow_their_density() {
        let mut random = Random::new(25);
        let mut observed = [0.0; 30];
        for _ in 0..SAMPLES {
            let x = tent(random.f32(), 1.5);
            observed[((x + 1.5) * 10.0) as usize] += 1.0;
        }
        let middle = |i: usize| (i as f32 + 0.5) / 10.0 - 1.5;
        let expected: Vec<f64> =
            (0..30).map(|i| f64::from(tent_pdf(middle(i), 1.5)) * 0.1 * f64::from(SAMPLES)).collect();
        chi_squared(&observed, &expected, SIGNIFICANCE).unwrap();
        assert_eq!(tent_pdf(2.0, 1.5), 0.0);
    }

    #[test]
    fn small_cones_keep_their_size() {
        let size = f64::from(cone_size(0.25f32.to_radians()));
        let exact = 1.0 - f64::from(0.25f32.to_radians()).cos();
        assert!((size / exact - 1.0).abs() < 1e-6, "{size} {exact}");
    }
}
