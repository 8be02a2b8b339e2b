//! Lobes that light meets from below a surface only.
//!
//! A patchwork of glass and of what is opaque must scatter light inside the solid too: the opaque part is a lobe turned over.
//!
//! Layers over glass, of transmittance T(w), let only T of what the glass transmits upwards leave. The rest goes back below:
//!
//! - A pane that transmits f(wo, wi') returns f (1 - (T(wo') + T(wi')) / 2) along the mirror image of wi', with wo' that of wo. As
//!   f is the same both ways, energy is kept on average over directions, whatever T is.
//! - A polished solid (α up to 0.04) returns light as a mirror of its own roughness, whose microfacets reflect
//!   (1 - F) (1 - (T(o) + T(i)) / 2), with o and i refracted from wo and wi by the microfacet. Beyond the critical angle it returns
//!   nothing.
//! - A rough solid (α from 0.2) returns m̄ h(wo) h(wi) / π, as such mirrors would return more than microfacets let out. h is what
//!   polished glass transmits from below over its mean, mixed with 1 by exp(-2α), which fits rough glass of η from 1.2 to 2. By
//!   reciprocity the mean m̄ is that of (1 - T) t from above over η², with t the transmittance of the rough glass.
//!
//! Between these roughnesses a solid has a share of both.
//!
//! BSDF values keep energy on average over directions, but not for each direction. A solid sphere holds
//! totally reflected light for many bounces, and each bounce would multiply the error. Samples therefore
//! follow the light: a sample of the glass that goes up leaves with probability T, and otherwise becomes
//! a sample of the returning lobe. Samples of white glass thus carry a weight of 1, so a path keeps its
//! energy exactly from every direction. The density of a returned sample is the density that the BSDF
//! values of the returning lobe imply.

use super::{Bsdf, Weighted, mean};
use crate::ScatteringLobe;
use crate::energy::Scramble;
use crate::fresnel::reflect;
use crate::lobe::Deltas;
use crate::{BsdfSample, Conductor, Dielectric, Fresnel, Lambert, Lobe, Scatter};
use juggler_math::{Rgb, Vec2, Vec3, fun, warp};
use std::f32::consts::FRAC_1_PI;

/// What a lobe is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Role {
    /// A lobe as it is.
    Upright,
    /// An opaque lobe turned over: for light from below.
    Below,
    /// A pane that only transmits: it returns what layers keep of the light that the pane at this place among the lobes transmits.
    ReturnedByPane { glass: usize },
    /// A mirror turned over that returns what layers keep of the light that the solid glass at this place transmits.
    Returned {
        glass: usize,
        /// Share of the mirror; the rest is diffuse.
        polished: f32,
        /// What polished glass transmits from below on average over directions.
        transmittance: f32,
    },
}

impl Role {
    /// The place of the glass whose light a lobe returns.
    #[inline]
    pub(super) fn glass(&self) -> Option<usize> {
        match self {
            Self::ReturnedByPane { glass } | Self::Returned { glass, .. } => Some(*glass),
            Self::Upright | Self::Below => None,
        }
    }
}

