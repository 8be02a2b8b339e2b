//! Phong's highlight (1975) as a lobe that gives no more light than it gets: f = ks (n + 2) / 2π (r · v)^n with r the
//! light mirrored (Lafortune and Willems 1994). The same both ways; its whole share `specular` head on, less at a slant.

use super::{BsdfSample, Scatter};
use crate::ScatteringLobe;
use juggler_math::{Frame, Rgb, Vec2, Vec3, fun};
use std::f32::consts::TAU;

/// A classic highlight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhongHighlight {
    /// Share of light that is given back, head on.
    pub specular: Rgb,
    /// n: the larger, the smaller the highlight; from 0.
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
        let power = fun::powf(cos.min(1.0), self.exponent) / TAU;
        (self.specular * ((self.exponent + 2.0) * power * wi.z), (self.exponent + 1.0) * power)
    }

    /// A direction around the mirrored one.
    #[inline]
    fn sample(&self, wo: Vec3, u: Vec2, _choice: f32) -> Option<BsdfSample> {
        let cos = fun::powf(1.0 - u.x, 1.0 / (self.exponent + 1.0));
        let radius = (1.0 - cos * cos).max(0.0).sqrt();
        let (sin, turn) = fun::sin_cos_turns(u.y);
        let frame = Frame::around(Vec3::new(-wo.x, -wo.y, wo.z));
        let wi = frame.to_world(Vec3::new(radius * turn, radius * sin, cos));
        let (value, pdf) = self.eval_pdf(wo, wi);
        (pdf > 1e-20).then(|| BsdfSample { wi, weight: value / pdf, pdf, scatter: Scatter::Glossy, ior: 1.0 })
    }

    /// Head on everything; at a slant what is left of the lobe's cosine, by a rough fit.
    fn albedo(&self, wo: Vec3) -> Rgb {
        if wo.z <= 0.0 {
            return Rgb::BLACK;
        }
        let least = 0.3 / (self.exponent + 2.0);
        self.specular * (wo.z * wo.z + least * (1.0 - wo.z * wo.z)).sqrt()
    }
}
