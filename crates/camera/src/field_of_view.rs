//! Field of view of a perspective camera, given by one of five alternatives.

use super::InvalidCamera;
use juggler_math::{UVec2, Vec2, portable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Field of view as a virtual screen in front of the eye. The aspect ratio of the picture gives its
/// height, so pixels are square.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "Screen")]
pub struct VirtualScreen {
    /// Width in scene units, above 0.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
    pub width: f32,
    /// Distance from the eye in scene units, above 0.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
    pub distance: f32,
}

impl VirtualScreen {
    /// Creates a screen of a width at a distance from the eye.
    pub fn new(width: f32, distance: f32) -> Self {
        Self { width, distance }
    }
}

/// Field of view as a virtual screen of a given width and height. A picture of another aspect ratio
/// is stretched over it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ViewPlane {
    /// Width in scene units, above 0.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
    pub width: f32,
    /// Height in scene units, above 0.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
    pub height: f32,
    /// Distance from the eye in scene units, above 0.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
    pub distance: f32,
}

impl ViewPlane {
    /// Creates a view plane of a width and a height at a distance from the eye.
    pub fn new(width: f32, height: f32, distance: f32) -> Self {
        Self { width, height, distance }
    }
}

/// Field of view as a description gives it. If all fields are `None`, it is 40 degrees vertically.
pub(super) struct FieldOfView {
    pub vertical_degrees: Option<f32>,
    pub horizontal_degrees: Option<f32>,
    pub screen: Option<VirtualScreen>,
    pub view_plane: Option<ViewPlane>,
    /// Focal length in millimeters.
    pub focal_length: Option<f32>,
    /// Width of the sensor in millimeters.
    pub sensor_width: Option<f32>,
    pub fit_aspect: Option<f32>,
}

/// Width of a full-frame sensor in millimeters.
pub(super) const FULL_FRAME: f32 = 36.0;

const DEFAULT_VERTICAL_DEGREES: f32 = 40.0;

/// Range of the tangent of half the field of view when zooming.
const ZOOM_RANGE: std::ops::RangeInclusive<f32> = 1e-4..=20.0;

impl FieldOfView {
    /// Returns the field of view with the tangent of its half divided by `factor`, clamped to
    /// [`ZOOM_RANGE`].
    pub fn zoomed(&self, factor: f32) -> Self {
        let factor = if factor > 0.0 { factor } else { 1.0 };
        let tangent = |now: f32| (now / factor).clamp(*ZOOM_RANGE.start(), *ZOOM_RANGE.end());
        let angle = |degrees: f32| {
            let now = half_tangent("", degrees).unwrap_or(1.0);
            portable::atan2(tangent(now), 1.0).to_degrees() * 2.0
        };
        let distance = |width: f32, distance: f32| width * 0.5 / tangent(width * 0.5 / distance);
        let nothing = !self.gives_width();
        let vertical = self.vertical_degrees.or(nothing.then_some(DEFAULT_VERTICAL_DEGREES));
        let screen = |s: VirtualScreen| VirtualScreen { distance: distance(s.width, s.distance), ..s };
        let plane = |p: ViewPlane| ViewPlane { distance: distance(p.width, p.distance), ..p };
        Self {
            vertical_degrees: vertical.map(angle),
            horizontal_degrees: self.horizontal_degrees.map(angle),
            screen: self.screen.map(screen),
            view_plane: self.view_plane.map(plane),
            focal_length: self.focal_length.map(|length| distance(self.sensor_width(), length)),
            sensor_width: self.sensor_width,
            fit_aspect: self.fit_aspect,
        }
    }

    fn sensor_width(&self) -> f32 {
        self.sensor_width.unwrap_or(FULL_FRAME)
    }

    /// Whether a field gives the width of what the picture shows.
    fn gives_width(&self) -> bool {
        self.horizontal_degrees.is_some()
            || self.screen.is_some()
            || self.view_plane.is_some()
            || self.focal_length.is_some()
    }

