//! sRGB transfer function (IEC 61966-2-1): a linear segment near black, then nearly a power of 2.2.
//! In JSON: `{"srgb": {}}`.

use super::Curve;
use juggler_math::color::{srgb_decode_f64, srgb_encode_f64};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// sRGB curve (IEC 61966-2-1), which displays expect. Values above 1 are clipped.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Srgb {}

impl Curve for Srgb {
    fn encode(&self, linear: f64) -> f64 {
        srgb_encode_f64(linear)
    }

    fn decode(&self, encoded: f64) -> f64 {
        srgb_decode_f64(encoded)
    }
}
