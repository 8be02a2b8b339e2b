//! Thin-lens camera: a plane in focus, depth-of-field blur before and behind it (Cook, Porter and
//! Carpenter, Distributed Ray Tracing, 1984).
//!
//! ```json
//! {"thin_lens": {"eye": [0, 2, 6], "look_at": [0, 1, 0], "lens_radius": 0.1, "focus_distance": 6}}
//! ```
//!
//! A point at depth d has a circle of confusion of radius `lens_radius` · |d − `focus_distance`| /
//! `focus_distance`, measured on the plane at depth d.

use super::field_of_view::{FieldOfView, ViewPlane, VirtualScreen, positive};
use super::pose::{CameraAxes, LocalTranslation, Pose};
use super::{Camera, InvalidCamera, Projection};
use juggler_math::{UVec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Thin-lens camera: a plane in focus, depth-of-field blur before and behind it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct ThinLens {
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
    /// `horizontal_fov_degrees`, `screen` and `view_plane` may be given; the default is 40.
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
    /// Aspect ratio, width / height, of the narrowest picture that keeps `vertical_fov_degrees`. A
    /// narrower picture keeps the width that a picture of this aspect ratio has and shows more above
    /// and below, so nothing at its sides is lost. By default `vertical_fov_degrees` holds for every picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub fit_aspect: Option<f32>,
    /// Radius of the lens in scene units, 0 or more. Larger lenses blur more outside the focal
    /// plane; 0 is a pinhole.
    #[schemars(range(min = 0), extend("x-unit" = "scene units"))]
    pub lens_radius: f32,
    /// Distance from the eye to the plane in focus along the view direction, in scene units. It
    /// must be above 0.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
    pub focus_distance: f32,
}

impl Default for ThinLens {
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
            fit_aspect: None,
            lens_radius: 0.05,
            focus_distance: 5.0,
        }
    }
}

impl ThinLens {
    /// Creates a camera at `eye` that looks at a point, with the y axis up, through a lens.
    pub fn new(eye: impl Into<Vec3>, look_at: impl Into<Vec3>, lens_radius: f32, focus_distance: f32) -> Self {
        Self { eye: eye.into(), look_at: Some(look_at.into()), lens_radius, focus_distance, ..Self::default() }
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

    fn field_of_view(&self) -> FieldOfView {
        FieldOfView {
            vertical_degrees: self.vertical_fov_degrees,
            horizontal_degrees: self.horizontal_fov_degrees,
            screen: self.screen,
            view_plane: self.view_plane,
            fit_aspect: self.fit_aspect,
        }
    }
}

impl Camera for ThinLens {
    fn projection(&self, size: UVec2) -> Result<Projection, InvalidCamera> {
        let half = self.field_of_view().half_extent(size)?;
        positive([("focus_distance", self.focus_distance)])?;
        if !(self.lens_radius >= 0.0 && self.lens_radius.is_finite()) {
            let message = format!("`lens_radius` must be 0 or more, it is {}", self.lens_radius);
            return Err(InvalidCamera::new("lens_radius", message));
        }
        Ok(Projection::thin_lens(&self.pose().axes()?, half, size, self.lens_radius, self.focus_distance))
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
        (self.screen, self.view_plane) = (zoomed.screen, zoomed.view_plane);
    }

    fn focus(&mut self, distance: f32) {
        self.focus_distance = distance;
    }
}

#[cfg(any(test, feature = "testing"))]
impl ThinLens {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let aside = Self { eye: Vec3::new(3.0, 1.0, 4.0), roll_degrees: 10.0, lens_radius: 0.3, ..Self::default() };
        let fitted = Self { fit_aspect: Some(2.0), ..aside.clone() };
        vec![Self::default(), aside, Self { lens_radius: 0.0, ..Self::default() }, fitted]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::{Random, close3};
    use juggler_math::{Ray, Vec2};

    const SIZE: UVec2 = UVec2::new(80, 60);

    /// Camera at the origin that looks along -z.
    fn camera(lens_radius: f32) -> Projection {
        let lens = ThinLens { eye: Vec3::ZERO, direction: Some(-Vec3::Z), lens_radius, ..ThinLens::default() };
        lens.projection(SIZE).unwrap()
    }

    /// Intersection of a ray with the plane at depth `distance`.
    fn at_distance(ray: &Ray, distance: f32) -> Vec3 {
        ray.at((-distance - ray.origin.z) / ray.direction.z)
    }

    #[test]
    fn the_plane_in_focus_is_sharp() {
        let (thin, pinhole) = (camera(0.4), camera(0.0));
        let mut random = Random::new(31);
        for _ in 0..1000 {
            let film = random.vec2() * SIZE.as_vec2();
            let sharp = at_distance(&pinhole.ray(film, Vec2::ZERO, 0.0), 5.0);
            let ray = thin.ray(film, random.vec2(), 0.0);
            assert!(close3(at_distance(&ray, 5.0), sharp, 1e-6), "{ray:?}");
        }
    }

    #[test]
    fn blur_is_the_circle_of_confusion() {
        let (thin, center) = (camera(0.4), SIZE.as_vec2() * 0.5);
        let mut random = Random::new(32);
        for distance in [1.0f32, 2.5, 4.0, 7.5, 20.0] {
            let radius = 0.4 * (distance - 5.0).abs() / 5.0;
            let (mut largest, mut squares) = (0f32, 0.0);
            for _ in 0..4000 {
                let spot = at_distance(&thin.ray(center, random.vec2(), 0.0), distance).truncate().length();
                largest = largest.max(spot);
                squares += spot * spot / 4000.0;
            }
            assert!(largest <= radius * 1.000_01 && largest > radius * 0.99, "{distance}: {largest} of {radius}");
            // On a uniform disk the mean square is half the square of the radius.
            assert!((squares / (radius * radius) - 0.5).abs() < 0.02, "{distance}: {squares}");
        }
    }

    #[test]
    fn invalid_fields_are_named() {
        for (json, field) in [
            (r#"{"lens_radius": -1}"#, "lens_radius"),
            (r#"{"focus_distance": 0}"#, "focus_distance"),
            (r#"{"screen": {"width": 1, "distance": 1}, "horizontal_fov_degrees": 3}"#, "screen"),
        ] {
            let lens: ThinLens = serde_json::from_str(json).unwrap();
            assert_eq!(lens.projection(SIZE).unwrap_err().field, field);
        }
    }
}
