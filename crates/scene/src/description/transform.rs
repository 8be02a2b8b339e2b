//! Transform steps, which place an object in the space of its parent.
//!
//! ```json
//! {"transform": [
//!   {"scale": 2}, {"rotate": {"axis": [0, 1, 0], "degrees": 30}}, {"translate": [0, 1, 0]}]}
//! {"transform": {"translate": [0, 1, 0]}}
//! ```

use super::PlacementError;
use glam::{DMat3, Mat3};
use juggler_math::quaternion;
use juggler_math::{DVec3, Transform, Vec3};
use schemars::JsonSchema;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt;

/// One step of a transform. The first step of a list is applied first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TransformStep {
    /// Translates by a vector.
    Translate(#[schemars(with = "[f32; 3]", extend("x-unit" = "scene units"))] Vec3),
    /// Rotates about the origin: about an axis, or by three angles in degrees, such as `[0, 90, 0]`:
    /// first about the x axis, then about the y axis, then about the z axis of the parent's space. Each
    /// angle is counterclockwise as seen from the tip of its axis.
    Rotate(Rotation),
    /// Scales about the origin.
    Scale(ScaleFactors),
    /// Rotates about the origin by a quaternion `[x, y, z, w]` as in glTF. It is normalized and
    /// must not be zero.
    Orient([f32; 4]),
    /// Turns the object toward a point, then moves its origin to a position.
    LookAt(LookAt),
    /// Applies an affine map: 12 or 16 numbers, the 3 or 4 rows of a matrix that multiplies column
    /// vectors. The matrix must be invertible; a fourth row must be 0 0 0 1.
    Matrix(#[schemars(length(min = 12, max = 16))] Vec<f32>),
}

/// Transform: a list of steps, or a single step.
#[derive(JsonSchema)]
#[schemars(untagged, rename = "Transform")]
pub enum TransformInput {
    /// Steps, applied in order.
    Several(Vec<TransformStep>),
    /// Single step.
    One(TransformStep),
}

impl<'de> Deserialize<'de> for TransformInput {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct TransformInputVisitor;

        impl<'de> Visitor<'de> for TransformInputVisitor {
            type Value = TransformInput;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an array of transform steps, or one step")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, steps: A) -> Result<TransformInput, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(steps)).map(TransformInput::Several)
            }

            fn visit_map<A: MapAccess<'de>>(self, step: A) -> Result<TransformInput, A::Error> {
                TransformStep::deserialize(MapAccessDeserializer::new(step)).map(TransformInput::One)
            }
        }

        deserializer.deserialize_any(TransformInputVisitor)
    }
}

/// Deserializes an array of transform steps or a single step.
pub fn steps<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<TransformStep>, D::Error> {
    Ok(match TransformInput::deserialize(deserializer)? {
        TransformInput::Several(steps) => steps,
        TransformInput::One(step) => vec![step],
    })
}

/// Rotation about the origin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Rotation {
    /// Rotation about an axis.
    About(Rotate),
    /// Angles about the x axis, then the y axis, then the z axis, which stay where they are.
    Angles(#[schemars(with = "[f32; 3]", extend("x-unit" = "degrees"))] Vec3),
}

impl Rotation {
    fn transform(&self) -> Result<Transform, PlacementError> {
        match self {
            Self::About(Rotate { axis, degrees }) => Transform::rotation(*axis, degrees.to_radians())
                .ok_or_else(|| PlacementError::new("rotate.axis", "`axis` must not be zero")),
            Self::Angles(degrees) => {
                let wrong = || PlacementError::new("rotate", "the angles of `rotate` are too large");
                let turn = |axis: Vec3, degrees: f32| Transform::rotation(axis, degrees.to_radians()).ok_or_else(wrong);
                let [x, y, z] = degrees.to_array();
                Ok(turn(Vec3::X, x)?.then(&turn(Vec3::Y, y)?).then(&turn(Vec3::Z, z)?))
            }
        }
    }
}

