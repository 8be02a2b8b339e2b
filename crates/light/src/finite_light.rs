//! Properties that point and spot lights share: position, extent and falloff with distance.

use super::{InvalidLight, check_position, in_range};
use crate::emitter::LightBounds;
use juggler_math::{Aabb, Frame, Vec2, Vec3, warp};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Falloff with the distance d from the light's center: the factor 1 / (constant + linear · d +
/// quadratic · d²). The default is the physical inverse square.
///
/// A missing coefficient is 0: `{"constant": 1}` gives light without falloff. At least one
/// coefficient must be above 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Attenuation {
    /// Constant coefficient, 0 or more.
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub constant: f32,
    /// Coefficient of the distance, 0 or more.
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub linear: f32,
    /// Coefficient of the squared distance, 0 or more.
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub quadratic: f32,
}

/// Size of a light, for soft shadows. The falloff is still measured from the center, so the size
/// changes only the shadows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Extent {
    /// Sphere. The hemisphere that faces the lit point emits uniformly.
    Sphere {
        /// Radius in scene units, 0 or more. Larger values soften shadows; 0 makes them hard.
        #[schemars(range(min = 0), extend("x-unit" = "scene units"))]
        radius: f32,
    },
    /// Square that always faces the lit point.
    Square {
        /// Edge length in scene units, 0 or more. Larger values soften shadows; 0 makes them hard.
        #[schemars(range(min = 0), extend("x-unit" = "scene units"))]
        side: f32,
    },
}

impl Extent {
    /// Radius of the bounding sphere of all orientations.
    pub(super) fn radius(self) -> f32 {
        match self {
            Self::Sphere { radius } => radius,
            Self::Square { side } => side * std::f32::consts::FRAC_1_SQRT_2,
        }
    }
}

impl Default for Attenuation {
    fn default() -> Self {
        Self { constant: 0.0, linear: 0.0, quadratic: 1.0 }
    }
}

impl Attenuation {
    /// Creates the attenuation 1 / (constant + linear d + quadratic d²) over the distance d.
    pub fn new(constant: f32, linear: f32, quadratic: f32) -> Self {
        Self { constant, linear, quadratic }
    }

    /// Falloff factor at `distance`.
    #[inline]
    pub fn at(&self, distance: f32) -> f32 {
        1.0 / (self.constant + distance * (self.linear + distance * self.quadratic))
    }
}

/// Sampled point of a light, as seen from the lit point.
#[derive(Clone, Copy, Debug)]
pub(super) struct PointOnLight {
    /// Unit direction towards the light's center.
    pub towards_center: Vec3,
    /// Unit direction towards the sampled point.
    pub wi: Vec3,
    /// Distance of the sampled point.
    pub distance: f32,
    /// Falloff factor, above 0 and finite.
    pub falloff: f32,
}

/// Samples a point of a light with `u` in the unit square. `None` at the light's center, and where
/// the falloff factor underflows or overflows.
#[inline(always)]
pub(super) fn sample_extent(
    center: Vec3,
    extent: Option<Extent>,
    attenuation: &Attenuation,
    from: Vec3,
    u: Vec2,
) -> Option<PointOnLight> {
    let to_center = center - from;
    let distance = to_center.length();
    let falloff = attenuation.at(distance);
    let usable = |number: f32| number > 0.0 && number < f32::INFINITY;
    if !(usable(distance) && usable(falloff)) {
        return None;
    }
    let towards_center = to_center * (1.0 / distance);
    let Some(extent) = extent else {
        return Some(PointOnLight { towards_center, wi: towards_center, distance, falloff });
    };
    let frame = Frame::around(-towards_center);
    let offset = match extent {
        Extent::Sphere { radius } => frame.to_world(warp::uniform_hemisphere(u)) * radius,
        Extent::Square { side } => (frame.tangent * (u.x - 0.5) + frame.bitangent * (u.y - 0.5)) * side,
    };
    let to = to_center + offset;
    let distance = to.length();
    (distance > 0.0).then(|| PointOnLight { towards_center, wi: to * (1.0 / distance), distance, falloff })
}

/// Factor max(min(1 - (d/r)⁴, 1), 0) at `distance` from a light of range `range`
/// (KHR_lights_punctual).
fn range_falloff(distance: f32, range: f32) -> f32 {
    let squared = (distance / range) * (distance / range);
    (1.0 - squared * squared).clamp(0.0, 1.0)
}

/// Factor by which a light's `range`, if it has one, dims it at `from`.
#[inline(never)]
pub(super) fn range_factor(range: Option<f32>, center: Vec3, from: Vec3) -> f32 {
    range.map_or(1.0, |range| range_falloff((center - from).length(), range))
}

/// Factor from the intensity to the power per steradian that counts for light selection. A light
/// without inverse-square falloff counts at `world_radius`, or at its range if that is nearer, so
/// the estimate stays above 0 wherever the light emits to.
pub(super) fn power_per_intensity(attenuation: &Attenuation, range: Option<f32>, world_radius: f32) -> f32 {
    let radius = range.map_or(world_radius, |range| world_radius.min(range));
    attenuation.at(radius) * radius * radius
}

/// Checks the range of a light.
pub(super) fn check_range(range: Option<f32>) -> Result<(), InvalidLight> {
    range.map_or(Ok(()), |range| in_range("range", range, 1e-30, f32::MAX))
}

/// Mean over all directions, on a stratified grid.
pub(super) fn mean_over_sphere(value: impl Fn(Vec3) -> f32) -> f32 {
    const ROWS: u16 = 128;
    const COLUMNS: u16 = 64;
    let cell = |i: u16, count: u16| (f32::from(i) + 0.5) / f32::from(count);
    let row = |i: u16| -> f32 {
        (0..COLUMNS).map(|j| value(warp::uniform_sphere(Vec2::new(cell(i, ROWS), cell(j, COLUMNS))))).sum()
    };
    (0..ROWS).map(row).sum::<f32>() / (f32::from(ROWS) * f32::from(COLUMNS))
}

/// Bounds of a light that emits in all directions.
pub(super) fn bounds(position: Vec3, extent: Option<Extent>, power: f32) -> LightBounds {
    let bounds = Aabb { min: position, max: position }.grown(extent.map_or(0.0, Extent::radius));
    LightBounds { bounds, axis: Vec3::Y, cos_theta_o: -1.0, cos_theta_e: 0.0, power, two_sided: false }
}

/// Checks the fields that point and spot lights share.
pub(super) fn check(
    position: Vec3,
    extent: Option<Extent>,
    attenuation: &Attenuation,
    samples: u32,
) -> Result<(), InvalidLight> {
    check_position(position)?;
    let Attenuation { constant, linear, quadratic } = *attenuation;
    in_range("attenuation.constant", constant, 0.0, f32::MAX)?;
    in_range("attenuation.linear", linear, 0.0, f32::MAX)?;
    in_range("attenuation.quadratic", quadratic, 0.0, f32::MAX)?;
    if constant + linear + quadratic == 0.0 {
        let message = "one of `constant`, `linear` and `quadratic` must be above 0".into();
        return Err(InvalidLight { field: "attenuation", message });
    }
    match extent {
        Some(Extent::Sphere { radius }) => in_range("extent.sphere.radius", radius, 0.0, f32::MAX)?,
        Some(Extent::Square { side }) => in_range("extent.square.side", side, 0.0, f32::MAX)?,
        None => {}
    }
    in_range("samples", samples as f32, 1.0, 10_000.0)
}
