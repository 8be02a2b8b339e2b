//! Lobes for light from below a surface.
//!
//! A mix of glass and opaque lobes must scatter light inside the solid too: the opaque lobe is
//! added again, flipped.
//!
//! Layers over glass, of transmittance T(w), let only T of the light leave that the glass transmits
//! upwards. The rest goes back below:
//!
//! - A pane that transmits f(wo, wi') returns f (1 - (T(wo') + T(wi')) / 2) along the mirror image
//!   of wi', with wo' that of wo. As f is reciprocal, energy is conserved on average over
//!   directions, whatever T is.
//! - A polished solid (α up to 0.04) returns light as a mirror of its own roughness, whose
//!   microfacets reflect (1 - F) (1 - (T(o) + T(i)) / 2), with o and i the directions into which
//!   the microfacet refracts wo and wi. Beyond the critical angle it returns nothing.
//! - A rough solid (α from 0.2) returns m̄ h(wo) h(wi) / π, as such mirrors would return more than
//!   microfacets transmit. h is the transmittance of polished glass from below over its mean, mixed
//!   with 1 by exp(-2α), which fits rough glass of η from 1.2 to 2. By reciprocity, the mean m̄ is
//!   that of (1 - T) t from above over η², with t the transmittance of the rough glass.
//!
//! Between these roughnesses, a solid combines both.
//!
//! BSDF values conserve energy on average over directions, but not for each direction. A solid
//! sphere holds totally reflected light for many bounces, and each bounce would multiply the error.
//! Samples therefore follow the light: a sample of the glass that goes up leaves with probability
//! T, and otherwise becomes a sample of the returning lobe. Samples of white glass thus have a
//! weight of 1, so a path keeps its energy exactly from every direction. The density of a returned
//! sample is the density that the BSDF values of the returning lobe imply.

use super::{Bsdf, WeightedLobe, layer_transmittances};
use crate::ScatteringLobe;
use crate::energy::SampleRng;
use crate::fresnel::reflect;
use crate::lanes::lanes;
use crate::lobe::Deltas;
use crate::quadrature::{self, Azimuth};
use crate::{BsdfSample, Conductor, Dielectric, Fresnel, Lambert, Lobe, Scatter};
use juggler_math::{Rgb, Vec2, Vec3, portable, warp};
use std::f32::consts::FRAC_1_PI;

/// Role of a lobe in a [`Bsdf`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Role {
    /// Unmodified lobe.
    Upright,
    /// Opaque lobe, flipped for light from below.
    Below,
    /// Pane that only transmits: it returns the light that layers keep from leaving the pane at
    /// index `glass`.
    PaneReturn { glass: u8 },
    /// Flipped mirror that returns the light that layers keep from leaving the solid glass at index
    /// `glass`.
    SolidReturn {
        glass: u8,
        /// Weight of the mirror; the rest is diffuse.
        polished: f32,
        /// Cosine-weighted mean transmittance of polished glass from below.
        transmittance: f32,
    },
}

impl Role {
    /// Index of the glass whose light the lobe returns.
    #[inline]
    pub(super) fn glass(&self) -> Option<usize> {
        match self {
            Self::PaneReturn { glass } | Self::SolidReturn { glass, .. } => Some(usize::from(*glass)),
            Self::Upright | Self::Below => None,
        }
    }
}

/// Flips a direction to the other side of the surface.
#[inline]
fn flip(w: Vec3) -> Vec3 {
    Vec3::new(w.x, w.y, -w.z)
}

impl Bsdf {
    /// Adds an opaque lobe with `weight` for light from below; layers do not attenuate it.
    pub fn push_below(&mut self, lobe: impl Into<Lobe>, weight: f32) {
        self.push_any(WeightedLobe { role: Role::Below, ..WeightedLobe::new(lobe, weight) });
    }

    /// Adds with `weight` the light that layers over a diffuse lobe of this transmittance return
    /// below.
    pub fn push_diffuse_return(&mut self, transmittance: Rgb, weight: f32) {
        let blocked = 1.0 - self.mean_transmittance();
        if blocked > 0.0 {
            self.push_below(Lambert { albedo: transmittance * blocked }, weight);
        }
    }

