//! Interface between two dielectric media, smooth or rough: reflection and refraction (Walter,
//! Marschner, Li and Torrance 2007) with [GGX](super::ggx) normals and Fresnel's equations.
//!
//! [`Dielectric::compensated`] adds multiple scattering between microfacets (after Kulla and Conty
//! 2017). With L(w) the loss of single scattering, L̄ its mean and T̄ the mean transmittance, each
//! for the side of the direction, lost light is reflected as (1 - b) L(wo) L(wi) / (π L̄) and
//! transmitted as c T̄o Lo(wo) Li(wi) / (π L̄o L̄i), where b = c T̄ / L̄ on each side. As T̄o = η²
//! T̄i (with η the index on the side of i over that on the side of o), this is reciprocal for any
//! c; we take the largest for which neither side transmits more of its multiple than of its single
//! scattering. L comes from [tables](super::energy::InterfaceLoss) for isotropic and anisotropic
//! surfaces.
//!
//! Sampling follows the light: a visible normal reflects or refracts, and the direction is accepted
//! with probability G2 / G1. Otherwise, that is with probability L(wo), a direction is sampled in
//! proportion to L(wi) cos θi. Samples of a white interface thus have a weight of 1 whatever the
//! error of the tables. Values and densities use L of the tables, which are within 0.002 for plain
//! glass. Under a thin film or a [`SpecularWeight`] below 1, whose reflectances no table holds, L is
//! that of the plain interface.

use super::energy::{self, InterfaceLoss, SampleRng, Side};
use super::ggx::Ggx;
use super::lobe::{Deltas, channel_sum, delta, nonzero_deltas, sample_delta_pair, selection_probability};
use super::{BsdfSample, Scatter, SpecularWeight, ThinFilm, choose, fresnel};
use crate::ScatteringLobe;
use juggler_math::{Rgb, Vec2, Vec3};
use std::f32::consts::FRAC_1_PI;

mod estimates;

/// Dielectric interface lobe: glass, water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric {
    ggx: Ggx,
    ior: f32,
    /// Factor on reflected light, 0 to 1; white in nature.
    pub reflection: Rgb,
    /// Factor on transmitted light, 0 to 1, the same in both directions.
    pub transmission: Rgb,
    /// Thin film above the interface, and the fraction of the surface that it covers, 0 to 1.
    pub thin_film: Option<(ThinFilm, f32)>,
    /// Factor on the Fresnel reflectance below total reflection.
    specular: SpecularWeight,
    compensation: Option<Compensation>,
}

/// Means of multiple scattering over directions, from above and from below.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Compensation {
    /// L̄.
    mean_loss: [f32; 2],
    /// b: fraction of the lost light that is transmitted.
    transmitted_fraction: [f32; 2],
}

/// The interface as seen along `wo`, flipped so that `wo` is above.
#[derive(Clone, Copy)]
struct InterfaceView {
    wo: Vec3,
    /// Index below over above.
    ior: f32,
    /// Multiple scattering; `None` without compensation.
    multiple: Option<Multiple>,
}

/// Multiple scattering of light along one `wo`.
#[derive(Clone, Copy)]
struct Multiple {
    loss: InterfaceLoss,
    /// The side of `wo`, and the opposite one.
    sides: [Side; 2],
    /// L(wo), which is also its probability.
    loss_probability: f32,
    /// b: fraction of it that is transmitted.
    transmitted_fraction: f32,
    /// L̄ on the side of `wo`, and on the opposite one.
    mean_loss: [f32; 2],
}

/// Mean loss below which an interface needs no compensation.
const LEAST_LOSS: f32 = 1e-5;

impl Dielectric {
    /// Distance of the index of refraction from 1 below which any interface counts as smooth: it
    /// spreads refracted light by no more than this.
    pub const MIN_IOR_DIFFERENCE: f32 = 1e-3;

    /// Interface with single scattering only. `alpha` as in [`Ggx`]; `ior` is the index of
    /// refraction below the surface (-z) over that above.
    #[inline]
    pub fn new(ior: f32, alpha: Vec2) -> Self {
        let ior = if ior > 0.0 && ior.is_finite() { ior } else { 1.0 };
        let ggx = if (ior - 1.0).abs() < Self::MIN_IOR_DIFFERENCE { Ggx::isotropic(0.0) } else { Ggx::new(alpha) };
        let (reflection, transmission, specular) = (Rgb::WHITE, Rgb::WHITE, SpecularWeight::default());
        Self { ggx, ior, reflection, transmission, thin_film: None, specular, compensation: None }
    }

    /// Interface with multiple scattering between microfacets.
    #[inline]
    pub fn compensated(ior: f32, alpha: Vec2) -> Self {
        let single = Self::new(ior, alpha);
        Self { compensation: single.compute_compensation(), ..single }
    }

