//! Light from infinitely far away and everywhere the same: a sun with or without size.
//!
//! ```json
//! {"directional": {"direction": [1, -2, -1], "color": [1, 0.9, 0.8], "intensity": 1, "angle_degrees": 0.53}}
//! ```
//!
//! An angle gives soft shadows and nothing else: every place of the disk gives the same light, as much in all as without.

use super::{InvalidLight, Light, LightSample, check_color, check_direction, in_range};
use juggler_math::{Frame, Rgb, Vec2, Vec3, warp};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Light from infinitely far away.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Directional {
    /// The direction in which the light travels, any length.
    #[schemars(with = "[f32; 3]")]
    pub direction: Vec3,
    /// Its colour.
    pub color: Rgb,
    /// Factor on the colour.
    #[schemars(range(min = 0, max = 1e30))]
    pub intensity: f32,
    /// Under which angle its disk is seen, from rim to rim, for soft shadows: 0.53 for the sun;
    /// 0, as without it, for hard shadows.
    #[serde(skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0, max = 180))]
    pub angle_degrees: f32,
    /// How many places of the disk are asked per sample of the picture; 1 without it.
    #[serde(skip_serializing_if = "is_one")]
    #[schemars(range(min = 1, max = 10_000))]
    pub samples: u32,
    /// The group of lights that it is kept apart with in layers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light_group: Option<String>,
}

fn is_zero(angle: &f32) -> bool {
    *angle == 0.0
}

fn is_one(samples: &u32) -> bool {
    *samples == 1
}

impl Default for Directional {
    fn default() -> Self {
        let (direction, color) = (Vec3::NEG_Y, Rgb::WHITE);
        Self { direction, color, intensity: 1.0, angle_degrees: 0.0, samples: 1, light_group: None }
    }
}

impl Light for Directional {
    fn light_group(&self) -> Option<&str> {
        self.light_group.as_deref()
    }

    fn check(&self) -> Result<(), InvalidLight> {
        check_direction(self.direction)?;
        in_range("angle_degrees", self.angle_degrees, 0.0, 180.0)?;
        in_range("samples", self.samples as f32, 1.0, 10_000.0)?;
        check_color(self.color, self.intensity)
    }

    fn sample(&self, _from: Vec3, u: Vec2) -> Option<LightSample> {
        let radiance = self.color * self.intensity;
        let mut wi = -self.direction.normalize_or_zero();
        if self.angle_degrees > 0.0 && wi != Vec3::ZERO {
            let size = warp::cone_size(0.5 * self.angle_degrees.to_radians());
            wi = Frame::around(wi).to_world(warp::uniform_cone(u, size));
        }
        (!radiance.is_black() && wi != Vec3::ZERO).then_some(LightSample {
            wi,
            distance: f32::INFINITY,
            radiance,
            pdf: 1.0,
        })
    }

    fn shadow_samples(&self) -> u32 {
        if self.is_point() { 1 } else { self.samples }
    }

    fn is_point(&self) -> bool {
        self.angle_degrees == 0.0
    }

    fn power(&self, world_radius: f32) -> f32 {
        std::f32::consts::PI * world_radius * world_radius * (self.color * self.intensity).luminance()
    }
}

#[cfg(any(test, feature = "testing"))]
impl Directional {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        let sun = Self { angle_degrees: 0.53, samples: 4, ..Self::default() };
        vec![Self::default(), Self { direction: Vec3::new(1.0, 1.0, -0.5), ..Self::default() }, sun]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::fun;
    use juggler_math::testing::{Random, chi_squared};

    #[test]
    fn comes_from_where_it_travels_against() {
        let light = Directional { direction: Vec3::new(3.0, 0.0, -4.0), intensity: 2.0, ..Directional::default() };
        let sample = light.sample(Vec3::new(1e9, 0.0, 3.0), Vec2::ZERO).unwrap();
        assert!((sample.wi - Vec3::new(-0.6, 0.0, 0.8)).length() < 1e-6);
        assert_eq!((sample.distance, sample.radiance), (f32::INFINITY, Rgb::splat(2.0)));
    }

    #[test]
    fn a_disk_is_filled_evenly() {
        let light = Directional { direction: Vec3::new(1.0, -2.0, 0.5), angle_degrees: 40.0, ..Directional::default() };
        let axis = -light.direction.normalize();
        let size = warp::cone_size(20f32.to_radians());
        let sample = |u| light.sample(Vec3::ZERO, u).map(|sample| sample.wi);
        let (frame, mut random, mut observed) = (Frame::around(axis), Random::new(97), [0.0; 64]);
        for _ in 0..1_000_000 {
            let u = warp::uniform_cone_inverse(frame.to_local(sample(random.vec2()).unwrap()), size);
            observed[((u.x * 8.0) as usize).min(7) * 8 + ((u.y * 8.0) as usize).min(7)] += 1.0;
        }
        chi_squared(&observed, &[15_625.0; 64], 1e-3).unwrap();
        let rim = sample(Vec2::new(1f32.next_down(), 0.3)).unwrap();
        assert!((fun::acos(rim.dot(axis)).to_degrees() - 20.0).abs() < 1e-3);
        assert!(!light.is_point() && Directional { samples: 9, ..Directional::default() }.shadow_samples() == 1);
    }
}
