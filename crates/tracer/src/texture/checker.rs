//! A checkerboard of two colours.
//!
//! ```json
//! {"checker": {"size": 1, "even": [1, 1, 1], "odd": [0, 0, 0]}}
//! ```

use super::{Lookup, Texture};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A checkerboard of two colours.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Checker {
    /// Edge of one cell.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub size: f32,
    /// Colour of the cell at the origin.
    pub even: Rgb,
    /// Colour of its neighbours.
    pub odd: Rgb,
}

impl Default for Checker {
    fn default() -> Self {
        Self { size: 1.0, even: Rgb::splat(0.8), odd: Rgb::splat(0.2) }
    }
}

impl Texture for Checker {
    fn eval(&self, at: &Lookup) -> Rgb {
        let cell = |x: f32| (x / self.size).floor();
        let sum = cell(at.uv.x) + cell(at.uv.y);
        if sum.rem_euclid(2.0) < 1.0 { self.even } else { self.odd }
    }
}

#[cfg(test)]
impl Checker {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default()]
    }
}
