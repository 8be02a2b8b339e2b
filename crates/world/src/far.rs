//! Lights without a place: suns, skies, pictures of surroundings. One of them is picked by what it brings.

use super::World;
use juggler_light::background::AnyBackground;

/// The share of picks that goes to all alike, so that a place which the strong ones do not reach still finds the weak ones
/// (defensive mixture: Hesterberg 1995).
const ALIKE: f32 = 0.25;

/// Something without a place that gives off light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Far {
    /// A light of the scene, by number.
    Lamp(u32),
    /// What lies behind everything.
    Background,
}

/// All that have no place.
#[derive(Clone, Debug, Default)]
pub(super) struct FarLights(Vec<(Far, f32)>);

impl FarLights {
    /// Each with its power (luminance), all by the same measure.
    pub fn new(mut lights: Vec<(Far, f32)>) -> Self {
        let even = 1.0 / lights.len() as f32;
        let total: f32 = lights.iter().map(|(_, power)| power.max(0.0)).sum();
        // What is too strong or too weak for a share is picked evenly.
        let counts = total > 0.0 && total < f32::INFINITY && lights.len() > 1;
        for (_, power) in &mut lights {
            *power = if counts { ALIKE * even + (1.0 - ALIKE) * (power.max(0.0) / total) } else { even };
        }
        Self(lights)
    }

    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// One of them, its chance, and what is left of `u`, in [0, 1).
    pub fn pick(&self, u: f32) -> Option<(Far, f32, f32)> {
        let (mut start, last) = (0.0, self.0.len().checked_sub(1)?);
        for (place, (far, chance)) in self.0.iter().enumerate() {
            if u < start + chance || place == last {
                return Some((*far, *chance, ((u - start) / chance).clamp(0.0, 1f32.next_down())));
            }
            start += chance;
        }
        None
    }

    /// The chance of picking that one.
    pub fn chance(&self, wanted: Far) -> f32 {
        self.0.iter().find(|(far, _)| *far == wanted).map_or(0.0, |(_, chance)| *chance)
    }
}

impl World {
    /// Names of the kinds of all that gives light without a place, each with its chance when one of them is asked. Paths
    /// ask one of these as often, for each, as one of all that have a place.
    pub fn far_lights(&self) -> Vec<(&'static str, f32)> {
        let of = |(far, chance): &(Far, f32)| {
            let name = match far {
                Far::Lamp(number) => self.lamps.get(*number as usize)?.at(0.0).light.name(),
                Far::Background => self.background.name(),
            };
            Some((name, *chance))
        };
        self.emitters.far.0.iter().filter_map(of).collect()
    }

    /// What lies behind everything.
    pub fn backdrop(&self) -> &AnyBackground {
        &self.background
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Lamp, Origin, Receiver};
    use super::*;
    use juggler_light::background::Solid;
    use juggler_light::{AnyLight, Directional};
    use juggler_material::MaterialTable;
    use juggler_math::testing::{Random, close};
    use juggler_math::{Rgb, Vec3};

    /// Suns of these strengths, and a sky of that radiance.
    fn world(suns: &[f32], sky: f32) -> World {
        let sun = |intensity: &f32| Lamp::from(AnyLight::from(Directional { intensity: *intensity, ..<_>::default() }));
        let background = AnyBackground::from(Solid { color: Rgb::splat(sky) });
        World::new(Vec::new(), MaterialTable::default(), suns.iter().map(sun), background)
    }

    const TO: Receiver = Receiver { point: Vec3::ZERO, error: 0.0, normal: Vec3::ZERO, time: 0.0 };

    #[test]
    fn the_stronger_is_picked_more_often() {
        // A sky of radiance r brings 4πr from everywhere together.
        let (world, mut random) = (world(&[1.0, 30.0], 1.0), Random::new(31));
        let (mut counts, count) = ([0.0f32; 3], 200_000);
        for _ in 0..count {
            let light = world.sample_light(&TO, random.vec2()).unwrap();
            counts[if let Origin::Lamp(number) = light.origin { number as usize } else { 2 }] += 1.0 / count as f32;
            if light.origin == Origin::Background {
                assert!(close(light.pdf, world.background_pdf(light.wi), 1e-5));
            }
        }
        let (sky, even) = (4.0 * std::f32::consts::PI, ALIKE / 3.0);
        for (found, power) in counts.into_iter().zip([1.0, 30.0, sky]) {
            let chance = even + (1.0 - ALIKE) * power / (31.0 + sky);
            assert!((found - chance).abs() < 0.004, "{found} {chance}");
        }
    }

    #[test]
    fn two_suns_bring_what_they_bring_with_less_noise_than_an_even_choice() {
        let (world, mut random) = (world(&[1.0, 9.0], 0.0), Random::new(32));
        let (mut sum, mut squares, count) = (0.0, 0.0, 100_000);
        for _ in 0..count {
            let light = world.sample_light(&TO, random.vec2()).unwrap();
            let value = f64::from(light.radiance.g / light.pdf);
            (sum, squares) = (sum + value, squares + value * value);
        }
        let mean = sum / f64::from(count);
        let variance = squares / f64::from(count) - mean * mean;
        // Of an even choice: 2 · (1 + 81) - 100 = 64. Of shares 0.2 and 0.8: 1 / 0.2 + 81 / 0.8 - 100 = 6.25.
        assert!((mean - 10.0).abs() < 0.05 && variance < 8.0, "{mean} {variance}");
    }

    #[test]
    fn what_cannot_be_compared_is_picked_evenly() {
        for powers in [[0.0, 0.0], [1.0, f32::INFINITY], [f32::NAN, f32::NAN]] {
            let far = FarLights::new(vec![(Far::Lamp(0), powers[0]), (Far::Background, powers[1])]);
            assert_eq!((far.chance(Far::Lamp(0)), far.chance(Far::Background)), (0.5, 0.5), "{powers:?}");
        }
        let far = FarLights::new(vec![(Far::Lamp(3), 7.0)]);
        assert_eq!((far.pick(0.25), far.chance(Far::Background)), (Some((Far::Lamp(3), 1.0, 0.25)), 0.0));
        assert_eq!(FarLights::new(Vec::new()).pick(0.5), None);
        assert_eq!(world(&[1.0], 0.0).far_lights(), [("directional", 1.0)]);
        assert_eq!(world(&[0.0; 3], 1.0).far_lights().last().unwrap().0, "solid");
    }
}