    fn compute_compensation(&self) -> Option<Compensation> {
        if self.is_smooth() {
            return None;
        }
        let loss = InterfaceLoss::new(self.ggx, self.ior);
        let [above, below] = [self.ior, 1.0 / self.ior].map(|ior| loss.mean(Side::from_ior(ior)));
        if above.min(below) < LEAST_LOSS {
            return None;
        }
        // Mean transmittance from the thinner medium, and by reciprocity from the denser one.
        let (outer, dense) = if self.ior > 1.0 { (above, self.ior) } else { (below, 1.0 / self.ior) };
        let outwards = (1.0 - energy::mean_dielectric_reflection_albedo(self.ggx.mean_alpha(), dense) - outer).max(0.0);
        let inwards = outwards / (dense * dense);
        let [from_above, from_below] = if self.ior > 1.0 { [outwards, inwards] } else { [inwards, outwards] };
        // The largest c for which neither side transmits more of its multiple than of its single
        // scattering.
        let c = (above / (1.0 - above)).min(below / (1.0 - below));
        Some(Compensation {
            mean_loss: [above, below],
            transmitted_fraction: [(c * from_above / above).min(1.0), (c * from_below / below).min(1.0)],
        })
    }

    /// The same interface with other factors on reflected and transmitted light.
    #[inline]
    pub fn tinted(self, reflection: Rgb, transmission: Rgb) -> Self {
        Self { reflection, transmission, ..self }
    }

    /// The same interface with a factor on the Fresnel reflectance; see [`SpecularWeight`].
    #[inline]
    pub fn with_specular(self, specular: SpecularWeight) -> Self {
        Self { specular, ..self }
    }

    /// Index of refraction below the surface over that above.
    #[inline]
    pub fn ior(&self) -> f32 {
        self.ior
    }

    /// Whether the interface has only specular reflection and refraction.
    #[inline]
    pub fn is_smooth(&self) -> bool {
        self.ggx.is_smooth()
    }

    /// Index of refraction on the opposite side over that on the side of `w`.
    #[inline]
    fn ior_from(&self, w: Vec3) -> f32 {
        if w.z < 0.0 { 1.0 / self.ior } else { self.ior }
    }

    /// Fresnel reflectance at an angle of cosine `cos`, for the index behind over that in front,
    /// times the specular weight unless reflection is total.
    #[inline]
    fn reflectance(&self, cos: f32, ior: f32) -> Rgb {
        let plain = fresnel::dielectric_reflectance(cos, ior);
        if plain < 1.0 { self.partial_reflectance(plain, cos, ior) * self.specular.weight() } else { Rgb::WHITE }
    }

    /// Reflectance below total reflection, of the thin film where it covers the interface, otherwise
    /// `plain`.
    #[inline]
    fn partial_reflectance(&self, plain: f32, cos: f32, ior: f32) -> Rgb {
        let Some((thin_film, amount)) = self.thin_film else { return Rgb::splat(plain) };
        // The film takes the angle above it, whichever side light comes from.
        let is_below = ior != self.ior;
        let above = if is_below { (1.0 - (1.0 - cos * cos) / (ior * ior)).max(0.0).sqrt() } else { cos };
        Rgb::splat(plain).lerp(thin_film.reflectance(above), amount)
    }

    #[inline]
    fn view(&self, wo: Vec3) -> InterfaceView {
        let ior = self.ior_from(wo);
        let wo = Vec3::new(wo.x, wo.y, wo.z.abs());
        InterfaceView { wo, ior, multiple: self.multiple(wo, ior) }
    }

    /// Probability that a microfacet of this reflectance reflects: with compensation the
    /// reflectance itself, so that L(wo) is lost, otherwise in proportion to both colors.
    #[inline]
    fn reflection_probability(&self, reflectance: Rgb) -> f32 {
        if self.compensation.is_some() {
            return channel_sum(reflectance) * (1.0 / 3.0);
        }
        selection_probability(self.reflected(reflectance), self.transmission * (Rgb::WHITE - reflectance))
    }

    /// Fraction of light that an interface of this reflectance reflects, with the factors on it.
    #[inline]
    fn reflected(&self, reflectance: Rgb) -> Rgb {
        self.reflection * self.specular.tint(reflectance)
    }

