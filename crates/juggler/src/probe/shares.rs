//! Where a pixel's light comes from: by its way, its group of lights, its light, the length of its path.

use super::luminance;
use super::names::{Namer, Origin};
use super::{Branch, SampleProbe};
use juggler_camera::layer::LightGroup;
use juggler_integrator::Way;
use juggler_math::Rgb;
use juggler_render::Inspected;
use serde::Serialize;
use std::collections::BTreeMap;

/// Where a pixel's light comes from.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Light {
    /// All of it, several times: by what it can be told apart.
    #[serde(flatten)]
    pub shares: Shares,
    /// The paths of all samples, merged by what they met.
    pub paths: Branch,
    /// The brightest samples, one by one.
    pub brightest: Vec<SampleProbe>,
}

/// All light of a pixel, several times, by what it can be told apart.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Shares {
    /// What the camera sees shine, what lights light, and what comes by longer ways.
    pub ways: Vec<Share>,
    /// By group of lights, those with most light first.
    pub groups: Vec<Share>,
    /// By light, those with most light first.
    pub lights: Vec<Share>,
    /// By the stretches of the path from the camera to the light.
    pub stretches: Vec<Share>,
}

/// A part of a pixel's light.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Share {
    /// Which.
    pub name: String,
    /// What it adds to the pixel, linear RGB.
    pub light: [f64; 3],
    /// Of all light, by luminance.
    pub share: f64,
}

/// From sums over samples to what they add to the pixel.
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

/// Light of some samples, summed.
#[derive(Default)]
pub struct Sums {
    total: [f64; 3],
    ways: [[f64; 3]; 3],
    groups: BTreeMap<u16, [f64; 3]>,
    lights: BTreeMap<Origin, [f64; 3]>,
    stretches: BTreeMap<u32, [f64; 3]>,
}

/// Adds light to a sum.
pub fn add(sum: &mut [f64; 3], light: Rgb) {
    sum.iter_mut().zip(light.to_array()).for_each(|(sum, light)| *sum += f64::from(light));
}

impl Sums {
    /// Samples that are no finite numbers count as black, as the film has them.
    pub fn add(&mut self, namer: &Namer, sample: &Inspected) {
        if !sample.radiance.is_finite() {
            return;
        }
        for vertex in &sample.vertices {
            for gain in &vertex.lights {
                add(&mut self.total, gain.radiance);
                add(&mut self.ways[gain.way as usize], gain.radiance);
                add(self.groups.entry(namer.group(gain.group).0).or_default(), gain.radiance);
                add(self.lights.entry(namer.origin(vertex, gain)).or_default(), gain.radiance);
                add(self.stretches.entry(gain.stretches).or_default(), gain.radiance);
            }
        }
        if !sample.untold.is_black() {
            add(&mut self.total, sample.untold);
            add(&mut self.ways[Way::Indirect as usize], sample.untold);
        }
    }

    pub fn told(&self, namer: &Namer, scale: &Scale) -> Shares {
        let ways = ["emission", "direct", "indirect"].into_iter().zip(self.ways);
        let groups = self.groups.iter().map(|(group, sum)| (namer.group_name(LightGroup(*group)), *sum));
        let lights = self.lights.iter().map(|(origin, sum)| (namer.origin_name(*origin), *sum));
        let stretches = self.stretches.iter().map(|(count, sum)| (count.to_string(), *sum));
        let mut shares = Shares {
            ways: ways.map(|(name, sum)| scale.named(name.into(), sum)).collect(),
            groups: groups.map(|(name, sum)| scale.named(name, sum)).collect(),
            lights: lights.map(|(name, sum)| scale.named(name, sum)).collect(),
            stretches: stretches.map(|(name, sum)| scale.named(name, sum)).collect(),
        };
        for list in [&mut shares.groups, &mut shares.lights] {
            list.sort_by(|a, b| b.share.total_cmp(&a.share));
        }
        shares
    }
}
