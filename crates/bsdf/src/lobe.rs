//! The lobes that a [`Bsdf`](super::Bsdf) is made of: a closed set, each in a file of its own.

use super::{
    BsdfSample, Conductor, Dielectric, DiffuseTransmission, Lambert, OrenNayar, PhongHighlight, Scatter, Sheen,
    ThinDielectric, Whitted,
};
use arrayvec::ArrayVec;
use juggler_math::{Rgb, Vec2, Vec3};

/// Deltas of one lobe.
pub type Deltas = ArrayVec<BsdfSample, 2>;

/// One way of scattering light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lobe {
    /// Matt.
    Lambert(Lambert),
    /// Metal.
    Conductor(Conductor),
    /// A border between clear media.
    Dielectric(Dielectric),
    /// A pane of glass.
    Thin(ThinDielectric),
    /// Rough matt.
    OrenNayar(OrenNayar),
    /// Matt on both sides.
    DiffuseTransmission(DiffuseTransmission),
    /// Cloth.
    Sheen(Sheen),
    /// A classic highlight.
    Highlight(PhongHighlight),
    /// A classic mirror and window.
    Whitted(Whitted),
}

impl From<Lambert> for Lobe {
    #[inline]
    fn from(lobe: Lambert) -> Self {
        Self::Lambert(lobe)
    }
}

impl From<Conductor> for Lobe {
    #[inline]
    fn from(lobe: Conductor) -> Self {
        Self::Conductor(lobe)
    }
}

impl From<Dielectric> for Lobe {
    #[inline]
    fn from(lobe: Dielectric) -> Self {
        Self::Dielectric(lobe)
    }
}

impl From<ThinDielectric> for Lobe {
    #[inline]
    fn from(lobe: ThinDielectric) -> Self {
        Self::Thin(lobe)
    }
}

impl From<OrenNayar> for Lobe {
    #[inline]
    fn from(lobe: OrenNayar) -> Self {
        Self::OrenNayar(lobe)
    }
}

impl From<DiffuseTransmission> for Lobe {
    #[inline]
    fn from(lobe: DiffuseTransmission) -> Self {
        Self::DiffuseTransmission(lobe)
    }
}

impl From<Sheen> for Lobe {
    #[inline]
    fn from(lobe: Sheen) -> Self {
        Self::Sheen(lobe)
    }
}

impl From<PhongHighlight> for Lobe {
    #[inline]
    fn from(lobe: PhongHighlight) -> Self {
        Self::Highlight(lobe)
    }
}

impl From<Whitted> for Lobe {
    #[inline]
    fn from(lobe: Whitted) -> Self {
        Self::Whitted(lobe)
    }
}