    /// Adds a lobe with `weight` that returns below the light that layers keep from leaving the
    /// glass. The glass is the lobe that was pushed last, and transmits light of this color.
    pub fn push_return(&mut self, color: Rgb, weight: f32) {
        let Some((glass, layers)) = self.lobes.split_last().filter(|(_, layers)| has_cover(layers)) else { return };
        let index = layers.len();
        let returned = match &glass.lobe {
            Lobe::ThinDielectric(pane) => WeightedLobe {
                role: Role::PaneReturn { glass: index as u8 },
                ..WeightedLobe::new(pane.tinted(Rgb::BLACK, color), weight)
            },
            Lobe::Dielectric(interface) => {
                let alpha = interface.mean_alpha();
                let polished = ((0.2 - alpha) / (0.2 - 0.04)).clamp(0.0, 1.0);
                let (polished, transmittance) = (polished * polished, interface.mean_smooth_transmittance_below());
                let scale = if interface.is_smooth() { 0.0 } else { mean_blocked_transmittance(layers, interface) };
                let role = Role::SolidReturn { glass: index as u8, polished, transmittance };
                let mirror = Conductor::new(Fresnel::Schlick { f0: color, f90: color }, interface.alpha());
                WeightedLobe {
                    role,
                    scale,
                    diffuse_fraction: 1.0 - portable::exp(-2.0 * alpha),
                    ..WeightedLobe::new(mirror, weight)
                }
            }
            _ => return,
        };
        self.push_any(returned);
    }

    /// The lobe that returns the light that layers keep from leaving the glass at this index.
    #[inline]
    pub(super) fn returning(&self, glass: usize) -> Option<&WeightedLobe> {
        self.lobes.get(glass + 1).filter(|one| one.role.glass().is_some())
    }

    /// The dielectric at an index among the lobes, if it is one.
    fn interface(&self, glass: usize) -> Option<&Dielectric> {
        let lobe = self.lobes.get(glass).map(|one| &one.lobe);
        if let Some(Lobe::Dielectric(interface)) = lobe { Some(interface) } else { None }
    }

    /// h(μ): transmittance of the glass from below at an angle of this cosine, over its mean.
    fn relative_transmittance(&self, one: &WeightedLobe, cos: f32) -> f32 {
        let Role::SolidReturn { glass, transmittance, .. } = one.role else { return 0.0 };
        let polished =
            self.interface(usize::from(glass)).map_or(0.0, |interface| interface.smooth_transmittance_below(cos));
        one.diffuse_fraction + (1.0 - one.diffuse_fraction) * polished / transmittance
    }

    /// Mean fraction of light along `a` and `b` that the layers over the glass block.
    fn blocked_fraction(&self, glass: usize, a: Vec3, b: Vec3) -> f32 {
        let layers = self.lobes.get(..glass).unwrap_or_default();
        1.0 - 0.5 * (layer_transmittance(layers, a) + layer_transmittance(layers, b))
    }

    /// Reflectance of a returning mirror's microfacet from `wo` into `wi`, both flipped.
    fn return_reflectance(&self, glass: usize, wo: Vec3, wi: Vec3) -> f32 {
        let refracted = |interface: &Dielectric| interface.refract_pair([wo, wi], (wo + wi).normalize_or_zero());
        let Some((transmittance, [a, b])) = self.interface(glass).and_then(refracted) else { return 0.0 };
        transmittance * self.blocked_fraction(glass, flip(a), flip(b))
    }

