//! Animation: how many pictures, how fast, and the numbers that change from one to the next.
//!
//! ```json
//! {"animation": {"frames": 30, "frames_per_second": 30}, "variables": {"phi": "2*pi*frame/frames"}}
//! ```

use crate::animate::ValueForm;
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

/// A variable: a number, an expression such as `2*pi*frame/frames`, a value form, or an array of 1 to 4 of these.
///
/// The numbers of an array called `ball` are `ball.x`, `ball.y`, `ball.z` and `ball.w` in expressions; `"=ball"` alone is
/// the whole array.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Variable {
    /// One number.
    One(Component),
    /// Several.
    Several(#[schemars(length(min = 1, max = 4))] Vec<Component>),
}

/// A number, or what gives one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Component {
    /// The number.
    Number(f64),
    /// The expression, with or without a `=` in front.
    Expression(String),
    /// What becomes a number or, alone, several.
    Form(ValueForm),
}

/// A curve through points, to move things along it: `{"along": {"path": NAME, "at": SHARE}}`.
///
/// It is a centripetal Catmull-Rom spline: it goes through all points in order, without corners, and comes near to straight
/// lines where points lie close. Two equal points in a row count as one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "Path")]
pub struct ScenePath {
    /// The points that it goes through.
    #[schemars(length(min = 1, max = 10_000))]
    pub points: Vec<[f32; 3]>,
    /// Whether it leads from the last point back to the first.
    #[serde(default)]
    pub closed: bool,
}
