//! Orthographic camera: all rays are parallel.
//!
//! ```json
//! {"orthographic": {"eye": [0, 2, 6], "look_at": [0, 1, 0], "height": 4}}
//! ```
//!
//! Rays start on the film, a plane through `eye`: objects behind it are not visible.

use super::field_of_view::{check_fit_aspect, enlargement_to_fit, positive};
use super::pose::{CameraAxes, LocalTranslation, Pose};
use super::{Camera, InvalidCamera, Projection};
use juggler_math::{UVec2, Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

const DEFAULT_HEIGHT: f32 = 4.0;

/// Orthographic camera: all rays are parallel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Orthographic {
    /// Position of the camera, in world space.
    #[schemars(with = "[f32; 3]", extend("x-unit" = "scene units"))]
    pub eye: Vec3,
    /// Point that the camera looks at before yaw, pitch and roll, in world space. The default is
    /// the origin, unless `direction` is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<[f32; 3]>", extend("x-unit" = "scene units"))]
    pub look_at: Option<Vec3>,
    /// View direction, of any length; replaces `look_at`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<[f32; 3]>")]
    pub direction: Option<Vec3>,
    /// Direction of the picture's top, of any length. It is projected perpendicular to the view
    /// direction.
    #[schemars(with = "[f32; 3]")]
    pub up: Vec3,
    /// Rotation to the right about the camera's up axis, in degrees.
    #[schemars(extend("x-unit" = "degrees"))]
    pub yaw_degrees: f32,
    /// Upward rotation about the camera's right axis, in degrees, after yaw.
    #[schemars(extend("x-unit" = "degrees"))]
    pub pitch_degrees: f32,
    /// Clockwise rotation of the camera about the view direction, in degrees, after pitch; its top
    /// leans to the right.
    #[schemars(extend("x-unit" = "degrees"))]
    pub roll_degrees: f32,
    /// Translation along the camera's axes, after the rotations.
    pub r#move: LocalTranslation,
    /// Height of the visible area in scene units, above 0. If only `width` is given, the aspect
    /// ratio of the picture gives the height, so pixels are square. If both are given, the picture
    /// is stretched. The default is 4.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
    pub height: Option<f32>,
    /// Width of the visible area in scene units, above 0. The default follows from `height`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
    pub width: Option<f32>,
    /// Aspect ratio, width / height, of the narrowest picture that keeps `height`. A
    /// narrower picture keeps the width that a picture of this aspect ratio has and shows more above
    /// and below, so nothing at its sides is lost. By default `height` holds for every picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub fit_aspect: Option<f32>,
}

impl Default for Orthographic {
    fn default() -> Self {
        Self {
            eye: Vec3::new(0.0, 0.0, 5.0),
            look_at: None,
            direction: None,
            up: Vec3::Y,
            yaw_degrees: 0.0,
            pitch_degrees: 0.0,
            roll_degrees: 0.0,
            r#move: LocalTranslation::default(),
            height: None,
            width: None,
            fit_aspect: None,
        }
    }
}

impl Orthographic {
    /// Creates a camera at `eye` that looks at a point and sees an area of this height.
    pub fn new(eye: impl Into<Vec3>, look_at: impl Into<Vec3>, height: f32) -> Self {
        Self { eye: eye.into(), look_at: Some(look_at.into()), height: Some(height), ..Self::default() }
    }

    fn pose(&self) -> Pose {
        Pose {
            eye: self.eye,
            look_at: self.look_at,
            direction: self.direction,
            up: self.up,
            yaw_degrees: self.yaw_degrees,
            pitch_degrees: self.pitch_degrees,
            roll_degrees: self.roll_degrees,
            r#move: self.r#move,
        }
    }

