//! Rough diffuse reflection, brighter than Lambertian where viewer and light are on the same side
//! (Oren and Nayar 1994), in Fujii's form (2012) with multiple scattering added, so that a white
//! surface reflects all light: EON (Portsmouth, Kutz and Hill 2024, "EON: a practical
//! energy-preserving rough diffuse BRDF").
//!
//! Directional albedos are the paper's polynomial fit, which needs no angles. Directions are
//! sampled by the cosine.

use super::{BsdfSample, Scatter};
use crate::ScatteringLobe;
use juggler_math::{Rgb, Vec2, Vec3, warp};
use std::f32::consts::{FRAC_1_PI, PI};

/// Rough diffuse lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrenNayar {
    /// Albedo of a single bounce, 0 to 1. The lobe's albedo is lower unless this is white: further
    /// bounces absorb more.
    albedo: Rgb,
    roughness: f32,
    /// Albedo of further bounces over π (1 - Ē), with Ē the mean albedo of a single white bounce.
    multiple: Rgb,
}

impl OrenNayar {
    /// Lobe of this color; `roughness` is clamped to 0, which is Lambertian, to 1.
    pub fn new(albedo: Rgb, roughness: f32) -> Self {
        let roughness = roughness.clamp(0.0, 1.0);
        let average = Self::scale(roughness) * (1.0 + (2.0 / 3.0 - 28.0 / (15.0 * PI)) * roughness);
        let lost = (1.0 - average).max(1e-6);
        let multiple = albedo.map(|a| a * a * average / (1.0 - a * lost) * (FRAC_1_PI / lost));
        Self { albedo, roughness, multiple }
    }

    /// Coefficient A of Fujii's model.
    #[inline]
    fn scale(roughness: f32) -> f32 {
        1.0 / (1.0 + (0.5 - 2.0 / (3.0 * PI)) * roughness)
    }

    /// Directional albedo of a single white bounce.
    #[inline]
    fn once(&self, cos: f32) -> f32 {
        let m = 1.0 - cos;
        let g = m * (0.057_108_53 + m * (0.491_881_87 + m * (-0.332_181_44 + m * 0.071_442_99)));
        Self::scale(self.roughness) * (1.0 + self.roughness * g)
    }
}

impl ScatteringLobe for OrenNayar {
    /// f |cos θi|, and the density per steradian.
    #[inline]
    fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return (Rgb::BLACK, 0.0);
        }
        let s = wo.x * wi.x + wo.y * wi.y;
        let s = if s > 0.0 { s / wo.z.max(wi.z) } else { s };
        let single = FRAC_1_PI * Self::scale(self.roughness) * (1.0 + self.roughness * s);
        let more = (1.0 - self.once(wo.z)) * (1.0 - self.once(wi.z));
        ((self.albedo * single + self.multiple * more.max(0.0)) * wi.z, wi.z * FRAC_1_PI)
    }

    /// Samples a cosine-weighted direction.
    #[inline]
    fn sample(&self, wo: Vec3, u: Vec2, _u_choice: f32) -> Option<BsdfSample> {
        let wi = warp::cosine_hemisphere(u);
        let (value, pdf) = self.eval_pdf(wo, wi);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: value / pdf, pdf, scatter: Scatter::Diffuse, ior: 1.0 })
    }

    /// Directional albedo of single and multiple scattering.
    fn albedo(&self, wo: Vec3) -> Rgb {
        if wo.z <= 0.0 {
            return Rgb::BLACK;
        }
        let once = self.once(wo.z);
        let average = Self::scale(self.roughness) * (1.0 + (2.0 / 3.0 - 28.0 / (15.0 * PI)) * self.roughness);
        self.albedo * once + self.multiple * ((1.0 - once) * (1.0 - average) * PI)
    }

    #[inline]
    fn attenuates_as_diffuse(&self) -> bool {
        true
    }
}
