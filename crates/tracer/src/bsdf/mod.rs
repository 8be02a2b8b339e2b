//! What a surface does with light at one point: numbers, no names and no textures.
//!
//! A [`Bsdf`] (bidirectional scattering distribution function) is a sum of lobes in the local frame: z is the shading
//! normal, `wo` goes towards the viewer, `wi` towards the light. Both are unit vectors and point away from the surface.
//! Values are for radiance that arrives along `wi` and leaves along `wo`: what crosses a border of media is scaled by
//! the square of the ratio of their indices of refraction, since radiance is squeezed into (or spread out of) a smaller
//! cone there (Veach 1997, section 5.2; the mode `Radiance` of PBR 4th ed., section 9.5.2). Particles from
//! lights would be scattered by the adjoint: the same values without that scale.
//!
//! Opaque lobes are black seen from z <= 0: who makes the `Bsdf` of a two-sided material turns the frame. Dielectrics
//! see z < 0 as their inside.

use arrayvec::ArrayVec;
use juggler_math::{Rgb, Vec2, Vec3};

pub mod conductor;
pub mod cone;
pub mod dielectric;
pub mod energy;
pub mod fresnel;
pub mod ggx;
pub mod lambert;
pub mod lobe;
pub mod metals;
mod phong;
pub mod thin;

#[cfg(test)]
mod contract;

pub use conductor::Conductor;
pub use dielectric::Dielectric;
pub use fresnel::Fresnel;
pub use lambert::Lambert;
pub use lobe::Lobe;
pub use phong::{Cone, Highlight, Phong};
pub use thin::ThinDielectric;

/// How a direction was scattered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scatter {
    /// Anywhere.
    Diffuse,
    /// Around a direction.
    Glossy,
    /// Into one direction only: a delta, which no light of finite size is seen by but in that very direction.
    Specular,
}

/// A direction that a [`Bsdf`] picked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// Where light comes from: unit, local.
    pub wi: Vec3,
    /// f |cos θi| over the density; of a delta its weight over the probability with which it was picked.
    pub weight: Rgb,
    /// Density per steradian of the whole `Bsdf`, all lobes together, at `wi`; of a delta the probability.
    pub pdf: f32,
    /// How it was scattered.
    pub scatter: Scatter,
    /// Index of refraction on the side of `wi` over that on the side of `wo`; 1 for what stays on its side.
    pub ior: f32,
}

impl BsdfSample {
    /// Whether the light comes from the other side than where `wo` goes.
    #[inline]
    pub fn is_transmitted(&self, wo: Vec3) -> bool {
        self.wi.z * wo.z < 0.0
    }
}

/// Lobes in one [`Bsdf`].
pub const MAX_LOBES: usize = 6;

/// Deltas in one [`Bsdf`]: a lobe has two at most.
pub const MAX_DELTAS: usize = 2 * MAX_LOBES;

/// What happens to light at one point of a surface: the sum of some lobes.
#[derive(Clone, Debug, Default)]
pub struct Bsdf {
    lobes: ArrayVec<Weighted, MAX_LOBES>,
}

/// A lobe and its share.
#[derive(Clone, Copy, Debug)]
struct Weighted {
    weight: f32,
    lobe: Lobe,
}

impl<L: Into<Lobe>> From<L> for Bsdf {
    #[inline]
    fn from(lobe: L) -> Self {
        let mut bsdf = Self::new();
        bsdf.push(lobe);
        bsdf
    }
}

/// Whether `u` in [0, 1) falls into the first `probability`, and where in its part it lies, in [0, 1) again.
#[inline]
pub(crate) fn choose(u: f32, probability: f32) -> (bool, f32) {
    let (first, rest) =
        if u < probability { (true, u / probability) } else { (false, (u - probability) / (1.0 - probability)) };
    (first, rest.clamp(0.0, 1f32.next_down()))
}

impl Bsdf {
    /// Without lobes: takes all light.
    #[inline]
    pub const fn new() -> Self {
        Self { lobes: ArrayVec::new_const() }
    }

    /// Adds a lobe. Who adds several sees to it that they give no more light than there was. More than
    /// [`MAX_LOBES`] are left out.
    #[inline]
    pub fn push(&mut self, lobe: impl Into<Lobe>) {
        self.push_scaled(lobe, 1.0);
    }

    /// Adds `weight`, 0 to 1, of a lobe; none of it at 0.
    #[inline]
    pub fn push_scaled(&mut self, lobe: impl Into<Lobe>, weight: f32) {
        if weight > 0.0 {
            let full = self.lobes.try_push(Weighted { weight, lobe: lobe.into() });
            debug_assert!(full.is_ok(), "more than {MAX_LOBES} lobes");
        }
    }