    /// Multiple scattering of light along `wo`, flipped to be above; `ior` is the index behind over
    /// that in front.
    #[inline]
    fn multiple(&self, wo: Vec3, ior: f32) -> Option<Multiple> {
        let Compensation { mean_loss: [above, below], transmitted_fraction } = self.compensation?;
        let loss = InterfaceLoss::new(self.ggx, ior);
        let sides = [Side::from_ior(ior), Side::from_ior(1.0 / ior)];
        let is_above = ior == self.ior;
        let mean_loss = if is_above { [above, below] } else { [below, above] };
        let transmitted_fraction = transmitted_fraction[usize::from(!is_above)];
        Some(Multiple { loss, sides, loss_probability: loss.at(sides[0], wo), transmitted_fraction, mean_loss })
    }

    #[inline]
    fn eval_pdf_in(&self, view: &InterfaceView, wi: Vec3) -> (Rgb, f32) {
        let (single, pdf) = if wi.z > 0.0 {
            let microfacet = self.ggx.eval_reflection(view.wo, wi);
            let reflectance = self.reflectance(microfacet.cos, view.ior);
            let pdf = if view.multiple.is_some() { microfacet.value } else { microfacet.pdf };
            (self.reflected(reflectance) * microfacet.value, pdf * self.reflection_probability(reflectance))
        } else {
            self.eval_refraction(view, wi)
        };
        match &view.multiple {
            None => (single, pdf),
            Some(multiple) => {
                let (more, density) = self.eval_multiple(view, multiple, wi);
                (single + more, pdf + density)
            }
        }
    }

    /// Value and density of single refraction.
    #[inline]
    fn eval_refraction(&self, view: &InterfaceView, wi: Vec3) -> (Rgb, f32) {
        let (wo, ior) = (view.wo, view.ior);
        let m = wo + wi * ior;
        let m = if m.z < 0.0 { -m } else { m };
        let squared = m.length_squared();
        let (o, i) = (wo.dot(m), -wi.dot(m));
        if o <= 0.0 || i <= 0.0 || squared <= 0.0 {
            return (Rgb::BLACK, 0.0);
        }
        let reflectance = self.reflectance(o / squared.sqrt(), ior);
        let (so, si, zi) = (self.ggx.stretched_length(wo), self.ggx.stretched_length(wi), -wi.z);
        // D |o·m| |i·m| / |m|², by the Jacobian from normals to directions.
        let common = 2.0 * self.ggx.normal_density(m) * o * i / (squared * squared);
        let scattered = zi / (so * zi + si * wo.z);
        let value = self.transmission * (Rgb::WHITE - reflectance) * (common * scattered);
        let picked = if view.multiple.is_some() { scattered } else { 1.0 / (wo.z + so) };
        (value, common * ior * ior * picked * (1.0 - self.reflection_probability(reflectance)))
    }

    /// Value and density of multiple scattering.
    fn eval_multiple(&self, view: &InterfaceView, multiple: &Multiple, wi: Vec3) -> (Rgb, f32) {
        let Multiple { loss, sides, loss_probability, transmitted_fraction, mean_loss } = *multiple;
        let (side, mean, color, fraction, scale) = if wi.z > 0.0 {
            (sides[0], mean_loss[0], self.reflection, 1.0 - transmitted_fraction, 1.0)
        } else {
            (sides[1], mean_loss[1], self.transmission, transmitted_fraction, view.ior * view.ior)
        };
        let density = fraction * loss_probability * loss.at(side, wi) / mean * (wi.z.abs() * FRAC_1_PI);
        (color * (density / scale), density)
    }

    fn sample_direction(&self, view: &InterfaceView, u: Vec2, u_choice: f32) -> Option<(Vec3, Scatter)> {
        let so = self.ggx.stretched_length(view.wo);
        let (m, _) = self.ggx.sample_visible_normal(view.wo, so, u);
        let reflectance = self.reflectance(view.wo.dot(m), view.ior);
        let (is_reflected, rest) = choose(u_choice, self.reflection_probability(reflectance));
        let once = if is_reflected {
            Some(fresnel::reflect(view.wo, m)).filter(|wi| wi.z > 0.0)
        } else {
            fresnel::refract(view.wo, m, 1.0 / view.ior).filter(|wi| wi.z < 0.0)
        };
        let Some(multiple) = &view.multiple else { return once.map(|wi| (wi, Scatter::Glossy)) };
        // Accept the direction with probability G2 / G1.
        let ratio = |wi: &Vec3| self.ggx.g2_over_g1(view.wo.z, so, wi.z.abs(), self.ggx.stretched_length(*wi));
        if let Some(wi) = once.filter(|wi| rest < ratio(wi)) {
            return Some((wi, Scatter::Glossy));
        }
        let mut random = SampleRng::new(u, u_choice);
        let is_transmitted = random.unit() < multiple.transmitted_fraction;
        let wi = multiple.loss.sample(multiple.sides[usize::from(is_transmitted)], &mut random);
        Some((if is_transmitted { Vec3::new(wi.x, wi.y, -wi.z) } else { wi }, Scatter::Diffuse))
    }

