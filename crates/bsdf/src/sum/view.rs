//! A BSDF for one viewer. What depends on the viewer alone is computed once for all directions of
//! light.

use super::{Bsdf, MAX_LOBES};
use crate::lobe::channel_sum;
use crate::{BsdfSample, Scatter};
use juggler_math::{Rgb, Vec2, Vec3};

/// A [`Bsdf`] for a viewer along `wo`.
#[derive(Clone, Copy, Debug)]
pub struct BsdfView<'a> {
    pub(super) bsdf: &'a Bsdf,
    pub(super) wo: Vec3,
    /// Numbers of the lobes; `None` unless there are several.
    lobes: Option<&'a LobeNumbers>,
}

/// Numbers of several lobes for one viewer. A [`BsdfView`] borrows them, since they are large and
/// most surfaces have a single lobe.
#[derive(Clone, Copy, Debug)]
pub struct LobeNumbers {
    /// Probability of selecting each lobe; all 0 where every albedo is black.
    probabilities: [f32; MAX_LOBES],
    /// Transmittance of each lobe to the lobes after it.
    transmittances: [f32; MAX_LOBES],
}

impl LobeNumbers {
    /// Computes the numbers of all lobes for a viewer along `wo`.
    #[inline(never)]
    fn new(bsdf: &Bsdf, wo: Vec3) -> Self {
        let (mut probabilities, mut transmittances) = ([0.0; MAX_LOBES], [1.0; MAX_LOBES]);
        let (mut sum, mut transmittance) = (0.0, 1.0);
        let numbers = probabilities.iter_mut().zip(&mut transmittances);
        for ((probability, own), one) in numbers.zip(&bsdf.lobes) {
            let albedo = bsdf.albedo_of_one(one, wo);
            *probability = channel_sum(albedo) * one.weight * transmittance;
            sum += *probability;
            if one.cover > 0.0 && wo.z > 0.0 {
                *own = (1.0 - one.cover * albedo.max_channel()).max(0.0);
                transmittance *= *own;
            }
        }
        if sum > 0.0 {
            probabilities.iter_mut().for_each(|probability| *probability /= sum);
        }
        Self { probabilities, transmittances }
    }
}

impl Bsdf {
    /// Numbers of the lobes for a viewer along `wo`; `None` unless there are several.
    #[inline]
    pub fn lobe_numbers(&self, wo: Vec3) -> Option<LobeNumbers> {
        (self.lobes.len() > 1).then(|| LobeNumbers::new(self, wo))
    }

    /// The BSDF for a viewer along `wo`, with the [`Bsdf::lobe_numbers`] of that viewer.
    #[inline]
    pub fn view<'a>(&'a self, wo: Vec3, lobes: Option<&'a LobeNumbers>) -> BsdfView<'a> {
        BsdfView { bsdf: self, wo, lobes }
    }
}

impl<'a> BsdfView<'a> {
    /// Unit vector towards the viewer.
    #[inline]
    pub fn wo(&self) -> Vec3 {
        self.wo
    }

    /// Sum of f |cos θi| over all lobes, without deltas.
    #[inline]
    pub fn eval(&self, wi: Vec3) -> Rgb {
        self.eval_pdf(wi).0
    }

    /// Density of [`BsdfView::sample`] at `wi`, per steradian, without deltas.
    #[inline]
    pub fn pdf(&self, wi: Vec3) -> f32 {
        self.eval_pdf(wi).1
    }

    /// [`BsdfView::eval`] and [`BsdfView::pdf`] in one call.
    #[inline]
    pub fn eval_pdf(&self, wi: Vec3) -> (Rgb, f32) {
        match &self.bsdf.horizon {
            None => self.eval_pdf_of_lobes(wi),
            Some(horizon) => self.eval_pdf_above(horizon, wi),
        }
    }

    #[inline]
    pub(super) fn eval_pdf_of_lobes(&self, wi: Vec3) -> (Rgb, f32) {
        match (self.bsdf.lobes.as_slice(), self.lobes) {
            ([one], _) => {
                let (value, pdf) = self.bsdf.eval_pdf_of_one(one, self.wo, wi);
                (value * one.weight, pdf)
            }
            (_, Some(numbers)) => self.eval_pdf_of_many(numbers, wi, None),
            (_, None) => (Rgb::BLACK, 0.0),
        }
    }

    /// Samples a direction by a point `u` in the unit square; `None` if the light is absorbed.
    /// `u.x` selects the lobe (and events within it) and is remapped to the unit interval;
    /// `u_choice`, in [0, 1), selects reflection or transmission at a microfacet and is used only
    /// where [`Bsdf::uses_u_choice`].
    #[inline]
    pub fn sample(&self, u: Vec2, u_choice: f32) -> Option<BsdfSample> {
        match &self.bsdf.horizon {
            None => self.sample_of_lobes(u, u_choice),
            Some(horizon) => self.sample_above(horizon, u, u_choice),
        }
    }