impl Lobe {
    /// f |cos θi| and the density of [`Lobe::sample`] per steradian, both without deltas.
    #[inline]
    pub fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        match self {
            Self::Lambert(lobe) => lobe.eval_pdf(wo, wi),
            Self::Conductor(lobe) => lobe.eval_pdf(wo, wi),
            Self::Dielectric(lobe) => lobe.eval_pdf(wo, wi),
            Self::Thin(lobe) => lobe.eval_pdf(wo, wi),
            Self::OrenNayar(lobe) => lobe.eval_pdf(wo, wi),
            Self::DiffuseTransmission(lobe) => lobe.eval_pdf(wo, wi),
            Self::Sheen(lobe) => lobe.eval_pdf(wo, wi),
            Self::Highlight(lobe) => lobe.eval_pdf(wo, wi),
            Self::Whitted(_) => (Rgb::BLACK, 0.0),
        }
    }

    /// A direction, by a point in the unit square and, where [`Lobe::has_choice`], a third number in [0, 1).
    #[inline]
    pub fn sample(&self, wo: Vec3, u: Vec2, choice: f32) -> Option<BsdfSample> {
        match self {
            Self::Lambert(lobe) => lobe.sample(wo, u),
            Self::Conductor(lobe) => lobe.sample(wo, u),
            Self::Dielectric(lobe) => lobe.sample(wo, u, choice),
            Self::Thin(lobe) => lobe.sample(wo, u, choice),
            Self::OrenNayar(lobe) => lobe.sample(wo, u),
            Self::DiffuseTransmission(lobe) => lobe.sample(wo, u),
            Self::Sheen(lobe) => lobe.sample(wo, u),
            Self::Highlight(lobe) => lobe.sample(wo, u),
            Self::Whitted(lobe) => lobe.sample(wo, u),
        }
    }

    /// Whether single microfacets mirror some light and let some through, between which a third number chooses.
    #[inline]
    pub fn has_choice(&self) -> bool {
        matches!(self, Self::Dielectric(_) | Self::Thin(_)) && !self.is_specular()
    }

    /// See [`Bsdf::albedo`](super::Bsdf::albedo). Never black where the lobe is not.
    #[inline]
    pub fn albedo(&self, wo: Vec3) -> Rgb {
        match self {
            Self::Lambert(lobe) => {
                if wo.z > 0.0 {
                    lobe.albedo
                } else {
                    Rgb::BLACK
                }
            }
            Self::Conductor(lobe) => lobe.albedo(wo),
            Self::Dielectric(lobe) => lobe.albedo(wo),
            Self::Thin(lobe) => lobe.albedo(wo),
            Self::OrenNayar(lobe) => lobe.albedo(wo),
            Self::DiffuseTransmission(lobe) => lobe.albedo(wo),
            Self::Sheen(lobe) => lobe.albedo(wo),
            Self::Highlight(lobe) => lobe.albedo(wo),
            Self::Whitted(lobe) => lobe.albedo(wo),
        }
    }

    /// Whether there are only deltas.
    #[inline]
    pub fn is_specular(&self) -> bool {
        match self {
            Self::Lambert(_) | Self::OrenNayar(_) | Self::DiffuseTransmission(_) => false,
            Self::Sheen(_) | Self::Highlight(_) => false,
            Self::Whitted(_) => true,
            Self::Conductor(lobe) => lobe.is_smooth(),
            Self::Dielectric(lobe) => lobe.is_smooth(),
            Self::Thin(lobe) => lobe.is_smooth(),
        }
    }

    /// How it scatters for the most part: what a rough mirror scatters more than once counts as the rest of it.
    pub fn scatter(&self) -> Scatter {
        if self.is_specular() {
            Scatter::Specular
        } else if self.is_matt() || matches!(self, Self::Sheen(_)) {
            Scatter::Diffuse
        } else {
            Scatter::Glossy
        }
    }

    /// Whether it spreads light so evenly that what lies over it shows in `wi` as much as in `wo`.
    #[inline]
    pub fn is_matt(&self) -> bool {
        matches!(self, Self::Lambert(_) | Self::OrenNayar(_) | Self::DiffuseTransmission(_))
    }

    /// How much of a glossy lobe under layers spreads light like a matt one, 0 to 1: fitted by its roughness, so that balls of
    /// white metal stay white within 0.01 on average under coat and sheen of any roughness, and each direction within 0.04.
    #[inline]
    pub(crate) fn spread(&self) -> f32 {
        let alpha = match self {
            Self::Conductor(lobe) => lobe.mean_alpha(),
            Self::Dielectric(lobe) => lobe.mean_alpha(),
            Self::Thin(lobe) => lobe.mean_alpha(),
            _ => 0.0,
        };
        (1.5 * alpha.sqrt() - 0.1).clamp(0.0, 0.92)
    }

    /// Whether its albedo depends on the azimuth.
    #[inline]
    pub(crate) fn is_stretched(&self) -> bool {
        matches!(self, Self::Conductor(lobe) if !lobe.is_round())
    }

    /// Whether there is any delta.
    #[inline]
    pub fn has_specular(&self) -> bool {
        self.is_specular()
    }

    /// Every delta with its full weight.
    pub fn deltas(&self, wo: Vec3) -> Deltas {
        match self {
            Self::Lambert(_) | Self::OrenNayar(_) | Self::DiffuseTransmission(_) => Deltas::new(),
            Self::Sheen(_) | Self::Highlight(_) => Deltas::new(),
            Self::Whitted(lobe) => lobe.deltas(wo),
            Self::Conductor(lobe) => lobe.deltas(wo),
            Self::Dielectric(lobe) => lobe.deltas(wo),
            Self::Thin(lobe) => lobe.deltas(wo),
        }
    }
}

/// A delta of weight 1 picked for sure.
#[inline]
pub(crate) fn delta(wi: Vec3, weight: Rgb, ior: f32) -> BsdfSample {
    BsdfSample { wi, weight, pdf: 1.0, scatter: Scatter::Specular, ior }
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
