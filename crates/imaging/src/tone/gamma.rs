//! Pure power curve, value^(1/gamma). In JSON: `{"gamma": {"gamma": 2.2}}`.

use super::Curve;
use juggler_math::portable::pow_f64;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Pure power curve, `value^(1/gamma)`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Gamma {
    /// Exponent of the display, above 0. The default 2.2 is close to sRGB; larger values brighten
    /// mid-tones.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub gamma: f64,
}

impl Gamma {
    /// Creates a curve for displays of an exponent.
    pub fn new(gamma: f64) -> Self {
        Self { gamma }
    }
}

impl Default for Gamma {
    fn default() -> Self {
        Self { gamma: 2.2 }
    }
}

impl Curve for Gamma {
    fn encode(&self, linear: f64) -> f64 {
        pow_f64(linear.clamp(0.0, 1.0), 1.0 / self.gamma)
    }

    fn decode(&self, encoded: f64) -> f64 {
        pow_f64(encoded.clamp(0.0, 1.0), self.gamma)
    }
}
