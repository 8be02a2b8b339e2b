//! A point that shines the same in every direction.
//!
//! ```json
//! {"point": {"position": [0, 4, 0], "color": [1, 1, 1], "intensity": 60}}
//! ```

use super::{Light, LightSample};
use juggler_math::{Rgb, Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A point that shines the same in every direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Point {
    /// Where it is, world space.
    #[schemars(with = "[f32; 3]")]
    pub position: Vec3,
    /// Its colour.
    pub color: Rgb,
    /// Factor on the colour.
    #[schemars(range(min = 0))]
    pub intensity: f32,
}

impl Default for Point {
    fn default() -> Self {
        Self { position: Vec3::ZERO, color: Rgb::WHITE, intensity: 1.0 }
    }
}

impl Light for Point {
    fn sample(&self, from: Vec3, _u: Vec2) -> Option<LightSample> {
        let to = self.position - from;
        let distance = to.length();
        let radiance = self.color * (self.intensity / (distance * distance));
        (distance > 0.0).then(|| LightSample { wi: to / distance, distance, radiance, pdf: 1.0 })
    }

    fn power(&self, _world_radius: f32) -> f32 {
        4.0 * std::f32::consts::PI * self.intensity * self.color.luminance()
    }
}

#[cfg(test)]
impl Point {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self { position: Vec3::new(0.0, 4.0, 0.0), ..Self::default() }]
    }
}
