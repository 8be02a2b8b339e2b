//! Animation: how many pictures, how fast, and the numbers that change from one to the next.
//!
//! ```json
//! {"animation": {"frames": 30, "frames_per_second": 30}, "variables": {"phi": "2*pi*frame/frames"}}
//! ```

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Length and pace of an animation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Animation {
    /// Number of pictures.
    #[schemars(range(min = 1, max = 1_000_000))]
    pub frames: u32,
    /// Pictures per second.
    #[schemars(range(max = 1000), extend("exclusiveMinimum" = 0))]
    pub frames_per_second: f64,
}

impl Default for Animation {
    fn default() -> Self {
        Self { frames: 1, frames_per_second: 30.0 }
    }
}

impl Animation {
    /// Whether it says nothing beyond the default.
    pub fn is_still(&self) -> bool {
        *self == Self::default()
    }
}

/// A number, or an expression such as `2*pi*frame/frames` that gives one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Variable {
    /// The number.
    Number(f64),
    /// The expression, with or without a `=` in front.
    Expression(String),
}
