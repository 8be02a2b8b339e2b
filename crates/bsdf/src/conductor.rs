//! Conductor, smooth or rough: microfacets of Torrance and Sparrow (1967) with [GGX](super::ggx)
//! normals.
//!
//! Single scattering loses light that is reflected more than once between microfacets.
//! [`Conductor::compensated`] adds it, which makes a perfect mirror white at any roughness. With E
//! the albedo of single scattering at a perfect mirror, Ē its mean and F the mean Fresnel
//! reflectance, every further bounce on average reflects B = F Ē / (1 - F (1 - Ē)) of the light
//! that single scattering loses. Where this light leaves depends on the microfacets:
//!
//! - isotropic ones: as one more lobe, f = m (1 - E(μo)) (1 - E(μi)) with m = F B / (π (1 - Ē))
//!   (Kulla and Conty 2017), which is reciprocal and nearly diffuse;
//! - anisotropic ones, which at roughness 1 along one axis lose half of the light: along the
//!   directions of single scattering, whose lobe is scaled by 1 + B (1 - E(wo)) / E(wo) (Turquin
//!   2019, with B for his F0, which leaves out the absorption of further bounces). The highlight
//!   keeps its shape, and there is no light across the grooves. The scaled lobe is not reciprocal.
//!
//! In between, both are blended by the ratio of the alphas: see `Conductor::scaled_fraction`.
//!
//! Sampling then follows the light, as that of a rough [`Dielectric`](super::Dielectric) does: the
//! direction that a visible normal reflects is accepted with probability G2 / G1. Otherwise, which
//! happens with probability 1 - E(wo), a direction is sampled in proportion to (1 - E(wi)) μi, or
//! visible normals are sampled until one is accepted. Samples of a perfect mirror have a weight of
//! 1 whatever the error of the tables of E: light that hits metal many times, as inside a solid
//! that is part metal and part glass, neither gains nor loses energy.

use super::energy::{self, SampleRng};
use super::ggx::{Ggx, MicrofacetReflection};
use super::lanes::lanes;
use super::lobe::{Deltas, delta};
use super::{BsdfSample, Fresnel, Scatter};
use crate::ScatteringLobe;
use crate::quadrature::{self, Azimuth, NODES};
use juggler_math::{Rgb, Vec2, Vec3};
use std::f32::consts::{FRAC_1_PI, PI};

/// Conductor lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor {
    ggx: Ggx,
    fresnel: Fresnel,
    /// m, see above; black without compensation.
    multiple: Rgb,
    /// m of a perfect mirror, 1 / (π (1 - Ē)), which normalizes (1 - E(wi)) μi to a density.
    normalization: f32,
    /// 1 - Ē; 0 without compensation.
    mean_loss: f32,
    /// B, see above; black without compensation.
    bounced: Rgb,
}

/// Ratio of the alphas at and below which light of further bounces leaves along the directions of
/// single scattering alone.
const BRUSHED: f32 = 0.5;
/// Maximum number of visible normals sampled for light of further bounces. More than three in ten
/// are accepted at any angle and roughness, so that fewer than one in 10⁹ samples needs more.
const MAX_TRIES: u32 = 64;

impl Conductor {
    /// Conductor with single scattering only. `alpha` as in [`Ggx`]: the square of a material's
    /// roughness along x and y.
    #[inline]
    pub fn new(fresnel: Fresnel, alpha: Vec2) -> Self {
        let (multiple, bounced) = (Rgb::BLACK, Rgb::BLACK);
        Self { ggx: Ggx::new(alpha), fresnel, multiple, normalization: 0.0, mean_loss: 0.0, bounced }
    }

    /// Conductor with multiple scattering between microfacets.
    pub fn compensated(fresnel: Fresnel, alpha: Vec2) -> Self {
        let mut conductor = Self::new(fresnel, alpha);
        if !conductor.ggx.is_smooth() {
            let mean_loss = energy::mean_mirror_loss(conductor.ggx);
            if mean_loss > 0.0 {
                let normalization = FRAC_1_PI / mean_loss;
                let mean_reflectance = fresnel.mean_reflectance();
                conductor.multiple =
                    mean_reflectance.map(|f| f * f * (1.0 - mean_loss) / (1.0 - f * mean_loss) * normalization);
                conductor.bounced = mean_reflectance.map(|f| f * (1.0 - mean_loss) / (1.0 - f * mean_loss));
                (conductor.normalization, conductor.mean_loss) = (normalization, mean_loss);
            }
        }
        conductor
    }

    /// f |cos θi| of single scattering for a Fresnel reflectance of 1.
    #[inline]
    pub(super) fn single_scattering_shape(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.ggx.eval_reflection(wo, wi).value
    }

