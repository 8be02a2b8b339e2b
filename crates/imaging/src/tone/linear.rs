//! No curve: display values equal linear values. In JSON: `{"linear": {}}`.

use super::Curve;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// No curve: linear values become levels directly, as in programs of the 1980s. On sRGB displays
/// the image looks dark and high in contrast.
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
