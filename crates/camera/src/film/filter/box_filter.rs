//! Box filter: uniform over the pixel.
//!
//! ```json
//! {"box": {}}
//! ```

use super::{FilterSampler, ReconstructionFilter};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Box filter: uniform over the pixel. No blur beyond the pixel, but more aliasing than wider
/// filters.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Box {}

impl ReconstructionFilter for Box {
    fn sampler(&self, _samples: u32) -> FilterSampler {
        FilterSampler::Box
    }
}

#[cfg(any(test, feature = "testing"))]
impl Box {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self {}]
    }
}
