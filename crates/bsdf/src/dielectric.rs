//! The border between two clear media, polished or rough: mirrored and refracted light (Walter, Marschner, Li and
//! Torrance 2007) with [GGX](super::ggx) normals and Fresnel's equations.
//!
//! [`Dielectric::compensated`] adds what is scattered more than once between microfacets (after Kulla and Conty
//! 2017). With L(w) what single scattering loses, its mean L̄, and T̄ the mean of what it transmits, each for the side of
//! the direction, light that is lost leaves on its own side as (1 - b) L(wo) L(wi) / (π L̄), and on the other as
//! c T̄o Lo(wo) Li(wi) / (π L̄o L̄i), where b = c T̄ / L̄ on each side. As T̄o = η² T̄i (with η the index on the side of i over
//! that on the side of o), that is reciprocal for any c; we take the largest that gives neither side more than what
//! it transmits of what it scatters once. L comes from [tables](super::energy::InterfaceLoss) for round and stretched surfaces.
//!
//! Sampling follows the light: a visible normal reflects or refracts, and the direction is taken with probability G2 / G1;
//! otherwise, that is with the very probability L(wo), one is drawn in proportion to L(wi) cos θi. Samples of a white interface
//! so carry a weight of 1, whatever the tables miss: no energy is gained or lost along a path, and none of its weights grow.
//! Values and densities know L from the tables only, which are within 0.002 of it for plain glass. Under a thin film, whose share
//! of reflection no table knows, L is taken to be that of the plain interface.

use super::energy::{self, InterfaceLoss, Scramble, Side};
use super::ggx::Ggx;
use super::lobe::{Deltas, delta, one_of_two, share_of_first, sum, visible};
use super::{BsdfSample, Film, Scatter, choose, fresnel};
use crate::ScatteringLobe;
use juggler_math::{Rgb, Vec2, Vec3};
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
    compensation: Option<Compensation>,
}

/// Scattering more than once, on average over directions; from above, and from below.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Compensation {
    /// L̄.
    lost: [f32; 2],
    /// b: how much of what is lost comes out on the other side.
    through: [f32; 2],
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
    loss: InterfaceLoss,
    /// The side of `wo`, and the other one.
    sides: [Side; 2],
    /// L(wo): also the probability.
    lost: f32,
    /// b: how much of it comes out on the other side.
    through: f32,
    /// L̄ on the side of `wo`, and on the other.
    average: [f32; 2],
}

/// The mean loss below which an interface needs no compensation.
const LEAST_LOSS: f32 = 1e-5;

impl Dielectric {
    /// An index of refraction closer to 1 than this counts as smooth, however rough: directions of light that
    /// goes through are spread by no more than this.
    pub const NO_BORDER: f32 = 1e-3;

    /// With single scattering only. `alpha` as in [`Ggx`]; `ior` is the index below the surface (-z) over that above.
    #[inline]
    pub fn new(ior: f32, alpha: Vec2) -> Self {
        let ior = if ior > 0.0 && ior.is_finite() { ior } else { 1.0 };
        let ggx = if (ior - 1.0).abs() < Self::NO_BORDER { Ggx::isotropic(0.0) } else { Ggx::new(alpha) };
        Self { ggx, ior, reflection: Rgb::WHITE, transmission: Rgb::WHITE, film: None, compensation: None }
    }

    /// With all scattering among its microfacets.
    #[inline]
    pub fn compensated(ior: f32, alpha: Vec2) -> Self {
        let single = Self::new(ior, alpha);
        Self { compensation: single.averages(), ..single }
    }

