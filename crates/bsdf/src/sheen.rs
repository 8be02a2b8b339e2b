//! Sheen of cloth at grazing angles: fibers stand upright, so their normals are near the horizon
//! (Estevez and Kulla 2017, "Production friendly microfacet sheen BRDF"; KHR_materials_sheen of
//! glTF), with the paper's fit of masking.
//!
//! D(m) = (2 + 1/α) sin^(1/α) θ / 2π. Directions are sampled uniformly over the hemisphere.
//! [`Sheen::albedo`], which a table holds, attenuates the layers below.

use super::{BsdfSample, Scatter, energy};
use crate::ScatteringLobe;
use crate::lanes::lanes;
use crate::quadrature::{self, Azimuth, NODES};
use juggler_math::{Rgb, Vec2, Vec3, portable, warp};
use std::f32::consts::TAU;

/// Sheen lobe of upright fibers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheen {
    /// Color of the fibers, 0 to 1.
    pub color: Rgb,
    alpha: f32,
    /// Coefficients of the masking fit for this alpha.
    fit: [f32; 5],
}

impl Sheen {
    /// Smallest alpha; below, the fit does not conserve energy.
    pub const LEAST: f32 = 0.05;

    /// Lobe of this color; `alpha`, the square of a material's roughness, is clamped to
    /// [`Sheen::LEAST`]`..=1`.
    pub fn new(color: Rgb, alpha: f32) -> Self {
        const SOFT: [f32; 5] = [21.547_3, 3.829_87, 0.198_23, -1.977_6, -4.320_54];
        const SHARP: [f32; 5] = [25.324_5, 3.324_35, 0.168_01, -1.273_93, -4.859_67];
        let alpha = if alpha > Self::LEAST { alpha.min(1.0) } else { Self::LEAST };
        let t = (1.0 - alpha) * (1.0 - alpha);
        let mut fit = SOFT;
        fit.iter_mut().zip(SHARP).for_each(|(soft, sharp)| *soft += (sharp - *soft) * t);
        Self { color, alpha, fit }
    }

    /// ln Λ at a cosine `x` up to 0.5.
    fn curve(&self, x: f32) -> f32 {
        let [a, b, c, d, e] = self.fit;
        a / (1.0 + b * portable::powf(x, c)) + d * x + e
    }

    /// Smith's Λ.
    fn lambda(&self, cos: f32) -> f32 {
        // Rounding can make cosines slightly larger than 1, where the fit is NaN.
        let power = if cos < 0.5 { self.curve(cos) } else { 2.0 * self.curve(0.5) - self.curve((1.0 - cos).max(0.0)) };
        portable::exp(power)
    }
}

impl ScatteringLobe for Sheen {
    /// f |cos θi|, and the density per steradian.
    fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return (Rgb::BLACK, 0.0);
        }
        let m = (wo + wi).normalize_or_zero();
        let inverse = 1.0 / self.alpha;
        // sin^(1/α) θ = (sin² θ)^(1 / 2α).
        let sin2 = (m.x * m.x + m.y * m.y).min(1.0);
        let density = (2.0 + inverse) * portable::powf(sin2, 0.5 * inverse) / TAU;
        let masked = 1.0 + self.lambda(wo.z) + self.lambda(wi.z);
        (self.color * (density / (4.0 * wo.z * masked).max(f32::MIN_POSITIVE)), 1.0 / TAU)
    }

    /// Samples the hemisphere uniformly.
    fn sample(&self, wo: Vec3, u: Vec2, _u_choice: f32) -> Option<BsdfSample> {
        let wi = warp::uniform_hemisphere(u);
        let (value, pdf) = self.eval_pdf(wo, wi);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: value / pdf, pdf, scatter: Scatter::Diffuse, ior: 1.0 })
    }

    /// Directional albedo, from a table.
    fn albedo(&self, wo: Vec3) -> Rgb {
        if wo.z <= 0.0 { Rgb::BLACK } else { self.color * energy::sheen_albedos([wo.z], self.alpha)[0] }
    }

    fn max_albedos(&self, _azimuth: Azimuth) -> [f32; NODES] {
        let Rgb { r, g, b } = self.color;
        let white = energy::sheen_albedos(quadrature::cosines(), self.alpha);
        lanes(|node| (r * white[node]).max(g * white[node]).max(b * white[node]))
    }

    #[inline]
    fn is_diffuse(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounded unit vectors are up to a few units in the last place longer than 1.
    #[test]
    fn sheen_is_continuous_at_the_normal() {
        for roughness in [0.2f32, 0.5, 0.9, 1.0] {
            let sheen = Sheen::new(Rgb::WHITE, roughness * roughness);
            let value = |z: f32| sheen.eval_pdf(Vec3::new(0.0, 0.6, 0.8), Vec3::new(0.0, 0.0, z)).0.g;
            let usual = value(0.999_999);
            for z in [1.0, 1.0f32.next_up(), 1.000_000_2, 1.000_000_5] {
                assert!((value(z) / usual - 1.0).abs() < 0.01, "{roughness} {z}: {} {usual}", value(z));
            }
        }
    }
}
