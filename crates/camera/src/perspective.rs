//! Pinhole camera.
//!
//! ```json
//! {"perspective": {"eye": [0, 2, 6], "look_at": [0, 1, 0], "vertical_fov_degrees": 40}}
//! ```
//!
//! The Juggler's virtual screen is `"screen": {"width": 100, "distance": 50}`. The teaching
//! engine's is `"view_plane": {"width": 500, "height": 500, "distance": 660}`. ScalaBlitz's zoom
//! angle is the vertical field of view, because tan(π α / 360) is the tangent of half of α degrees.

use super::field_of_view::{FieldOfView, ViewPlane, VirtualScreen};
use super::pose::{CameraAxes, LocalTranslation, Pose};
use super::{Camera, InvalidCamera, Projection};
use juggler_math::{UVec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Pinhole camera: objects at all distances are sharp.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Perspective {
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
    /// Vertical field of view in degrees, between 0 and 180. At most one of `vertical_fov_degrees`,
    /// `horizontal_fov_degrees`, `screen`, `view_plane` and `focal_length` may be given; the default is
    /// 40.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 180, "x-unit" = "degrees"))]
    pub vertical_fov_degrees: Option<f32>,
    /// Horizontal field of view in degrees, between 0 and 180.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 180, "x-unit" = "degrees"))]
    pub horizontal_fov_degrees: Option<f32>,
    /// Field of view as a screen of a given width at a given distance; pixels are square.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub screen: Option<VirtualScreen>,
    /// Field of view as a rectangle at a given distance; the picture is stretched over it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub view_plane: Option<ViewPlane>,
    /// Focal length in millimeters, above 0, of a lens before a sensor of width `sensor_width`: it
    /// gives the field of view.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "mm"))]
    pub focal_length: Option<f32>,
    /// Width of the sensor in millimeters, above 0, which the picture's width stands for. The default
    /// is 36, a full frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "mm"))]
    pub sensor_width: Option<f32>,
    /// Aspect ratio, width / height, of the narrowest picture that keeps `vertical_fov_degrees`. A
    /// narrower picture keeps the width that a picture of this aspect ratio has and shows more above
    /// and below, so nothing at its sides is lost. By default `vertical_fov_degrees` holds for every picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub fit_aspect: Option<f32>,
}

impl Default for Perspective {
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
            vertical_fov_degrees: None,
            horizontal_fov_degrees: None,
            screen: None,
            view_plane: None,
            focal_length: None,
            sensor_width: None,
            fit_aspect: None,
        }
    }
}

impl Perspective {
    /// Creates a camera at `eye` that looks at a point, with the y axis up.
    pub fn new(eye: impl Into<Vec3>, look_at: impl Into<Vec3>) -> Self {
        Self { eye: eye.into(), look_at: Some(look_at.into()), ..Self::default() }
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

    /// Fails for the width of a sensor without a focal length.
    fn check_sensor(&self) -> Result<(), InvalidCamera> {
        if self.sensor_width.is_none() || self.focal_length.is_some() {
            return Ok(());
        }
        let message = "`sensor_width` has an effect only with `focal_length`";
        Err(InvalidCamera::new("sensor_width", message))
    }

    fn field_of_view(&self) -> FieldOfView {
        FieldOfView {
            vertical_degrees: self.vertical_fov_degrees,
            horizontal_degrees: self.horizontal_fov_degrees,
            screen: self.screen,
            view_plane: self.view_plane,
            focal_length: self.focal_length,
            sensor_width: self.sensor_width,
            fit_aspect: self.fit_aspect,
        }
    }
}

impl Camera for Perspective {
    fn projection(&self, size: UVec2) -> Result<Projection, InvalidCamera> {
        self.check_sensor()?;
        let half = self.field_of_view().half_extent(size)?;
        Ok(Projection::pinhole(&self.pose().axes()?, half, size))
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
        let zoomed = self.field_of_view().zoomed(factor);
        (self.vertical_fov_degrees, self.horizontal_fov_degrees) = (zoomed.vertical_degrees, zoomed.horizontal_degrees);
        (self.screen, self.view_plane, self.focal_length) = (zoomed.screen, zoomed.view_plane, zoomed.focal_length);
    }
}

#[cfg(any(test, feature = "testing"))]
impl Perspective {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let juggler = Self {
            eye: Vec3::new(2.0, 100.0, -2.0),
            look_at: Some(Vec3::new(1000.0, 77.0, -1000.0)),
            screen: Some(VirtualScreen { width: 100.0, distance: 50.0 }),
            ..Self::default()
        };
        let chess = Self {
            eye: Vec3::new(-500.0, 100.0, 400.0),
            direction: Some(Vec3::new(5.0, -1.0, 0.0)),
            up: Vec3::Z,
            pitch_degrees: -40.0,
            view_plane: Some(ViewPlane { width: 500.0, height: 500.0, distance: 660.0 }),
            ..Self::default()
        };
        vec![Self::default(), juggler, chess, Self { fit_aspect: Some(2.0), ..Self::default() }]
    }
}