    /// f |cos θi| of light that layers over a solid return below, and the density of glass samples
    /// that become such light.
    fn eval_pdf_of_returned(&self, one: &WeightedLobe, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        let (Role::SolidReturn { glass, polished, .. }, Lobe::Conductor(mirror)) = (one.role, &one.lobe) else {
            return (Rgb::BLACK, 0.0);
        };
        if wo.z >= 0.0 || wi.z >= 0.0 || mirror.is_smooth() {
            return (Rgb::BLACK, 0.0);
        }
        let (o, i) = (flip(wo), flip(wi));
        let mut density = 0.0;
        if polished > 0.0 {
            density +=
                polished * mirror.single_scattering_shape(o, i) * self.return_reflectance(usize::from(glass), o, i);
        }
        if polished < 1.0 {
            let h = self.relative_transmittance(one, o.z) * self.relative_transmittance(one, i.z);
            density += (1.0 - polished) * one.scale * h * i.z * FRAC_1_PI;
        }
        (mirror.f0() * density, density)
    }

    /// Samples the glass at an index for light from below; layers may return the sample below.
    /// Weight and density of a sample that is no delta are left to the caller to evaluate.
    pub(super) fn sample_under_layers(
        &self,
        glass: usize,
        returning: &WeightedLobe,
        wo: Vec3,
        u: Vec2,
        u_choice: f32,
    ) -> Option<BsdfSample> {
        let sample = self.lobes.get(glass)?.lobe.sample(wo, u, u_choice)?;
        if sample.wi.z <= 0.0 {
            return Some(sample);
        }
        let transmittance = layer_transmittance(self.lobes.get(..glass)?, sample.wi);
        if sample.scatter == Scatter::Specular {
            if u.y < transmittance {
                return Some(BsdfSample {
                    weight: sample.weight / transmittance,
                    pdf: sample.pdf * transmittance,
                    ..sample
                });
            }
            let weight = sample.weight * (sample.ior * sample.ior);
            let wi = Vec3::new(-wo.x, -wo.y, wo.z);
            return Some(BsdfSample {
                wi,
                weight,
                pdf: sample.pdf * (1.0 - transmittance),
                scatter: Scatter::Specular,
                ior: 1.0,
            });
        }
        let mut random = SampleRng::new(Vec2::new(u.y, u.x), u_choice);
        if random.unit() < transmittance {
            return Some(sample);
        }
        let (wi, scatter) = self.return_direction(returning, wo, &sample, &mut random);
        Some(BsdfSample { wi, scatter, ior: 1.0, ..sample })
    }

    /// Direction and kind of scattering of a sample that layers return.
    fn return_direction(
        &self,
        returning: &WeightedLobe,
        wo: Vec3,
        sample: &BsdfSample,
        random: &mut SampleRng,
    ) -> (Vec3, Scatter) {
        let Role::SolidReturn { polished, .. } = returning.role else { return (flip(sample.wi), sample.scatter) };
        if sample.scatter == Scatter::Glossy && random.unit() < polished {
            // Reflect at the microfacet that refracted the sample.
            let m = (wo + sample.wi * sample.ior).normalize_or_zero();
            let wi = reflect(wo, m);
            if wi.z < 0.0 && m != Vec3::ZERO {
                return (wi, Scatter::Glossy);
            }
        }
        // Sample in proportion to h(μ) μ by rejection.
        let max = self.relative_transmittance(returning, 1.0);
        let mut wi = Vec3::NEG_Z;
        for _ in 0..64 {
            wi = flip(warp::cosine_hemisphere(Vec2::new(random.unit(), random.unit())));
            if random.unit() * max < self.relative_transmittance(returning, -wi.z) {
                break;
            }
        }
        (wi, Scatter::Diffuse)
    }

    /// Fraction that layers over a pane return along directions below; 0 for other directions.
    fn pane_blocked_fraction(&self, glass: usize, wo: Vec3, wi: Vec3) -> f32 {
        if wo.z < 0.0 && wi.z < 0.0 { self.blocked_fraction(glass, flip(wo), flip(wi)) } else { 0.0 }
    }

