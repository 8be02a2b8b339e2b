//! Lobes, the parts of a [`Bsdf`](super::Bsdf): a closed set, each kind in a file of its own.

use super::{BsdfSample, Lobe, Scatter};
use arrayvec::ArrayVec;
use juggler_math::{Rgb, Vec2, Vec3};

/// Deltas of one lobe.
pub type Deltas = ArrayVec<BsdfSample, 2>;

/// Scattering of light at a point of a surface. Directions are unit vectors in the shading frame,
/// z along the shading normal; `wo` points to the viewer, `wi` to where light comes from.
pub trait ScatteringLobe: Copy {
    /// f |cos θi| and the density of [`sample`](Self::sample) per steradian, both without deltas.
    fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32);

    /// Samples a direction, by a point `u` in the unit square and, where
    /// [`has_choice`](Self::has_choice), a third number `choice` in [0, 1).
    fn sample(&self, wo: Vec3, u: Vec2, choice: f32) -> Option<BsdfSample>;

    /// Share of light from `wo` that the lobe scatters anywhere; see
    /// [`Bsdf::albedo`](super::Bsdf::albedo). Never black where the lobe is not.
    fn albedo(&self, wo: Vec3) -> Rgb;

    /// Every delta with its full weight.
    fn deltas(&self, _wo: Vec3) -> Deltas {
        Deltas::new()
    }

    /// Whether the lobe consists of deltas only.
    #[inline]
    fn is_specular(&self) -> bool {
        false
    }

    /// Whether single microfacets reflect some light and transmit some, between which a third
    /// number chooses.
    #[inline]
    fn has_choice(&self) -> bool {
        false
    }

    /// Whether the lobe spreads light so evenly that what lies over it shows in `wi` as much as in
    /// `wo`.
    #[inline]
    fn is_matt(&self) -> bool {
        false
    }

    /// Whether paths count the lobe's scattering as diffuse.
    #[inline]
    fn is_diffuse(&self) -> bool {
        self.is_matt()
    }

    /// Mean of the microfacet distribution's roughness α along both tangents; 0 for lobes without
    /// microfacets.
    #[inline]
    fn mean_alpha(&self) -> f32 {
        0.0
    }

    /// Whether the albedo depends on the azimuth.
    #[inline]
    fn is_stretched(&self) -> bool {
        false
    }
}

impl Lobe {
    /// Scattering that paths count for the lobe; multiple scattering of a rough mirror counts as
    /// its rest.
    pub fn scatter(&self) -> Scatter {
        if self.is_specular() {
            Scatter::Specular
        } else if self.is_diffuse() {
            Scatter::Diffuse
        } else {
            Scatter::Glossy
        }
    }

    /// Share of a glossy lobe under layers that spreads light like a matt one, 0 to 1: fitted by
    /// its roughness, so that balls of white metal stay white within 0.01 on average under coat and
    /// sheen of any roughness, and each direction within 0.04.
    #[inline]
    pub(crate) fn spread(&self) -> f32 {
        (1.5 * self.mean_alpha().sqrt() - 0.1).clamp(0.0, 0.92)
    }
}

/// A delta of weight 1 picked for sure.
#[inline]
pub(crate) fn delta(wi: Vec3, weight: Rgb, ior: f32) -> BsdfSample {
    BsdfSample { wi, weight, pdf: 1.0, scatter: Scatter::Specular, ior }
}

/// Deltas whose weight is not black.
pub(crate) fn visible(deltas: [BsdfSample; 2]) -> Deltas {
    deltas.into_iter().filter(|delta| !delta.weight.is_black()).collect()
}

/// One of two deltas, by the energy that each carries.
#[inline]
pub(crate) fn one_of_two(first: BsdfSample, second: BsdfSample, u: f32) -> Option<BsdfSample> {
    let energy = |delta: &BsdfSample| sum(delta.weight) * (delta.ior * delta.ior);
    let (a, b) = (energy(&first), energy(&second));
    if a + b <= 0.0 {
        return None;
    }
    let probability = a / (a + b);
    let (is_first, _) = super::choose(u, probability);
    let (picked, probability) = if is_first { (first, probability) } else { (second, 1.0 - probability) };
    Some(BsdfSample { weight: picked.weight / probability, pdf: probability, ..picked })
}

/// How often to take the first of two parts of light: by what each carries.
#[inline]
pub(crate) fn share_of_first(first: Rgb, second: Rgb) -> f32 {
    let (a, b) = (sum(first), sum(second));
    if a + b > 0.0 { a / (a + b) } else { 0.5 }
}

/// Of all channels.
#[inline]
pub(crate) fn sum(color: Rgb) -> f32 {
    color.r + color.g + color.b
}