/// Turned over.
#[inline]
fn turned(w: Vec3) -> Vec3 {
    Vec3::new(w.x, w.y, -w.z)
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

    /// Adds `weight` of a lobe that returns below the light that layers keep from leaving the glass. The
    /// glass is the lobe that was pushed last, and transmits light in this color.
    pub fn push_return(&mut self, color: Rgb, weight: f32) {
        let Some((glass, layers)) = self.lobes.split_last().filter(|(_, layers)| has_cover(layers)) else { return };
        let place = layers.len();
        let returned = match &glass.lobe {
            Lobe::ThinDielectric(pane) => Weighted {
                role: Role::ReturnedByPane { glass: place },
                ..Weighted::new(pane.tinted(Rgb::BLACK, color), weight)
            },
            Lobe::Dielectric(interface) => {
                let alpha = interface.mean_alpha();
                let polished = ((0.2 - alpha) / (0.2 - 0.04)).clamp(0.0, 1.0);
                let (polished, transmittance) = (polished * polished, interface.polished_transmittance_below());
                let kept = |w: Vec3| (1.0 - left_by(layers, w)) * interface.parts(w)[1];
                let is_smooth = interface.is_smooth();
                let scale = if is_smooth { 0.0 } else { mean(!interface.is_round(), kept) * interface.shrunk_below() };
                let role = Role::Returned { glass: place, polished, transmittance };
                let mirror = Conductor::new(Fresnel::Schlick { f0: color, f90: color }, interface.alpha());
                Weighted { role, scale, spread: 1.0 - fun::exp(-2.0 * alpha), ..Weighted::new(mirror, weight) }
            }
            _ => return,
        };
        self.push_any(returned);
    }

    /// The lobe that returns what layers keep of the light that the glass at this place transmits.
    #[inline]
    pub(super) fn returning(&self, glass: usize) -> Option<&Weighted> {
        self.lobes.get(glass + 1).filter(|one| one.role.glass().is_some())
    }

    /// The interface at a place among the lobes.
    fn interface(&self, glass: usize) -> Option<&Dielectric> {
        let lobe = self.lobes.get(glass).map(|one| &one.lobe);
        if let Some(Lobe::Dielectric(interface)) = lobe { Some(interface) } else { None }
    }

    /// h(μ): what glass transmits of light from below at an angle of this cosine, over its mean.
    fn transmitted(&self, one: &Weighted, cos: f32) -> f32 {
        let Role::Returned { glass, transmittance, .. } = one.role else { return 0.0 };
        let polished = self.interface(glass).map_or(0.0, |interface| interface.polished_share_below(cos));
        one.spread + (1.0 - one.spread) * polished / transmittance
    }

    /// The mean of what the layers over glass keep of light that leaves it along `a` and `b`.
    fn kept(&self, glass: usize, a: Vec3, b: Vec3) -> f32 {
        let layers = self.lobes.get(..glass).unwrap_or_default();
        1.0 - 0.5 * (left_by(layers, a) + left_by(layers, b))
    }

    /// The share of the light that a microfacet mirrors from `wo` into `wi`, both turned over, which a returning mirror reflects.
    fn returned_once(&self, glass: usize, wo: Vec3, wi: Vec3) -> f32 {
        let leaving = |interface: &Dielectric| interface.leaving([wo, wi], (wo + wi).normalize_or_zero());
        let Some((share, [a, b])) = self.interface(glass).and_then(leaving) else { return 0.0 };
        share * self.kept(glass, turned(a), turned(b))
    }

    /// f |cos θi| of what layers over a solid return below, and the density of samples of the glass that become it.
    fn eval_pdf_of_returned(&self, one: &Weighted, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        let (Role::Returned { glass, polished, .. }, Lobe::Conductor(mirror)) = (one.role, &one.lobe) else {
            return (Rgb::BLACK, 0.0);
        };
        if wo.z >= 0.0 || wi.z >= 0.0 || mirror.is_smooth() {
            return (Rgb::BLACK, 0.0);
        }
        let (o, i) = (turned(wo), turned(wi));
        let mut density = 0.0;
        if polished > 0.0 {
            density += polished * mirror.shape(o, i) * self.returned_once(glass, o, i);
        }
        if polished < 1.0 {
            let h = self.transmitted(one, o.z) * self.transmitted(one, i.z);
            density += (1.0 - polished) * one.scale * h * i.z * FRAC_1_PI;
        }
        (mirror.color() * density, density)
    }

    /// A sample of the glass at a place among the lobes, for light from below, which may return below because of layers; its
    /// weight and density, if it is no delta, are to be found by evaluation.
    pub(super) fn sample_under_layers(
        &self,
        glass: usize,
        returning: &Weighted,
        wo: Vec3,
        u: Vec2,
        choice: f32,
    ) -> Option<BsdfSample> {
        let sample = self.lobes.get(glass)?.lobe.sample(wo, u, choice)?;
        if sample.wi.z <= 0.0 {
            return Some(sample);
        }
        let left = left_by(self.lobes.get(..glass)?, sample.wi);
        if sample.scatter == Scatter::Specular {
            if u.y < left {
                return Some(BsdfSample { weight: sample.weight / left, pdf: sample.pdf * left, ..sample });
            }
            let weight = sample.weight * (sample.ior * sample.ior);
            let wi = Vec3::new(-wo.x, -wo.y, wo.z);
            return Some(BsdfSample {
                wi,
                weight,
                pdf: sample.pdf * (1.0 - left),
                scatter: Scatter::Specular,
                ior: 1.0,
            });
        }
        let mut random = Scramble::new(Vec2::new(u.y, u.x), choice);
        if random.unit() < left {
            return Some(sample);
        }
        let (wi, scatter) = self.return_direction(returning, wo, &sample, &mut random);
        Some(BsdfSample { wi, scatter, ior: 1.0, ..sample })
    }

    /// Where a sample that layers keep from leaving goes.
    fn return_direction(
        &self,
        returning: &Weighted,
        wo: Vec3,
        sample: &BsdfSample,
        random: &mut Scramble,
    ) -> (Vec3, Scatter) {
        let Role::Returned { polished, .. } = returning.role else { return (turned(sample.wi), sample.scatter) };
        if sample.scatter == Scatter::Glossy && random.unit() < polished {
            // By the microfacet that refracted it.
            let m = (wo + sample.wi * sample.ior).normalize_or_zero();
            let wi = reflect(wo, m);
            if wi.z < 0.0 && m != Vec3::ZERO {
                return (wi, Scatter::Glossy);
            }
        }
        // In proportion to h(μ) μ.
        let most = self.transmitted(returning, 1.0);
        let mut wi = Vec3::NEG_Z;
        for _ in 0..64 {
            wi = turned(warp::cosine_hemisphere(Vec2::new(random.unit(), random.unit())));
            if random.unit() * most < self.transmitted(returning, -wi.z) {
                break;
            }
        }
        (wi, Scatter::Diffuse)
    }

    /// What a pane returns along the mirror images of directions below.
    fn kept_by_pane(&self, glass: usize, wo: Vec3, wi: Vec3) -> f32 {
        if wo.z < 0.0 && wi.z < 0.0 { self.kept(glass, turned(wo), turned(wi)) } else { 0.0 }
    }

    /// [`Lobe::eval_pdf`] in its role.
    #[inline]
    pub(super) fn eval_pdf_of_one(&self, one: &Weighted, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        match one.role {
            Role::Upright => one.lobe.eval_pdf(wo, wi),
            Role::Below => one.lobe.eval_pdf(turned(wo), turned(wi)),
            Role::ReturnedByPane { glass } => {
                let share = self.kept_by_pane(glass, wo, wi);
                let through =
                    self.lobes.get(glass).filter(|_| share > 0.0).map(|pane| pane.lobe.eval_pdf(wo, turned(wi)));
                through.map_or((Rgb::BLACK, 0.0), |(value, pdf)| (value * share, pdf * share))
            }
            Role::Returned { .. } => self.eval_pdf_of_returned(one, wo, wi),
        }
    }

    /// [`Lobe::sample`] in its role.
    #[inline]
    pub(super) fn sample_of_one(&self, one: &Weighted, wo: Vec3, u: Vec2, choice: f32) -> Option<BsdfSample> {
        match one.role {
            Role::Upright => one.lobe.sample(wo, u, choice),
            Role::Below => one.lobe.sample(turned(wo), u, choice).map(turned_back),
            // `sample_under_layers` turns samples of the glass into samples of this lobe.
            Role::ReturnedByPane { .. } | Role::Returned { .. } => None,
        }
    }

    /// [`Lobe::deltas`] in its role.
    pub(super) fn deltas_of_one(&self, one: &Weighted, wo: Vec3) -> Deltas {
        match one.role {
            Role::Upright => one.lobe.deltas(wo),
            Role::Below => one.lobe.deltas(turned(wo)).into_iter().map(turned_back).collect(),
            _ if wo.z >= 0.0 => Deltas::new(),
            Role::ReturnedByPane { glass } => {
                let kept = |delta: BsdfSample| self.kept_by_pane(glass, wo, delta.wi);
                let deltas = one.lobe.deltas(turned(wo)).into_iter();
                deltas.map(|delta| BsdfSample { weight: delta.weight * kept(delta), ..delta }).collect()
            }
            Role::Returned { glass, .. } => {
                let share = |delta: &BsdfSample| self.returned_once(glass, turned(wo), delta.wi);
                let deltas = one.lobe.deltas(turned(wo)).into_iter();
                deltas.map(|delta| turned_back(BsdfSample { weight: delta.weight * share(&delta), ..delta })).collect()
            }
        }
    }

    /// [`Lobe::albedo`] in its role; that of glass from below counts what is returned.
    pub(super) fn albedo_of_one(&self, one: &Weighted, wo: Vec3) -> Rgb {
        match one.role {
            Role::Upright => one.lobe.albedo(wo),
            _ if wo.z >= 0.0 => Rgb::BLACK,
            Role::Below => one.lobe.albedo(turned(wo)),
            Role::ReturnedByPane { .. } | Role::Returned { .. } => Rgb::BLACK,
        }
    }
}

/// A sample of a lobe that is turned over.
fn turned_back(sample: BsdfSample) -> BsdfSample {
    BsdfSample { wi: turned(sample.wi), ..sample }
}

fn has_cover(layers: &[Weighted]) -> bool {
    layers.iter().any(|one| one.cover > 0.0)
}

/// What layers leave of light along `w`.
#[inline]
fn left_by(layers: &[Weighted], w: Vec3) -> f32 {
    layers.iter().fold(1.0, |left, one| left * one.leaves(w))
}
