//! A sheet of a clear medium too thin to be modelled by two borders: a window pane, a soap bubble. Light is mirrored
//! to and fro within it, and leaves where it came in: with F Fresnel's share at one border, R = F + F (1 - F)² / (1 - F²)
//! = 2F / (1 + F) is mirrored in all and 1 - R goes straight on (PBR 4th ed., section 9.5.1).
//!
//! A rough one spreads both alike, as the extension KHR_materials_transmission of glTF has it: what goes through is
//! what is mirrored, turned over at the surface. Light that is scattered more than once is given back, and samples of a
//! clear pane carry a weight of 1, as those of a [`Conductor`](super::Conductor) do.

use super::energy::Scramble;
use super::ggx::{Facing, Ggx};
use super::lobe::{Deltas, delta, one_of_two, share_of_first, sum, visible};
use super::{BsdfSample, Film, Scatter, energy, fresnel};
use crate::ScatteringLobe;
use juggler_math::{Rgb, Vec2, Vec3};
use std::f32::consts::FRAC_1_PI;

/// A thin sheet, the same from either side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinDielectric {
    ggx: Ggx,
    ior: f32,
    /// Factor on mirrored light, 0 to 1.
    pub reflection: Rgb,
    /// Factor on light that goes through, 0 to 1.
    pub transmission: Rgb,
    /// A thin film on it, and how much of it that covers.
    pub film: Option<(Film, f32)>,
    compensated: bool,
}

impl ThinDielectric {
    /// With single scattering only. `ior` is the index of the sheet over that around it, `alpha` as in [`Ggx`].
    #[inline]
    pub fn new(ior: f32, alpha: Vec2) -> Self {
        let ior = if ior > 0.0 && ior.is_finite() { ior } else { 1.0 };
        let (reflection, transmission) = (Rgb::WHITE, Rgb::WHITE);
        Self { ggx: Ggx::new(alpha), ior, reflection, transmission, film: None, compensated: false }
    }

    /// With all scattering among its microfacets.
    #[inline]
    pub fn compensated(ior: f32, alpha: Vec2) -> Self {
        let single = Self::new(ior, alpha);
        Self { compensated: energy::mirror_lost_average(single.ggx) > 0.0, ..single }
    }

    /// The same in other colours.
    #[inline]
    pub fn tinted(self, reflection: Rgb, transmission: Rgb) -> Self {
        Self { reflection, transmission, ..self }
    }

    /// Whether it only mirrors and lets through, without spread.
    #[inline]
    pub fn is_smooth(&self) -> bool {
        self.ggx.is_smooth()
    }

    /// R at an angle of cosine `cos`.
    #[inline]
    fn share(&self, cos: f32) -> Rgb {
        let once = if self.ior == 1.0 { 0.0 } else { fresnel::dielectric(cos, self.ior) };
        let once = self.film.map_or(Rgb::splat(once), |(film, amount)| Rgb::splat(once).lerp(film.at(cos), amount));
        once.map(|once| 2.0 * once / (1.0 + once))
    }

    /// How often a microfacet that mirrors this share is to mirror.
    #[inline]
    fn chance(&self, share: Rgb) -> f32 {
        share_of_first(self.reflection * share, self.transmission * (Rgb::WHITE - share))
    }

    /// What single scattering loses of light along `w`.
    fn lost(&self, w: Vec3) -> f32 {
        energy::mirror_lost(self.ggx, w)
    }

    /// How much of the light that is scattered more than once is mirrored.
    fn average(&self) -> f32 {
        let once = fresnel::dielectric_average(self.ior);
        2.0 * once / (1.0 + once)
    }

