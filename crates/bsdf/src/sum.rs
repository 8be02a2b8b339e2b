//! Sum of lobes, side by side or in layers.
//!
//! A layer attenuates the lobes pushed after it, so that both together conserve energy. With T(μ)
//! its transmittance, one minus its albedo, a diffuse lobe is attenuated by T(μo) T(μi) / T̄ (the
//! mean T̄ over all directions keeps a white one white), a mirror by the smaller of T(μo) and
//! T(μi), which are the same. A glossy lobe is attenuated by T(μo) T(μi) / √(A(μo) A(μi)), where A
//! goes from T for a mirror to T̄ for a diffuse lobe. All of these are reciprocal, while glTF's
//! attenuation by T(μo) alone is not.
//!
//! Light that layers keep from leaving a surface that is also lit from below goes back there: see
//! [`below`]. Light that a perturbed shading normal would scatter below the geometric surface is
//! redistributed above it: see [`horizon`].

mod below;
mod horizon;
mod view;

use super::{BsdfSample, Lobe, Scatter};
use crate::lanes::lanes;
use crate::quadrature::{self, Azimuth, NODES};
use arrayvec::ArrayVec;
use below::Role;
use horizon::Horizon;
use juggler_math::{Rgb, Vec2, Vec3};
pub use view::{BsdfView, LobeNumbers};

/// Maximum number of lobes of a [`Bsdf`].
pub const MAX_LOBES: usize = 9;

/// BSDF at one point of a surface: the sum of its lobes.
#[derive(Clone, Debug, Default)]
pub struct Bsdf {
    lobes: ArrayVec<WeightedLobe, MAX_LOBES>,
    /// The geometric surface, where a map has perturbed the shading normal.
    horizon: Option<Horizon>,
}

/// A lobe with its weight and its interaction with layers.
#[derive(Clone, Copy, Debug)]
struct WeightedLobe {
    weight: f32,
    /// 1 / T̄ of a diffuse or glossy lobe under layers; m̄ of a returning lobe.
    scale: f32,
    /// Factor on the lobe's albedo by which it attenuates lobes after it; 0 if it is no layer.
    cover: f32,
    /// Fraction, 0 to 1, of a glossy lobe under layers that is attenuated like a diffuse one; for a
    /// returning lobe, the constant part of h.
    diffuse_fraction: f32,
    role: Role,
    lobe: Lobe,
}

impl WeightedLobe {
    #[inline]
    fn new(lobe: impl Into<Lobe>, weight: f32) -> Self {
        Self { weight, scale: 1.0, cover: 0.0, diffuse_fraction: 0.0, role: Role::Upright, lobe: lobe.into() }
    }

    /// Transmittance of light along `w` to the lobes after it.
    #[inline]
    fn transmittance(&self, w: Vec3) -> f32 {
        if self.cover == 0.0 || w.z <= 0.0 {
            return 1.0;
        }
        (1.0 - self.cover * self.lobe.albedo(w).max_channel()).max(0.0)
    }

    /// Attenuation by the layers over it, from their transmittances along both directions.
    #[inline]
    fn attenuation(&self, wo: Vec3, wi: Vec3, transmittance_o: f32, transmittance_i: f32) -> f32 {
        if self.role != Role::Upright {
            return 1.0;
        }
        match (self.lobe.attenuates_as_diffuse(), wo.z > 0.0 && wi.z > 0.0) {
            (false, true) if self.diffuse_fraction > 0.0 => {
                let around =
                    |transmittance: f32| transmittance + self.diffuse_fraction * (1.0 / self.scale - transmittance);
                transmittance_o * transmittance_i
                    / (around(transmittance_o) * around(transmittance_i)).max(f32::MIN_POSITIVE).sqrt()
            }
            (false, _) => transmittance_o.min(transmittance_i),
            (true, true) => transmittance_o * transmittance_i * self.scale,
            (true, false) => transmittance_o * transmittance_i,
        }
    }
}

impl<L: Into<Lobe>> From<L> for Bsdf {
    #[inline]
    fn from(lobe: L) -> Self {
        let mut bsdf = Self::new();
        bsdf.push(lobe);
        bsdf
    }
}

impl Bsdf {
    /// BSDF without lobes: absorbs all light.
    #[inline(always)]
    pub fn new() -> Self {
        Self { lobes: ArrayVec::new(), horizon: None }
    }

    /// BSDF of the lobes that `add` pushes.
    #[inline]
    pub fn with_lobes(add: impl FnOnce(&mut Self)) -> Self {
        let mut bsdf = Self::new();
        add(&mut bsdf);
        bsdf
    }

    /// Adds a lobe. The caller ensures that lobes side by side conserve energy. Lobes beyond
    /// [`MAX_LOBES`] are dropped.
    #[inline]
    pub fn push(&mut self, lobe: impl Into<Lobe>) {
        self.push_scaled(lobe, 1.0);
    }

    /// Adds a lobe with `weight`, 0 to 1; nothing at 0.
    #[inline]
    pub fn push_scaled(&mut self, lobe: impl Into<Lobe>, weight: f32) {
        self.push_any(WeightedLobe::new(lobe, weight));
    }

    /// Adds a lobe with `weight`, 0 to 1, as a layer that attenuates lobes pushed later.
    #[inline]
    pub fn push_layer(&mut self, lobe: impl Into<Lobe>, weight: f32) {
        self.push_any(WeightedLobe { cover: weight, ..WeightedLobe::new(lobe, weight) });
    }

