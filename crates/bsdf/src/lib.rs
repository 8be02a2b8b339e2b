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

use juggler_math::{Rgb, Vec2, Vec3};

pub mod conductor;
pub mod cone;
pub mod curve;
pub mod dielectric;
pub mod diffuse_transmission;
pub mod energy;
pub mod film;
pub mod fresnel;
pub mod ggx;
pub mod highlight;
pub mod lambert;
pub mod lobe;
pub mod metals;
pub mod oren_nayar;
mod phong;
pub mod plastic;
pub mod principled;
pub mod sheen;
mod sum;
pub mod thin;
pub mod whitted;

#[cfg(test)]
mod contract;
#[cfg(any(test, feature = "testing"))]
pub mod testing;

pub use curve::Fresnel;
pub use film::Film;
pub use lobe::{Deltas, ScatteringLobe};
pub use phong::{Cone, Highlight, Phong};
pub use plastic::Plastic;
pub use principled::Principled;
pub use sum::{Bsdf, MAX_DELTAS, MAX_LOBES};

juggler_math::closed_set! {
    /// Every lobe, a few of which make a [`Bsdf`].
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub enum Lobe: static ScatteringLobe {
        lambert::Lambert,
        conductor::Conductor,
        dielectric::Dielectric,
        thin::ThinDielectric,
        oren_nayar::OrenNayar,
        diffuse_transmission::DiffuseTransmission,
        sheen::Sheen,
        highlight::PhongHighlight,
        whitted::Whitted,
    }
    fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32);
    fn sample(&self, wo: Vec3, u: Vec2, choice: f32) -> Option<BsdfSample>;
    fn albedo(&self, wo: Vec3) -> Rgb;
    fn deltas(&self, wo: Vec3) -> Deltas;
    fn is_specular(&self) -> bool;
    fn has_choice(&self) -> bool;
    fn is_matt(&self) -> bool;
    fn is_diffuse(&self) -> bool;
    fn mean_alpha(&self) -> f32;
    fn is_stretched(&self) -> bool;
}

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

/// Whether `u` in [0, 1) falls into the first `probability`, and where in its part it lies, in [0, 1) again.
#[inline]
pub fn choose(u: f32, probability: f32) -> (bool, f32) {
    let (first, rest) =
        if u < probability { (true, u / probability) } else { (false, (u - probability) / (1.0 - probability)) };
    (first, rest.clamp(0.0, 1f32.next_down()))
}
