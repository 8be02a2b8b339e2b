//! Gaussian filter, truncated at the radius and offset to end at zero (PBR 4th ed., section 8.8).
//!
//! ```json
//! {"gaussian": {"radius": 1.5, "sigma": 0.5}}
//! ```

use super::{FilterSampler, FilterTable, ReconstructionFilter};
use juggler_math::portable;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Gaussian filter: soft, without ringing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Gaussian {
    /// Radius of the filter in pixels, 0.1 to 16.
    #[schemars(range(min = 0.1, max = 16), extend("x-unit" = "pixels"))]
    pub radius: f32,
    /// Standard deviation in pixels, 0.05 to 16. Larger values blur more.
    #[schemars(range(min = 0.05, max = 16), extend("x-unit" = "pixels"))]
    pub sigma: f32,
}

impl Gaussian {
    /// Creates a Gaussian of a standard deviation `sigma`, cut off at a radius, both in pixels.
    pub fn new(radius: f32, sigma: f32) -> Self {
        Self { radius, sigma }
    }
}

impl Default for Gaussian {
    fn default() -> Self {
        Self { radius: 1.5, sigma: 0.5 }
    }
}

impl ReconstructionFilter for Gaussian {
    fn sampler(&self, _samples: u32) -> FilterSampler {
        let bell = |x: f32| portable::exp(-x * x / (2.0 * self.sigma * self.sigma));
        let end = bell(self.radius);
        FilterSampler::Table(Arc::new(FilterTable::new(self.radius, |x| (bell(x) - end).max(0.0))))
    }
}

#[cfg(any(test, feature = "testing"))]
impl Gaussian {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default()]
    }
}