    /// Reflected and refracted delta of a smooth interface.
    fn delta_pair(&self, wo: Vec3) -> [BsdfSample; 2] {
        let ior = self.ior_from(wo);
        let reflectance = self.smooth_reflectance(wo.z.abs(), ior);
        let reflected = delta(Vec3::new(-wo.x, -wo.y, wo.z), self.reflected(reflectance), 1.0);
        let (wi, transmitted) = match fresnel::refract(wo, Vec3::Z, 1.0 / ior) {
            Some(wi) => (wi, (Rgb::WHITE - reflectance) / (ior * ior)),
            None => (-wo, Rgb::BLACK),
        };
        [reflected, delta(wi, self.transmission * transmitted, ior)]
    }

    #[inline]
    fn smooth_reflectance(&self, cos: f32, ior: f32) -> Rgb {
        if ior == 1.0 && self.thin_film.is_none() { Rgb::BLACK } else { self.reflectance(cos, ior) }
    }

    /// Transmittance of a microfacet of normal `m` for either of two directions that it reflects
    /// into each other, and their refracted directions; flipped, so that light from below is above.
    #[inline]
    pub(super) fn refract_pair(&self, along: [Vec3; 2], m: Vec3) -> Option<(f32, [Vec3; 2])> {
        let [a, b] = along.map(|w| fresnel::refract(w, m, self.ior));
        let reflectance = self.smooth_reflectance(along[0].dot(m).clamp(0.0, 1.0), 1.0 / self.ior);
        Some((1.0 - channel_sum(reflectance) / 3.0, [a?, b?]))
    }

    /// Whether the microfacets are isotropic.
    #[inline]
    pub(super) fn is_isotropic(&self) -> bool {
        self.ggx.is_isotropic()
    }

    /// Alpha along x and y.
    #[inline]
    pub(super) fn alpha(&self) -> Vec2 {
        self.ggx.alpha()
    }
}

impl ScatteringLobe for Dielectric {
    #[inline]
    fn mean_alpha(&self) -> f32 {
        self.ggx.mean_alpha()
    }

    /// f |cos θi|, and the density per steradian.
    #[inline]
    fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        if wo.z == 0.0 || wi.z == 0.0 || self.is_smooth() {
            return (Rgb::BLACK, 0.0);
        }
        let up = if wo.z < 0.0 { Vec3::new(wi.x, wi.y, -wi.z) } else { wi };
        self.eval_pdf_in(&self.view(wo), up)
    }

    /// Samples a direction: `u` selects a microfacet, and `u_choice`, in [0, 1), reflection or
    /// refraction by its Fresnel reflectance (PBR 4th ed., section 9.7.2). Without compensation,
    /// the energy of the sample is G2 / G1.
    #[inline]
    fn sample(&self, wo: Vec3, u: Vec2, u_choice: f32) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        if self.is_smooth() {
            let [reflected, refracted] = self.delta_pair(wo);
            return sample_delta_pair(reflected, refracted, u.x);
        }
        let view = self.view(wo);
        let (wi, scatter) = self.sample_direction(&view, u, u_choice)?;
        let (value, pdf) = self.eval_pdf_in(&view, wi);
        if pdf <= 0.0 {
            return None;
        }
        let ior = if wi.z < 0.0 { view.ior } else { 1.0 };
        let wi = if wo.z < 0.0 { Vec3::new(wi.x, wi.y, -wi.z) } else { wi };
        Some(BsdfSample { wi, weight: value / pdf, pdf, scatter, ior })
    }

    /// Reflected and transmitted light with their factors.
    fn albedo(&self, wo: Vec3) -> Rgb {
        if wo.z == 0.0 {
            return Rgb::BLACK;
        }
        if self.is_smooth() {
            let reflectance = self.smooth_reflectance(wo.z.abs(), self.ior_from(wo));
            return self.reflected(reflectance) + self.transmission * (Rgb::WHITE - reflectance);
        }
        let [reflected, transmitted] = self.reflectance_and_transmittance(wo);
        self.reflected(Rgb::splat(reflected)) + self.transmission * transmitted
    }

    /// Specular reflection and refraction, if smooth; deltas of zero weight are left out.
    fn deltas(&self, wo: Vec3) -> Deltas {
        if !self.is_smooth() || wo.z == 0.0 {
            return Deltas::new();
        }
        nonzero_deltas(self.delta_pair(wo))
    }

    #[inline]
    fn is_specular(&self) -> bool {
        self.is_smooth()
    }

    #[inline]
    fn uses_u_choice(&self) -> bool {
        !self.is_smooth()
    }
}