    #[inline]
    pub(super) fn sample_of_lobes(&self, u: Vec2, u_choice: f32) -> Option<BsdfSample> {
        match (self.bsdf.lobes.as_slice(), self.lobes) {
            ([one], _) => {
                let sample = self.bsdf.sample_of_one(one, self.wo, u, u_choice)?;
                Some(BsdfSample { weight: sample.weight * one.weight, ..sample })
            }
            (_, numbers) => self.sample_one_of_many(numbers?, u, u_choice),
        }
    }

    fn sample_one_of_many(&self, numbers: &LobeNumbers, u: Vec2, u_choice: f32) -> Option<BsdfSample> {
        let Self { bsdf, wo, .. } = *self;
        let mut rest = u.x;
        // Rounding may leave a remainder at the end, which goes to the last lobe of nonzero
        // probability.
        let mut picked = None;
        for (index, probability) in
            numbers.probabilities.iter().enumerate().filter(|(_, probability)| **probability > 0.0)
        {
            picked = Some((index, *probability, (rest / probability).clamp(0.0, 1f32.next_down())));
            if rest < *probability {
                break;
            }
            rest -= probability;
        }
        let (index, probability, x) = picked?;
        let one = bsdf.lobes.get(index)?;
        let u = Vec2::new(x, u.y);
        let returning = bsdf.returning(index).filter(|_| wo.z < 0.0);
        let sample = match returning {
            Some(returning) => bsdf.sample_under_layers(index, returning, wo, u, u_choice)?,
            None => bsdf.sample_of_one(one, wo, u, u_choice)?,
        };
        if sample.scatter == Scatter::Specular {
            let attenuation = self.layer_attenuation(index, sample.wi);
            let weight = sample.weight * (one.weight * attenuation / probability);
            return Some(BsdfSample { weight, pdf: sample.pdf * probability, ..sample });
        }
        let own = (index, (sample.weight * sample.pdf, sample.pdf));
        let (value, pdf) = self.eval_pdf_of_many(numbers, sample.wi, returning.is_none().then_some(own));
        (pdf > 0.0).then(|| BsdfSample { weight: value / pdf, pdf, ..sample })
    }

    /// Sum over all lobes; value and density of one lobe may be `known`.
    fn eval_pdf_of_many(&self, numbers: &LobeNumbers, wi: Vec3, known: Option<(usize, (Rgb, f32))>) -> (Rgb, f32) {
        let Self { bsdf, wo, .. } = *self;
        let (mut value, mut density) = (Rgb::BLACK, 0.0);
        let (mut transmittance_o, mut transmittance_i) = (1.0, 1.0);
        let probabilities = &numbers.probabilities;
        let by_lobe = probabilities.iter().zip(&numbers.transmittances);
        for (index, (one, (probability, through))) in bsdf.lobes.iter().zip(by_lobe).enumerate() {
            let (part, pdf) = match known {
                Some((same, known)) if same == index => known,
                _ => bsdf.eval_pdf_of_one(one, wo, wi),
            };
            let attenuation = one.attenuation(wo, wi, transmittance_o, transmittance_i);
            value += part * (one.weight * attenuation);
            density += match one.role.glass().and_then(|glass| probabilities.get(glass)) {
                Some(probability) => pdf * probability,
                // Some samples of the glass become samples of the lobe that returns light below.
                None if wo.z < 0.0 && wi.z > 0.0 && bsdf.returning(index).is_some() => pdf * probability * attenuation,
                None => pdf * probability,
            };
            if one.cover > 0.0 {
                (transmittance_o, transmittance_i) =
                    (transmittance_o * through, transmittance_i * one.transmittance(wi));
            }
        }
        (value, density)
    }

    /// Attenuation of a lobe by the layers over it; 1 for the first lobe.
    #[inline]
    pub(super) fn layer_attenuation(&self, index: usize, wi: Vec3) -> f32 {
        if index == 0 { 1.0 } else { self.attenuation_by_layers(index, wi) }
    }

    #[inline(never)]
    fn attenuation_by_layers(&self, index: usize, wi: Vec3) -> f32 {
        let (Some(numbers), Some(one)) = (self.lobes, self.bsdf.lobes.get(index)) else { return 1.0 };
        let over = self.bsdf.lobes.iter().zip(&numbers.transmittances).take(index);
        let (transmittance_o, transmittance_i) =
            over.fold((1.0, 1.0), |(o, i), (one, through)| (o * through, i * one.transmittance(wi)));
        one.attenuation(self.wo, wi, transmittance_o, transmittance_i)
    }

    /// Every delta with its full weight, not divided by a probability; `pdf` is 1.
    #[inline]
    pub fn deltas(self) -> impl Iterator<Item = BsdfSample> + 'a {
        let lobes = self.bsdf.lobes.iter().enumerate().filter(|(_, one)| one.lobe.is_specular());
        lobes.flat_map(move |(index, one)| {
            self.bsdf.deltas_of_one(one, self.wo).into_iter().map(move |delta| {
                let weight = one.weight * self.layer_attenuation(index, delta.wi);
                self.bsdf.delta_above(BsdfSample { weight: delta.weight * weight, ..delta })
            })
        })
    }
}
