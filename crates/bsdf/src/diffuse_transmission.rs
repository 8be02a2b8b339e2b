//! Thin sheet with diffuse reflection and diffuse transmission, the same from both sides: paper,
//! leaves, lampshades.
//!
//! Where the sheet is part of the surface of a solid that refracts light, radiance inside is η²
//! times as large, and transmitted radiance is scaled as at a refracting interface. By reciprocity,
//! the denser side then transmits 1 / η² of the transmittance and reflects the rest.

use super::lobe::channel_sum;
use super::{BsdfSample, Scatter, choose};
use crate::ScatteringLobe;
use juggler_math::{Rgb, Vec2, Vec3, warp};
use std::f32::consts::FRAC_1_PI;

/// Diffuse lobe that reflects and transmits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffuseTransmission {
    /// Fraction of light that is reflected, 0 to 1.
    pub reflectance: Rgb,
    /// Fraction of light that is transmitted, 0 to 1; no channel of the sum of both exceeds 1.
    pub transmittance: Rgb,
    /// Index of refraction below the surface over that above; 1 for a free-standing sheet.
    pub ior: f32,
}

impl DiffuseTransmission {
    /// Index on the opposite side over that on the side of `wo`.
    #[inline]
    fn ior_from(&self, wo: Vec3) -> f32 {
        if wo.z < 0.0 { 1.0 / self.ior } else { self.ior }
    }

    /// Reflectance and transmittance of light along `wo`.
    #[inline]
    fn reflectance_and_transmittance(&self, wo: Vec3) -> [Rgb; 2] {
        let ior = self.ior_from(wo);
        let open = (ior * ior).min(1.0);
        [self.reflectance + self.transmittance * (1.0 - open), self.transmittance * open]
    }

    /// Probability of sampling reflection.
    #[inline]
    fn reflection_probability([reflectance, transmittance]: [Rgb; 2]) -> f32 {
        let (r, t) = (channel_sum(reflectance), channel_sum(transmittance));
        if r + t > 0.0 { r / (r + t) } else { 0.5 }
    }
}

impl ScatteringLobe for DiffuseTransmission {
    /// f |cos θi|, and the density per steradian.
    #[inline]
    fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        let (side, pdf) = (wo.z * wi.z, wi.z.abs() * FRAC_1_PI);
        let reflectance_and_transmittance = self.reflectance_and_transmittance(wo);
        if side > 0.0 {
            (reflectance_and_transmittance[0] * pdf, pdf * Self::reflection_probability(reflectance_and_transmittance))
        } else if side < 0.0 {
            let ior = self.ior_from(wo);
            (
                reflectance_and_transmittance[1] * (pdf / (ior * ior)),
                pdf * (1.0 - Self::reflection_probability(reflectance_and_transmittance)),
            )
        } else {
            (Rgb::BLACK, 0.0)
        }
    }

    /// Samples a cosine-weighted direction on either side.
    #[inline]
    fn sample(&self, wo: Vec3, u: Vec2, _u_choice: f32) -> Option<BsdfSample> {
        let (is_reflected, x) = choose(u.x, Self::reflection_probability(self.reflectance_and_transmittance(wo)));
        let wi = warp::cosine_hemisphere(Vec2::new(x, u.y));
        let wi = if is_reflected == (wo.z > 0.0) { wi } else { -wi };
        let (value, pdf) = self.eval_pdf(wo, wi);
        let ior = if is_reflected { 1.0 } else { self.ior_from(wo) };
        (pdf > 0.0).then(|| BsdfSample { wi, weight: value / pdf, pdf, scatter: Scatter::Diffuse, ior })
    }

    /// Reflectance plus transmittance.
    fn albedo(&self, wo: Vec3) -> Rgb {
        if wo.z == 0.0 { Rgb::BLACK } else { self.reflectance + self.transmittance }
    }

    #[inline]
    fn attenuates_as_diffuse(&self) -> bool {
        true
    }
}
