//! Position and orientation of a camera.
//!
//! The fields are applied in this order:
//!
//! 1. `eye` with `look_at` (a point) or `direction` (any length) gives the view direction, and `up`
//!    gives the direction of the picture's top. If `up` is parallel to the view, the picture's
//!    right side is x (y for a view along x): a view straight down on a world with y up has −z at
//!    the top, as on a map. The camera's axes are always orthogonal unit vectors. (The Java remake
//!    of the 1986 Juggler does not normalize the right axis, which widens a tilted picture by 1 /
//!    cos tilt: a defect that is not reproduced.)
//! 2. `yaw_degrees` rotates to the right about the camera's up axis, then `pitch_degrees` rotates
//!    up about its right axis, then `roll_degrees` leans its top to the right about the view
//!    direction: a pilot's signs. Conversions: the teaching engine has the opposite signs of pitch
//!    and roll and the same sign of yaw; ScalaBlitz has the same sign of pitch and the opposite
//!    sign of yaw.
//! 3. `move` translates along the resulting axes.

use super::InvalidCamera;
use juggler_math::{Vec3, portable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Translation along the camera's axes, in scene units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
#[schemars(rename = "Move")]
pub struct LocalTranslation {
    /// Distance to the picture's right.
    #[schemars(extend("x-unit" = "scene units"))]
    pub right: f32,
    /// Distance to the picture's top.
    #[schemars(extend("x-unit" = "scene units"))]
    pub up: f32,
    /// Distance into the picture.
    #[schemars(extend("x-unit" = "scene units"))]
    pub forward: f32,
}

impl LocalTranslation {
    /// Creates a translation along the camera's own axes, in scene units.
    pub fn new(right: f32, up: f32, forward: f32) -> Self {
        Self { right, up, forward }
    }
}

/// Pose of a camera as a description gives it.
pub(super) struct Pose {
    pub eye: Vec3,
    pub look_at: Option<Vec3>,
    pub direction: Option<Vec3>,
    pub up: Vec3,
    pub yaw_degrees: f32,
    pub pitch_degrees: f32,
    pub roll_degrees: f32,
    pub r#move: LocalTranslation,
}

/// Position of a camera and its axes: orthogonal unit vectors with `right × up = -forward`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraAxes {
    /// Position, in world space.
    pub eye: Vec3,
    /// Direction of the picture's right.
    pub right: Vec3,
    /// Direction of the picture's top.
    pub up: Vec3,
    /// View direction.
    pub forward: Vec3,
}

impl Pose {
    /// Applies the fields in the order that the module documentation states.
    pub fn axes(&self) -> Result<CameraAxes, InvalidCamera> {
        self.check_finite()?;
        let forward = self.forward()?;
        let Some(up) = unit(self.up) else {
            return Err(InvalidCamera::new("up", "`up` is a direction and cannot be zero"));
        };
        let right = unit(forward.cross(up))
            .filter(|_| forward.cross(up).length_squared() > 1e-12)
            .unwrap_or_else(|| right_of_vertical(forward));
        let mut axes = CameraAxes { eye: self.eye, right, up: right.cross(forward), forward };
        (axes.forward, axes.right) = rotate(axes.forward, axes.right, self.yaw_degrees);
        (axes.forward, axes.up) = rotate(axes.forward, axes.up, self.pitch_degrees);
        (axes.up, axes.right) = rotate(axes.up, axes.right, self.roll_degrees);
        let LocalTranslation { right, up, forward } = self.r#move;
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

/// Normalizes `v` in `f64`, where no finite `f32` length overflows or underflows.
fn unit(v: Vec3) -> Option<Vec3> {
    v.as_dvec3().try_normalize().map(|d| d.as_vec3())
}

fn unit_between(from: Vec3, to: Vec3) -> Option<Vec3> {
    (to.as_dvec3() - from.as_dvec3()).try_normalize().map(|d| d.as_vec3())
}

/// Right axis for an `up` parallel to the view: x, or y for a view along x.
fn right_of_vertical(forward: Vec3) -> Vec3 {
    let right = if forward.x.abs() < 0.9 { Vec3::X } else { Vec3::Y };
    (right - forward * right.dot(forward)).normalize()
}

/// Rotates `a` towards `b`, and `b` away from `a`.
fn rotate(a: Vec3, b: Vec3, degrees: f32) -> (Vec3, Vec3) {
    if degrees == 0.0 {
        return (a, b);
    }
    let (sin, cos) = portable::sin_cos(degrees.to_radians());
    (a * cos + b * sin, b * cos - a * sin)
}
