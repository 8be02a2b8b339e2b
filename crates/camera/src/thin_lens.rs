//! A camera with a round lens: sharp on one plane, blurred before and behind it (Cook, Porter and Carpenter,
//! Distributed Ray Tracing, 1984).
//!
//! ```json
//! {"thin_lens": {"eye": [0, 2, 6], "look_at": [0, 1, 0], "lens_radius": 0.1, "focus_distance": 6}}
//! ```
//!
//! A point at distance d along the view is spread over a circle of confusion of radius
//! `lens_radius` · |d − `focus_distance`| / `focus_distance`, measured on the plane at distance d.

use super::field_of_view::{FieldOfView, Screen, ViewPlane, positive};
use super::pose::{Axes, Move, Pose};
use super::{Camera, InvalidCamera, Projection};
use juggler_math::{UVec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A camera with a round lens: sharp on one plane, blurred before and behind it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct ThinLens {
    /// Where it stands, world space.
    #[schemars(with = "[f32; 3]")]
    pub eye: Vec3,
    /// Point that it looks at, world space; the origin when neither this nor `direction` is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<[f32; 3]>")]
    pub look_at: Option<Vec3>,
    /// Direction in which it looks, any length; instead of `look_at`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<[f32; 3]>")]
    pub direction: Option<Vec3>,
    /// Direction to which the picture's top leans.
    #[schemars(with = "[f32; 3]")]
    pub up: Vec3,
    /// Turns to the right from there.
    pub yaw_degrees: f32,
    /// Then tilts upwards.
    pub pitch_degrees: f32,
    /// Then leans its top to the right.
    pub roll_degrees: f32,
    /// Then steps along its own axes.
    pub r#move: Move,
    /// Angle that the picture spans from bottom to top. At most one of `vertical_fov_degrees`,
    /// `horizontal_fov_degrees`, `screen` and `view_plane` may be given; without any, it is 40.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 180))]
    pub vertical_fov_degrees: Option<f32>,
    /// Angle that the picture spans from left to right.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 180))]
    pub horizontal_fov_degrees: Option<f32>,
    /// Field of view as a screen of some width at some distance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub screen: Option<Screen>,
    /// Field of view as a rectangle at some distance, over which the picture is stretched.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub view_plane: Option<ViewPlane>,
    /// Radius of the lens, scene units; 0 is a pinhole.
    #[schemars(range(min = 0))]
    pub lens_radius: f32,
    /// Distance of the plane that is sharp, along the view direction, scene units.
    #[schemars(extend("exclusiveMinimum" = 0))]
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
            r#move: Move::default(),
            vertical_fov_degrees: None,
            horizontal_fov_degrees: None,
            screen: None,
            view_plane: None,
            lens_radius: 0.05,
            focus_distance: 5.0,
        }
    }
}

impl ThinLens {
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
        }
    }
}

impl Camera for ThinLens {
    fn project(&self, size: UVec2) -> Result<Projection, InvalidCamera> {
        let half = self.field_of_view().half_extent(size)?;
        positive([("focus_distance", self.focus_distance)])?;
        if !(self.lens_radius >= 0.0 && self.lens_radius.is_finite()) {
            let message = format!("`lens_radius` must be 0 or more, it is {}", self.lens_radius);
            return Err(InvalidCamera::new("lens_radius", message));
        }
        Ok(Projection::thin_lens(&self.pose().axes()?, half, size, self.lens_radius, self.focus_distance))
    }

    fn axes(&self) -> Result<Axes, InvalidCamera> {
        self.pose().axes()
    }

    fn stand(&mut self, eye: Vec3, direction: Vec3, up: Vec3) {
        (self.eye, self.look_at, self.direction, self.up) = (eye, None, Some(direction), up);
        (self.yaw_degrees, self.pitch_degrees, self.roll_degrees) = (0.0, 0.0, 0.0);
        self.r#move = Move::default();
    }

    fn target(&self) -> Option<Vec3> {
        self.look_at
    }

    fn upward(&self) -> Vec3 {
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
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        let aside = Self { eye: Vec3::new(3.0, 1.0, 4.0), roll_degrees: 10.0, lens_radius: 0.3, ..Self::default() };
        vec![Self::default(), aside, Self { lens_radius: 0.0, ..Self::default() }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::{Random, close3};
    use juggler_math::{Ray, Vec2};

    const SIZE: UVec2 = UVec2::new(80, 60);

    /// Looks along -z from the origin.
    fn camera(lens_radius: f32) -> Projection {
        let lens = ThinLens { eye: Vec3::ZERO, direction: Some(-Vec3::Z), lens_radius, ..ThinLens::default() };
        lens.project(SIZE).unwrap()
    }

    /// Where a ray meets the plane `distance` ahead.
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
        let (thin, centre) = (camera(0.4), SIZE.as_vec2() * 0.5);
        let mut random = Random::new(32);
        for distance in [1.0f32, 2.5, 4.0, 7.5, 20.0] {
            let radius = 0.4 * (distance - 5.0).abs() / 5.0;
            let (mut largest, mut squares) = (0f32, 0.0);
            for _ in 0..4000 {
                let spot = at_distance(&thin.ray(centre, random.vec2(), 0.0), distance).truncate().length();
                largest = largest.max(spot);
                squares += spot * spot / 4000.0;
            }
            assert!(largest <= radius * 1.000_01 && largest > radius * 0.99, "{distance}: {largest} of {radius}");
            // Uniform on the disk: the mean square is half the square of the radius.
            assert!((squares / (radius * radius) - 0.5).abs() < 0.02, "{distance}: {squares}");
        }
    }

    #[test]
    fn says_what_is_wrong() {
        for (json, field) in [
            (r#"{"lens_radius": -1}"#, "lens_radius"),
            (r#"{"focus_distance": 0}"#, "focus_distance"),
            (r#"{"screen": {"width": 1, "distance": 1}, "horizontal_fov_degrees": 3}"#, "screen"),
        ] {
            let lens: ThinLens = serde_json::from_str(json).unwrap();
            assert_eq!(lens.project(SIZE).unwrap_err().field, field);
        }
    }
}
