//! Bidirectional scattering distribution functions (BSDFs) of surfaces at one point, without names
//! or textures.
//!
//! A [`Bsdf`] is a sum of lobes in the local shading frame: z is the shading normal, `wo` points
//! towards the viewer and `wi` towards the light. Both are unit vectors and point away from the
//! surface. Values are for radiance that arrives along `wi` and leaves along `wo`: radiance that
//! crosses an interface of two media is scaled by the squared ratio of their indices of refraction,
//! because refraction changes its solid angle (Veach 1997, section 5.2; the mode `Radiance` of PBR
//! 4th ed., section 9.5.2). Particles from lights are scattered by the adjoint, which lacks that
//! scale.
//!
//! Opaque lobes are black for z <= 0: the caller that makes the `Bsdf` of a two-sided material
//! flips the frame. Dielectrics take z < 0 as their inside.

use juggler_math::{Rgb, Vec2, Vec3};

pub mod conductor;
pub mod cone;
pub mod curve;
pub mod dielectric;
pub mod diffuse_transmission;
pub mod energy;
pub mod fresnel;
pub mod ggx;
pub mod highlight;
pub mod lambert;
mod lanes;
pub mod lobe;
pub mod metals;
pub mod oren_nayar;
mod phong;
pub mod plastic;
pub mod principled;
pub mod quadrature;
pub mod sheen;
mod specular_weight;
mod sum;
pub mod thin;
pub mod thin_film;
pub mod tilted;
mod tilted_diffuse;
pub mod whitted;

#[cfg(test)]
mod contract;
#[cfg(any(test, feature = "testing"))]
pub mod testing;

pub use curve::Fresnel;
pub use lobe::{Deltas, ScatteringLobe};
pub use phong::{ConeSampling, Highlight, PhongParameters};
pub use plastic::Plastic;
pub use principled::Principled;
use quadrature::{Azimuth, NODES};
pub use specular_weight::SpecularWeight;
pub use sum::{Bsdf, BsdfView, LobeNumbers, MAX_LOBES};
pub use thin_film::ThinFilm;

juggler_math::closed_set! {
    /// Any kind of lobe; a [`Bsdf`] is a sum of a few.
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
        tilted::TiltedConductor,
        tilted_diffuse::TiltedDiffuse,
    }
    fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32);
    fn sample(&self, wo: Vec3, u: Vec2, u_choice: f32) -> Option<BsdfSample>;
    fn albedo(&self, wo: Vec3) -> Rgb;
    fn max_albedos(&self, azimuth: Azimuth) -> [f32; NODES];
    fn deltas(&self, wo: Vec3) -> Deltas;
    fn is_specular(&self) -> bool;
    fn uses_u_choice(&self) -> bool;
    fn attenuates_as_diffuse(&self) -> bool;
    fn is_diffuse(&self) -> bool;
    fn mean_alpha(&self) -> f32;
    fn is_anisotropic(&self) -> bool;
}

/// Kind of scattering that produced a direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scatter {
    /// Over the whole hemisphere.
    Diffuse,
    /// Around one direction.
    Glossy,
    /// Into one direction only: a Dirac delta, which light sampling never hits.
    Specular,
}

/// Direction sampled from a [`Bsdf`], with its weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// Direction towards the light: unit vector, shading frame.
    pub wi: Vec3,
    /// f |cos θi| / pdf; for a delta, its weight over the probability of its selection.
    pub weight: Rgb,
    /// Density per steradian of the whole `Bsdf` at `wi`, over all lobes; for a delta, the
    /// probability of its selection.
    pub pdf: f32,
    /// Kind of scattering.
    pub scatter: Scatter,
    /// Index of refraction on the side of `wi` over that on the side of `wo`; 1 unless light
    /// crosses an interface.
    pub ior: f32,
}

impl BsdfSample {
    /// Whether `wi` and `wo` are on opposite sides of the surface.
    #[inline]
    pub fn is_transmitted(&self, wo: Vec3) -> bool {
        self.wi.z * wo.z < 0.0
    }
}

/// Selects the first of two events, of this `probability`, by `u` in [0, 1). Returns whether it
/// occurs, and `u` remapped to [0, 1) for reuse.
#[inline]
pub fn choose(u: f32, probability: f32) -> (bool, f32) {
    let (first, rest) =
        if u < probability { (true, u / probability) } else { (false, (u - probability) / (1.0 - probability)) };
    (first, rest.clamp(0.0, 1f32.next_down()))
}
