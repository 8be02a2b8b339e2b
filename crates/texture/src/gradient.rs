//! Color gradient along a line or around a point.
//!
//! ```json
//! {"gradient": {"space": "local", "start": [0, -1, 0], "end": [0, 1, 0], "stops": [
//!     {"position": 0, "color": "#202060"}, {"position": 0.5, "color": [1, 1, 1]},
//!     {"position": 1, "color": "#802020"}]}}
//! ```
//!
//! With d = end - start, the position of a point p is (p - start) · d / |d|², or |p - start| / |d|
//! for the radial shape. Colors are interpolated in linear light. Before the first and after
//! the last stop, the color is constant.

use super::CompiledTexture;
use super::{
    Input, InvalidTexture, SharedTexture, Slot, Space, Texture, TextureError, TextureLookup, TextureResolver,
    TextureTable, check,
};
use juggler_math::{Rgb, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Color gradient along a line or around a point, interpolated in linear light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
#[schemars(rename = "GradientTexture")]
pub struct Gradient {
    /// Stops in order of rising position. Two stops at one position form a sharp edge.
    #[schemars(length(min = 1))]
    pub stops: Vec<Stop>,
    /// Coordinate space of `start` and `end`.
    pub space: Space,
    /// Point of position 0; the center of a radial gradient.
    #[schemars(with = "[f32; 3]", extend("x-unit" = "units of space"))]
    pub start: Vec3,
    /// Point of position 1, different from `start`.
    #[schemars(with = "[f32; 3]", extend("x-unit" = "units of space"))]
    pub end: Vec3,
    /// Shape of the gradient: `linear`, along the line from `start` to `end`, or `radial`, around
    /// `start`.
    pub shape: GradientShape,
}

impl Gradient {
    /// Creates a linear gradient along the surface coordinate v.
    pub fn new(stops: impl Into<Vec<Stop>>) -> Self {
        Self { stops: stops.into(), ..Self::default() }
    }
}

/// Color at a position of a gradient or ramp.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Stop {
    /// Position: from 0 at a gradient's start to 1 at its end, or the number that a ramp maps.
    pub position: f32,
    /// Color at the position.
    pub color: Input<Rgb>,
}

impl Stop {
    /// Creates a stop of a color at a position.
    pub fn new(position: f32, color: impl Into<Input<Rgb>>) -> Self {
        Self { position, color: color.into() }
    }
}

/// Shape of a gradient.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum GradientShape {
    /// Positions grow along the direction from start to end.
    #[default]
    Linear,
    /// Positions grow with the distance from the start.
    Radial,
}

impl Default for Gradient {
    fn default() -> Self {
        Self {
            stops: vec![Stop::new(0.0, Rgb::BLACK), Stop::new(1.0, Rgb::WHITE)],
            space: Space::Uv,
            start: Vec3::ZERO,
            end: Vec3::Y,
            shape: GradientShape::Linear,
        }
    }
}

/// Checks that there are stops, all finite and in order of position.
pub(super) fn check_stops(stops: &[Stop]) -> Result<(), InvalidTexture> {
    if stops.is_empty() {
        return Err(InvalidTexture::new("stops", "a gradient needs at least one stop"));
    }
    for (i, stop) in stops.iter().enumerate() {
        let color = check::color("color", &stop.color);
        if !stop.position.is_finite() || color.is_err() {
            return Err(InvalidTexture::new(format!("stops[{i}]"), "positions and colors must be finite"));
        }
    }
    if let Some(i) = stops.windows(2).position(|pair| matches!(pair, [a, b] if a.position > b.position)) {
        let field = format!("stops[{}].position", i + 1);
        return Err(InvalidTexture::new(field, "positions must not decrease from stop to stop"));
    }
    Ok(())
}

/// Stops with names resolved, in order of position.
#[derive(Clone, Debug)]
pub struct CompiledStops(Vec<(f32, Slot<Rgb>)>);

impl CompiledStops {
    /// Resolves the names of all stops.
    pub fn new(stops: &[Stop], resolver: &mut TextureResolver<'_>) -> Result<Self, TextureError> {
        let stops = stops.iter().enumerate();
        let slot =
            |(i, stop): (usize, &Stop)| Ok((stop.position, resolver.color(&format!("stops[{i}].color"), &stop.color)?));
        stops.map(slot).collect::<Result<_, _>>().map(Self)
    }

    /// Color at a position. `remap` remaps the fraction between two stops.
    pub fn at(&self, position: f32, remap: fn(f32) -> f32, textures: &TextureTable, at: &TextureLookup) -> Rgb {
        let color = |slot: &Slot<Rgb>| textures.color(slot, at);
        // Find the first stop beyond `position`.
        let next = self.0.iter().position(|(stop, _)| position < *stop);
        let before = next.unwrap_or(self.0.len()).checked_sub(1).and_then(|i| self.0.get(i));
        match (before, next.and_then(|i| self.0.get(i))) {
            (Some((a, from)), Some((b, to))) => color(from).lerp(color(to), remap((position - a) / (b - a))),
            (Some((_, stop)), None) | (None, Some((_, stop))) => color(stop),
            (None, None) => Rgb::BLACK,
        }
    }
}

