//! The border between two clear media, polished or rough: mirrored and refracted light (Walter, Marschner, Li and
//! Torrance 2007) with [GGX](super::ggx) normals and Fresnel's equations.
//!
//! [`Dielectric::compensated`] adds what is scattered more than once between microfacets (after Kulla and Conty
//! 2017). With L(μ) what single scattering loses, its mean L̄, and T̄ the mean of what it transmits, each for the side of
//! the direction, light that is lost comes out on its own side as (1 - b) L(μo) L(μi) / (π L̄), and on the other as
//! c T̄o Lo(μo) Li(μi) / (π L̄o L̄i), where b = c T̄ / L̄ on each side. As T̄o = η² T̄i (with η the index on the side of i over
//! that on the side of o), that is reciprocal for any c; we take the largest that gives neither side more than what
//! it transmits of what it scatters once. Round surfaces are white within 0.02, but for indices within 3 % of each other;
//! what brushed ones miss says `energy/stretched.rs`.

use super::ggx::Ggx;
use super::lobe::{Deltas, delta, one_of_two, share_of_first};
use super::{BsdfSample, Film, Scatter, choose, energy, fresnel};
use juggler_math::{Rgb, Vec2, Vec3, warp};
use std::f32::consts::FRAC_1_PI;

/// Glass, water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric {
    ggx: Ggx,
    ior: f32,
    /// Factor on mirrored light, 0 to 1; white in nature.
    pub reflection: Rgb,
    /// Factor on light that goes through, 0 to 1, the same both ways.
    pub transmission: Rgb,
    /// A thin film on it, seen from above, and how much of it that covers.
    pub film: Option<(Film, f32)>,
    compensated: bool,
}

/// One direction's view of the border: everything is mirrored so that `wo` is above.
#[derive(Clone, Copy)]
struct View {
    wo: Vec3,
    /// Index below over above.
    ior: f32,
    /// Scattering more than once; `None` without compensation.
    multiple: Option<Multiple>,
}

/// Scattering more than once, of one `wo`.
#[derive(Clone, Copy)]
struct Multiple {
    /// L(μo): also the probability.
    lost: f32,
    /// b: how much of it comes out on the other side.
    through: f32,
    /// L̄ on the side of `wo`, and on the other.
    average: [f32; 2],
}

impl Dielectric {
    /// An index of refraction closer to 1 than this counts as smooth, however rough: directions of light that
    /// goes through are spread by no more than this.
    pub const NO_BORDER: f32 = 1e-3;

    /// With single scattering only. `alpha` as in [`Ggx`]; `ior` is the index below the surface (-z) over that above.
    #[inline]
    pub fn new(ior: f32, alpha: Vec2) -> Self {
        let ior = if ior > 0.0 && ior.is_finite() { ior } else { 1.0 };
        let ggx = if (ior - 1.0).abs() < Self::NO_BORDER { Ggx::isotropic(0.0) } else { Ggx::new(alpha) };
        Self { ggx, ior, reflection: Rgb::WHITE, transmission: Rgb::WHITE, film: None, compensated: false }
    }

    /// With all scattering among its microfacets.
    #[inline]
    pub fn compensated(ior: f32, alpha: Vec2) -> Self {
        Self { compensated: true, ..Self::new(ior, alpha) }
    }

    /// The same in other colours.
    #[inline]
    pub fn tinted(self, reflection: Rgb, transmission: Rgb) -> Self {
        Self { reflection, transmission, ..self }
    }

    /// Whether it only mirrors and refracts, without spread.
    #[inline]
    pub fn is_smooth(&self) -> bool {
        self.ggx.is_smooth()
    }

    /// Index below over above, for `wo` above: and the border's side that `w` is on turned up.
    #[inline]
    fn ior_from(&self, w: Vec3) -> f32 {
        if w.z < 0.0 { 1.0 / self.ior } else { self.ior }
    }

    /// Fresnel's share at an angle of cosine `cos`, for the index behind over that in front.
    #[inline]
    fn share(&self, cos: f32, ior: f32) -> Rgb {
        let plain = fresnel::dielectric(cos, ior);
        let Some((film, amount)) = self.film.filter(|_| plain < 1.0) else { return Rgb::splat(plain) };
        // A film's angle is that above it, on whichever side light comes.
        let is_below = ior != self.ior;
        let above = if is_below { (1.0 - (1.0 - cos * cos) / (ior * ior)).max(0.0).sqrt() } else { cos };
        Rgb::splat(plain).lerp(film.at(above), amount)
    }