/// Right-handed rotation about an axis through the origin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "AxisRotation")]
pub struct Rotate {
    /// Rotation axis, of any length except zero.
    #[schemars(with = "[f32; 3]")]
    pub axis: Vec3,
    /// Rotation angle, counterclockwise as seen from the tip of the axis.
    #[schemars(extend("x-unit" = "degrees"))]
    pub degrees: f32,
}

impl From<Rotate> for Rotation {
    fn from(rotate: Rotate) -> Self {
        Self::About(rotate)
    }
}

impl Rotate {
    /// Creates a rotation about an axis through the origin.
    pub fn new(axis: impl Into<Vec3>, degrees: f32) -> Self {
        Self { axis: axis.into(), degrees }
    }
}

/// Position of an object and a point that it faces.
///
/// A rotation takes the object's axis `forward` to the direction from `from` to `to` and turns the
/// object's y axis (its z axis if `forward` is the y axis) toward `up` as far as possible. Then the
/// object's origin moves to `from`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LookAt {
    /// Position of the object's origin.
    #[serde(default)]
    #[schemars(with = "[f32; 3]", extend("x-unit" = "scene units"))]
    pub from: Vec3,
    /// Point that the object faces. Must differ from `from`.
    #[schemars(with = "[f32; 3]", extend("x-unit" = "scene units"))]
    pub to: Vec3,
    /// Up direction, of any length except zero. If it is parallel to the direction that the object
    /// faces, the z axis takes its place.
    #[serde(default = "y_axis")]
    #[schemars(with = "[f32; 3]")]
    pub up: Vec3,
    /// Axis of the object that faces `to`, of any length except zero. Set it for models whose front
    /// is not +z.
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
    /// Creates a step that moves an object to `from` and turns its z axis toward `to` and its y axis
    /// up.
    pub fn new(from: impl Into<Vec3>, to: impl Into<Vec3>) -> Self {
        Self { from: from.into(), to: to.into(), up: y_axis(), forward: z_axis() }
    }

    fn transform(&self) -> Result<Transform, PlacementError> {
        let zero = |field, message: &str| PlacementError::new(field, message);
        let direction = (self.to.as_dvec3() - self.from.as_dvec3()).try_normalize();
        let direction = direction.ok_or_else(|| zero("look_at.to", "`from` and `to` must not be the same point"))?;
        let forward = self.forward.as_dvec3().try_normalize();
        let forward = forward.ok_or_else(|| zero("look_at.forward", "`forward` must not be zero"))?;
        let up = self.up.as_dvec3().try_normalize();
        let up = up.ok_or_else(|| zero("look_at.up", "`up` must not be zero"))?;
        let turn = orthonormal_frame(direction, up) * orthonormal_frame(forward, DVec3::Y).transpose();
        Transform::new(turn.as_mat3(), self.from)
            .ok_or_else(|| zero("look_at", "the points are too far away for 32-bit floats"))
    }
}

/// Orthonormal frame whose third axis is `axis` and whose second axis leans toward `top`. If these
/// two are parallel, z or else y replaces `top`.
fn orthonormal_frame(axis: DVec3, top: DVec3) -> DMat3 {
    let side = |top: DVec3| Some(top.cross(axis)).filter(|side| side.length_squared() > 1e-12);
    let side = [top, DVec3::Z, DVec3::Y].into_iter().find_map(side).unwrap_or(DVec3::X).normalize();
    DMat3::from_cols(side, axis.cross(side), axis)
}

/// One scale factor, or one for each axis. Negative factors mirror the object. Factors must not be
/// 0, except at some frames of an animation: at these, the object is absent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ScaleFactors {
    /// Factor along all axes.
    All(f32),
    /// Factors along x, y and z.
    Each(#[schemars(with = "[f32; 3]")] Vec3),
}

