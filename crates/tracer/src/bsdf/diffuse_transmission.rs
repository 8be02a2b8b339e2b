//! A sheet that spreads light evenly on either side of itself: paper, leaves, lampshades. The same from both sides.

use super::lobe::sum;
use super::{BsdfSample, Scatter, choose};
use juggler_math::{Rgb, Vec2, Vec3, warp};
use std::f32::consts::FRAC_1_PI;

/// A matt sheet that light gets through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffuseTransmission {
    /// Share of light that is given back to its own side, 0 to 1.
    pub reflectance: Rgb,
    /// Share of light that gets through; no channel of both together is above 1.
    pub transmittance: Rgb,
}

impl DiffuseTransmission {
    /// How often light is given back.
    #[inline]
    fn reflected(&self) -> f32 {
        let (r, t) = (sum(self.reflectance), sum(self.transmittance));
        if r + t > 0.0 { r / (r + t) } else { 0.5 }
    }

    /// f |cos θi|, and the density per steradian.
    #[inline]
    pub fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        let (side, pdf) = (wo.z * wi.z, wi.z.abs() * FRAC_1_PI);
        if side > 0.0 {
            (self.reflectance * pdf, pdf * self.reflected())
        } else if side < 0.0 {
            (self.transmittance * pdf, pdf * (1.0 - self.reflected()))
        } else {
            (Rgb::BLACK, 0.0)
        }
    }

    /// A direction by cosine, on either side.
    #[inline]
    pub fn sample(&self, wo: Vec3, u: Vec2) -> Option<BsdfSample> {
        let (is_reflected, x) = choose(u.x, self.reflected());
        let wi = warp::cosine_hemisphere(Vec2::new(x, u.y));
        let wi = if is_reflected == (wo.z > 0.0) { wi } else { -wi };
        let (value, pdf) = self.eval_pdf(wo, wi);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: value / pdf, pdf, scatter: Scatter::Diffuse, ior: 1.0 })
    }

    /// What comes out on either side.
    pub fn albedo(&self, wo: Vec3) -> Rgb {
        if wo.z == 0.0 { Rgb::BLACK } else { self.reflectance + self.transmittance }
    }
}