    /// Fresnel reflectance at normal incidence.
    #[inline]
    pub(super) fn f0(&self) -> Rgb {
        self.fresnel.reflectance(1.0)
    }

    /// Whether the microfacets are isotropic.
    #[inline]
    pub(super) fn is_isotropic(&self) -> bool {
        self.ggx.is_isotropic()
    }

    /// Whether the lobe is a delta.
    #[inline]
    pub fn is_smooth(&self) -> bool {
        self.ggx.is_smooth()
    }

    /// Fraction of the light of further bounces that leaves along the directions of single
    /// scattering: 0 on isotropic surfaces, 1 where one alpha is half of the other or less, and
    /// smooth in between.
    #[inline]
    fn scaled_fraction(&self) -> f32 {
        let t = ((1.0 - self.ggx.alpha_ratio()) * (1.0 / (1.0 - BRUSHED))).min(1.0);
        t * t * (3.0 - 2.0 * t)
    }

    /// Adds multiple scattering to the value and the density of single scattering.
    fn with_multiple(&self, wo: Vec3, wi: Vec3, single: Rgb, density: f32) -> (Rgb, f32) {
        if self.is_isotropic() {
            let [loss, other] = energy::isotropic_mirror_losses([wo.z, wi.z], self.ggx.mean_alpha());
            let more = loss * other * wi.z;
            return (single + self.multiple * more, density + self.normalization * more);
        }
        let (loss, scaled) = (self.energy_loss(wo), self.scaled_fraction());
        let more = scaled * loss / (1.0 - loss);
        let (mut value, mut pdf) = (single + single * self.bounced * more, density + density * more);
        if scaled < 1.0 {
            let more = (1.0 - scaled) * loss * self.energy_loss(wi) * wi.z;
            (value, pdf) = (value + self.multiple * more, pdf + self.normalization * more);
        }
        (value, pdf)
    }

    /// 1 - E(w): fraction of light along `w` that single scattering loses.
    #[inline]
    fn energy_loss(&self, w: Vec3) -> f32 {
        energy::mirror_loss(self.ggx, w)
    }

    /// Reflects `wo` at a visible normal, with probability G2 / G1.
    fn sample_once(&self, wo: Vec3, u: Vec2, random: &mut SampleRng) -> Option<(Vec3, MicrofacetReflection)> {
        let found = self.ggx.sample_reflection(wo, u);
        found.filter(|(_, microfacet)| random.unit() * microfacet.pdf < microfacet.value)
    }

    /// Samples single scattering until it is accepted.
    fn sample_again(&self, wo: Vec3, random: &mut SampleRng) -> Option<(Vec3, MicrofacetReflection)> {
        (0..MAX_TRIES).find_map(|_| {
            let u = Vec2::new(random.unit(), random.unit());
            self.sample_once(wo, u, random)
        })
    }

    fn sample_compensated(&self, wo: Vec3, u: Vec2) -> Option<BsdfSample> {
        let mut random = SampleRng::new(u, 0.0);
        let once = self.sample_once(wo, u, &mut random).or_else(|| {
            let scaled = self.scaled_fraction();
            let is_scaled = scaled > 0.0 && random.unit() < scaled;
            if is_scaled { self.sample_again(wo, &mut random) } else { None }
        });
        let (wi, microfacet, scatter) = if let Some((wi, microfacet)) = once {
            (wi, microfacet, Scatter::Glossy)
        } else {
            let wi = energy::sample_mirror_loss(self.ggx, &mut random);
            (wi, self.ggx.eval_reflection(wo, wi), Scatter::Diffuse)
        };
        let single = self.fresnel.reflectance(microfacet.cos) * microfacet.value;
        let (value, pdf) = self.with_multiple(wo, wi, single, microfacet.value);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: value / pdf, pdf, scatter, ior: 1.0 })
    }

    fn mirror_delta(&self, wo: Vec3) -> BsdfSample {
        delta(Vec3::new(-wo.x, -wo.y, wo.z), self.fresnel.reflectance(wo.z), 1.0)
    }

    /// Albedos at several cosines above 0 on a rough isotropic surface, by channel.
    #[inline(always)]
    fn isotropic_albedos<const N: usize>(&self, cos: [f32; N]) -> [[f32; N]; 3] {
        let alpha = self.ggx.mean_alpha();
        let losses = energy::isotropic_mirror_losses(cos, alpha);
        let single = self.fresnel.rough_albedos(cos, alpha, losses);
        if self.multiple.is_black() {
            return single;
        }
        let all = |single: &[f32; N], multiple: f32| {
            lanes(|lane| single[lane] + multiple * (losses[lane] * self.mean_loss * PI))
        };
        let ([r, g, b], multiple) = (&single, self.multiple);
        [all(r, multiple.r), all(g, multiple.g), all(b, multiple.b)]
    }

    /// Albedo of single scattering on an anisotropic surface. The angles at visible microfacets
    /// depend on the slopes along `wo`: an isotropic surface of these slopes gives the mean Fresnel
    /// reflectance, a table of anisotropic surfaces the loss. That isotropic surface is as rough
    /// across `wo` as along it; see [`Conductor::isotropic_cosine`]. `lost` is the energy loss along
    /// `wo`.
    fn anisotropic_albedo(&self, wo: Vec3, lost: f32) -> Rgb {
        let alpha = self.ggx.alpha_towards(wo);
        let cos = self.isotropic_cosine(wo, alpha);
        let isotropic_loss = energy::isotropic_mirror_loss(cos, alpha);
        let isotropic = self.fresnel.rough_albedo(cos, alpha, isotropic_loss);
        isotropic * ((1.0 - lost) / (1.0 - isotropic_loss).max(f32::MIN_POSITIVE))
    }

    /// Cosine of the angle at which an isotropic surface of this alpha has the reflectance of this
    /// one along `wo`: slopes across `wo` tilt microfacets away from it, and the isotropic surface
    /// has others. Fitted to integrals over visible normals for ratios of both alphas from 0.1 to
    /// 0.55 and indices from 1.1 to 2.4: the root mean square error over all directions is 0.001
    /// and the largest error 0.02, half of the errors without this.
    fn isotropic_cosine(&self, wo: Vec3, alpha: f32) -> f32 {
        let cos = wo.z.min(1.0);
        let across = self.ggx.alpha_towards(Vec3::new(-wo.y, wo.x, wo.z));
        let tilt = |alpha: f32| cos + 0.5 * alpha * alpha * (1.0 - cos);
        cos * (tilt(alpha) / tilt(across)).sqrt()
    }
}

