//! Steps that bring an object into place.
//!
//! ```json
//! {"transform": [{"scale": 2}, {"rotate": {"axis": [0, 1, 0], "degrees": 30}}, {"translate": [0, 1, 0]}]}
//! {"transform": {"translate": [0, 1, 0]}}
//! ```

use super::Misplaced;
use glam::{DMat3, Mat3};
use juggler_math::quaternion;
use juggler_math::{DVec3, Transform, Vec3};
use schemars::JsonSchema;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt;

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
    /// Turns about the origin by a quaternion x, y, z, w as in glTF, which is made a unit quaternion.
    Orient([f32; 4]),
    /// Turns so that the object faces a point, then moves it to where it stands.
    LookAt(LookAt),
    /// Any affine map: 3 or 4 rows of 4 numbers, that multiply points written as columns; a fourth row is 0 0 0 1.
    Matrix(#[schemars(length(min = 12, max = 16))] Vec<f32>),
}

/// A transform as it may be written.
#[derive(JsonSchema)]
#[schemars(untagged, rename = "Transform")]
pub enum Steps {
    /// Steps in order; the first happens first.
    Several(Vec<TransformStep>),
    /// A single step.
    One(TransformStep),
}

impl<'de> Deserialize<'de> for Steps {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct StepsVisitor;

        impl<'de> Visitor<'de> for StepsVisitor {
            type Value = Steps;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an array of transform steps, or one step")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, steps: A) -> Result<Steps, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(steps)).map(Steps::Several)
            }

            fn visit_map<A: MapAccess<'de>>(self, step: A) -> Result<Steps, A::Error> {
                TransformStep::deserialize(MapAccessDeserializer::new(step)).map(Steps::One)
            }
        }

        deserializer.deserialize_any(StepsVisitor)
    }
}

/// Steps from an array of them or from one.
pub fn steps<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<TransformStep>, D::Error> {
    Ok(match Steps::deserialize(deserializer)? {
        Steps::Several(steps) => steps,
        Steps::One(step) => vec![step],
    })
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

/// A place to stand and a point to face.
///
/// The object's axis `forward` comes to point from `from` to `to`, and its y axis leans to `up` as far as that allows (its
/// z axis, where `forward` is the y axis). Then its origin is moved to `from`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LookAt {
    /// Where the object's origin comes to stand.
    #[serde(default)]
    #[schemars(with = "[f32; 3]")]
    pub from: Vec3,
    /// The point that it faces.
    #[schemars(with = "[f32; 3]")]
    pub to: Vec3,
    /// Where its top leans to; need not be unit. Where it faces straight along `up`, z takes
    /// its place.
    #[serde(default = "y_axis")]
    #[schemars(with = "[f32; 3]")]
    pub up: Vec3,
    /// The axis of the object that comes to point at `to`; need not be unit.
    #[serde(default = "z_axis")]
    #[schemars(with = "[f32; 3]")]
    pub forward: Vec3,
}

fn y_axis() -> Vec3 {
    Vec3::Y
}

fn z_axis() -> Vec3 {
    Vec3::Z
}

impl LookAt {
    fn transform(&self) -> Result<Transform, Misplaced> {
        let zero = |field, message: &str| Misplaced::new(field, message);
        let sight = (self.to.as_dvec3() - self.from.as_dvec3()).try_normalize();
        let sight = sight.ok_or_else(|| zero("look_at.to", "`from` and `to` must not be the same point"))?;
        let forward = self.forward.as_dvec3().try_normalize();
        let forward = forward.ok_or_else(|| zero("look_at.forward", "`forward` must not be zero"))?;
        let up = self.up.as_dvec3().try_normalize();
        let up = up.ok_or_else(|| zero("look_at.up", "`up` must not be zero"))?;
        let turn = frame(sight, up) * frame(forward, DVec3::Y).transpose();
        Transform::new(turn.as_mat3(), self.from)
            .ok_or_else(|| zero("look_at", "the points are too far away for 32 bits"))
    }
}

