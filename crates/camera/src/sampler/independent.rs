//! Independent random numbers: plain Monte Carlo, the reference for the other samplers.
//!
//! ```json
//! {"independent": {}}
//! ```

use super::{AnyPointSet, PointSet, SamplerDescription};
use juggler_math::{Vec2, hash};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Independent random numbers: plain Monte Carlo. The noise is higher than that of the other
/// samplers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Independent {}

impl SamplerDescription for Independent {
    fn point_set(&self, _samples: u32) -> AnyPointSet {
        IndependentPoints.into()
    }
}

/// Points of [`Independent`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IndependentPoints;

impl PointSet for IndependentPoints {
    #[inline]
    fn point(&self, index: u32, _is_first: bool, seed: u32) -> Vec2 {
        point(index, seed)
    }
}

/// Point `index` of the stream `seed`.
#[inline]
pub fn point(index: u32, seed: u32) -> Vec2 {
    let x = hash::mix(seed.wrapping_add(index.wrapping_mul(0x9e37_79b9)));
    Vec2::new(hash::unit_f32(x), hash::unit_f32(hash::mix(x ^ 0x68bc_21eb)))
}

#[cfg(any(test, feature = "testing"))]
impl Independent {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self {}]
    }
}
