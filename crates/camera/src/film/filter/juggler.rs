//! The scatter of the Amiga Juggler's Java program: a whole pixel of jitter from the corner of each cell of
//! the sampling grid, so the picture is filtered over nearly two pixels and moved half a pixel right and
//! down. Only for pictures that must match that program; use it with the `stratified` sampler.
//!
//! ```json
//! {"juggler": {}}
//! ```

use super::{Filter, Reconstruction};
use juggler_math::Vec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The ancestor's two-pixel jitter.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Juggler {}

impl Reconstruction for Juggler {
    fn filter(&self, samples: u32) -> Filter {
        Filter::Juggler(samples.isqrt().max(1))
    }
}

/// `u` = (cell + jitter) / side becomes cell / side + jitter, measured from the pixel's corner.
pub fn warp(u: Vec2, side: u32) -> Vec2 {
    let scaled = u * side as f32;
    let cell = scaled.floor();
    cell / side as f32 + (scaled - cell) - 0.5
}

#[cfg(any(test, feature = "testing"))]
impl Juggler {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self {}]
    }
}