    /// A direction above and how it is scattered, turned over by `choice` if light goes through.
    fn pick(&self, wo: Vec3, u: Vec2, choice: f32) -> Option<(Vec3, Scatter)> {
        let mut random = Scramble::new(u, 0.0);
        // Take the direction that a visible normal reflects, if compensated with probability G2 / G1.
        let mut is_taken = |facing: &Facing| !self.compensated || random.unit() * facing.pdf < facing.value;
        let once = self.ggx.sample_mirror(wo, u).filter(|(_, facing)| is_taken(facing));
        let (wi, probability, scatter) = match once {
            Some((wi, facing)) => (wi, self.chance(self.share(facing.cos)), Scatter::Glossy),
            None if self.compensated => {
                (energy::sample_mirror_lost(self.ggx, &mut random), self.average(), Scatter::Diffuse)
            }
            None => return None,
        };
        Some((if choice < probability { wi } else { Vec3::new(wi.x, wi.y, -wi.z) }, scatter))
    }

    fn both(&self, wo: Vec3) -> [BsdfSample; 2] {
        let share = self.share(wo.z.abs());
        let mirrored = delta(Vec3::new(-wo.x, -wo.y, wo.z), self.reflection * share, 1.0);
        [mirrored, delta(-wo, self.transmission * (Rgb::WHITE - share), 1.0)]
    }
}

impl ScatteringLobe for ThinDielectric {
    /// One alpha of its microfacets that stands for both.
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
        let is_mirrored = wo.z * wi.z > 0.0;
        let (o, i) = (Vec3::new(wo.x, wo.y, wo.z.abs()), Vec3::new(wi.x, wi.y, wi.z.abs()));
        let facing = self.ggx.mirror(o, i);
        let share = self.share(facing.cos);
        let probability = self.chance(share);
        let (color, average) =
            if is_mirrored { (self.reflection, self.average()) } else { (self.transmission, 1.0 - self.average()) };
        let (share, probability) =
            if is_mirrored { (share, probability) } else { (Rgb::WHITE - share, 1.0 - probability) };
        if !self.compensated {
            return (color * share * facing.value, probability * facing.pdf);
        }
        let more = average * FRAC_1_PI * self.lost(o) * self.lost(i) * i.z / energy::mirror_lost_average(self.ggx);
        (color * (share * facing.value + Rgb::splat(more)), probability * facing.value + more)
    }

    /// A direction: `u` picks a microfacet, and `choice`, in [0, 1), whether light is mirrored by it or goes through, as often
    /// as R says there.
    #[inline]
    fn sample(&self, wo: Vec3, u: Vec2, choice: f32) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        if self.is_smooth() {
            let [mirrored, through] = self.both(wo);
            return one_of_two(mirrored, through, u.x);
        }
        let up = Vec3::new(wo.x, wo.y, wo.z.abs());
        let (wi, scatter) = self.pick(up, u, choice)?;
        let wi = if wo.z < 0.0 { Vec3::new(wi.x, wi.y, -wi.z) } else { wi };
        let (value, pdf) = self.eval_pdf(wo, wi);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: value / pdf, pdf, scatter, ior: 1.0 })
    }

    /// What is mirrored and what goes through, each in its colour.
    fn albedo(&self, wo: Vec3) -> Rgb {
        if wo.z == 0.0 {
            return Rgb::BLACK;
        }
        let (cos, alpha) = (wo.z.abs(), self.ggx.alpha_towards(wo));
        if self.is_smooth() {
            let share = self.share(cos);
            return self.reflection * share + self.transmission * (Rgb::WHITE - share);
        }
        let lost = self.lost(wo);
        let share = energy::mirrored_share(cos, alpha, |cos| sum(self.share(cos)) / 3.0);
        let once = (self.reflection * share + self.transmission * (1.0 - share)) * (1.0 - lost);
        if !self.compensated {
            return once;
        }
        let average = self.average();
        once + (self.reflection * average + self.transmission * (1.0 - average)) * lost
    }

    /// Mirrored and straight on, if it is smooth; not those of no weight.
    fn deltas(&self, wo: Vec3) -> Deltas {
        if !self.is_smooth() || wo.z == 0.0 {
            return Deltas::new();
        }
        visible(self.both(wo))
    }

    #[inline]
    fn is_specular(&self) -> bool {
        self.is_smooth()
    }

    #[inline]
    fn has_choice(&self) -> bool {
        !self.is_smooth()
    }
}
