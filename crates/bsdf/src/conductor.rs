//! Metal, polished or rough: Torrance and Sparrow's mirrors (1967) with [GGX](super::ggx) normals.
//!
//! Single scattering loses what is mirrored more than once between microfacets; [`Conductor::compensated`] gives
//! it back as one more lobe, f = m (1 - E(μo)) (1 - E(μi)) (Kulla and Conty 2017), which is reciprocal and makes a
//! perfect mirror white at any roughness. Its colour m counts the absorption of every further bounce:
//! F² Ē / (1 - F (1 - Ē)) / (π (1 - Ē)) with F Fresnel's mean and Ē that of E.
//!
//! Sampling then follows the light, as that of a rough [`Dielectric`](super::Dielectric) does: the
//! direction that a visible normal reflects is taken with probability G2 / G1; otherwise, that is
//! with the very probability 1 - E(μo), one is drawn in proportion to (1 - E(μi)) μi. Samples of a
//! perfect mirror carry a weight of 1, whatever the tables of E miss: light that meets metal many
//! times, as inside of a solid that is part metal and part glass, neither gains nor loses energy.

use super::energy::{self, Scramble};
use super::ggx::Ggx;
use super::lobe::{Deltas, delta};
use super::{BsdfSample, Fresnel, Scatter};
use crate::ScatteringLobe;
use juggler_math::{Rgb, Vec2, Vec3};
use std::f32::consts::FRAC_1_PI;

/// A metal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor {
    ggx: Ggx,
    fresnel: Fresnel,
    /// m, see above; black without compensation.
    multiple: Rgb,
    /// m of a perfect mirror, 1 / (π (1 - Ē)): what makes (1 - E(μi)) μi a density.
    normalization: f32,
}

impl Conductor {
    /// With single scattering only. `alpha` as in [`Ggx`]: the square of a material's roughness along x and y.
    #[inline]
    pub fn new(fresnel: Fresnel, alpha: Vec2) -> Self {
        Self { ggx: Ggx::new(alpha), fresnel, multiple: Rgb::BLACK, normalization: 0.0 }
    }

    /// With all scattering among its microfacets.
    pub fn compensated(fresnel: Fresnel, alpha: Vec2) -> Self {
        let mut conductor = Self::new(fresnel, alpha);
        if !conductor.ggx.is_smooth() {
            let lost = energy::mirror_lost_average(conductor.ggx);
            if lost > 0.0 {
                let normalization = FRAC_1_PI / lost;
                conductor.multiple = fresnel.average().map(|f| f * f * (1.0 - lost) / (1.0 - f * lost) * normalization);
                conductor.normalization = normalization;
            }
        }
        conductor
    }

    /// f |cos θi| of single scattering where Fresnel's share is 1.
    #[inline]
    pub(super) fn shape(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.ggx.mirror(wo, wi).value
    }

    /// Fresnel's share at normal incidence.
    #[inline]
    pub(super) fn color(&self) -> Rgb {
        self.fresnel.at(1.0)
    }

    /// Whether both alphas are the same.
    #[inline]
    pub(super) fn is_round(&self) -> bool {
        self.ggx.is_round()
    }

    /// Whether it is a perfect mirror's delta.
    #[inline]
    pub fn is_smooth(&self) -> bool {
        self.ggx.is_smooth()
    }

    /// Adds the lobe of what is scattered more than once to the value and the density of what is
    /// scattered once.
    fn with_multiple(&self, wo: Vec3, wi: Vec3, single: Rgb, density: f32) -> (Rgb, f32) {
        let more = self.lost(wo) * self.lost(wi) * wi.z;
        (single + self.multiple * more, density + self.normalization * more)
    }

    /// 1 - E.
    fn lost(&self, w: Vec3) -> f32 {
        energy::mirror_lost(self.ggx, w)
    }

