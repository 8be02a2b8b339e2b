//! Where a camera stands and how it is turned.
//!
//! The fields are applied in this order:
//!
//! 1. `eye` with `look_at` (a point) or `direction` (any length) gives the view direction; `up` says which
//!    way the picture's top leans. Where `up` is parallel to the view, the picture's right side is x (y when
//!    the view goes along x): looking straight down on a world with y up, −z is at the top, as on a map.
//!    The camera's axes are unit vectors at right angles, always. (The 1986 Juggler's Java remake forgot to
//!    normalise the axis to the right, which widens a tilted picture by 1 / cos tilt: a defect, not kept.)
//! 2. `yaw_degrees` turns to the right around the camera's own upward axis, then `pitch_degrees` tilts up
//!    around its axis to the right, then `roll_degrees` leans its top to the right around the view direction:
//!    a pilot's signs. Conversions: the teaching engine's pitch and roll count the other way, its yaw the
//!    same way; ScalaBlitz's pitch counts the same way, its yaw the other way.
//! 3. `move` goes along the axes that result.

use super::InvalidCamera;
use juggler_math::{Vec3, fun};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Steps along the camera's own axes, in scene units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Move {
    /// To the picture's right.
    pub right: f32,
    /// To the picture's top.
    pub up: f32,
    /// Into the picture.
    pub forward: f32,
}

/// A camera's pose as descriptions give it.
pub(super) struct Pose {
    pub eye: Vec3,
    pub look_at: Option<Vec3>,
    pub direction: Option<Vec3>,
    pub up: Vec3,
    pub yaw_degrees: f32,
    pub pitch_degrees: f32,
    pub roll_degrees: f32,
    pub r#move: Move,
}

/// A camera's place and its axes: unit vectors at right angles, `right × up = -forward`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    /// The place, world space.
    pub eye: Vec3,
    /// To the picture's right.
    pub right: Vec3,
    /// To the picture's top.
    pub up: Vec3,
    /// Into the picture.
    pub forward: Vec3,
}

impl Pose {
    /// Applies the fields in the order that this page states.
    pub fn axes(&self) -> Result<Axes, InvalidCamera> {
        self.check_finite()?;
        let forward = self.forward()?;
        let Some(up) = unit(self.up) else {
            return Err(InvalidCamera::new("up", "`up` is a direction and cannot be zero"));
        };
        let right = unit(forward.cross(up))
            .filter(|_| forward.cross(up).length_squared() > 1e-12)
            .unwrap_or_else(|| right_of_vertical(forward));
        let mut axes = Axes { eye: self.eye, right, up: right.cross(forward), forward };
        (axes.forward, axes.right) = turn(axes.forward, axes.right, self.yaw_degrees);
        (axes.forward, axes.up) = turn(axes.forward, axes.up, self.pitch_degrees);
        (axes.up, axes.right) = turn(axes.up, axes.right, self.roll_degrees);
        let Move { right, up, forward } = self.r#move;
        axes.eye = axes.eye + axes.right * right + axes.up * up + axes.forward * forward;
        Ok(axes)
    }

    fn forward(&self) -> Result<Vec3, InvalidCamera> {
        match (self.look_at, self.direction) {
            (Some(_), Some(_)) => Err(InvalidCamera::new(
                "direction",
                "`look_at` and `direction` both say where the camera looks; give one of them",
            )),
            (None, Some(direction)) => {
                unit(direction).ok_or_else(|| InvalidCamera::new("direction", "`direction` cannot be zero"))
            }
            (look_at, None) => {
                let target = look_at.unwrap_or(Vec3::ZERO);
                unit_between(self.eye, target).ok_or_else(|| {
                    InvalidCamera::new("look_at", "the camera stands at the point it looks at; move `eye` or `look_at`")
                })
            }
        }
    }

    fn check_finite(&self) -> Result<(), InvalidCamera> {
        let m = self.r#move;
        let fields = [
            ("eye", self.eye),
            ("look_at", self.look_at.unwrap_or_default()),
            ("direction", self.direction.unwrap_or_default()),
            ("up", self.up),
            ("yaw_degrees", Vec3::splat(self.yaw_degrees)),
            ("pitch_degrees", Vec3::splat(self.pitch_degrees)),
            ("roll_degrees", Vec3::splat(self.roll_degrees)),
            ("move", Vec3::new(m.right, m.up, m.forward)),
        ];
        match fields.iter().find(|(_, value)| !value.is_finite()) {
            Some((field, _)) => Err(InvalidCamera::new(field, format!("`{field}` must be finite"))),
            None => Ok(()),
        }
    }
}

/// Unit vector along `v`; in f64, so that no length that f32 can hold is too short or too long.
fn unit(v: Vec3) -> Option<Vec3> {
    v.as_dvec3().try_normalize().map(|d| d.as_vec3())
}

fn unit_between(from: Vec3, to: Vec3) -> Option<Vec3> {
    (to.as_dvec3() - from.as_dvec3()).try_normalize().map(|d| d.as_vec3())
}

/// The axis to the right where `up` cannot say: x, or y for a view along x.
fn right_of_vertical(forward: Vec3) -> Vec3 {
    let right = if forward.x.abs() < 0.9 { Vec3::X } else { Vec3::Y };
    (right - forward * right.dot(forward)).normalize()
}

/// Turns `a` towards `b`, and `b` away from where `a` was.
fn turn(a: Vec3, b: Vec3, degrees: f32) -> (Vec3, Vec3) {
    if degrees == 0.0 {
        return (a, b);
    }
    let (sin, cos) = fun::sin_cos(degrees.to_radians());
    (a * cos + b * sin, b * cos - a * sin)
}
