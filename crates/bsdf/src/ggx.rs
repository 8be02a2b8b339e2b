//! Microfacets whose normals are distributed like those of an ellipsoid: GGX (Trowbridge and Reitz
//! 1975; Walter, Marschner, Li and Torrance 2007), with Smith's height-correlated masking (Heitz
//! 2014). Visible normals are sampled by spherical caps (Dupuy and Benyoub 2023).
//!
//! `alpha` is the tangent of the typical slope along each axis. Materials have a roughness instead,
//! whose square is alpha (Burley 2012); lobes take alpha.
//!
//! With s(w) = √(z² + αx² x² + αy² y²), Smith's functions need no tangents: G1(w) = 2z / (z +
//! s(w)), and G2(o, i) = 2 zo zi / (zo s(i) + zi s(o)).

use juggler_math::{Vec2, Vec3, portable};
use std::f32::consts::PI;

/// Distribution of microfacet normals, all with z > 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx {
    x: f32,
    y: f32,
}

/// Reflection of one direction into another at the microfacets between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MicrofacetReflection {
    /// Cosine between either direction and the microfacet normal.
    pub cos: f32,
    /// D G2 / (4 zo): f |cos θi| for a Fresnel reflectance of 1.
    pub value: f32,
    /// Density of [`Ggx::sample_reflection`], per steradian.
    pub pdf: f32,
}

impl Ggx {
    /// Alpha below which (on both axes) a surface counts as smooth: it blurs a mirror image by less
    /// than 0.1 degrees, and single precision cannot resolve the directions of its lobe.
    pub const SMOOTH: f32 = 1e-3;

    /// Distribution of this alpha along x and y, each clamped to `SMOOTH..=1`; smooth if both are
    /// below `SMOOTH`.
    #[inline]
    pub fn new(alpha: Vec2) -> Self {
        if alpha.x < Self::SMOOTH && alpha.y < Self::SMOOTH {
            return Self { x: 0.0, y: 0.0 };
        }
        // NaN becomes `SMOOTH`.
        let clamped = |alpha: f32| if alpha > Self::SMOOTH { alpha.min(1.0) } else { Self::SMOOTH };
        Self { x: clamped(alpha.x), y: clamped(alpha.y) }
    }

    /// Distribution of the same alpha along both axes.
    #[inline]
    pub fn isotropic(alpha: f32) -> Self {
        Self::new(Vec2::splat(alpha))
    }

    /// Whether all normals are z.
    #[inline]
    pub fn is_smooth(self) -> bool {
        self.x == 0.0
    }

    /// Alpha along x and y; 0 if smooth.
    #[inline]
    pub fn alpha(self) -> Vec2 {
        Vec2::new(self.x, self.y)
    }

    /// Root mean square of both alphas.
    #[inline]
    pub fn mean_alpha(self) -> f32 {
        if self.is_isotropic() { self.x } else { (0.5 * (self.x * self.x + self.y * self.y)).sqrt() }
    }

    /// Isotropic alpha for light along `w`: at grazing angles only the slopes along `w` matter, at
    /// normal incidence both axes alike.
    #[inline]
    pub fn alpha_towards(self, w: Vec3) -> f32 {
        if self.is_isotropic() {
            return self.x;
        }
        let (x2, y2, z2) = (self.x * self.x, self.y * self.y, (w.z * w.z).min(1.0));
        let along = (1.0 + z2) * (x2 * w.x * w.x + y2 * w.y * w.y);
        (along + 0.5 * (x2 + y2) * (z2 * z2)).sqrt()
    }

    /// Whether the distribution is isotropic.
    #[inline]
    pub fn is_isotropic(self) -> bool {
        self.x == self.y
    }

    /// Smaller alpha over the larger one; 1 if isotropic.
    #[inline]
    pub fn alpha_ratio(self) -> f32 {
        if self.is_isotropic() { 1.0 } else { self.x.min(self.y) / self.x.max(self.y) }
    }

    /// s(w) of the module's documentation.
    #[inline]
    pub fn stretched_length(self, w: Vec3) -> f32 {
        let (x, y) = (self.x * w.x, self.y * w.y);
        (w.z * w.z + x * x + y * y).sqrt()
    }

    /// D at the normal `m`, which need not be a unit vector; per steradian.
    #[inline]
    pub fn normal_density(self, m: Vec3) -> f32 {
        let (x, y) = (m.x / self.x, m.y / self.y);
        let ratio = m.length_squared() / (x * x + y * y + m.z * m.z).max(f32::MIN_POSITIVE);
        ratio * ratio / (PI * self.x * self.y)
    }

    /// Samples a normal visible from `wo` (z >= 0), and returns it with its D; `so` is s(wo).
    #[inline]
    pub fn sample_visible_normal(self, wo: Vec3, so: f32, u: Vec2) -> (Vec3, f32) {
        let standard = Vec3::new(self.x * wo.x, self.y * wo.y, wo.z) / so.max(f32::MIN_POSITIVE);
        let z = (1.0 - u.x) * (1.0 + standard.z) - standard.z;
        let radius = (1.0 - z * z).max(0.0).sqrt();
        let (sin, cos) = portable::sin_cos_turns(u.y);
        let cap = Vec3::new(radius * cos, radius * sin, z) + standard;
        let m = Vec3::new(self.x * cap.x, self.y * cap.y, cap.z.max(0.0));
        let squared = m.length_squared().max(f32::MIN_POSITIVE);
        let ratio = squared / cap.length_squared().max(f32::MIN_POSITIVE);
        (m / squared.sqrt(), ratio * ratio / (PI * self.x * self.y))
    }

