//! What a point light and a spot light share: a place, a size, and light that falls off with distance.

use super::{InvalidLight, check_position, in_range};
use crate::emitter::LightBounds;
use juggler_math::{Aabb, Frame, Vec2, Vec3, warp};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How light falls off with the distance d from the light's centre: by the factor
/// 1 / (constant + linear · d + quadratic · d²). The default is the inverse square of nature.
///
/// A coefficient that is not written is 0: `{"constant": 1}` is light that never falls off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Attenuation {
    /// Does not depend on the distance.
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub constant: f32,
    /// Grows with the distance.
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub linear: f32,
    /// Grows with its square.
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub quadratic: f32,
}

/// A size that casts soft shadows. Light still falls off from the centre, so that the size changes shadows
/// and nothing else.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Extent {
    /// A sphere: the half of its surface that faces the lit point shines, each place the same.
    Sphere {
        /// Radius, scene units.
        #[schemars(range(min = 0))]
        radius: f32,
    },
    /// A square that always faces the lit point.
    Square {
        /// Edge, scene units.
        #[schemars(range(min = 0))]
        side: f32,
    },
}

impl Extent {
    /// Radius of the ball that holds it, whichever way it faces.
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
    /// The factor at a distance.
    #[inline]
    pub fn at(&self, distance: f32) -> f32 {
        1.0 / (self.constant + distance * (self.linear + distance * self.quadratic))
    }
}

/// A place on a light and how to get there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrival {
    /// Unit direction towards the light's centre.
    pub towards_centre: Vec3,
    /// Unit direction towards the place.
    pub wi: Vec3,
    /// Distance of the place.
    pub distance: f32,
    /// Factor on the light's colour, above 0 and finite.
    pub factor: f32,
}

/// Goes from a point to one place of a light, chosen by `u`; `None` at the light's very centre and too far off.
#[inline]
pub(super) fn reach(
    centre: Vec3,
    extent: Option<Extent>,
    attenuation: &Attenuation,
    from: Vec3,
    u: Vec2,
) -> Option<Arrival> {
    let to_centre = centre - from;
    let distance = to_centre.length();
    let factor = attenuation.at(distance);
    let usable = |number: f32| number > 0.0 && number < f32::INFINITY;
    if !(usable(distance) && usable(factor)) {
        return None;
    }
    let towards_centre = to_centre * (1.0 / distance);
    let Some(extent) = extent else {
        return Some(Arrival { towards_centre, wi: towards_centre, distance, factor });
    };
    let frame = Frame::around(-towards_centre);
    let offset = match extent {
        Extent::Sphere { radius } => frame.to_world(warp::uniform_hemisphere(u)) * radius,
        Extent::Square { side } => (frame.tangent * (u.x - 0.5) + frame.bitangent * (u.y - 0.5)) * side,
    };
    let to = to_centre + offset;
    let distance = to.length();
    (distance > 0.0).then(|| Arrival { towards_centre, wi: to * (1.0 / distance), distance, factor })
}

/// Mean over all directions, by a grid.
pub(super) fn mean(share: impl Fn(Vec3) -> f32) -> f32 {
    const ROWS: u16 = 128;
    const COLUMNS: u16 = 64;
    let cell = |i: u16, count: u16| (f32::from(i) + 0.5) / f32::from(count);
    let row = |i: u16| -> f32 {
        (0..COLUMNS).map(|j| share(warp::uniform_sphere(Vec2::new(cell(i, ROWS), cell(j, COLUMNS))))).sum()
    };
    (0..ROWS).map(row).sum::<f32>() / (f32::from(ROWS) * f32::from(COLUMNS))
}

/// Bounds of a light that shines everywhere.
pub(super) fn bounds(position: Vec3, extent: Option<Extent>, power: f32) -> LightBounds {
    let bounds = Aabb { min: position, max: position }.grown(extent.map_or(0.0, Extent::radius));
    LightBounds { bounds, axis: Vec3::Y, cos_theta_o: -1.0, cos_theta_e: 0.0, power, two_sided: false }
}

/// Checks the fields that both lights share.
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
