//! A Gaussian, cut at the radius and lowered so that it ends at zero (PBR 4th ed., section 8.8).
//!
//! ```json
//! {"gaussian": {"radius": 1.5, "sigma": 0.5}}
//! ```

use super::{Filter, Reconstruction, Table};
use juggler_math::fun;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Soft, without ringing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Gaussian {
    /// Where it ends, in pixels.
    #[schemars(range(min = 0.1, max = 16))]
    pub radius: f32,
    /// Standard deviation in pixels.
    #[schemars(range(min = 0.05, max = 16))]
    pub sigma: f32,
}

impl Default for Gaussian {
    fn default() -> Self {
        Self { radius: 1.5, sigma: 0.5 }
    }
}

impl Reconstruction for Gaussian {
    fn filter(&self, _samples: u32) -> Filter {
        let bell = |x: f32| fun::exp(-x * x / (2.0 * self.sigma * self.sigma));
        let end = bell(self.radius);
        Filter::Table(Arc::new(Table::new(self.radius, |x| (bell(x) - end).max(0.0))))
    }
}

#[cfg(any(test, feature = "testing"))]
impl Gaussian {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default()]
    }
}
