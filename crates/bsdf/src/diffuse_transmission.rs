//! A sheet that spreads light evenly on either side of itself: paper, leaves, lampshades. The same from both sides.
//!
//! Where the sheet is part of the surface of a solid that refracts light, radiance inside is η² times as large, and what the
//! sheet transmits is scaled as what glass transmits is. By reciprocity the denser side then lets 1 / η² of the transmittance
//! through and reflects the rest.

use super::lobe::sum;
use super::{BsdfSample, Scatter, choose};
use crate::ScatteringLobe;
use juggler_math::{Rgb, Vec2, Vec3, warp};
use std::f32::consts::FRAC_1_PI;

/// A matt sheet that light gets through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffuseTransmission {
    /// Share of light that is given back to its own side, 0 to 1.
    pub reflectance: Rgb,
    /// Share of light that gets through; no channel of both together is above 1.
    pub transmittance: Rgb,
    /// Index of refraction below over above; 1 for a sheet of its own.
    pub ior: f32,
}

impl DiffuseTransmission {
    /// Index on the other side over that on the side of `wo`.
    #[inline]
    fn ior_from(&self, wo: Vec3) -> f32 {
        if wo.z < 0.0 { 1.0 / self.ior } else { self.ior }
    }

    /// The shares of light along `wo` that are given back and that get through.
    #[inline]
    fn shares(&self, wo: Vec3) -> [Rgb; 2] {
        let ior = self.ior_from(wo);
        let open = (ior * ior).min(1.0);
        [self.reflectance + self.transmittance * (1.0 - open), self.transmittance * open]
    }

    /// How often light is given back.
    #[inline]
    fn reflected([reflectance, transmittance]: [Rgb; 2]) -> f32 {
        let (r, t) = (sum(reflectance), sum(transmittance));
        if r + t > 0.0 { r / (r + t) } else { 0.5 }
    }
}

impl ScatteringLobe for DiffuseTransmission {
    /// f |cos θi|, and the density per steradian.
    #[inline]
    fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        let (side, pdf) = (wo.z * wi.z, wi.z.abs() * FRAC_1_PI);
        let shares = self.shares(wo);
        if side > 0.0 {
            (shares[0] * pdf, pdf * Self::reflected(shares))
        } else if side < 0.0 {
            let ior = self.ior_from(wo);
            (shares[1] * (pdf / (ior * ior)), pdf * (1.0 - Self::reflected(shares)))
        } else {
            (Rgb::BLACK, 0.0)
        }
    }

    /// A direction by cosine, on either side.
    #[inline]
    fn sample(&self, wo: Vec3, u: Vec2, _choice: f32) -> Option<BsdfSample> {
        let (is_reflected, x) = choose(u.x, Self::reflected(self.shares(wo)));
        let wi = warp::cosine_hemisphere(Vec2::new(x, u.y));
        let wi = if is_reflected == (wo.z > 0.0) { wi } else { -wi };
        let (value, pdf) = self.eval_pdf(wo, wi);
        let ior = if is_reflected { 1.0 } else { self.ior_from(wo) };
        (pdf > 0.0).then(|| BsdfSample { wi, weight: value / pdf, pdf, scatter: Scatter::Diffuse, ior })
    }

    /// What comes out on either side.
    fn albedo(&self, wo: Vec3) -> Rgb {
        if wo.z == 0.0 { Rgb::BLACK } else { self.reflectance + self.transmittance }
    }

    #[inline]
    fn is_matt(&self) -> bool {
        true
    }
}