    fn averages(&self) -> Option<Compensation> {
        if self.is_smooth() {
            return None;
        }
        let loss = InterfaceLoss::new(self.ggx, self.ior);
        let [above, below] = [self.ior, 1.0 / self.ior].map(|ior| loss.mean(Side::of(ior)));
        if above.min(below) < LEAST_LOSS {
            return None;
        }
        // What goes through on average, from the side of the larger cone, and by reciprocity the other way.
        let (outer, dense) = if self.ior > 1.0 { (above, self.ior) } else { (below, 1.0 / self.ior) };
        let outwards = (1.0 - energy::dielectric_mirrored_average(self.ggx.mean_alpha(), dense) - outer).max(0.0);
        let inwards = outwards / (dense * dense);
        let [from_above, from_below] = if self.ior > 1.0 { [outwards, inwards] } else { [inwards, outwards] };
        // The largest c that gives neither side more than what it transmits of what it scatters once.
        let c = (above / (1.0 - above)).min(below / (1.0 - below));
        Some(Compensation {
            lost: [above, below],
            through: [(c * from_above / above).min(1.0), (c * from_below / below).min(1.0)],
        })
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

    /// How often a microfacet that mirrors this share is to mirror: as often as Fresnel's equations say, so that what is lost is
    /// L(wo), or without compensation by what each direction carries.
    #[inline]
    fn chance(&self, share: Rgb) -> f32 {
        if self.compensation.is_some() {
            return sum(share) * (1.0 / 3.0);
        }
        share_of_first(self.reflection * share, self.transmission * (Rgb::WHITE - share))
    }

    /// Scattering more than once of light along `wo`, which is turned up; `ior` is the index behind over in front of it.
    #[inline]
    fn multiple(&self, wo: Vec3, ior: f32) -> Option<Multiple> {
        let Compensation { lost: [above, below], through } = self.compensation?;
        let loss = InterfaceLoss::new(self.ggx, ior);
        let sides = [Side::of(ior), Side::of(1.0 / ior)];
        let is_above = ior == self.ior;
        let average = if is_above { [above, below] } else { [below, above] };
        let through = through[usize::from(!is_above)];
        Some(Multiple { loss, sides, lost: loss.at(sides[0], wo), through, average })
    }

    #[inline]
    fn eval_pdf_in(&self, view: &View, wi: Vec3) -> (Rgb, f32) {
        let (single, pdf) = if wi.z > 0.0 {
            let facing = self.ggx.mirror(view.wo, wi);
            let share = self.share(facing.cos, view.ior);
            let pdf = if view.multiple.is_some() { facing.value } else { facing.pdf };
            (self.reflection * share * facing.value, pdf * self.chance(share))
        } else {
            self.refracted(view, wi)
        };
        match &view.multiple {
            None => (single, pdf),
            Some(multiple) => {
                let (more, density) = self.eval_multiple(view, multiple, wi);
                (single + more, pdf + density)
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
        let scattered = zi / (so * zi + si * wo.z);
        let value = self.transmission * (Rgb::WHITE - share) * (common * scattered);
        let picked = if view.multiple.is_some() { scattered } else { 1.0 / (wo.z + so) };
        (value, common * ior * ior * picked * (1.0 - self.chance(share)))
    }

    /// What is scattered more than once, and its density.
    fn eval_multiple(&self, view: &View, multiple: &Multiple, wi: Vec3) -> (Rgb, f32) {
        let Multiple { loss, sides, lost, through, average } = *multiple;
        let (side, mean, color, share, scale) = if wi.z > 0.0 {
            (sides[0], average[0], self.reflection, 1.0 - through, 1.0)
        } else {
            (sides[1], average[1], self.transmission, through, view.ior * view.ior)
        };
        let density = share * lost * loss.at(side, wi) / mean * (wi.z.abs() * FRAC_1_PI);
        (color * (density / scale), density)
    }

    fn pick(&self, view: &View, u: Vec2, choice: f32) -> Option<(Vec3, Scatter)> {
        let so = self.ggx.stretch(view.wo);
        let (m, _) = self.ggx.sample(view.wo, so, u);
        let share = self.share(view.wo.dot(m), view.ior);
        let (is_reflected, rest) = choose(choice, self.chance(share));
        let once = if is_reflected {
            Some(fresnel::reflect(view.wo, m)).filter(|wi| wi.z > 0.0)
        } else {
            fresnel::refract(view.wo, m, 1.0 / view.ior).filter(|wi| wi.z < 0.0)
        };
        let Some(multiple) = &view.multiple else { return once.map(|wi| (wi, Scatter::Glossy)) };
        // Take the direction with probability G2 / G1.
        let taken = once.filter(|wi| rest < self.ggx.unmasked(view.wo.z, so, wi.z.abs(), self.ggx.stretch(*wi)));
        if let Some(wi) = taken {
            return Some((wi, Scatter::Glossy));
        }
        let mut random = Scramble::new(u, choice);
        let is_through = random.unit() < multiple.through;
        let wi = multiple.loss.sample(multiple.sides[usize::from(is_through)], &mut random);
        Some((if is_through { Vec3::new(wi.x, wi.y, -wi.z) } else { wi }, Scatter::Diffuse))
    }

    /// The two deltas of a smooth border, mirrored and refracted.
    fn both(&self, wo: Vec3) -> [BsdfSample; 2] {
        let ior = self.ior_from(wo);
        let share = self.smooth_share(wo.z.abs(), ior);
        let mirrored = delta(Vec3::new(-wo.x, -wo.y, wo.z), self.reflection * share, 1.0);
        let (wi, through) = match fresnel::refract(wo, Vec3::Z, 1.0 / ior) {
            Some(wi) => (wi, (Rgb::WHITE - share) / (ior * ior)),
            None => (-wo, Rgb::BLACK),
        };
        [mirrored, delta(wi, self.transmission * through, ior)]
    }

    /// The shares of light along `wo` that are mirrored and that go through, but for their colors.
    pub(super) fn parts(&self, wo: Vec3) -> [f32; 2] {
        let (ior, cos) = (self.ior_from(wo), wo.z.abs());
        if self.is_smooth() {
            let share = sum(self.smooth_share(cos, ior)) / 3.0;
            return [share, 1.0 - share];
        }
        let up = Vec3::new(wo.x, wo.y, cos);
        let mirrored = energy::dielectric_mirrored(cos, self.ggx.mean_alpha(), ior);
        let multiple = self.multiple(up, ior);
        let lost = multiple.map_or_else(|| InterfaceLoss::new(self.ggx, ior).at(Side::of(ior), up), |all| all.lost);
        let through = (1.0 - mirrored - lost).max(0.0);
        match multiple {
            Some(Multiple { lost, through: share, .. }) => [mirrored + lost * (1.0 - share), through + lost * share],
            None => [mirrored, through],
        }
    }

    #[inline]
    fn smooth_share(&self, cos: f32, ior: f32) -> Rgb {
        if ior == 1.0 && self.film.is_none() { Rgb::BLACK } else { self.share(cos, ior) }
    }

    /// What a microfacet with the normal `m` transmits of light along one of two directions that it mirrors into each other, and
    /// where light of each goes; all is turned over, so that light comes from below the interface along directions above.
    #[inline]
    pub(super) fn leaving(&self, along: [Vec3; 2], m: Vec3) -> Option<(f32, [Vec3; 2])> {
        let [a, b] = along.map(|w| fresnel::refract(w, m, self.ior));
        let share = self.smooth_share(along[0].dot(m).clamp(0.0, 1.0), 1.0 / self.ior);
        Some((1.0 - sum(share) / 3.0, [a?, b?]))
    }

    /// The size of the cone of directions below into which the interface refracts all of those above, over the whole hemisphere:
    /// 1 / η².
    #[inline]
    pub(super) fn shrunk_below(&self) -> f32 {
        1.0 / (self.ior * self.ior)
    }

    /// The share of light from below at an angle of this cosine that the interface transmits if it is polished.
    #[inline]
    pub(super) fn polished_share_below(&self, cos: f32) -> f32 {
        1.0 - fresnel::dielectric(cos.min(1.0), 1.0 / self.ior)
    }

    /// The mean of [`Dielectric::polished_share_below`] over all directions, each weighted by its cosine.
    pub(super) fn polished_transmittance_below(&self) -> f32 {
        1.0 - fresnel::dielectric_average(1.0 / self.ior)
    }

    /// Whether both alphas are the same.
    #[inline]
    pub(super) fn is_round(&self) -> bool {
        self.ggx.is_round()
    }

    /// Alpha along x and y.
    #[inline]
    pub(super) fn alpha(&self) -> Vec2 {
        self.ggx.alpha()
    }
}

impl ScatteringLobe for Dielectric {
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
        let up = if wo.z < 0.0 { Vec3::new(wi.x, wi.y, -wi.z) } else { wi };
        self.eval_pdf_in(&self.view(wo), up)
    }

    /// A direction: `u` picks a microfacet, and `choice`, in [0, 1), whether it mirrors or refracts, as often as Fresnel's
    /// equations say of it (PBR 4th ed., section 9.7.2). Without compensation, the sample carries the energy G2 / G1.
    #[inline]
    fn sample(&self, wo: Vec3, u: Vec2, choice: f32) -> Option<BsdfSample> {
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

    /// What is mirrored and what goes through, each in its colour.
    fn albedo(&self, wo: Vec3) -> Rgb {
        if wo.z == 0.0 {
            return Rgb::BLACK;
        }
        if self.is_smooth() {
            let share = self.smooth_share(wo.z.abs(), self.ior_from(wo));
            return self.reflection * share + self.transmission * (Rgb::WHITE - share);
        }
        let [mirrored, through] = self.parts(wo);
        self.reflection * mirrored + self.transmission * through
    }

    /// Mirrored and refracted, if it is smooth; not those of no weight.
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