    fn half_extent(&self, size: UVec2) -> Result<Vec2, InvalidCamera> {
        positive([("width", self.width.unwrap_or(1.0)), ("height", self.height.unwrap_or(1.0))])?;
        check_fit_aspect(self.fit_aspect, self.width.is_some(), "height")?;
        let size = size.max(UVec2::ONE).as_vec2();
        let extent = match (self.width, self.height) {
            (Some(width), Some(height)) => Vec2::new(width, height),
            (Some(width), None) => Vec2::new(width, width * size.y / size.x),
            (None, height) => Vec2::new(size.x / size.y, 1.0) * height.unwrap_or(DEFAULT_HEIGHT),
        };
        let extent = extent * enlargement_to_fit(self.fit_aspect, size);
        if !(extent.min_element() > 0.0 && extent.is_finite()) {
            return Err(InvalidCamera::new(
                "width",
                format!("the camera shows an area of {extent}; both sides must be finite and above 0"),
            ));
        }
        Ok(extent * 0.5)
    }
}

impl Camera for Orthographic {
    fn projection(&self, size: UVec2) -> Result<Projection, InvalidCamera> {
        let half = self.half_extent(size)?;
        Ok(Projection::parallel(&self.pose().axes()?, half, size))
    }

    fn axes(&self) -> Result<CameraAxes, InvalidCamera> {
        self.pose().axes()
    }

    fn set_pose(&mut self, eye: Vec3, direction: Vec3, up: Vec3) {
        (self.eye, self.look_at, self.direction, self.up) = (eye, None, Some(direction), up);
        (self.yaw_degrees, self.pitch_degrees, self.roll_degrees) = (0.0, 0.0, 0.0);
        self.r#move = LocalTranslation::default();
    }

    fn target(&self) -> Option<Vec3> {
        self.look_at
    }

    fn up(&self) -> Vec3 {
        self.up
    }

    fn zoom(&mut self, factor: f32) {
        let factor = if factor > 0.0 { factor } else { 1.0 };
        let zoomed = |length: f32| (length / factor).clamp(f32::MIN_POSITIVE, 1e30);
        if self.width.is_none() {
            self.height = Some(self.height.unwrap_or(DEFAULT_HEIGHT));
        }
        (self.width, self.height) = (self.width.map(zoomed), self.height.map(zoomed));
    }
}

#[cfg(any(test, feature = "testing"))]
impl Orthographic {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let above = Self { eye: Vec3::new(0.0, 9.0, 0.0), width: Some(3.0), ..Self::default() };
        vec![Self::default(), above, Self { fit_aspect: Some(2.0), ..Self::default() }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::close3;

    #[test]
    fn film_edges_stand_where_width_and_height_say() {
        for (json, half) in [
            (r#"{"height": 3}"#, Vec2::new(2.0, 1.5)),
            (r#"{"width": 8}"#, Vec2::new(4.0, 3.0)),
            (r#"{"width": 8, "height": 2}"#, Vec2::new(4.0, 1.0)),
            (r#"{}"#, Vec2::new(8.0 / 3.0, 2.0)),
        ] {
            let camera: Orthographic = serde_json::from_str(json).unwrap();
            let projection = camera.projection(UVec2::new(400, 300)).unwrap();
            let corner = projection.ray(Vec2::ZERO, Vec2::ZERO, 0.0);
            assert!(close3(corner.origin, Vec3::new(-half.x, half.y, 5.0), 1e-6), "{json} {corner:?}");
            assert_eq!(corner.direction, -Vec3::Z);
            let opposite = projection.ray(Vec2::new(400.0, 300.0), Vec2::ZERO, 0.0);
            assert!(close3(opposite.origin, Vec3::new(half.x, -half.y, 5.0), 1e-6), "{json} {opposite:?}");
        }
    }

    #[test]
    fn factors_that_are_not_positive_do_not_zoom() {
        for factor in [0.0, -2.0, f32::NEG_INFINITY, f32::NAN] {
            let mut camera = Orthographic { width: Some(3.0), height: Some(2.0), ..Orthographic::default() };
            camera.zoom(factor);
            assert_eq!((camera.width, camera.height), (Some(3.0), Some(2.0)), "{factor}");
            camera.zoom(2.0);
            assert_eq!((camera.width, camera.height), (Some(1.5), Some(1.0)), "{factor}");
        }
    }

    #[test]
    fn invalid_fields_are_named() {
        for (json, field) in [(r#"{"height": 0}"#, "height"), (r#"{"width": -2}"#, "width")] {
            let camera: Orthographic = serde_json::from_str(json).unwrap();
            assert_eq!(camera.projection(UVec2::new(4, 3)).unwrap_err().field, field);
        }
    }
}
