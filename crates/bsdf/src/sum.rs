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

use super::{BsdfSample, Lobe, Scatter};
use arrayvec::ArrayVec;
use below::Role;
use horizon::Horizon;
use juggler_math::{Rgb, Vec2, Vec3};

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
        mean(is_anisotropic, |w| self.lobes.iter().fold(1.0, |transmittance, one| transmittance * one.transmittance(w)))
    }

    /// Sum of f |cos θi| over all lobes, without deltas.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Rgb {
        self.eval_pdf(wo, wi).0
    }

    /// Density of [`Bsdf::sample`] at `wi`, per steradian, without deltas.
    #[inline]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        self.eval_pdf(wo, wi).1
    }

    /// [`Bsdf::eval`] and [`Bsdf::pdf`] in one call.
    #[inline]
    pub fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        match &self.horizon {
            None => self.eval_pdf_of_lobes(wo, wi),
            Some(horizon) => self.eval_pdf_above(horizon, wo, wi),
        }
    }

    #[inline]
    fn eval_pdf_of_lobes(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        match self.lobes.as_slice() {
            [] => (Rgb::BLACK, 0.0),
            [one] => {
                let (value, pdf) = self.eval_pdf_of_one(one, wo, wi);
                (value * one.weight, pdf)
            }
            _ => self.eval_pdf_of_many(&self.selection_probabilities(wo), wo, wi, None),
        }
    }

    /// Samples a direction by a point `u` in the unit square; `None` if the light is absorbed.
    /// `u.x` selects the lobe (and events within it) and is remapped to the unit interval;
    /// `u_choice`, in [0, 1), selects reflection or transmission at a microfacet and is used only
    /// where [`Bsdf::uses_u_choice`].
    #[inline]
    pub fn sample(&self, wo: Vec3, u: Vec2, u_choice: f32) -> Option<BsdfSample> {
        match &self.horizon {
            None => self.sample_of_lobes(wo, u, u_choice),
            Some(horizon) => self.sample_above(horizon, wo, u, u_choice),
        }
    }

    #[inline]
    fn sample_of_lobes(&self, wo: Vec3, u: Vec2, u_choice: f32) -> Option<BsdfSample> {
        match self.lobes.as_slice() {
            [] => None,
            [one] => {
                let sample = self.sample_of_one(one, wo, u, u_choice)?;
                Some(BsdfSample { weight: sample.weight * one.weight, ..sample })
            }
            _ => self.sample_one_of_many(wo, u, u_choice),
        }
    }

    fn sample_one_of_many(&self, wo: Vec3, u: Vec2, u_choice: f32) -> Option<BsdfSample> {
        let probabilities = self.selection_probabilities(wo);
        let mut rest = u.x;
        // Rounding may leave a remainder at the end, which goes to the last lobe of nonzero
        // probability.
        let mut picked = None;
        for (index, probability) in probabilities.iter().enumerate().filter(|(_, probability)| **probability > 0.0) {
            picked = Some((index, *probability, (rest / probability).clamp(0.0, 1f32.next_down())));
            if rest < *probability {
                break;
            }
            rest -= probability;
        }
        let (index, probability, x) = picked?;
        let one = self.lobes.get(index)?;
        let u = Vec2::new(x, u.y);
        let returning = self.returning(index).filter(|_| wo.z < 0.0);
        let sample = match returning {
            Some(returning) => self.sample_under_layers(index, returning, wo, u, u_choice)?,
            None => self.sample_of_one(one, wo, u, u_choice)?,
        };
        if sample.scatter == Scatter::Specular {
            let weight = sample.weight * (one.weight * self.layer_attenuation(index, wo, sample.wi) / probability);
            return Some(BsdfSample { weight, pdf: sample.pdf * probability, ..sample });
        }
        let own = (index, (sample.weight * sample.pdf, sample.pdf));
        let (value, pdf) = self.eval_pdf_of_many(&probabilities, wo, sample.wi, returning.is_none().then_some(own));
        (pdf > 0.0).then(|| BsdfSample { weight: value / pdf, pdf, ..sample })
    }

    /// Whether [`Bsdf::sample`] uses `u_choice`.
    #[inline]
    pub fn uses_u_choice(&self) -> bool {
        self.lobes.iter().any(|one| one.lobe.uses_u_choice())
    }

    /// Sum over all lobes; value and density of one lobe may be `known`.
    fn eval_pdf_of_many(
        &self,
        probabilities: &[f32; MAX_LOBES],
        wo: Vec3,
        wi: Vec3,
        known: Option<(usize, (Rgb, f32))>,
    ) -> (Rgb, f32) {
        let (mut value, mut density) = (Rgb::BLACK, 0.0);
        let (mut transmittance_o, mut transmittance_i) = (1.0, 1.0);
        for (index, (one, probability)) in self.lobes.iter().zip(probabilities).enumerate() {
            let (part, pdf) = match known {
                Some((same, known)) if same == index => known,
                _ => self.eval_pdf_of_one(one, wo, wi),
            };
            let attenuation = one.attenuation(wo, wi, transmittance_o, transmittance_i);
            value += part * (one.weight * attenuation);
            density += match one.role.glass().and_then(|glass| probabilities.get(glass)) {
                Some(probability) => pdf * probability,
                // Some samples of the glass become samples of the lobe that returns light below.
                None if wo.z < 0.0 && wi.z > 0.0 && self.returning(index).is_some() => pdf * probability * attenuation,
                None => pdf * probability,
            };
            if one.cover > 0.0 {
                (transmittance_o, transmittance_i) =
                    (transmittance_o * one.transmittance(wo), transmittance_i * one.transmittance(wi));
            }
        }
        (value, density)
    }

    /// Attenuation of a lobe by the layers over it; 1 for the first lobe.
    #[inline]
    fn layer_attenuation(&self, index: usize, wo: Vec3, wi: Vec3) -> f32 {
        if index == 0 {
            return 1.0;
        }
        let over = self.lobes.iter().take(index);
        let (transmittance_o, transmittance_i) =
            over.fold((1.0, 1.0), |(o, i), one| (o * one.transmittance(wo), i * one.transmittance(wi)));
        self.lobes.get(index).map_or(0.0, |one| one.attenuation(wo, wi, transmittance_o, transmittance_i))
    }

    /// Probability of selecting each lobe; all 0 where every albedo is black.
    fn selection_probabilities(&self, wo: Vec3) -> [f32; MAX_LOBES] {
        let mut probabilities = [0.0; MAX_LOBES];
        let (mut sum, mut transmittance) = (0.0, 1.0);
        for (probability, one) in probabilities.iter_mut().zip(&self.lobes) {
            let albedo = self.albedo_of_one(one, wo);
            *probability = super::lobe::channel_sum(albedo) * one.weight * transmittance;
            sum += *probability;
            if one.cover > 0.0 && wo.z > 0.0 {
                transmittance *= (1.0 - one.cover * albedo.max_channel()).max(0.0);
            }
        }
        if sum > 0.0 {
            probabilities.iter_mut().for_each(|probability| *probability /= sum);
        }
        probabilities
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

    /// Every delta with its full weight, not divided by a probability; `pdf` is 1.
    #[inline]
    pub fn deltas(&self, wo: Vec3) -> impl Iterator<Item = BsdfSample> {
        let lobes = self.lobes.iter().enumerate().filter(|(_, one)| one.lobe.is_specular());
        lobes.flat_map(move |(index, one)| {
            self.deltas_of_one(one, wo).into_iter().map(move |delta| {
                let weight = one.weight * self.layer_attenuation(index, wo, delta.wi);
                self.delta_above(BsdfSample { weight: delta.weight * weight, ..delta })
            })
        })
    }
}

