//! Selection of one infinite light: directional light, sky or environment map, by power.

use super::World;
use juggler_light::background::AnyBackground;

/// Fraction of the selection probability that is uniform, so that points which the strong lights do
/// not reach still sample the weak ones (defensive mixture: Hesterberg 1995).
const UNIFORM_FRACTION: f32 = 0.25;

/// An infinite light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum InfiniteLight {
    /// A light of the scene, by index.
    Light(u32),
    /// The background.
    Background,
}

/// All infinite lights with their selection probabilities.
#[derive(Clone, Debug, Default)]
pub(super) struct InfiniteLights(Vec<(InfiniteLight, f32)>);

impl InfiniteLights {
    /// Creates the distribution from each light's power (luminance), all in the same unit.
    pub fn new(mut lights: Vec<(InfiniteLight, f32)>) -> Self {
        let even = 1.0 / lights.len() as f32;
        let total: f32 = lights.iter().map(|(_, power)| power.max(0.0)).sum();
        // Use equal probabilities if the powers cannot be normalized.
        let is_proportional = total > 0.0 && total < f32::INFINITY && lights.len() > 1;
        for (_, power) in &mut lights {
            *power = if is_proportional {
                UNIFORM_FRACTION * even + (1.0 - UNIFORM_FRACTION) * (power.max(0.0) / total)
            } else {
                even
            };
        }
        Self(lights)
    }

    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Selects a light: its identity, its probability, and `u` rescaled to [0, 1).
    pub fn pick(&self, u: f32) -> Option<(InfiniteLight, f32, f32)> {
        let (mut start, last) = (0.0, self.0.len().checked_sub(1)?);
        for (index, (light, probability)) in self.0.iter().enumerate() {
            if u < start + probability || index == last {
                return Some((*light, *probability, ((u - start) / probability).clamp(0.0, 1f32.next_down())));
            }
            start += probability;
        }
        None
    }

    /// Probability of selecting `light`.
    pub fn probability(&self, light: InfiniteLight) -> f32 {
        self.0.iter().find(|(other, _)| *other == light).map_or(0.0, |(_, probability)| *probability)
    }
}

impl World {
    /// Kind names of all infinite lights, each with its probability among them. Paths sample each
    /// infinite light on average as often as all finite emitters together.
    pub fn infinite_lights(&self) -> Vec<(&'static str, f32)> {
        let named = |(light, probability): &(InfiniteLight, f32)| {
            let name = match light {
                InfiniteLight::Light(index) => self.lights.get(*index as usize)?.at(0.0).light.name(),
                InfiniteLight::Background => self.background.name(),
            };
            Some((name, *probability))
        };
        self.emitters.infinite.0.iter().filter_map(named).collect()
    }

    /// Background of the world.
    pub fn background(&self) -> &AnyBackground {
        &self.background
    }
}

#[cfg(test)]
mod tests {
    use super::super::{EmitterId, LightSampleContext, SceneLight};
    use super::*;
    use juggler_light::background::Solid;
    use juggler_light::{AnyLight, Directional};
    use juggler_material::MaterialTable;
    use juggler_math::testing::{Random, close};
    use juggler_math::{Rgb, Vec3};

    /// A world with directional lights of these intensities and a sky of this radiance.
    fn world(suns: &[f32], sky: f32) -> World {
        let sun =
            |intensity: &f32| SceneLight::from(AnyLight::from(Directional { intensity: *intensity, ..<_>::default() }));
        let background = AnyBackground::from(Solid { color: Rgb::splat(sky) });
        World::new(
            Vec::new(),
            MaterialTable::default(),
            suns.iter().map(sun),
            background,
            &juggler_math::BuildControl::default(),
        )
        .unwrap()
    }

    const CONTEXT: LightSampleContext =
        LightSampleContext { point: Vec3::ZERO, error: 0.0, normal: Vec3::ZERO, time: 0.0 };

    #[test]
    fn infinite_lights_are_sampled_in_proportion_to_power() {
        // A sky of radiance L has the power 4π L here.
        let (world, mut random) = (world(&[1.0, 30.0], 1.0), Random::new(31));
        let (mut counts, count) = ([0.0f32; 3], 200_000);
        for _ in 0..count {
            let light = world.sample_light(&CONTEXT, random.vec2()).unwrap();
            counts[if let EmitterId::Light(index) = light.emitter { index as usize } else { 2 }] += 1.0 / count as f32;
            if light.emitter == EmitterId::Background {
                assert!(close(light.pdf, world.background_pdf(light.wi), 1e-5));
            }
        }
        let (sky, even) = (4.0 * std::f32::consts::PI, UNIFORM_FRACTION / 3.0);
        for (found, power) in counts.into_iter().zip([1.0, 30.0, sky]) {
            let probability = even + (1.0 - UNIFORM_FRACTION) * power / (31.0 + sky);
            assert!((found - probability).abs() < 0.004, "{found} {probability}");
        }
    }

    #[test]
    fn power_sampling_of_two_suns_is_unbiased_with_lower_variance() {
        let (world, mut random) = (world(&[1.0, 9.0], 0.0), Random::new(32));
        let (mut sum, mut squares, count) = (0.0, 0.0, 100_000);
        for _ in 0..count {
            let light = world.sample_light(&CONTEXT, random.vec2()).unwrap();
            let value = f64::from(light.radiance.g / light.pdf);
            (sum, squares) = (sum + value, squares + value * value);
        }
        let mean = sum / f64::from(count);
        let variance = squares / f64::from(count) - mean * mean;
        // Variance of uniform selection: 2 · (1 + 81) - 100 = 64. Of probabilities 0.2 and 0.8: 1 /
        // 0.2 + 81 / 0.8 - 100 = 6.25.
        assert!((mean - 10.0).abs() < 0.05 && variance < 8.0, "{mean} {variance}");
    }

    #[test]
    fn incomparable_lights_are_sampled_uniformly() {
        for powers in [[0.0, 0.0], [1.0, f32::INFINITY], [f32::NAN, f32::NAN]] {
            let lights =
                InfiniteLights::new(vec![(InfiniteLight::Light(0), powers[0]), (InfiniteLight::Background, powers[1])]);
            assert_eq!(
                (lights.probability(InfiniteLight::Light(0)), lights.probability(InfiniteLight::Background)),
                (0.5, 0.5),
                "{powers:?}"
            );
        }
        let lights = InfiniteLights::new(vec![(InfiniteLight::Light(3), 7.0)]);
        assert_eq!(
            (lights.pick(0.25), lights.probability(InfiniteLight::Background)),
            (Some((InfiniteLight::Light(3), 1.0, 0.25)), 0.0)
        );
        assert_eq!(InfiniteLights::new(Vec::new()).pick(0.5), None);
        assert_eq!(world(&[1.0], 0.0).infinite_lights(), [("directional", 1.0)]);
        assert_eq!(world(&[0.0; 3], 1.0).infinite_lights().last().unwrap().0, "solid");
    }
}
