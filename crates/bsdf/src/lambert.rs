//! Lambertian diffuse reflection: the same radiance in all directions (Lambert 1760).

use super::{BsdfSample, Scatter};
use crate::ScatteringLobe;
use juggler_math::{Rgb, Vec2, Vec3, warp};
use std::f32::consts::FRAC_1_PI;

/// Lambertian lobe: f = albedo / π.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lambert {
    /// Fraction of light that is reflected, 0 to 1.
    pub albedo: Rgb,
}

impl ScatteringLobe for Lambert {
    /// f |cos θi|, and the density of `wi` per steradian.
    #[inline]
    fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return (Rgb::BLACK, 0.0);
        }
        let pdf = wi.z * FRAC_1_PI;
        (self.albedo * pdf, pdf)
    }

    /// Samples a cosine-weighted direction.
    #[inline]
    fn sample(&self, wo: Vec3, u: Vec2, _u_choice: f32) -> Option<BsdfSample> {
        let wi = warp::cosine_hemisphere(u);
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return None;
        }
        Some(BsdfSample { wi, weight: self.albedo, pdf: wi.z * FRAC_1_PI, scatter: Scatter::Diffuse, ior: 1.0 })
    }

    #[inline]
    fn attenuates_as_diffuse(&self) -> bool {
        true
    }

    #[inline]
    fn albedo(&self, wo: Vec3) -> Rgb {
        if wo.z > 0.0 { self.albedo } else { Rgb::BLACK }
    }
}