    /// [`Lobe::eval_pdf`] of a lobe in its role.
    #[inline]
    pub(super) fn eval_pdf_of_one(&self, one: &WeightedLobe, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        match one.role {
            Role::Upright => one.lobe.eval_pdf(wo, wi),
            Role::Below => one.lobe.eval_pdf(flip(wo), flip(wi)),
            Role::PaneReturn { glass } => {
                let blocked = self.pane_blocked_fraction(usize::from(glass), wo, wi);
                let scattered = self
                    .lobes
                    .get(usize::from(glass))
                    .filter(|_| blocked > 0.0)
                    .map(|pane| pane.lobe.eval_pdf(wo, flip(wi)));
                scattered.map_or((Rgb::BLACK, 0.0), |(value, pdf)| (value * blocked, pdf * blocked))
            }
            Role::SolidReturn { .. } => self.eval_pdf_of_returned(one, wo, wi),
        }
    }

    /// [`Lobe::sample`] of a lobe in its role.
    #[inline]
    pub(super) fn sample_of_one(&self, one: &WeightedLobe, wo: Vec3, u: Vec2, u_choice: f32) -> Option<BsdfSample> {
        match one.role {
            Role::Upright => one.lobe.sample(wo, u, u_choice),
            Role::Below => one.lobe.sample(flip(wo), u, u_choice).map(flip_sample),
            // `sample_under_layers` turns samples of the glass into samples of this lobe.
            Role::PaneReturn { .. } | Role::SolidReturn { .. } => None,
        }
    }

    /// [`Lobe::deltas`] of a lobe in its role.
    pub(super) fn deltas_of_one(&self, one: &WeightedLobe, wo: Vec3) -> Deltas {
        match one.role {
            Role::Upright => one.lobe.deltas(wo),
            Role::Below => one.lobe.deltas(flip(wo)).into_iter().map(flip_sample).collect(),
            _ if wo.z >= 0.0 => Deltas::new(),
            Role::PaneReturn { glass } => {
                let blocked = |delta: BsdfSample| self.pane_blocked_fraction(usize::from(glass), wo, delta.wi);
                let deltas = one.lobe.deltas(flip(wo)).into_iter();
                deltas.map(|delta| BsdfSample { weight: delta.weight * blocked(delta), ..delta }).collect()
            }
            Role::SolidReturn { glass, .. } => {
                let reflectance = |delta: &BsdfSample| self.return_reflectance(usize::from(glass), flip(wo), delta.wi);
                let deltas = one.lobe.deltas(flip(wo)).into_iter();
                deltas
                    .map(|delta| flip_sample(BsdfSample { weight: delta.weight * reflectance(&delta), ..delta }))
                    .collect()
            }
        }
    }

    /// [`Lobe::albedo`] of a lobe in its role; the albedo of glass from below includes returned
    /// light.
    pub(super) fn albedo_of_one(&self, one: &WeightedLobe, wo: Vec3) -> Rgb {
        match one.role {
            Role::Upright => one.lobe.albedo(wo),
            _ if wo.z >= 0.0 => Rgb::BLACK,
            Role::Below => one.lobe.albedo(flip(wo)),
            Role::PaneReturn { .. } | Role::SolidReturn { .. } => Rgb::BLACK,
        }
    }
}

/// Flips the sample of a flipped lobe back.
fn flip_sample(sample: BsdfSample) -> BsdfSample {
    BsdfSample { wi: flip(sample.wi), ..sample }
}

fn has_cover(layers: &[WeightedLobe]) -> bool {
    layers.iter().any(|one| one.cover > 0.0)
}

/// Cosine-weighted mean of the fraction of light below that rough glass transmits and layers over it
/// keep from leaving.
fn mean_blocked_transmittance(layers: &[WeightedLobe], interface: &Dielectric) -> f32 {
    let blocked = |azimuth: Azimuth| {
        let (through, directions) = (layer_transmittances(layers, azimuth), azimuth.directions());
        lanes(|node| (1.0 - through[node]) * interface.reflectance_and_transmittance(directions[node])[1])
    };
    quadrature::mean(!interface.is_isotropic(), blocked) * interface.inverse_squared_ior()
}

/// Transmittance of layers for light along `w`.
#[inline]
fn layer_transmittance(layers: &[WeightedLobe], w: Vec3) -> f32 {
    layers.iter().fold(1.0, |transmittance, one| transmittance * one.transmittance(w))
}