    /// Adds a layer that attenuates lobes pushed later by `cover` times its albedo.
    #[inline]
    pub fn push_partial_layer(&mut self, lobe: impl Into<Lobe>, cover: f32) {
        self.push_any(WeightedLobe { cover, ..WeightedLobe::new(lobe, 1.0) });
    }

    /// Adds a lobe with `weight` that attenuates lobes pushed later by its full albedo: they belong
    /// to the same fraction of the surface.
    #[inline]
    pub fn push_coat(&mut self, lobe: impl Into<Lobe>, weight: f32) {
        self.push_any(WeightedLobe { cover: 1.0, ..WeightedLobe::new(lobe, weight) });
    }

    #[inline]
    fn push_any(&mut self, mut lobe: WeightedLobe) {
        if lobe.weight > 0.0 {
            if lobe.role == Role::Upright && self.lobes.iter().any(|one| one.cover > 0.0) {
                lobe.diffuse_fraction = if lobe.cover > 0.0 { 0.0 } else { lobe.lobe.diffuse_fraction() };
                if lobe.lobe.attenuates_as_diffuse() || lobe.diffuse_fraction > 0.0 {
                    lobe.scale = 1.0 / self.mean_transmittance().max(1e-3);
                }
            }
            let full = self.lobes.try_push(lobe);
            debug_assert!(full.is_ok(), "more than {MAX_LOBES} lobes");
        }
    }

    /// Removes scattering of the kinds that `is_removed` accepts; layers still attenuate lower
    /// lobes.
    pub fn remove_scattering(&mut self, is_removed: impl Fn(Scatter) -> bool) {
        self.lobes.iter_mut().filter(|one| is_removed(one.lobe.scatter())).for_each(|one| one.weight = 0.0);
    }

    /// Cosine-weighted mean transmittance of all layers.
    fn mean_transmittance(&self) -> f32 {
        let is_anisotropic = self.lobes.iter().any(|one| one.cover > 0.0 && one.lobe.is_anisotropic());
        quadrature::mean(is_anisotropic, |azimuth| layer_transmittances(&self.lobes, azimuth))
    }

    /// [`BsdfView::eval`] for a single direction of light.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.view(wo, self.lobe_numbers(wo).as_ref()).eval(wi)
    }

    /// [`BsdfView::pdf`] for a single direction of light.
    #[inline]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.view(wo, self.lobe_numbers(wo).as_ref()).pdf(wi)
    }

    /// [`BsdfView::eval_pdf`] for a single direction of light.
    #[inline]
    pub fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        self.view(wo, self.lobe_numbers(wo).as_ref()).eval_pdf(wi)
    }

    /// [`BsdfView::sample`] for a single sample.
    #[inline]
    pub fn sample(&self, wo: Vec3, u: Vec2, u_choice: f32) -> Option<BsdfSample> {
        self.view(wo, self.lobe_numbers(wo).as_ref()).sample(u, u_choice)
    }

    /// [`BsdfView::deltas`] where nothing else is evaluated.
    #[inline]
    pub fn deltas(&self, wo: Vec3) -> Vec<BsdfSample> {
        self.view(wo, self.lobe_numbers(wo).as_ref()).deltas().collect()
    }

    /// Whether [`BsdfView::sample`] uses `u_choice`.
    #[inline]
    pub fn uses_u_choice(&self) -> bool {
        self.lobes.iter().any(|one| one.lobe.uses_u_choice())
    }

    /// Directional albedo: fraction of light along `wo` that is scattered into all directions,
    /// without the scale of radiance that crosses an interface. An estimate within a few percent,
    /// for denoisers and the selection of lobes.
    pub fn albedo(&self, wo: Vec3) -> Rgb {
        let mut transmittance = 1.0;
        self.lobes.iter().fold(Rgb::BLACK, |sum, one| {
            let sum = sum + self.albedo_of_one(one, wo) * (one.weight * transmittance);
            transmittance *= one.transmittance(wo);
            sum
        })
    }

    /// Whether there are only deltas or no lobes at all, so that light sampling has no effect.
    #[inline]
    pub fn is_specular(&self) -> bool {
        self.lobes.iter().all(|one| one.lobe.is_specular())
    }

    /// Whether any lobe is glossy: neither diffuse nor a delta.
    #[inline]
    pub fn is_glossy(&self) -> bool {
        self.lobes.iter().any(|one| one.lobe.scatter() == Scatter::Glossy)
    }

    /// Kind of scattering of the lobe of the largest weight that is no delta; specular if there is
    /// none.
    pub fn scatter(&self) -> Scatter {
        let non_specular = self.lobes.iter().filter(|one| !one.lobe.is_specular());
        let heaviest = non_specular.max_by(|a, b| a.weight.total_cmp(&b.weight));
        heaviest.map_or(Scatter::Specular, |one| one.lobe.scatter())
    }

    /// Whether any lobe transmits light diffusely, as a leaf does.
    #[inline]
    pub fn transmits_diffusely(&self) -> bool {
        self.lobes.iter().any(|one| matches!(one.lobe, Lobe::DiffuseTransmission(_)))
    }

    /// Whether there is any delta.
    #[inline]
    pub fn has_specular(&self) -> bool {
        self.lobes.iter().any(|one| one.lobe.is_specular())
    }
}

/// Transmittance of layers for each direction of a quadrature.
fn layer_transmittances(layers: &[WeightedLobe], azimuth: Azimuth) -> [f32; NODES] {
    layers.iter().filter(|one| one.cover != 0.0).fold([1.0; NODES], |transmittances, one| {
        let albedos = one.lobe.max_albedos(azimuth);
        lanes(|node| transmittances[node] * (1.0 - one.cover * albedos[node]).max(0.0))
    })
}