/// The frame of unit vectors whose third points along `axis` and whose second leans to `top`; or to z, y or x in this
/// order, where these two are one line.
fn frame(axis: DVec3, top: DVec3) -> DMat3 {
    let side = |top: DVec3| Some(top.cross(axis)).filter(|side| side.length_squared() > 1e-12);
    let side = [top, DVec3::Z, DVec3::Y].into_iter().find_map(side).unwrap_or(DVec3::X).normalize();
    DMat3::from_cols(side, axis.cross(side), axis)
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
            Self::Orient(quaternion) => {
                let turn = quaternion::matrix(quaternion.map(f64::from));
                turn.and_then(|turn| Transform::new(turn.as_mat3(), Vec3::ZERO))
                    .ok_or_else(|| Misplaced::new("orient", "a quaternion must not be all 0: it turns nowhere"))
            }
            Self::LookAt(step) => step.transform(),
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

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: Vec3, b: [f32; 3]) -> bool {
        a.abs_diff_eq(b.into(), 1e-6)
    }

    fn look(from: [f32; 3], to: [f32; 3]) -> LookAt {
        LookAt { from: from.into(), to: to.into(), up: Vec3::Y, forward: Vec3::Z }
    }

    #[test]
    fn orient_turns_as_in_gltf() {
        // A quarter turn about y, in another length.
        let quarter = TransformStep::Orient([0.0, 3.0, 0.0, 3.0]).transform().unwrap();
        assert!(near(quarter.point(Vec3::X), [0.0, 0.0, -1.0]) && near(quarter.point(Vec3::Y), [0.0, 1.0, 0.0]));
        assert!(TransformStep::Orient([0.0; 4]).transform().is_err());
        let rotate =
            TransformStep::Rotate(Rotate { axis: Vec3::new(1.0, 2.0, 3.0), degrees: 40.0 }).transform().unwrap();
        let turn = quaternion::turn(DVec3::new(1.0, 2.0, 3.0), 40.0).unwrap().to_array().map(|number| number as f32);
        let orient = TransformStep::Orient(turn).transform().unwrap();
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            assert!(rotate.point(axis).abs_diff_eq(orient.point(axis), 1e-6));
        }
    }

    #[test]
    fn what_looks_at_a_point_faces_it_upright() {
        let step = look([1.0, 2.0, 3.0], [1.0, 2.0, 13.0]);
        let place = TransformStep::LookAt(step).transform().unwrap();
        assert!(near(place.point(Vec3::ZERO), [1.0, 2.0, 3.0]) && near(place.vector(Vec3::X), [1.0, 0.0, 0.0]));
        let side = TransformStep::LookAt(look([0.0, 0.0, 0.0], [5.0, 0.0, 0.0])).transform().unwrap();
        assert!(near(side.vector(Vec3::Z), [1.0, 0.0, 0.0]) && near(side.vector(Vec3::Y), [0.0, 1.0, 0.0]));
        let minus = LookAt { forward: Vec3::NEG_Z, ..look([0.0, 0.0, 0.0], [0.0, 3.0, 4.0]) };
        let minus = TransformStep::LookAt(minus).transform().unwrap();
        assert!(near(minus.vector(Vec3::NEG_Z), [0.0, 0.6, 0.8]) && minus.vector(Vec3::Y).y > 0.0);
        assert!(minus.vector(Vec3::X).y.abs() < 1e-6, "upright");
    }

    #[test]
    fn straight_up_and_along_its_own_top_there_is_a_way() {
        for (to, forward) in [([0.0, 5.0, 0.0], Vec3::Z), ([0.0, -5.0, 0.0], Vec3::Y), ([1.0, 2.0, 3.0], Vec3::NEG_Y)] {
            let step = LookAt { forward, ..look([0.0; 3], to) };
            let place = TransformStep::LookAt(step).transform().unwrap();
            assert!(near(place.vector(forward), Vec3::from(to).normalize().to_array()));
            assert!((place.matrix().determinant() - 1.0).abs() < 1e-5, "a turn, not a mirror");
        }
        for wrong in [
            look([1.0; 3], [1.0; 3]),
            LookAt { up: Vec3::ZERO, ..look([0.0; 3], [1.0; 3]) },
            LookAt { forward: Vec3::ZERO, ..look([0.0; 3], [1.0; 3]) },
        ] {
            assert!(TransformStep::LookAt(wrong).transform().is_err());
        }
    }
}
