//! Color ramp: maps the value of another texture to a color by interpolation between stops.
//!
//! ```json
//! {"ramp": {"input": "clouds", "interpolation": "smooth", "stops": [
//!     {"position": 0.4, "color": "#3060c0"}, {"position": 0.6, "color": [1, 1, 1]}]}}
//! ```
//!
//! Before the first and after the last stop, the color is constant.

use super::CompiledTexture;
use super::gradient::{CompiledStops, check_stops};
use super::{
    Input, InvalidTexture, SharedTexture, Slot, Stop, Texture, TextureError, TextureLookup, TextureResolver,
    TextureTable, check,
};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Color ramp: maps a number, such as the luminance of a texture, to a color by interpolation
/// between stops.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Ramp {
    /// Number to map; of a texture, the luminance.
    pub input: Input<f32>,
    /// Stops in order of rising position. Two stops at one position form a sharp edge.
    #[schemars(length(min = 1))]
    pub stops: Vec<Stop>,
    /// Interpolation between stops.
    pub interpolation: Steps,
}

impl Ramp {
    /// Creates a texture that maps a number to the color of its place between the stops.
    pub fn new(input: impl Into<Input<f32>>, stops: impl Into<Vec<Stop>>) -> Self {
        Self { input: input.into(), stops: stops.into(), ..Self::default() }
    }
}

/// Interpolation between the stops of a ramp.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Steps {
    /// Linear interpolation, in linear light.
    #[default]
    Linear,
    /// Smoothstep interpolation, with slope 0 at the stops.
    Smooth,
    /// No interpolation: each color holds up to the next stop.
    Hold,
}

impl Default for Ramp {
    fn default() -> Self {
        let stops = vec![Stop::new(0.0, Rgb::BLACK), Stop::new(1.0, Rgb::WHITE)];
        Self { input: 0.5.into(), stops, interpolation: Steps::Linear }
    }
}

impl Texture for Ramp {
    fn check(&self) -> Result<(), InvalidTexture> {
        if let Some(value) = self.input.constant_factor() {
            check::in_range("input", value, f32::MIN, f32::MAX)?;
        }
        check_stops(&self.stops)
    }

    fn compile(&self, resolver: &mut TextureResolver<'_>) -> Result<SharedTexture, TextureError> {
        let input = resolver.number("input", &self.input)?;
        let stops = CompiledStops::new(&self.stops, resolver)?;
        Ok(Arc::new(CompiledRamp { input, stops, interpolation: self.interpolation }))
    }
}

/// A [`Ramp`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledRamp {
    input: Slot<f32>,
    stops: CompiledStops,
    interpolation: Steps,
}

impl CompiledTexture for CompiledRamp {
    fn eval(&self, textures: &TextureTable, at: &TextureLookup) -> Rgb {
        let remap: fn(f32) -> f32 = match self.interpolation {
            Steps::Linear => |share| share,
            Steps::Smooth => |share| share * share * (3.0 - 2.0 * share),
            Steps::Hold => |_| 0.0,
        };
        self.stops.at(textures.number(&self.input, at), remap, textures, at)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Ramp {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default(), Self { interpolation: Steps::Smooth, ..Self::default() }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::reader;

    #[test]
    fn numbers_become_colors() {
        let at = |input: &str, interpolation: &str| {
            let stops =
                r#"[{"position": 0, "color": 1}, {"position": 2, "color": [3, 5, 9]}, {"position": 2, "color": 7}]"#;
            let json = format!(r#"{{"input": {input}, "interpolation": "{interpolation}", "stops": {stops}}}"#);
            reader(&format!(r#"{{"ramp": {json}}}"#))(&TextureLookup::default())
        };
        assert_eq!(at("-1", "linear"), Rgb::splat(1.0));
        assert_eq!(at("0.5", "linear"), Rgb::new(1.5, 2.0, 3.0));
        assert_eq!(at("0.5", "smooth"), Rgb::new(1.3125, 1.625, 2.25));
        assert_eq!(at("1.9", "hold"), Rgb::splat(1.0));
        assert_eq!(at("2", "hold"), Rgb::splat(7.0));
    }

    #[test]
    fn invalid_fields_are_named() {
        let wrong: Ramp = serde_json::from_str(r#"{"stops": []}"#).unwrap();
        assert_eq!(wrong.check().unwrap_err().field, "stops");
    }
}
