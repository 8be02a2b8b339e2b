//! Decomposition of a pixel's light by path kind, light group, light and path length.

use super::luminance;
use super::names::{LightOrigin, Namer};
use super::{Branch, SampleProbe};
use juggler_camera::aov::LightGroup;
use juggler_integrator::PathKind;
use juggler_math::Rgb;
use juggler_render::InspectedSample;
use serde::Serialize;
use std::collections::BTreeMap;

/// Origins of a pixel's light.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LightOrigins {
    /// Decompositions of the light.
    #[serde(flatten)]
    pub shares: Shares,
    /// Tree of the paths of all samples.
    pub paths: Branch,
    /// Brightest samples.
    pub brightest: Vec<SampleProbe>,
}

/// Decompositions of a pixel's light; the shares of each list sum to the whole.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Shares {
    /// By path kind: emission, direct and indirect lighting.
    #[serde(rename = "ways")]
    pub kinds: Vec<Share>,
    /// By light group, brightest first.
    pub groups: Vec<Share>,
    /// By light, brightest first.
    pub lights: Vec<Share>,
    /// By number of path segments between camera and light.
    #[serde(rename = "stretches")]
    pub segments: Vec<Share>,
}

/// Part of a pixel's light.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Share {
    /// Name of the path kind, light group or light, or number of segments.
    pub name: String,
    /// Contribution to the pixel, linear RGB.
    pub light: [f64; 3],
    /// Fraction of the pixel's light, by luminance.
    pub share: f64,
}

/// Conversion from sums over samples to contributions to the pixel.
pub struct Scale {
    count: f64,
    all: f64,
}

impl Scale {
    pub fn new(samples: u32, sums: &Sums) -> Self {
        Self { count: f64::from(samples.max(1)), all: luminance(sums.total) }
    }

    pub fn light(&self, sum: [f64; 3]) -> [f64; 3] {
        sum.map(|channel| channel / self.count)
    }

    pub fn share(&self, sum: [f64; 3]) -> f64 {
        if self.all == 0.0 { 0.0 } else { luminance(sum) / self.all }
    }

    fn named(&self, name: String, sum: [f64; 3]) -> Share {
        Share { name, light: self.light(sum), share: self.share(sum) }
    }
}

/// Sums of light over samples.
#[derive(Default)]
pub struct Sums {
    total: [f64; 3],
    kinds: [[f64; 3]; 3],
    groups: BTreeMap<u16, [f64; 3]>,
    lights: BTreeMap<LightOrigin, [f64; 3]>,
    segments: BTreeMap<u32, [f64; 3]>,
}

/// Adds radiance to a sum.
pub fn add(sum: &mut [f64; 3], light: Rgb) {
    sum.iter_mut().zip(light.to_array()).for_each(|(sum, light)| *sum += f64::from(light));
}

impl Sums {
    /// Adds a sample. Radiance that is not finite counts as black, as in the film.
    pub fn add(&mut self, namer: &Namer, sample: &InspectedSample) {
        if !sample.radiance.is_finite() {
            return;
        }
        for vertex in &sample.vertices {
            for contribution in &vertex.contributions {
                add(&mut self.total, contribution.radiance);
                add(&mut self.kinds[contribution.path_kind as usize], contribution.radiance);
                add(self.groups.entry(namer.group(contribution.group).0).or_default(), contribution.radiance);
                add(self.lights.entry(namer.origin(vertex, contribution)).or_default(), contribution.radiance);
                add(self.segments.entry(contribution.segments).or_default(), contribution.radiance);
            }
        }
        if !sample.unrecorded.is_black() {
            add(&mut self.total, sample.unrecorded);
            add(&mut self.kinds[PathKind::Indirect as usize], sample.unrecorded);
        }
    }

    pub fn report(&self, namer: &Namer, scale: &Scale) -> Shares {
        let kinds = ["emission", "direct", "indirect"].into_iter().zip(self.kinds);
        let groups = self.groups.iter().map(|(group, sum)| (namer.group_name(LightGroup(*group)), *sum));
        let lights = self.lights.iter().map(|(origin, sum)| (namer.origin_name(*origin), *sum));
        let segments = self.segments.iter().map(|(count, sum)| (count.to_string(), *sum));
        let mut shares = Shares {
            kinds: kinds.map(|(name, sum)| scale.named(name.into(), sum)).collect(),
            groups: groups.map(|(name, sum)| scale.named(name, sum)).collect(),
            lights: lights.map(|(name, sum)| scale.named(name, sum)).collect(),
            segments: segments.map(|(name, sum)| scale.named(name, sum)).collect(),
        };
        for list in [&mut shares.groups, &mut shares.lights] {
            list.sort_by(|a, b| b.share.total_cmp(&a.share));
        }
        shares
    }
}
