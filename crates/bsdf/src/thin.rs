//! Dielectric sheet too thin to model its two interfaces: a window pane, a soap bubble. Light is
//! reflected between both interfaces any number of times. With F the Fresnel reflectance of one
//! interface, the sheet reflects R = F + F (1 - F)² / (1 - F²) = 2F / (1 + F) and transmits 1 - R
//! in a straight line (PBR 4th ed., section 9.5.1).
//!
//! A rough sheet transmits the lobe that it reflects, flipped to the other side, as the extension
//! KHR_materials_transmission of glTF does. [`ThinDielectric::compensated`] adds multiple
//! scattering between microfacets; samples of a clear pane then have a weight of 1, as those of a
//! [`Conductor`](super::Conductor) do.

use super::energy::SampleRng;
use super::ggx::{Ggx, MicrofacetReflection};
use super::lobe::{Deltas, channel_sum, delta, nonzero_deltas, sample_delta_pair, selection_probability};
use super::{BsdfSample, Scatter, SpecularWeight, ThinFilm, energy, fresnel};
use crate::ScatteringLobe;
use juggler_math::{Rgb, Vec2, Vec3};
use std::f32::consts::FRAC_1_PI;

/// Thin dielectric sheet, the same from either side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinDielectric {
    ggx: Ggx,
    ior: f32,
    /// Factor on reflected light, 0 to 1.
    pub reflection: Rgb,
    /// Factor on transmitted light, 0 to 1.
    pub transmission: Rgb,
    /// Thin film on the sheet, and the fraction of the sheet that it covers, 0 to 1.
    pub thin_film: Option<(ThinFilm, f32)>,
    /// Factor on the Fresnel reflectance of each interface.
    specular: SpecularWeight,
    compensated: bool,
}

impl ThinDielectric {
    /// Sheet with single scattering only. `ior` is the index of refraction of the sheet over that
    /// around it, `alpha` as in [`Ggx`].
    #[inline]
    pub fn new(ior: f32, alpha: Vec2) -> Self {
        let ior = if ior > 0.0 && ior.is_finite() { ior } else { 1.0 };
        let (reflection, transmission, specular) = (Rgb::WHITE, Rgb::WHITE, SpecularWeight::default());
        Self { ggx: Ggx::new(alpha), ior, reflection, transmission, thin_film: None, specular, compensated: false }
    }

    /// Sheet with multiple scattering between microfacets.
    #[inline]
    pub fn compensated(ior: f32, alpha: Vec2) -> Self {
        let single = Self::new(ior, alpha);
        Self { compensated: energy::mean_mirror_loss(single.ggx) > 0.0, ..single }
    }

    /// The same sheet with other factors on reflected and transmitted light.
    #[inline]
    pub fn tinted(self, reflection: Rgb, transmission: Rgb) -> Self {
        Self { reflection, transmission, ..self }
    }

    /// The same sheet with a factor on the Fresnel reflectance of each interface; see
    /// [`SpecularWeight`].
    #[inline]
    pub fn with_specular(self, specular: SpecularWeight) -> Self {
        Self { specular, ..self }
    }

    /// Whether the sheet has only specular reflection and transmission.
    #[inline]
    pub fn is_smooth(&self) -> bool {
        self.ggx.is_smooth()
    }

    /// Reflectance R at an angle of cosine `cos`.
    #[inline]
    fn reflectance(&self, cos: f32) -> Rgb {
        let once = if self.ior == 1.0 { 0.0 } else { fresnel::dielectric_reflectance(cos, self.ior) };
        let once = self
            .thin_film
            .map_or(Rgb::splat(once), |(thin_film, amount)| Rgb::splat(once).lerp(thin_film.reflectance(cos), amount));
        (once * self.specular.weight()).map(|once| 2.0 * once / (1.0 + once))
    }

    /// Fraction of light that a sheet of this reflectance reflects, with the factors on it.
    #[inline]
    fn reflected(&self, reflectance: Rgb) -> Rgb {
        self.reflection * self.specular.tint(reflectance)
    }

    /// Probability that a microfacet of this reflectance reflects.
    #[inline]
    fn reflection_probability(&self, reflectance: Rgb) -> f32 {
        selection_probability(self.reflected(reflectance), self.transmission * (Rgb::WHITE - reflectance))
    }

    /// Fraction of light along `w` that single scattering loses.
    fn energy_loss(&self, w: Vec3) -> f32 {
        energy::mirror_loss(self.ggx, w)
    }

    /// Fraction of multiply scattered light that is reflected.
    fn multiple_reflectance(&self) -> f32 {
        let once = fresnel::mean_dielectric_reflectance(self.ior) * self.specular.weight();
        2.0 * once / (1.0 + once)
    }

