//! How much a perspective camera sees: exactly one of four ways to say it.

use super::InvalidCamera;
use juggler_math::{UVec2, Vec2, fun};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A virtual screen in front of the eye; its height follows from the picture's shape (pixels are square).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Screen {
    /// Width, scene units.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub width: f32,
    /// Distance from the eye, scene units.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub distance: f32,
}

/// A virtual screen of stated width and height; pictures of another shape are stretched over it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ViewPlane {
    /// Width, scene units.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub width: f32,
    /// Height, scene units.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub height: f32,
    /// Distance from the eye, scene units.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub distance: f32,
}

/// A field of view as descriptions give it. None: 40 degrees from bottom to top.
pub(super) struct FieldOfView {
    pub vertical_degrees: Option<f32>,
    pub horizontal_degrees: Option<f32>,
    pub screen: Option<Screen>,
    pub view_plane: Option<ViewPlane>,
}

const DEFAULT_VERTICAL_DEGREES: f32 = 40.0;

/// Half of the narrowest and of the widest field of view that zooming leads to, as tangents.
const ZOOM: std::ops::RangeInclusive<f32> = 1e-4..=20.0;

impl FieldOfView {
    /// The same with the tangent of its half divided by `factor`.
    pub fn zoomed(&self, factor: f32) -> Self {
        let factor = if factor > 0.0 { factor } else { 1.0 };
        let tangent = |now: f32| (now / factor).clamp(*ZOOM.start(), *ZOOM.end());
        let angle = |degrees: f32| {
            let now = half_tangent("", degrees).unwrap_or(1.0);
            fun::atan2(tangent(now), 1.0).to_degrees() * 2.0
        };
        let distance = |width: f32, distance: f32| width * 0.5 / tangent(width * 0.5 / distance);
        let nothing = self.horizontal_degrees.is_none() && self.screen.is_none() && self.view_plane.is_none();
        let vertical = self.vertical_degrees.or(nothing.then_some(DEFAULT_VERTICAL_DEGREES));
        let screen = |s: Screen| Screen { distance: distance(s.width, s.distance), ..s };
        let plane = |p: ViewPlane| ViewPlane { distance: distance(p.width, p.distance), ..p };
        Self {
            vertical_degrees: vertical.map(angle),
            horizontal_degrees: self.horizontal_degrees.map(angle),
            screen: self.screen.map(screen),
            view_plane: self.view_plane.map(plane),
        }
    }

    /// Half of the width and height of a film one unit in front of the eye.
    pub fn half_extent(&self, size: UVec2) -> Result<Vec2, InvalidCamera> {
        self.check_single()?;
        let size = size.max(UVec2::ONE).as_vec2();
        let from_width = |x: f32| Vec2::new(x, x * size.y / size.x);
        let (field, half) = if let Some(degrees) = self.horizontal_degrees {
            ("horizontal_fov_degrees", from_width(half_tangent("horizontal_fov_degrees", degrees)?))
        } else if let Some(Screen { width, distance }) = self.screen {
            positive([("screen.width", width), ("screen.distance", distance)])?;
            ("screen", from_width(width * 0.5 / distance))
        } else if let Some(ViewPlane { width, height, distance }) = self.view_plane {
            let fields =
                [("view_plane.width", width), ("view_plane.height", height), ("view_plane.distance", distance)];
            positive(fields)?;
            ("view_plane", Vec2::new(width, height) * 0.5 / distance)
        } else {
            let degrees = self.vertical_degrees.unwrap_or(DEFAULT_VERTICAL_DEGREES);
            let y = half_tangent("vertical_fov_degrees", degrees)?;
            ("vertical_fov_degrees", Vec2::new(y * size.x / size.y, y))
        };
        // Within these limits no ray can overflow or lose its direction.
        if half.min_element() >= 1e-12 && half.max_element() <= 1e12 {
            return Ok(half);
        }
        Err(InvalidCamera::new(
            field,
            format!("`{field}` makes the picture's edges {half} times as far as its distance"),
        ))
    }

    fn check_single(&self) -> Result<(), InvalidCamera> {
        let given = [
            ("vertical_fov_degrees", self.vertical_degrees.is_some()),
            ("horizontal_fov_degrees", self.horizontal_degrees.is_some()),
            ("screen", self.screen.is_some()),
            ("view_plane", self.view_plane.is_some()),
        ];
        let mut given = given.iter().filter(|(_, given)| *given).map(|(field, _)| *field);
        match (given.next(), given.next()) {
            (Some(first), Some(second)) => Err(InvalidCamera::new(
                second,
                format!("`{first}` and `{second}` both set the field of view; give one of them"),
            )),
            _ => Ok(()),
        }
    }
}

fn half_tangent(field: &'static str, degrees: f32) -> Result<f32, InvalidCamera> {
    if degrees > 0.0 && degrees < 180.0 {
        let (sin, cos) = fun::sin_cos(degrees.to_radians() * 0.5);
        return Ok(sin / cos.max(f32::MIN_POSITIVE));
    }
    Err(InvalidCamera::new(field, format!("`{field}` must lie between 0 and 180, it is {degrees}")))
}

/// Refuses numbers that are not finite and above 0.
pub(super) fn positive<const N: usize>(fields: [(&'static str, f32); N]) -> Result<(), InvalidCamera> {
    match fields.iter().find(|(_, value)| !(*value > 0.0 && value.is_finite())) {
        Some((field, value)) => Err(InvalidCamera::new(field, format!("`{field}` must be above 0, it is {value}"))),
        None => Ok(()),
    }
}