impl ScatteringLobe for Conductor {
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
        let microfacet = self.ggx.eval_reflection(wo, wi);
        let single = self.fresnel.reflectance(microfacet.cos) * microfacet.value;
        if self.multiple.is_black() {
            return (single, microfacet.pdf);
        }
        self.with_multiple(wo, wi, single, microfacet.value)
    }

    /// Samples visible normals or, with the probability that single scattering loses the light,
    /// multiple scattering.
    #[inline]
    fn sample(&self, wo: Vec3, u: Vec2, _u_choice: f32) -> Option<BsdfSample> {
        if wo.z <= 0.0 {
            return None;
        }
        if self.is_smooth() {
            return Some(self.mirror_delta(wo));
        }
        if !self.multiple.is_black() {
            return self.sample_compensated(wo, u);
        }
        let (wi, microfacet) = self.ggx.sample_reflection(wo, u)?;
        let weight = self.fresnel.reflectance(microfacet.cos) * (microfacet.value / microfacet.pdf);
        Some(BsdfSample { wi, weight, pdf: microfacet.pdf, scatter: Scatter::Glossy, ior: 1.0 })
    }

    /// Albedo of single and, if compensated, multiple scattering.
    fn albedo(&self, wo: Vec3) -> Rgb {
        if wo.z <= 0.0 {
            return Rgb::BLACK;
        }
        if self.is_smooth() {
            return self.fresnel.reflectance(wo.z);
        }
        if self.is_isotropic() {
            let [[r], [g], [b]] = self.isotropic_albedos([wo.z]);
            return Rgb::new(r, g, b);
        }
        let loss = self.energy_loss(wo);
        let single = self.anisotropic_albedo(wo, loss);
        if self.multiple.is_black() {
            return single;
        }
        let scaled = self.scaled_fraction();
        let apart = self.multiple * (loss * self.mean_loss * PI);
        single + single * self.bounced * (scaled * loss / (1.0 - loss)) + apart * (1.0 - scaled)
    }

    fn max_albedos(&self, azimuth: Azimuth) -> [f32; NODES] {
        if self.is_smooth() || !self.is_isotropic() {
            return azimuth.directions().map(|w| self.albedo(w).max_channel());
        }
        let [r, g, b] = self.isotropic_albedos(quadrature::cosines());
        lanes(|node| r[node].max(g[node]).max(b[node]))
    }

    /// Mirror reflection, if smooth.
    fn deltas(&self, wo: Vec3) -> Deltas {
        let mut deltas = Deltas::new();
        if self.is_smooth() && wo.z > 0.0 {
            deltas.push(self.mirror_delta(wo));
        }
        deltas
    }

    #[inline]
    fn is_specular(&self) -> bool {
        self.is_smooth()
    }

    #[inline]
    fn is_anisotropic(&self) -> bool {
        !self.is_isotropic()
    }
}