    /// The sum of f |cos θi|, without deltas.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.eval_pdf(wo, wi).0
    }

    /// The density of [`Bsdf::sample`] at `wi`, per steradian, without deltas.
    #[inline]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.eval_pdf(wo, wi).1
    }

    /// [`Bsdf::eval`] and [`Bsdf::pdf`] in one go.
    #[inline]
    pub fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        match self.lobes.as_slice() {
            [] => (Rgb::BLACK, 0.0),
            [one] => {
                let (value, pdf) = one.lobe.eval_pdf(wo, wi);
                (value * one.weight, pdf)
            }
            _ => self.eval_pdf_but(usize::MAX, &self.shares(wo), wo, wi),
        }
    }

    /// A direction where light may come from, by a point in the unit square; `None` if it is absorbed. The lobe (and
    /// what may happen within it) is chosen by `u.x`, which is stretched to the unit interval again.
    #[inline]
    pub fn sample(&self, wo: Vec3, u: Vec2) -> Option<BsdfSample> {
        match self.lobes.as_slice() {
            [] => None,
            [one] => {
                let sample = one.lobe.sample(wo, u)?;
                Some(BsdfSample { weight: sample.weight * one.weight, ..sample })
            }
            _ => self.sample_one_of_many(wo, u),
        }
    }

    fn sample_one_of_many(&self, wo: Vec3, u: Vec2) -> Option<BsdfSample> {
        let shares = self.shares(wo);
        let mut rest = u.x;
        // Rounding may leave a rest at the end, which the last lobe with a share takes.
        let mut picked = None;
        for (index, share) in shares.iter().enumerate().filter(|(_, share)| **share > 0.0) {
            picked = Some((index, *share, (rest / share).clamp(0.0, 1f32.next_down())));
            if rest < *share {
                break;
            }
            rest -= share;
        }
        let (index, share, x) = picked?;
        let one = self.lobes.get(index)?;
        let sample = one.lobe.sample(wo, Vec2::new(x, u.y))?;
        if sample.scatter == Scatter::Specular {
            return Some(BsdfSample {
                weight: sample.weight * (one.weight / share),
                pdf: sample.pdf * share,
                ..sample
            });
        }
        let (value, pdf) = self.eval_pdf_but(index, &shares, wo, sample.wi);
        let own = sample.weight * (sample.pdf * one.weight);
        let pdf = pdf + sample.pdf * share;
        Some(BsdfSample { weight: (value + own) / pdf, pdf, ..sample })
    }

    fn eval_pdf_but(&self, left_out: usize, shares: &[f32; MAX_LOBES], wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        let mut sum = (Rgb::BLACK, 0.0);
        for (index, (one, share)) in self.lobes.iter().zip(shares).enumerate() {
            if index != left_out {
                let (value, pdf) = one.lobe.eval_pdf(wo, wi);
                sum = (sum.0 + value * one.weight, sum.1 + pdf * share);
            }
        }
        sum
    }

    /// The probability of each lobe; all 0 where none gives light.
    fn shares(&self, wo: Vec3) -> [f32; MAX_LOBES] {
        let mut shares = [0.0; MAX_LOBES];
        let mut sum = 0.0;
        for (share, one) in shares.iter_mut().zip(&self.lobes) {
            let albedo = one.lobe.albedo(wo);
            *share = one.weight * (albedo.r + albedo.g + albedo.b);
            sum += *share;
        }
        if sum > 0.0 {
            shares.iter_mut().for_each(|share| *share /= sum);
        }
        shares
    }

    /// The share of the light along `wo`, were it sent in from there, that comes out again anywhere (without the scale
    /// of radiance that crosses a border): an estimate within a few percent, for denoisers and picking lobes.
    pub fn albedo(&self, wo: Vec3) -> Rgb {
        self.lobes.iter().fold(Rgb::BLACK, |sum, one| sum + one.lobe.albedo(wo) * one.weight)
    }

    /// Whether there are only deltas, or nothing at all: lights need not be asked.
    #[inline]
    pub fn is_specular(&self) -> bool {
        self.lobes.iter().all(|one| one.lobe.is_specular())
    }

    /// Whether there is any delta.
    #[inline]
    pub fn has_specular(&self) -> bool {
        self.lobes.iter().any(|one| one.lobe.has_specular())
    }

    /// Every delta with its full weight, not divided by a probability; `pdf` is 1.
    pub fn deltas(&self, wo: Vec3) -> ArrayVec<BsdfSample, MAX_DELTAS> {
        let of = |one: &Weighted| {
            let weight = one.weight;
            one.lobe.deltas(wo).into_iter().map(move |delta| BsdfSample { weight: delta.weight * weight, ..delta })
        };
        self.lobes.iter().flat_map(of).take(MAX_DELTAS).collect()
    }
}