impl Texture for Gradient {
    fn check(&self) -> Result<(), InvalidTexture> {
        check_stops(&self.stops)?;
        let length = (self.end - self.start).length_squared();
        if !(length >= f32::MIN_POSITIVE && length.is_finite()) {
            return Err(InvalidTexture::new(
                "end",
                "`start` and `end` must be two different points, neither too far apart nor too close together",
            ));
        }
        Ok(())
    }

    fn compile(&self, resolver: &mut TextureResolver<'_>) -> Result<SharedTexture, TextureError> {
        let Self { space, start, end, shape, .. } = *self;
        let stops = CompiledStops::new(&self.stops, resolver)?;
        Ok(Arc::new(CompiledGradient { stops, space, start, end, shape }))
    }

    fn space(&self) -> Option<Space> {
        Some(self.space)
    }
}

/// A [`Gradient`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledGradient {
    stops: CompiledStops,
    space: Space,
    start: Vec3,
    end: Vec3,
    shape: GradientShape,
}

impl CompiledGradient {
    fn position(&self, p: Vec3) -> f32 {
        let (along, from_start) = (self.end - self.start, p - self.start);
        match self.shape {
            GradientShape::Linear => from_start.dot(along) / along.length_squared(),
            GradientShape::Radial => from_start.length() / along.length(),
        }
    }
}

impl CompiledTexture for CompiledGradient {
    fn eval(&self, textures: &TextureTable, at: &TextureLookup) -> Rgb {
        self.stops.at(self.position(at.point(self.space)), |share| share, textures, at)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Gradient {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let radial = Self { shape: GradientShape::Radial, space: Space::World, ..Self::default() };
        vec![Self::default(), radial]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::color;
    use juggler_math::Vec2;

    fn at(json: &str, p: Vec3) -> Rgb {
        let gradient: Gradient = serde_json::from_str(json).unwrap();
        gradient.check().unwrap();
        color(
            &gradient.into(),
            &TextureLookup { uv: Vec2::new(p.x, p.y), local: p, world: p * 2.0, ..TextureLookup::default() },
        )
    }

    fn near(a: Rgb, b: [f32; 3]) -> bool {
        (Vec3::from(a.to_array()) - Vec3::from(b)).abs().max_element() < 1e-6
    }

    #[test]
    fn colors_between_stops_are_mixed() {
        let json = r#"{"space": "local", "start": [0, -1, 0], "end": [0, 3, 0], "stops": [{"position": 0, "color": [1, 0, 0]},
            {"position": 0.5, "color": [0, 1, 0]}, {"position": 0.5, "color": [0, 0, 1]}, {"position": 1, "color": [1, 1, 1]}]}"#;
        for (y, color) in [
            (-9.0, [1.0, 0.0, 0.0]),
            (-1.0, [1.0, 0.0, 0.0]),
            (0.0, [0.5, 0.5, 0.0]),
            (0.5, [0.25, 0.75, 0.0]),
            (1.0, [0.0, 0.0, 1.0]),
            (2.0, [0.5, 0.5, 1.0]),
            (3.0, [1.0, 1.0, 1.0]),
            (1e30, [1.0, 1.0, 1.0]),
        ] {
            assert!(near(at(json, Vec3::new(5.0, y, -7.0)), color), "{y}: {:?}", at(json, Vec3::Y * y));
        }
    }

    #[test]
    fn radial_positions_are_distances() {
        let json = r#"{"space": "world", "start": [1, 0, 0], "end": [1, 0, 4], "shape": "radial"}"#;
        // World space is twice the local point in this test.
        assert!(near(at(json, Vec3::new(0.5, 0.6, 0.8)), [0.5; 3]));
        assert!(near(at(json, Vec3::new(0.5, 0.0, 0.0)), [0.0; 3]) && near(at(json, Vec3::ONE * 9.0), [1.0; 3]));
        assert!(near(at(r#"{"stops": [{"position": 0.3, "color": 0.7}]}"#, Vec3::ONE), [0.7; 3]));
    }

    #[test]
    fn invalid_fields_are_named() {
        for (json, field) in [
            (r#"{"stops": []}"#, "stops"),
            (r#"{"stops": [{"position": 1, "color": 0}, {"position": 0, "color": 1}]}"#, "stops[1].position"),
            (r#"{"stops": [{"position": 1e39, "color": 0}]}"#, "stops[0]"),
            (r#"{"start": [0, 1, 0]}"#, "end"),
        ] {
            assert_eq!(serde_json::from_str::<Gradient>(json).unwrap().check().unwrap_err().field, field);
        }
    }
}
