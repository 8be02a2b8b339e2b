//! Even over the pixel: the classic average.
//!
//! ```json
//! {"box": {}}
//! ```

use super::{Filter, Reconstruction};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Even over the pixel.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Box {}

impl Reconstruction for Box {
    fn filter(&self, _samples: u32) -> Filter {
        Filter::Box
    }
}

#[cfg(any(test, feature = "testing"))]
impl Box {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self {}]
    }
}