/// Cosine-weighted mean of a function over directions above: ∫ 2 μ f(μ) dμ = ∫ 4 s³ f(s²) ds by
/// five-point Gauss-Legendre quadrature. Functions of anisotropic surfaces are evaluated at
/// azimuths of 22.5 and 67.5 degrees, others at 45.
fn mean(is_anisotropic: bool, f: impl Fn(Vec3) -> f32) -> f32 {
    const NODES: [(f32, f32); 5] = [
        (0.046_910_077, 0.118_463_44),
        (0.230_765_34, 0.239_314_34),
        (0.5, 0.284_444_45),
        (0.769_234_66, 0.239_314_34),
        (0.953_089_9, 0.118_463_44),
    ];
    // Squared cosine of 22.5 and of 45 degrees.
    let (near, scale) = if is_anisotropic { (0.853_553_4, 0.5) } else { (0.5, 1.0) };
    NODES.iter().fold(0.0, |sum, (s, weight)| {
        let cos = s * s;
        let sin2 = 1.0 - cos * cos;
        let (x, y) = ((sin2 * near).max(0.0).sqrt(), (sin2 * (1.0 - near)).max(0.0).sqrt());
        let mut value = f(Vec3::new(x, y, cos));
        if is_anisotropic {
            value += f(Vec3::new(y, x, cos));
        }
        sum + weight * 4.0 * s * cos * value * scale
    })
}
