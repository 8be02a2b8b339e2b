//! Lobes, the parts of a [`Bsdf`](super::Bsdf): a closed set, each kind in a file of its own.

use super::{BsdfSample, Lobe, Scatter};
use crate::quadrature::{Azimuth, NODES};
use arrayvec::ArrayVec;
use juggler_math::{Rgb, Vec2, Vec3};

/// Dirac deltas of one lobe.
pub type Deltas = ArrayVec<BsdfSample, 2>;

/// Scattering of light at a point of a surface. Directions are unit vectors in the shading frame, z
/// along the shading normal; `wo` points towards the viewer, `wi` towards the light.
pub trait ScatteringLobe: Copy {
    /// f |cos θi| and the density of [`sample`](Self::sample) per steradian, both without deltas.
    fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32);

    /// Samples a direction by a point `u` in the unit square and, where
    /// [`uses_u_choice`](Self::uses_u_choice), a third number `u_choice` in [0, 1). `None` counts
    /// as absorption.
    fn sample(&self, wo: Vec3, u: Vec2, u_choice: f32) -> Option<BsdfSample>;

    /// Directional albedo: fraction of light along `wo` that the lobe scatters into all directions;
    /// see [`Bsdf::albedo`](super::Bsdf::albedo). Never black where the lobe is not.
    fn albedo(&self, wo: Vec3) -> Rgb;

    /// Largest channel of [`albedo`](Self::albedo) for each direction of a quadrature.
    fn max_albedos(&self, azimuth: Azimuth) -> [f32; NODES] {
        azimuth.directions().map(|w| self.albedo(w).max_channel())
    }

    /// Every delta with its full weight, not divided by a probability.
    fn deltas(&self, _wo: Vec3) -> Deltas {
        Deltas::new()
    }

    /// Whether the lobe consists of deltas only.
    #[inline]
    fn is_specular(&self) -> bool {
        false
    }

    /// Whether [`sample`](Self::sample) uses `u_choice`, which selects reflection or transmission
    /// at a microfacet.
    #[inline]
    fn uses_u_choice(&self) -> bool {
        false
    }

    /// Whether the lobe is so diffuse that layers over it attenuate light along `wi` as much as
    /// along `wo`.
    #[inline]
    fn attenuates_as_diffuse(&self) -> bool {
        false
    }

    /// Whether paths count the lobe's scattering as diffuse.
    #[inline]
    fn is_diffuse(&self) -> bool {
        self.attenuates_as_diffuse()
    }

    /// Mean of the microfacet distribution's roughness α along both tangents; 0 for lobes without
    /// microfacets.
    #[inline]
    fn mean_alpha(&self) -> f32 {
        0.0
    }

    /// Whether the albedo depends on the azimuth.
    #[inline]
    fn is_anisotropic(&self) -> bool {
        false
    }
}

impl Lobe {
    /// Kind of scattering of the lobe as a whole; multiple scattering between microfacets counts as
    /// the lobe does.
    pub fn scatter(&self) -> Scatter {
        if self.is_specular() {
            Scatter::Specular
        } else if self.is_diffuse() {
            Scatter::Diffuse
        } else {
            Scatter::Glossy
        }
    }

    /// Fraction, 0 to 1, of a glossy lobe under layers that is attenuated like a diffuse lobe.
    /// Fitted over roughness: spheres of white metal under coat and sheen of any roughness have an
    /// albedo within 0.01 of 1 on average and within 0.04 for each direction.
    #[inline]
    pub(crate) fn diffuse_fraction(&self) -> f32 {
        (1.5 * self.mean_alpha().sqrt() - 0.1).clamp(0.0, 0.92)
    }
}

/// Delta that is selected with probability 1.
#[inline]
pub(crate) fn delta(wi: Vec3, weight: Rgb, ior: f32) -> BsdfSample {
    BsdfSample { wi, weight, pdf: 1.0, scatter: Scatter::Specular, ior }
}

/// Deltas whose weight is not black.
pub(crate) fn nonzero_deltas(deltas: [BsdfSample; 2]) -> Deltas {
    deltas.into_iter().filter(|delta| !delta.weight.is_black()).collect()
}

/// Selects one of two deltas in proportion to their energies; `None` if both are black.
#[inline]
pub(crate) fn sample_delta_pair(first: BsdfSample, second: BsdfSample, u: f32) -> Option<BsdfSample> {
    let energy = |delta: &BsdfSample| channel_sum(delta.weight) * (delta.ior * delta.ior);
    let (a, b) = (energy(&first), energy(&second));
    if a + b <= 0.0 {
        return None;
    }
    let probability = a / (a + b);
    let (is_first, _) = super::choose(u, probability);
    let (picked, probability) = if is_first { (first, probability) } else { (second, 1.0 - probability) };
    Some(BsdfSample { weight: picked.weight / probability, pdf: probability, ..picked })
}

/// Probability of the first of two events in proportion to their weights; 0.5 if both are black.
#[inline]
pub(crate) fn selection_probability(first: Rgb, second: Rgb) -> f32 {
    let (a, b) = (channel_sum(first), channel_sum(second));
    if a + b > 0.0 { a / (a + b) } else { 0.5 }
}

/// Sum of all channels.
#[inline]
pub(crate) fn channel_sum(color: Rgb) -> f32 {
    color.r + color.g + color.b
}
