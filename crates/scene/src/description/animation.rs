//! Animation settings, variables and paths of a scene.
//!
//! ```json
//! {
//!   "animation": {"frames": 30, "frames_per_second": 30},
//!   "variables": {"phi": "2*pi*frame/frames"}
//! }
//! ```

use crate::animate::ValueForm;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Length and frame rate of an animation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Animation {
    /// Number of frames. The default of 1 describes a still image.
    #[schemars(range(min = 1, max = 1_000_000), extend("x-unit" = "frames"))]
    pub frames: u32,
    /// Frame rate: playback speed, and the ratio of `frame` to `seconds` in expressions.
    #[schemars(range(max = 1000), extend("exclusiveMinimum" = 0, "x-unit" = "frames/second"))]
    pub frames_per_second: f64,
}

impl Default for Animation {
    fn default() -> Self {
        Self { frames: 1, frames_per_second: 30.0 }
    }
}

impl Animation {
    /// Creates an animation of a number of frames at a rate.
    pub fn new(frames: u32, frames_per_second: f64) -> Self {
        Self { frames, frames_per_second }
    }

    /// Whether the settings equal the defaults, which describe a still image.
    pub fn is_still(&self) -> bool {
        *self == Self::default()
    }
}

/// Variable: a number, an expression such as `2*pi*frame/frames`, a value form, or an array of 1 to
/// 4 of these.
///
/// The components of an array named `ball` are `ball.x`, `ball.y`, `ball.z` and `ball.w` in
/// expressions; `"=ball"` alone is the whole array.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Variable {
    /// One value.
    One(Component),
    /// Array of 1 to 4 values.
    Several(#[schemars(length(min = 1, max = 4))] Vec<Component>),
}

/// Number, expression or value form.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Component {
    /// Number.
    Number(f64),
    /// Expression, with or without a leading `=`.
    Expression(String),
    /// Value form that yields a number or, outside of an array, up to 4 numbers.
    Form(Box<ValueForm>),
}

/// Curve through points, for the value form `along`: `{"along": {"path": NAME, "at": SHARE}}`.
///
/// The curve is a centripetal Catmull-Rom spline. It passes through all points in order with a
/// continuous tangent and stays close to straight lines between points that are close to each
/// other. Consecutive equal points count as one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "Path")]
pub struct ScenePath {
    /// Points `[x, y, z]` that the curve passes through, in the space of the value that uses the
    /// path.
    #[schemars(length(min = 1, max = 10_000))]
    pub points: Vec<[f32; 3]>,
    /// Whether the curve continues from the last point back to the first. Set it for cyclic motion:
    /// a closed path can be followed any number of times.
    #[serde(default)]
    pub closed: bool,
}

impl ScenePath {
    /// Creates an open path through points.
    pub fn new(points: impl IntoIterator<Item = impl Into<[f32; 3]>>) -> Self {
        Self { points: points.into_iter().map(Into::into).collect(), closed: false }
    }
}