impl ScaleFactors {
    /// Factors along x, y and z.
    pub(crate) fn factors(&self) -> Vec3 {
        match self {
            Self::All(factor) => Vec3::splat(*factor),
            Self::Each(factors) => *factors,
        }
    }
}

impl TransformStep {
    /// Whether the step scales by 0 along an axis.
    pub(crate) fn is_flat(&self) -> bool {
        matches!(self, Self::Scale(axes) if axes.factors().abs().min_element() == 0.0)
    }

    /// Affine map of this step, or an error if the step is degenerate.
    pub fn transform(&self) -> Result<Transform, PlacementError> {
        match self {
            Self::Translate(by) => Ok(Transform::translation(*by)),
            Self::Rotate(rotation) => rotation.transform(),
            Self::Scale(axes) => Transform::scale(axes.factors())
                .ok_or_else(|| PlacementError::new("scale", "`scale` must not be 0: the object would be flat")),
            Self::Orient(quaternion) => {
                let turn = quaternion::matrix(quaternion.map(f64::from));
                turn.and_then(|turn| Transform::new(turn.as_mat3(), Vec3::ZERO))
                    .ok_or_else(|| PlacementError::new("orient", "a quaternion must not be zero"))
            }
            Self::LookAt(step) => step.transform(),
            Self::Matrix(rows) => matrix(rows).map_err(|message| PlacementError::new("matrix", message)),
        }
    }
}

/// Affine map of the 3 or 4 rows of a matrix.
pub fn matrix(rows: &[f32]) -> Result<Transform, String> {
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
        // Rotation by 90° about y, by a quaternion of length 3√2.
        let quarter = TransformStep::Orient([0.0, 3.0, 0.0, 3.0]).transform().unwrap();
        assert!(near(quarter.point(Vec3::X), [0.0, 0.0, -1.0]) && near(quarter.point(Vec3::Y), [0.0, 1.0, 0.0]));
        assert!(TransformStep::Orient([0.0; 4]).transform().is_err());
        let rotate = TransformStep::Rotate(Rotate::new([1.0, 2.0, 3.0], 40.0).into()).transform().unwrap();
        let turn = quaternion::from_axis_degrees(DVec3::new(1.0, 2.0, 3.0), 40.0)
            .unwrap()
            .to_array()
            .map(|number| number as f32);
        let orient = TransformStep::Orient(turn).transform().unwrap();
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            assert!(rotate.point(axis).abs_diff_eq(orient.point(axis), 1e-6));
        }
    }

    /// Angles turn about x, then y, then z, as `<x, y, z>` of POV-Ray and the order XYZ of Blender.
    #[test]
    fn angles_turn_about_x_then_y_then_z() {
        let angles =
            |x: f32, y: f32, z: f32| TransformStep::Rotate(Rotation::Angles(Vec3::new(x, y, z))).transform().unwrap();
        assert!(near(angles(90.0, 90.0, 0.0).point(Vec3::Y), [1.0, 0.0, 0.0]));
        assert!(near(angles(0.0, 90.0, 90.0).point(Vec3::X), [0.0, 0.0, -1.0]));
        let about =
            |axis: Vec3, degrees: f32| TransformStep::Rotate(Rotate::new(axis, degrees).into()).transform().unwrap();
        let steps = about(Vec3::X, 20.0).then(&about(Vec3::Y, -70.0)).then(&about(Vec3::Z, 130.0));
        assert!(near(angles(20.0, -70.0, 130.0).point(Vec3::ONE), steps.point(Vec3::ONE).to_array()));
        let read: TransformStep = serde_json::from_str(r#"{"rotate": [0, 90, 0]}"#).unwrap();
        assert_eq!(read, TransformStep::Rotate(Rotation::Angles(Vec3::new(0.0, 90.0, 0.0))));
    }

    #[test]
    fn look_at_faces_the_target_upright() {
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
    fn look_at_handles_directions_parallel_to_up() {
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