    fn sample_compensated(&self, wo: Vec3, u: Vec2) -> Option<BsdfSample> {
        let mut random = Scramble::new(u, 0.0);
        // Take the direction with probability G2 / G1.
        let once = self.ggx.sample_mirror(wo, u).filter(|(_, facing)| random.unit() * facing.pdf < facing.value);
        let (wi, facing, scatter) = if let Some((wi, facing)) = once {
            (wi, facing, Scatter::Glossy)
        } else {
            let wi = energy::sample_mirror_lost(self.ggx, &mut random);
            (wi, self.ggx.mirror(wo, wi), Scatter::Diffuse)
        };
        let single = self.fresnel.at(facing.cos) * facing.value;
        let (value, pdf) = self.with_multiple(wo, wi, single, facing.value);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: value / pdf, pdf, scatter, ior: 1.0 })
    }

    fn mirrored(&self, wo: Vec3) -> BsdfSample {
        delta(Vec3::new(-wo.x, -wo.y, wo.z), self.fresnel.at(wo.z), 1.0)
    }

    /// Albedo of single scattering. On a stretched surface, the angles of visible microfacets depend on the slopes along `wo`: a
    /// round surface of these slopes gives the mean of Fresnel's share, a table of stretched surfaces the loss. That round
    /// surface is as rough across `wo` as along it; see [`Conductor::round_cosine`].
    fn single_albedo(&self, wo: Vec3) -> Rgb {
        let alpha = self.ggx.alpha_towards(wo);
        if self.ggx.is_round() {
            return self.fresnel.mirrored(wo.z, alpha);
        }
        let cos = self.round_cosine(wo, alpha);
        let round = self.fresnel.mirrored(cos, alpha);
        round * ((1.0 - self.lost(wo)) / (1.0 - energy::mirror_loss(cos, alpha)).max(f32::MIN_POSITIVE))
    }

    /// The cosine of the angle at which a round surface of this alpha reflects the share of light that this one reflects
    /// along `wo`: slopes across `wo` turn microfacets away from it, and the round surface has others. Fitted to integrals over
    /// visible normals for ratios of both alphas from 0.1 to 0.55 and indices from 1.1 to 2.4: the root mean square of the
    /// errors over all directions is 0.001 and the largest error 0.02, half of what they are without this.
    fn round_cosine(&self, wo: Vec3, alpha: f32) -> f32 {
        let cos = wo.z.min(1.0);
        let across = self.ggx.alpha_towards(Vec3::new(-wo.y, wo.x, wo.z));
        let tilt = |alpha: f32| cos + 0.5 * alpha * alpha * (1.0 - cos);
        cos * (tilt(alpha) / tilt(across)).sqrt()
    }
}

impl ScatteringLobe for Conductor {
    /// One alpha of its microfacets that stands for both.
    #[inline]
    fn mean_alpha(&self) -> f32 {
        self.ggx.mean_alpha()
    }

    /// f |cos θi|, and the density per steradian.
    #[inline]
    fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        if wo.z <= 0.0 || wi.z <= 0.0 || self.is_smooth() {
            return (Rgb::BLACK, 0.0);
        }
        let facing = self.ggx.mirror(wo, wi);
        let single = self.fresnel.at(facing.cos) * facing.value;
        if self.multiple.is_black() {
            return (single, facing.pdf);
        }
        self.with_multiple(wo, wi, single, facing.value)
    }

    /// A direction by visible normals, or as often as single scattering loses light by what it loses.
    #[inline]
    fn sample(&self, wo: Vec3, u: Vec2, _choice: f32) -> Option<BsdfSample> {
        if wo.z <= 0.0 {
            return None;
        }
        if self.is_smooth() {
            return Some(self.mirrored(wo));
        }
        if !self.multiple.is_black() {
            return self.sample_compensated(wo, u);
        }
        let (wi, facing) = self.ggx.sample_mirror(wo, u)?;
        let weight = self.fresnel.at(facing.cos) * (facing.value / facing.pdf);
        Some(BsdfSample { wi, weight, pdf: facing.pdf, scatter: Scatter::Glossy, ior: 1.0 })
    }

    /// What is mirrored once and, if compensated, more often.
    fn albedo(&self, wo: Vec3) -> Rgb {
        if wo.z <= 0.0 {
            return Rgb::BLACK;
        }
        let single = self.single_albedo(wo);
        if self.multiple.is_black() {
            return single;
        }
        let average = energy::mirror_lost_average(self.ggx);
        single + self.multiple * (self.lost(wo) * average * std::f32::consts::PI)
    }

    /// The mirror's, if it is smooth.
    fn deltas(&self, wo: Vec3) -> Deltas {
        let mut deltas = Deltas::new();
        if self.is_smooth() && wo.z > 0.0 {
            deltas.push(self.mirrored(wo));
        }
        deltas
    }

    #[inline]
    fn is_specular(&self) -> bool {
        self.is_smooth()
    }

    #[inline]
    fn is_stretched(&self) -> bool {
        !self.is_round()
    }
}