    /// Half of the width and height of the film at unit distance from the eye.
    pub fn half_extent(&self, size: UVec2) -> Result<Vec2, InvalidCamera> {
        self.check_single()?;
        check_fit_aspect(self.fit_aspect, self.gives_width(), "vertical_fov_degrees")?;
        let size = size.max(UVec2::ONE).as_vec2();
        let from_width = |x: f32| Vec2::new(x, x * size.y / size.x);
        let (field, half) = if let Some(degrees) = self.horizontal_degrees {
            ("horizontal_fov_degrees", from_width(half_tangent("horizontal_fov_degrees", degrees)?))
        } else if let Some(VirtualScreen { width, distance }) = self.screen {
            positive([("screen.width", width), ("screen.distance", distance)])?;
            ("screen", from_width(width * 0.5 / distance))
        } else if let Some(ViewPlane { width, height, distance }) = self.view_plane {
            let fields =
                [("view_plane.width", width), ("view_plane.height", height), ("view_plane.distance", distance)];
            positive(fields)?;
            ("view_plane", Vec2::new(width, height) * 0.5 / distance)
        } else if let Some(length) = self.focal_length {
            positive([("focal_length", length), ("sensor_width", self.sensor_width())])?;
            ("focal_length", from_width(self.sensor_width() * 0.5 / length))
        } else {
            let degrees = self.vertical_degrees.unwrap_or(DEFAULT_VERTICAL_DEGREES);
            let y = half_tangent("vertical_fov_degrees", degrees)?;
            let half = Vec2::new(y * size.x / size.y, y);
            ("vertical_fov_degrees", half * enlargement_to_fit(self.fit_aspect, size))
        };
        // Stay within limits where no ray overflows or loses its direction.
        if half.min_element() >= 1e-12 && half.max_element() <= 1e12 {
            return Ok(half);
        }
        Err(InvalidCamera::new(
            field,
            format!("`{field}` is out of range: half the picture's size is {half} times its distance"),
        ))
    }

    fn check_single(&self) -> Result<(), InvalidCamera> {
        let given = [
            ("vertical_fov_degrees", self.vertical_degrees.is_some()),
            ("horizontal_fov_degrees", self.horizontal_degrees.is_some()),
            ("screen", self.screen.is_some()),
            ("view_plane", self.view_plane.is_some()),
            ("focal_length", self.focal_length.is_some()),
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
        let (sin, cos) = portable::sin_cos(degrees.to_radians() * 0.5);
        return Ok(sin / cos.max(f32::MIN_POSITIVE));
    }
    Err(InvalidCamera::new(field, format!("`{field}` must lie between 0 and 180, it is {degrees}")))
}

/// Factor on the film's extent by which a picture narrower than `fit_aspect` keeps the width that a
/// picture of that aspect ratio has.
pub(super) fn enlargement_to_fit(fit_aspect: Option<f32>, size: Vec2) -> f32 {
    fit_aspect.map_or(1.0, |aspect| (aspect * size.y / size.x).max(1.0))
}

/// Checks `fit_aspect`, which needs a given height: `gives_width` is whether other fields give the
/// width, and `height_field` is the field that gives the height.
pub(super) fn check_fit_aspect(
    fit_aspect: Option<f32>,
    gives_width: bool,
    height_field: &str,
) -> Result<(), InvalidCamera> {
    let Some(aspect) = fit_aspect else { return Ok(()) };
    positive([("fit_aspect", aspect)])?;
    if gives_width {
        let message = format!("`fit_aspect` needs `{height_field}`: other fields give the width already");
        return Err(InvalidCamera::new("fit_aspect", message));
    }
    Ok(())
}

/// Rejects numbers that are not finite and above 0.
pub(super) fn positive<const N: usize>(fields: [(&'static str, f32); N]) -> Result<(), InvalidCamera> {
    match fields.iter().find(|(_, value)| !(*value > 0.0 && value.is_finite())) {
        Some((field, value)) => Err(InvalidCamera::new(field, format!("`{field}` must be above 0, it is {value}"))),
        None => Ok(()),
    }
}
