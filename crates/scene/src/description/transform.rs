//! Steps that bring an object into place.
//!
//! ```json
//! {"transform": [{"scale": 2}, {"rotate": {"axis": [0, 1, 0], "degrees": 30}}, {"translate": [0, 1, 0]}]}
//! ```

use super::Misplaced;
use glam::Mat3;
use juggler_math::{Transform, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// One step; the first of a list happens first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TransformStep {
    /// Moves by a vector.
    Translate(#[schemars(with = "[f32; 3]")] Vec3),
    /// Turns about an axis through the origin.
    Rotate(Rotate),
    /// Scales about the origin.
    Scale(Axes),
    /// Any affine map: 3 or 4 rows of 4 numbers, that multiply points written as columns; a fourth row is 0 0 0 1.
    Matrix(#[schemars(length(min = 12, max = 16))] Vec<f32>),
}

/// A turn about an axis through the origin, right-handed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Rotate {
    /// The axis; its length does not matter.
    #[schemars(with = "[f32; 3]")]
    pub axis: Vec3,
    /// The angle.
    pub degrees: f32,
}

/// One factor, or one for each axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Axes {
    /// The same along all axes.
    All(f32),
    /// Along x, y and z.
    Each(#[schemars(with = "[f32; 3]")] Vec3),
}

impl TransformStep {
    /// The map of this step, or why there is none.
    pub fn transform(&self) -> Result<Transform, Misplaced> {
        match self {
            Self::Translate(by) => Ok(Transform::translation(*by)),
            Self::Rotate(Rotate { axis, degrees }) => {
                Transform::rotation(*axis, degrees.to_radians()).ok_or_else(|| {
                    Misplaced::new("rotate.axis", "`axis` must not be zero: there is nothing to turn about")
                })
            }
            Self::Scale(axes) => {
                let by = match axes {
                    Axes::All(factor) => Vec3::splat(*factor),
                    Axes::Each(factors) => *factors,
                };
                Transform::scale(by)
                    .ok_or_else(|| Misplaced::new("scale", "`scale` must not be 0: the object would be flat"))
            }
            Self::Matrix(rows) => matrix(rows).map_err(|message| Misplaced::new("matrix", message)),
        }
    }
}

fn matrix(rows: &[f32]) -> Result<Transform, String> {
    let (rows, last) = rows.split_at_checked(12).ok_or("`matrix` needs 12 or 16 numbers")?;
    if !matches!(last, [] | [0.0, 0.0, 0.0, 1.0]) {
        return Err(match last.len() {
            4 => "the last row of `matrix` must be 0 0 0 1".into(),
            more => format!("`matrix` needs 12 or 16 numbers, has {}", 12 + more),
        });
    }
    let column = |c: usize| {
        let at = |row: usize| rows.get(4 * row + c).copied().unwrap_or_default();
        Vec3::new(at(0), at(1), at(2))
    };
    Transform::new(Mat3::from_cols(column(0), column(1), column(2)), column(3))
        .ok_or_else(|| "`matrix` is singular: it flattens the object and cannot be inverted".to_owned())
}
