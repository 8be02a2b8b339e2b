//! Light from infinitely far away, parallel and everywhere the same: a sun without size.
//!
//! ```json
//! {"directional": {"direction": [1, -2, -1], "color": [1, 0.9, 0.8], "intensity": 1}}
//! ```

use super::{InvalidLight, Light, LightSample, check_color, check_direction};
use juggler_math::{Rgb, Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parallel light from infinitely far away.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Directional {
    /// The direction in which the light travels, any length.
    #[schemars(with = "[f32; 3]")]
    pub direction: Vec3,
    /// Its colour.
    pub color: Rgb,
    /// Factor on the colour.
    #[schemars(range(min = 0))]
    pub intensity: f32,
}

impl Default for Directional {
    fn default() -> Self {
        Self { direction: Vec3::NEG_Y, color: Rgb::WHITE, intensity: 1.0 }
    }
}

impl Light for Directional {
    fn check(&self) -> Result<(), InvalidLight> {
        check_direction(self.direction)?;
        check_color(self.color, self.intensity)
    }

    fn sample(&self, _from: Vec3, _u: Vec2) -> Option<LightSample> {
        let radiance = self.color * self.intensity;
        let wi = -self.direction.normalize_or_zero();
        (!radiance.is_black() && wi != Vec3::ZERO).then_some(LightSample {
            wi,
            distance: f32::INFINITY,
            radiance,
            pdf: 1.0,
        })
    }

    fn is_point(&self) -> bool {
        true
    }

    fn power(&self, world_radius: f32) -> f32 {
        std::f32::consts::PI * world_radius * world_radius * (self.color * self.intensity).luminance()
    }
}

#[cfg(test)]
impl Directional {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default(), Self { direction: Vec3::new(1.0, 1.0, -0.5), ..Self::default() }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comes_from_where_it_travels_against() {
        let light = Directional { direction: Vec3::new(3.0, 0.0, -4.0), intensity: 2.0, ..Directional::default() };
        let sample = light.sample(Vec3::new(1e9, 0.0, 3.0), Vec2::ZERO).unwrap();
        assert!((sample.wi - Vec3::new(-0.6, 0.0, 0.8)).length() < 1e-6);
        assert_eq!((sample.distance, sample.radiance), (f32::INFINITY, Rgb::splat(2.0)));
    }
}