    /// Reflection of `wo` into `wi`, both above the surface.
    #[inline]
    pub fn eval_reflection(self, wo: Vec3, wi: Vec3) -> MicrofacetReflection {
        let m = wo + wi;
        let (so, si) = (self.stretched_length(wo), self.stretched_length(wi));
        Self::reflection_terms(wo.z, wi.z, so, si, 0.5 * m.length(), self.normal_density(m))
    }

    /// Reflects `wo` at a sampled visible normal; `None` where the direction would be below the
    /// surface.
    #[inline]
    pub fn sample_reflection(self, wo: Vec3, u: Vec2) -> Option<(Vec3, MicrofacetReflection)> {
        let so = self.stretched_length(wo);
        let (m, density) = self.sample_visible_normal(wo, so, u);
        let cos = wo.dot(m);
        let wi = m * (2.0 * cos) - wo;
        if wi.z <= 0.0 || cos <= 0.0 {
            return None;
        }
        Some((wi, Self::reflection_terms(wo.z, wi.z, so, self.stretched_length(wi), cos, density)))
    }

    /// G2 / G1(o): fraction of the light from visible normals that no other microfacet blocks, from
    /// the cosines and s(w) of both directions.
    #[inline]
    pub fn g2_over_g1(self, zo: f32, so: f32, zi: f32, si: f32) -> f32 {
        zi * (zo + so) / (so * zi + si * zo).max(f32::MIN_POSITIVE)
    }

    #[inline]
    fn reflection_terms(zo: f32, zi: f32, so: f32, si: f32, cos: f32, density: f32) -> MicrofacetReflection {
        let cross = (so * zi + si * zo).max(f32::MIN_POSITIVE);
        MicrofacetReflection {
            cos,
            value: 0.5 * density * zi / cross,
            pdf: 0.5 * density / (zo + so).max(f32::MIN_POSITIVE),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::{Random, chi_squared_directions, close};

    const ALPHAS: [(f32, f32); 5] = [(0.1, 0.1), (0.5, 0.5), (1.0, 1.0), (0.1, 0.6), (0.9, 0.2)];

    #[test]
    fn microfacet_normals_integrate_to_the_projected_area() {
        // ∫ D cos = 1, and visible normals cover the projected area from any view: ∫ D G1 max(0,
        // o·m) = zo.
        let mut random = Random::new(71);
        for (x, y) in ALPHAS {
            let ggx = Ggx::new(Vec2::new(x, y));
            let wo = Vec3::new(0.6, -0.3, random.range(0.1, 1.0)).normalize();
            let g1 = 2.0 * wo.z / (wo.z + ggx.stretched_length(wo));
            let (mut flat, mut seen) = (0.0f64, 0.0f64);
            let (steps, turns) = (1500, 300);
            for i in 0..steps {
                // Uniform in t = s / (1 + s) of the slope s over alpha, where the density is
                // smooth.
                let t = (i as f32 + 0.5) / steps as f32;
                let slope = t / (1.0 - t);
                for j in 0..turns {
                    let (sin, cos) = portable::sin_cos_turns((j as f32 + 0.5) / turns as f32);
                    let m = Vec3::new(x * slope * cos, y * slope * sin, 1.0);
                    // dω = dx dy / |m|³ over slopes dx dy = αx αy s ds dφ.
                    let area =
                        x * y * slope * (std::f32::consts::TAU / turns as f32) / ((1.0 - t) * (1.0 - t) * steps as f32);
                    let weight = ggx.normal_density(m) * area / m.length().powi(3);
                    flat += f64::from(weight / m.length());
                    seen += f64::from(weight * g1 * wo.dot(m.normalize()).max(0.0));
                }
            }
            assert!((flat - 1.0).abs() < 2e-3, "{x} {y}: {flat}");
            assert!((seen - f64::from(wo.z)).abs() < 3e-3, "{x} {y}: {seen} {wo}");
        }
    }

    #[test]
    fn visible_normals_are_sampled_by_their_density() {
        for (i, (x, y)) in ALPHAS.into_iter().enumerate() {
            let ggx = Ggx::new(Vec2::new(x, y));
            let wo = Vec3::new(0.7, 0.3, [0.4, 0.05, 2.0][i % 3]).normalize();
            let so = ggx.stretched_length(wo);
            let pdf = |m: Vec3| {
                if m.z > 0.0 { 2.0 * ggx.normal_density(m) * wo.dot(m).max(0.0) / (wo.z + so) } else { 0.0 }
            };
            // Rotate the normal away from z, around which the test's cells are longest.
            let turned = |w: Vec3| Vec3::new(w.z, w.x, w.y);
            let back = |w: Vec3| Vec3::new(w.y, w.z, w.x);
            chi_squared_directions(
                |u| Some(turned(ggx.sample_visible_normal(wo, so, u).0)),
                |w| pdf(back(w)),
                1_000_000,
                1e-3 / 5.0,
            )
            .unwrap();
            let (m, density) = ggx.sample_visible_normal(wo, so, Vec2::new(0.3, 0.8));
            assert!(close(m.length(), 1.0, 1e-6) && close(density, ggx.normal_density(m), 1e-4));
        }
    }

    #[test]
    fn alpha_is_clamped_to_its_range() {
        assert!(
            Ggx::isotropic(0.0).is_smooth() && Ggx::isotropic(9e-4).is_smooth() && !Ggx::isotropic(1e-3).is_smooth()
        );
        assert_eq!(Ggx::new(Vec2::new(0.0, 3.0)).alpha(), Vec2::new(Ggx::SMOOTH, 1.0));
        assert_eq!(Ggx::new(Vec2::new(f32::NAN, 0.5)).alpha(), Vec2::new(Ggx::SMOOTH, 0.5));
    }
}
