//! Ambient light: constant incident radiance from all directions.
//!
//! ```json
//! {"ambient": {"color": [1, 1, 1], "intensity": 0.1}}
//! ```

use super::{InvalidLight, Light, LightSample, check_color};
use juggler_math::{Rgb, Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Ambient light: constant incident radiance at every surface, scaled by each material's ambient
/// reflectance. Only the classic integrator uses it; with path tracing, use a background instead.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Ambient {
    /// Color of the light, linear RGB.
    pub color: Rgb,
    /// Factor on `color`.
    #[schemars(range(min = 0, max = 1e30), extend("x-unit" = "W/(scene unit² sr)"))]
    pub intensity: f32,
}

impl Ambient {
    /// Creates white ambient light of an intensity.
    pub fn new(intensity: f32) -> Self {
        Self { intensity, ..Self::default() }
    }
}

impl Default for Ambient {
    fn default() -> Self {
        Self { color: Rgb::WHITE, intensity: 0.1 }
    }
}

impl Light for Ambient {
    fn check(&self) -> Result<(), InvalidLight> {
        check_color(self.color, self.intensity)
    }

    fn sample(&self, _from: Vec3, _u: Vec2) -> Option<LightSample> {
        None
    }

    fn ambient(&self) -> Rgb {
        self.color * self.intensity
    }

    fn is_delta(&self) -> bool {
        true
    }

    fn power(&self, _world_radius: f32) -> f32 {
        0.0
    }
}

#[cfg(any(test, feature = "testing"))]
impl Ambient {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default()]
    }
}