    #[inline]
    fn view(&self, wo: Vec3) -> View {
        let ior = self.ior_from(wo);
        let wo = Vec3::new(wo.x, wo.y, wo.z.abs());
        View { wo, ior, multiple: self.multiple(wo, ior) }
    }

    /// How often a microfacet that mirrors this share is to mirror.
    #[inline]
    fn chance(&self, share: Rgb) -> f32 {
        share_of_first(self.reflection * share, self.transmission * (Rgb::WHITE - share))
    }

    /// L of light along `w`, for the index behind the border over that in front.
    fn lost(&self, w: Vec3, ior: f32) -> f32 {
        energy::border_lost(self.ggx, w, ior)
    }

    fn multiple(&self, wo: Vec3, ior: f32) -> Option<Multiple> {
        if !self.compensated {
            return None;
        }
        let here = energy::border_average(self.ggx, ior);
        let there = energy::border_average(self.ggx, 1.0 / ior);
        // What goes through on average, from the side of the larger cone, and by reciprocity the other way.
        let (outer, dense) = if ior > 1.0 { (here, ior) } else { (there, 1.0 / ior) };
        let through = (1.0 - outer.mirrored - outer.lost).max(0.0);
        let through = if ior > 1.0 { through } else { through / (dense * dense) };
        let average = [here.lost, there.lost];
        if average.contains(&0.0) {
            return None;
        }
        let c = (average[0] / (1.0 - average[0])).min(average[1] / (1.0 - average[1]));
        Some(Multiple { lost: self.lost(wo, ior), through: (c * through / average[0]).min(1.0), average })
    }

