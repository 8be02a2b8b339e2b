//! Thin-lens camera: a plane in focus, depth-of-field blur before and behind it (Cook, Porter and
//! Carpenter, Distributed Ray Tracing, 1984).
//!
//! ```json
//! {"thin_lens": {"eye": [0, 2, 6], "look_at": [0, 1, 0], "lens_radius": 0.1, "focus_distance": 6}}
//! ```
//!
//! A point at depth d has a circle of confusion of radius `lens_radius` · |d − `focus_distance`| /
//! `focus_distance`, measured on the plane at depth d.

use super::field_of_view::{FULL_FRAME, FieldOfView, ViewPlane, VirtualScreen, positive};
use super::pose::{CameraAxes, LocalTranslation, Pose};
use super::{Camera, InvalidCamera, Projection};
use juggler_math::{UVec2, Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

const METERS_PER_MILLIMETER: f32 = 1e-3;

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
    /// Radius of the lens in scene units, 0 or more. Larger lenses blur more outside the focal
    /// plane; 0 is a pinhole.
    #[schemars(range(min = 0), extend("x-unit" = "scene units"))]
    pub lens_radius: f32,
    /// f-number of the lens, above 0: the focal length divided by the diameter of the lens. It replaces
    /// `lens_radius`. Without `focal_length`, the focal length is the one that gives the field of view
    /// with `sensor_width`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub f_stop: Option<f32>,
    /// Length of a scene unit in meters, above 0, for `f_stop`. The default is 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "m"))]
    pub unit: Option<f32>,
    /// Name of an object whose middle is in focus; it replaces `focus_distance`. The object must be
    /// in front of the camera.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub focus_on: Option<String>,
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
            focal_length: None,
            sensor_width: None,
            fit_aspect: None,
            lens_radius: 0.05,
            f_stop: None,
            unit: None,
            focus_on: None,
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

    /// Radius of the lens in scene units; `half` is half of the width and height of the film at unit
    /// distance.
    fn radius(&self, half: Vec2) -> Result<f32, InvalidCamera> {
        let Some(f_stop) = self.f_stop else {
            return match self.unit {
                Some(_) => Err(InvalidCamera::new("unit", "`unit` has an effect only with `f_stop`")),
                None => Ok(self.lens_radius),
            };
        };
        let sensor_width = self.sensor_width.unwrap_or(FULL_FRAME);
        let unit = self.unit.unwrap_or(1.0);
        positive([("f_stop", f_stop), ("sensor_width", sensor_width), ("unit", unit)])?;
        let focal_length = self.focal_length.unwrap_or(sensor_width * 0.5 / half.x);
        let radius = focal_length * 0.5 / f_stop * (METERS_PER_MILLIMETER / unit);
        if radius.is_finite() { Ok(radius) } else { Err(InvalidCamera::new("f_stop", "the lens would be too large")) }
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

impl Camera for ThinLens {
    fn projection(&self, size: UVec2) -> Result<Projection, InvalidCamera> {
        let half = self.field_of_view().half_extent(size)?;
        positive([("focus_distance", self.focus_distance)])?;
        let radius = self.radius(half)?;
        if !(self.lens_radius >= 0.0 && self.lens_radius.is_finite()) {
            let message = format!("`lens_radius` must be 0 or more, it is {}", self.lens_radius);
            return Err(InvalidCamera::new("lens_radius", message));
        }
        Ok(Projection::thin_lens(&self.pose().axes()?, half, size, radius, self.focus_distance))
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

    fn focus(&mut self, distance: f32) {
        (self.focus_distance, self.focus_on) = (distance, None);
    }

    fn focused_object(&self) -> Option<&str> {
        self.focus_on.as_deref()
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
    use juggler_math::Ray;
    use juggler_math::testing::{Random, close3};

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

    /// A lens of 50 mm at f/2 has a diameter of 25 mm, and a sensor of 36 mm gives 39.6°.
    #[test]
    fn f_stops_give_the_radius_of_the_lens() {
        let radius = |json: &str| {
            let lens: ThinLens = serde_json::from_str(json).unwrap();
            let half = lens.field_of_view().half_extent(SIZE).unwrap();
            (lens.radius(half).unwrap() * 1e6).round() / 1e6
        };
        assert_eq!(radius(r#"{"focal_length": 50, "f_stop": 2}"#), 0.0125);
        assert_eq!(radius(r#"{"focal_length": 50, "f_stop": 2, "unit": 0.001}"#), 12.5);
        // The field of view gives the focal length: 18 mm / tan(45°).
        assert_eq!(radius(r#"{"horizontal_fov_degrees": 90, "f_stop": 4}"#), 0.00225);
        assert_eq!(radius(r#"{"horizontal_fov_degrees": 90, "f_stop": 4, "sensor_width": 24}"#), 0.0015);
        assert_eq!(radius(r#"{"lens_radius": 0.3}"#), 0.3);
        let wide: ThinLens = serde_json::from_str(r#"{"focal_length": 50}"#).unwrap();
        let degrees = 2.0 * wide.field_of_view().half_extent(SIZE).unwrap().x.atan().to_degrees();
        assert!((degrees - 39.6).abs() < 0.01, "{degrees}");
    }

    #[test]
    fn zooming_changes_the_focal_length() {
        let mut lens = ThinLens { focal_length: Some(50.0), ..ThinLens::default() };
        lens.zoom(2.0);
        assert!(
            lens.focal_length.is_some_and(|length| (length - 100.0).abs() < 1e-3)
                && lens.vertical_fov_degrees.is_none()
        );
    }

    #[test]
    fn invalid_fields_are_named() {
        for (json, field) in [
            (r#"{"f_stop": 0}"#, "f_stop"),
            (r#"{"unit": 0.01}"#, "unit"),
            (r#"{"f_stop": 2, "unit": -1}"#, "unit"),
            (r#"{"focal_length": 0}"#, "focal_length"),
            (r#"{"focal_length": 50, "sensor_width": -1}"#, "sensor_width"),
            (r#"{"focal_length": 50, "vertical_fov_degrees": 30}"#, "focal_length"),
            (r#"{"lens_radius": -1}"#, "lens_radius"),
            (r#"{"focus_distance": 0}"#, "focus_distance"),
            (r#"{"screen": {"width": 1, "distance": 1}, "horizontal_fov_degrees": 3}"#, "screen"),
        ] {
            let lens: ThinLens = serde_json::from_str(json).unwrap();
            assert_eq!(lens.projection(SIZE).unwrap_err().field, field);
        }
    }
}
