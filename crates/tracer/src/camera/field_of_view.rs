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

impl FieldOfView {
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