    /// Samples a direction and its kind of scattering for `wo` above; `u_choice` selects
    /// transmission, which flips the direction.
    fn sample_direction(&self, wo: Vec3, u: Vec2, u_choice: f32) -> Option<(Vec3, Scatter)> {
        let mut random = SampleRng::new(u, 0.0);
        // Reflect at a visible normal; with compensation, accept the direction with probability G2
        // / G1.
        let mut is_accepted =
            |microfacet: &MicrofacetReflection| !self.compensated || random.unit() * microfacet.pdf < microfacet.value;
        let once = self.ggx.sample_reflection(wo, u).filter(|(_, microfacet)| is_accepted(microfacet));
        let (wi, probability, scatter) = match once {
            Some((wi, microfacet)) => {
                (wi, self.reflection_probability(self.reflectance(microfacet.cos)), Scatter::Glossy)
            }
            None if self.compensated => {
                (energy::sample_mirror_loss(self.ggx, &mut random), self.multiple_reflectance(), Scatter::Diffuse)
            }
            None => return None,
        };
        Some((if u_choice < probability { wi } else { Vec3::new(wi.x, wi.y, -wi.z) }, scatter))
    }

    fn delta_pair(&self, wo: Vec3) -> [BsdfSample; 2] {
        let reflectance = self.reflectance(wo.z.abs());
        let reflected = delta(Vec3::new(-wo.x, -wo.y, wo.z), self.reflected(reflectance), 1.0);
        [reflected, delta(-wo, self.transmission * (Rgb::WHITE - reflectance), 1.0)]
    }
}

impl ScatteringLobe for ThinDielectric {
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
        let is_reflected = wo.z * wi.z > 0.0;
        let (o, i) = (Vec3::new(wo.x, wo.y, wo.z.abs()), Vec3::new(wi.x, wi.y, wi.z.abs()));
        let microfacet = self.ggx.eval_reflection(o, i);
        let reflectance = self.reflectance(microfacet.cos);
        let probability = self.reflection_probability(reflectance);
        let (color, multiple_reflectance) = if is_reflected {
            (self.reflection * self.specular.color(), self.multiple_reflectance())
        } else {
            (self.transmission, 1.0 - self.multiple_reflectance())
        };
        let (fraction, probability) =
            if is_reflected { (reflectance, probability) } else { (Rgb::WHITE - reflectance, 1.0 - probability) };
        if !self.compensated {
            return (color * fraction * microfacet.value, probability * microfacet.pdf);
        }
        let more = multiple_reflectance * FRAC_1_PI * self.energy_loss(o) * self.energy_loss(i) * i.z
            / energy::mean_mirror_loss(self.ggx);
        (color * (fraction * microfacet.value + Rgb::splat(more)), probability * microfacet.value + more)
    }

    /// Samples a direction: `u` selects a microfacet, and `u_choice`, in [0, 1), reflection with
    /// the microfacet's R or else transmission.
    #[inline]
    fn sample(&self, wo: Vec3, u: Vec2, u_choice: f32) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        if self.is_smooth() {
            let [reflected, transmitted] = self.delta_pair(wo);
            return sample_delta_pair(reflected, transmitted, u.x);
        }
        let up = Vec3::new(wo.x, wo.y, wo.z.abs());
        let (wi, scatter) = self.sample_direction(up, u, u_choice)?;
        let wi = if wo.z < 0.0 { Vec3::new(wi.x, wi.y, -wi.z) } else { wi };
        let (value, pdf) = self.eval_pdf(wo, wi);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: value / pdf, pdf, scatter, ior: 1.0 })
    }

    /// Reflected and transmitted light with their factors.
    fn albedo(&self, wo: Vec3) -> Rgb {
        if wo.z == 0.0 {
            return Rgb::BLACK;
        }
        let (cos, alpha) = (wo.z.abs(), self.ggx.alpha_towards(wo));
        if self.is_smooth() {
            let reflectance = self.reflectance(cos);
            return self.reflected(reflectance) + self.transmission * (Rgb::WHITE - reflectance);
        }
        let loss = self.energy_loss(wo);
        let reflectance =
            energy::mean_microfacet_reflectance(cos, alpha, |cos| channel_sum(self.reflectance(cos)) / 3.0);
        let once = (self.reflected(Rgb::splat(reflectance)) + self.transmission * (1.0 - reflectance)) * (1.0 - loss);
        if !self.compensated {
            return once;
        }
        let multiple_reflectance = self.multiple_reflectance();
        once + (self.reflected(Rgb::splat(multiple_reflectance)) + self.transmission * (1.0 - multiple_reflectance))
            * loss
    }

    /// Specular reflection and transmission, if smooth; deltas of zero weight are left out.
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
