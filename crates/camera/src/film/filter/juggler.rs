//! Jitter of the Amiga Juggler's Java program: up to one pixel from the corner of each cell of the
//! sampling grid. It filters the picture over nearly two pixels and moves it half a pixel right and
//! down. Only for pictures that must match that program; use it with the `stratified` sampler.
//!
//! ```json
//! {"juggler": {}}
//! ```

use super::{FilterSampler, ReconstructionFilter};
use juggler_math::Vec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Two-pixel jitter of the Juggler's Java program, only for pictures that must match that program.
/// Use it with the `stratified` sampler.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Juggler {}

impl ReconstructionFilter for Juggler {
    fn sampler(&self, samples: u32) -> FilterSampler {
        FilterSampler::Juggler(samples.isqrt().max(1))
    }
}

/// Maps `u` = (cell + jitter) / side to cell / side + jitter from the pixel's corner; returns the
/// offset from the pixel's center.
pub fn warp(u: Vec2, side: u32) -> Vec2 {
    let scaled = u * side as f32;
    let cell = scaled.floor();
    cell / side as f32 + (scaled - cell) - 0.5
}

#[cfg(any(test, feature = "testing"))]
impl Juggler {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self {}]
    }
}
