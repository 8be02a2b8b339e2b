//! Phong's highlight (1975) as a lobe that conserves energy: f = ks (n + 2) / 2π (r · v)^n with r
//! the mirror direction of the light (Lafortune and Willems 1994). It is reciprocal; its albedo is
//! `specular` at normal incidence and less at oblique angles.

use super::{BsdfSample, Scatter};
use crate::ScatteringLobe;
use juggler_math::{Frame, Rgb, Vec2, Vec3, portable};
use std::f32::consts::TAU;

/// Phong highlight lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhongHighlight {
    /// Albedo at normal incidence, 0 to 1.
    pub specular: Rgb,
    /// Exponent n, from 0; larger values make the highlight smaller.
    pub exponent: f32,
}

impl ScatteringLobe for PhongHighlight {
    /// f |cos θi|, and the density per steradian.
    #[inline]
    fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        let cos = wo.z * wi.z - wo.x * wi.x - wo.y * wi.y;
        if wo.z <= 0.0 || wi.z <= 0.0 || cos <= 0.0 {
            return (Rgb::BLACK, 0.0);
        }
        let power = portable::powf(cos.min(1.0), self.exponent) / TAU;
        (self.specular * ((self.exponent + 2.0) * power * wi.z), (self.exponent + 1.0) * power)
    }

    /// Samples a direction around the mirror direction.
    #[inline]
    fn sample(&self, wo: Vec3, u: Vec2, _u_choice: f32) -> Option<BsdfSample> {
        let cos = portable::powf(1.0 - u.x, 1.0 / (self.exponent + 1.0));
        let radius = (1.0 - cos * cos).max(0.0).sqrt();
        let (sin, turn) = portable::sin_cos_turns(u.y);
        let frame = Frame::around(Vec3::new(-wo.x, -wo.y, wo.z));
        let wi = frame.to_world(Vec3::new(radius * turn, radius * sin, cos));
        let (value, pdf) = self.eval_pdf(wo, wi);
        (pdf > 1e-20).then(|| BsdfSample { wi, weight: value / pdf, pdf, scatter: Scatter::Glossy, ior: 1.0 })
    }

    /// Fit of the directional albedo, exact at normal incidence.
    fn albedo(&self, wo: Vec3) -> Rgb {
        if wo.z <= 0.0 {
            return Rgb::BLACK;
        }
        let least = 0.3 / (self.exponent + 2.0);
        self.specular * (wo.z * wo.z + least * (1.0 - wo.z * wo.z)).sqrt()
    }
}
