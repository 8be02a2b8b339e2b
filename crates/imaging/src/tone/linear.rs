//! No curve: linear values are the levels. In JSON: `{"linear": {}}`.

use super::Curve;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// No curve: linear values go straight to levels, as programs of the 1980s did; on today's displays that is dark
/// and rich in contrast.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Linear {}

impl Curve for Linear {
    fn encode(&self, linear: f64) -> f64 {
        linear.clamp(0.0, 1.0)
    }

    fn decode(&self, encoded: f64) -> f64 {
        encoded.clamp(0.0, 1.0)
    }
}