    /// f |cos θi|, and the density per steradian.
    #[inline]
    pub fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        if wo.z == 0.0 || wi.z == 0.0 || self.is_smooth() {
            return (Rgb::BLACK, 0.0);
        }
        let up = if wo.z < 0.0 { Vec3::new(wi.x, wi.y, -wi.z) } else { wi };
        self.eval_pdf_in(&self.view(wo), up)
    }

    #[inline]
    fn eval_pdf_in(&self, view: &View, wi: Vec3) -> (Rgb, f32) {
        let (single, pdf) = if wi.z > 0.0 {
            let facing = self.ggx.mirror(view.wo, wi);
            let share = self.share(facing.cos, view.ior);
            (self.reflection * share * facing.value, facing.pdf * self.chance(share))
        } else {
            self.refracted(view, wi)
        };
        match &view.multiple {
            None => (single, pdf),
            Some(multiple) => {
                let (more, share) = self.eval_multiple(view, multiple, wi);
                let cosine = wi.z.abs() * FRAC_1_PI;
                (single + more * cosine, pdf * (1.0 - multiple.lost) + cosine * share * multiple.lost)
            }
        }
    }

    /// Radiance that goes through once, and its density.
    #[inline]
    fn refracted(&self, view: &View, wi: Vec3) -> (Rgb, f32) {
        let (wo, ior) = (view.wo, view.ior);
        let m = wo + wi * ior;
        let m = if m.z < 0.0 { -m } else { m };
        let squared = m.length_squared();
        let (o, i) = (wo.dot(m), -wi.dot(m));
        if o <= 0.0 || i <= 0.0 || squared <= 0.0 {
            return (Rgb::BLACK, 0.0);
        }
        let share = self.share(o / squared.sqrt(), ior);
        let (so, si, zi) = (self.ggx.stretch(wo), self.ggx.stretch(wi), -wi.z);
        // D |o·m| |i·m| / |m|²: what solid angle of normals one of directions is.
        let common = 2.0 * self.ggx.density(m) * o * i / (squared * squared);
        let value = self.transmission * (Rgb::WHITE - share) * (common * zi / (so * zi + si * wo.z));
        (value, common * ior * ior / (wo.z + so) * (1.0 - self.chance(share)))
    }

    /// What is scattered more than once, but for cosine and π: and the probability of that side.
    fn eval_multiple(&self, view: &View, multiple: &Multiple, wi: Vec3) -> (Rgb, f32) {
        let Multiple { lost, through, average } = *multiple;
        if wi.z > 0.0 {
            let out = self.lost(wi, view.ior) / average[0];
            (self.reflection * ((1.0 - through) * lost * out), 1.0 - through)
        } else {
            let out = self.lost(wi, 1.0 / view.ior) / average[1];
            (self.transmission * (through * lost * out / (view.ior * view.ior)), through)
        }
    }

    /// A direction: `u` picks a microfacet, and `choice`, in [0, 1), whether it mirrors or refracts, as often as Fresnel's
    /// equations say of it (PBR 4th ed., section 9.7.2). So what is scattered once carries the energy G2 / G1, at
    /// most 1. What is scattered more often is picked by the cosine, and carries more than 1 at grazing angles.
    #[inline]
    pub fn sample(&self, wo: Vec3, u: Vec2, choice: f32) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        if self.is_smooth() {
            let [mirrored, refracted] = self.both(wo);
            return one_of_two(mirrored, refracted, u.x);
        }
        let view = self.view(wo);
        let (wi, scatter) = self.pick(&view, u, choice)?;
        let (value, pdf) = self.eval_pdf_in(&view, wi);
        if pdf <= 0.0 {
            return None;
        }
        let ior = if wi.z < 0.0 { view.ior } else { 1.0 };
        let wi = if wo.z < 0.0 { Vec3::new(wi.x, wi.y, -wi.z) } else { wi };
        Some(BsdfSample { wi, weight: value / pdf, pdf, scatter, ior })
    }

    fn pick(&self, view: &View, u: Vec2, choice: f32) -> Option<(Vec3, Scatter)> {
        let mut x = u.x;
        if let Some(multiple) = &view.multiple {
            let (is_multiple, rest) = choose(x, multiple.lost);
            x = rest;
            if is_multiple {
                let wi = warp::cosine_hemisphere(Vec2::new(x, u.y));
                let wi = if choice < multiple.through { -wi } else { wi };
                return (wi.z != 0.0).then_some((wi, Scatter::Diffuse));
            }
        }
        let (m, _) = self.ggx.sample(view.wo, self.ggx.stretch(view.wo), Vec2::new(x, u.y));
        let share = self.share(view.wo.dot(m), view.ior);
        let (wi, is_there) = if choice < self.chance(share) {
            let wi = fresnel::reflect(view.wo, m);
            (wi, wi.z > 0.0)
        } else {
            let wi = fresnel::refract(view.wo, m, 1.0 / view.ior)?;
            (wi, wi.z < 0.0)
        };
        is_there.then_some((wi, Scatter::Glossy))
    }

    /// The two deltas of a smooth border, mirrored and refracted.
    fn both(&self, wo: Vec3) -> [BsdfSample; 2] {
        let ior = self.ior_from(wo);
        let share = if ior == 1.0 && self.film.is_none() { Rgb::BLACK } else { self.share(wo.z.abs(), ior) };
        let mirrored = delta(Vec3::new(-wo.x, -wo.y, wo.z), self.reflection * share, 1.0);
        let (wi, through) = match fresnel::refract(wo, Vec3::Z, 1.0 / ior) {
            Some(wi) => (wi, (Rgb::WHITE - share) / (ior * ior)),
            None => (-wo, Rgb::BLACK),
        };
        [mirrored, delta(wi, self.transmission * through, ior)]
    }

    /// What is mirrored and what goes through, each in its colour.
    pub fn albedo(&self, wo: Vec3) -> Rgb {
        if wo.z == 0.0 {
            return Rgb::BLACK;
        }
        let (ior, cos, alpha) = (self.ior_from(wo), wo.z.abs(), self.ggx.mean_alpha());
        if self.is_smooth() {
            let share = if ior == 1.0 && self.film.is_none() { Rgb::BLACK } else { self.share(cos, ior) };
            return self.reflection * share + self.transmission * (Rgb::WHITE - share);
        }
        let mut mirrored = energy::dielectric_mirrored(cos, alpha, ior);
        let mut through = 1.0 - mirrored - energy::dielectric_loss(self.ggx.round_cos(wo), alpha, ior);
        if let Some(Multiple { lost, through: share, .. }) = self.multiple(wo, ior) {
            mirrored += lost * (1.0 - share);
            through += lost * share;
        }
        self.reflection * mirrored + self.transmission * through
    }

    /// Mirrored and refracted, if it is smooth; not those of no weight.
    pub fn deltas(&self, wo: Vec3) -> Deltas {
        if !self.is_smooth() || wo.z == 0.0 {
            return Deltas::new();
        }
        self.both(wo).into_iter().filter(|delta| !delta.weight.is_black()).collect()
    }
}
