//! Mitchell and Netravali's cubic (SIGGRAPH 1988): sharp, with slight negative lobes.
//!
//! ```json
//! {"mitchell": {"b": 0.333, "c": 0.333}}
//! ```

use super::{Filter, Reconstruction, Table};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Sharp, with slight negative lobes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Mitchell {
    /// Blur; the authors recommend b + 2c = 1.
    #[schemars(range(min = 0, max = 1))]
    pub b: f32,
    /// Ringing.
    #[schemars(range(min = 0, max = 1))]
    pub c: f32,
}

impl Default for Mitchell {
    fn default() -> Self {
        Self { b: 1.0 / 3.0, c: 1.0 / 3.0 }
    }
}

impl Reconstruction for Mitchell {
    fn filter(&self, _samples: u32) -> Filter {
        Filter::Table(Arc::new(Table::new(2.0, |x| value(x, self.b, self.c))))
    }
}

/// The filter along one axis, radius 2 (Mitchell and Netravali 1988, equation 8).
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
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default()]
    }
}
