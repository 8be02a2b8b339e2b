//! Lobes that light meets from below a surface only.
//!
//! A patchwork of glass and of what is opaque must scatter light inside the solid too: the opaque part is a lobe turned over.
//!
//! Layers over glass, of transmittance T(μ), let only T of what the glass transmits from below leave: the rest is reflected
//! back. Polished glass of transmittance 1 - F returns m(μ) = (1 - F(μ)) (1 - T(μt)), with μt the cosine of the refracted
//! direction, as a mirror does. Rough glass returns it as a mirror of the same roughness with all scattering among its
//! microfacets. By reciprocity the mean m̄ of what is to return is the mean of (1 - T) t from above over η², with t the
//! transmittance of the rough glass. The mirror's share at an angle θ of incidence goes from m(cos θ), with polished glass, to
//! m̄, once microfacets turn to all sides. So energy is kept on average over directions, and exactly for each direction where the
//! glass is polished.

use super::{Bsdf, Weighted, mean};
use crate::bsdf::ggx::Ggx;
use crate::bsdf::lobe::Deltas;
use crate::bsdf::{BsdfSample, Conductor, Fresnel, Lambert, Lobe};
use juggler_math::{Rgb, Vec2, Vec3};

/// What a lobe is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// A lobe as it is.
    Upright,
    /// An opaque lobe turned over: for light from below.
    Below,
    /// A mirror turned over that returns what layers keep of the light that the lobe before it transmits.
    Returned,
}

/// Turned over.
#[inline]
fn turned(w: Vec3) -> Vec3 {
    Vec3::new(w.x, w.y, -w.z)
}

/// A direction above of this cosine.
#[inline]
fn above(cos: f32) -> Vec3 {
    Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos)
}

impl Bsdf {
    /// Adds `weight` of an opaque lobe that light from below meets; layers do not dim it.
    pub fn push_below(&mut self, lobe: impl Into<Lobe>, weight: f32) {
        self.push_any(Weighted { role: Role::Below, ..Weighted::new(lobe, weight) });
    }

    /// Adds `weight` of what goes back below because layers over a matt lobe that transmits this much keep it from leaving.
    pub fn push_matt_return(&mut self, transmittance: Rgb, weight: f32) {
        let kept = 1.0 - self.mean_left();
        if kept > 0.0 {
            self.push_below(Lambert { albedo: transmittance * kept }, weight);
        }
    }

    /// Adds `weight` of what goes back below because layers over the lobe that was pushed last, which transmits light in this
    /// color, keep it from leaving.
    pub fn push_return(&mut self, color: Rgb, alpha: Vec2, weight: f32) {
        let Some((glass, layers)) = self.lobes.split_last().filter(|(_, layers)| has_cover(layers)) else { return };
        let ggx = Ggx::new(alpha);
        let scale = if ggx.is_smooth() {
            0.0
        } else {
            mean(|w| (1.0 - left_by(layers, w)) * glass.lobe.transmitted(w)) * glass.lobe.shrunk_below()
        };
        let spread = (1.0 - ggx.mean_alpha() / 0.25).max(0.0);
        let spread = 1.0 - spread * spread * spread * spread;
        let mirror = Conductor::compensated(Fresnel::Schlick { f0: color, f90: color }, alpha);
        self.push_any(Weighted { scale, spread, role: Role::Returned, ..Weighted::new(mirror, weight) });
    }

    /// The share of light that meets microfacets from below at this cosine which a returning lobe reflects.
    fn returned(&self, index: usize, one: &Weighted, cos: f32) -> f32 {
        let Some((glass, layers)) = self.lobes.get(..index).and_then(|before| before.split_last()) else { return 0.0 };
        let (share, out) = glass.lobe.leaving(cos);
        let polished =
            if share <= 0.0 || one.spread >= 1.0 { 0.0 } else { share * (1.0 - left_by(layers, above(out))) };
        polished + (one.scale - polished) * one.spread
    }

    /// [`Lobe::eval_pdf`] in its role.
    #[inline]
    pub(super) fn eval_pdf_of_one(&self, index: usize, one: &Weighted, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        match one.role {
            Role::Upright => one.lobe.eval_pdf(wo, wi),
            Role::Below => one.lobe.eval_pdf(turned(wo), turned(wi)),
            Role::Returned => {
                let (value, pdf) = one.lobe.eval_pdf(turned(wo), turned(wi));
                if pdf <= 0.0 {
                    return (Rgb::BLACK, 0.0);
                }
                (value * self.returned(index, one, 0.5 * (wo + wi).length()), pdf)
            }
        }
    }

    /// [`Lobe::sample`] in its role.
    #[inline]
    pub(super) fn sample_of_one(
        &self,
        index: usize,
        one: &Weighted,
        wo: Vec3,
        u: Vec2,
        choice: f32,
    ) -> Option<BsdfSample> {
        if one.role == Role::Upright {
            return one.lobe.sample(wo, u, choice);
        }
        let sample = one.lobe.sample(turned(wo), u, choice)?;
        Some(self.turned_back(index, one, wo, sample))
    }

    fn turned_back(&self, index: usize, one: &Weighted, wo: Vec3, sample: BsdfSample) -> BsdfSample {
        let wi = turned(sample.wi);
        let share = if one.role == Role::Returned { self.returned(index, one, 0.5 * (wo + wi).length()) } else { 1.0 };
        BsdfSample { wi, weight: sample.weight * share, ..sample }
    }

    /// [`Lobe::deltas`] in its role.
    pub(super) fn deltas_of_one(&self, index: usize, one: &Weighted, wo: Vec3) -> Deltas {
        if one.role == Role::Upright {
            return one.lobe.deltas(wo);
        }
        one.lobe.deltas(turned(wo)).into_iter().map(|delta| self.turned_back(index, one, wo, delta)).collect()
    }

    /// [`Lobe::albedo`] in its role.
    pub(super) fn albedo_of_one(&self, index: usize, one: &Weighted, wo: Vec3) -> Rgb {
        match one.role {
            Role::Upright => one.lobe.albedo(wo),
            _ if wo.z >= 0.0 => Rgb::BLACK,
            Role::Below => one.lobe.albedo(turned(wo)),
            Role::Returned => {
                let share = self.returned(index, one, -wo.z);
                // Microfacets may be tilted to where more returns.
                let least = if one.lobe.is_specular() { 0.0 } else { 0.3 * self.returned(index, one, 1.0) };
                one.lobe.albedo(turned(wo)) * share.max(least)
            }
        }
    }
}

fn has_cover(layers: &[Weighted]) -> bool {
    layers.iter().any(|one| one.cover > 0.0)
}

/// What layers leave of light along `w`.
#[inline]
fn left_by(layers: &[Weighted], w: Vec3) -> f32 {
    layers.iter().fold(1.0, |left, one| left * one.leaves(w))
}
