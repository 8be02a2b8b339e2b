//! Cubic filter of Mitchell and Netravali (SIGGRAPH 1988): sharp, with small negative lobes.
//!
//! ```json
//! {"mitchell": {"b": 0.333, "c": 0.333}}
//! ```

use super::{FilterSampler, FilterTable, ReconstructionFilter};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Cubic filter of Mitchell and Netravali: sharp, with small negative lobes and a radius of 2
/// pixels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Mitchell {
    /// Parameter B, 0 to 1: larger values blur more. The authors recommend B + 2C = 1.
    #[schemars(range(min = 0, max = 1))]
    pub b: f32,
    /// Parameter C, 0 to 1: larger values are sharper and ring more.
    #[schemars(range(min = 0, max = 1))]
    pub c: f32,
}

impl Mitchell {
    /// Creates Mitchell's filter of the parameters B and C.
    pub fn new(b: f32, c: f32) -> Self {
        Self { b, c }
    }
}

impl Default for Mitchell {
    fn default() -> Self {
        Self { b: 1.0 / 3.0, c: 1.0 / 3.0 }
    }
}

impl ReconstructionFilter for Mitchell {
    fn sampler(&self, _samples: u32) -> FilterSampler {
        FilterSampler::Table(Arc::new(FilterTable::new(2.0, |x| value(x, self.b, self.c))))
    }
}

/// Filter along one axis, radius 2 (Mitchell and Netravali 1988, equation 8).
pub fn value(x: f32, b: f32, c: f32) -> f32 {
    let x = x.abs();
    let cubic = |a3: f32, a2: f32, a1: f32, a0: f32| ((a3 * x + a2) * x + a1) * x + a0;
    if x < 1.0 {
        cubic(12.0 - 9.0 * b - 6.0 * c, -18.0 + 12.0 * b + 6.0 * c, 0.0, 6.0 - 2.0 * b) / 6.0
    } else if x < 2.0 {
        cubic(-b - 6.0 * c, 6.0 * b + 30.0 * c, -12.0 * b - 48.0 * c, 8.0 * b + 24.0 * c) / 6.0
    } else {
        0.0
    }
}

#[cfg(any(test, feature = "testing"))]
impl Mitchell {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default()]
    }
}
