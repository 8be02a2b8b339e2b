//! Tent filter: linear falloff from the center to the radius.
//!
//! ```json
//! {"tent": {"radius": 1}}
//! ```

use super::{FilterSampler, ReconstructionFilter};
use juggler_math::Vec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Tent filter: linear falloff from the center to the radius.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Tent {
    /// Radius in pixels, 0.1 to 16. Larger values blur more.
    #[schemars(range(min = 0.1, max = 16), extend("x-unit" = "pixels"))]
    pub radius: f32,
}

impl Tent {
    /// Creates a tent of a radius in pixels.
    pub fn new(radius: f32) -> Self {
        Self { radius }
    }
}

impl Default for Tent {
    fn default() -> Self {
        Self { radius: 1.0 }
    }
}

impl ReconstructionFilter for Tent {
    fn sampler(&self, _samples: u32) -> FilterSampler {
        FilterSampler::Tent(self.radius)
    }
}

/// Samples the unit tent by inversion of its CDF along each axis.
pub fn warp(u: Vec2) -> Vec2 {
    let one = |u: f32| if u < 0.5 { (2.0 * u).sqrt() - 1.0 } else { 1.0 - (2.0 - 2.0 * u).sqrt() };
    Vec2::new(one(u.x), one(u.y))
}

#[cfg(any(test, feature = "testing"))]
impl Tent {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default(), Self { radius: 2.0 }]
    }
}
