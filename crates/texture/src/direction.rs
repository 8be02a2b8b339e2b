//! Direction in a plane, as an angle: the rotation of anisotropy from a texture.
//!
//! ```json
//! {"direction": {"of": "brushed directions", "turns": 0.25}}
//! ```
//!
//! Red and green of the texture, from 0 to 1, encode x and y of a direction from -1 to 1, as in
//! `KHR_materials_anisotropy` of glTF. The value is atan2(y, x) / 2π + `turns`. The angle is taken
//! after the texture is filtered, since angles on both sides of half a turn have no mean.

use super::CompiledTexture;
use super::{
    Input, InvalidTexture, SharedTexture, Slot, Texture, TextureError, TextureLookup, TextureResolver, TextureTable,
    check,
};
use juggler_math::{Rgb, portable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f32::consts::TAU;
use std::sync::Arc;

/// Angle of a direction whose x and y a texture encodes as red and green, in full turns. Use it for
/// `anisotropy_rotation`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Direction {
    /// Texture of directions: red 0 to 1 is x from -1 to 1, green is y. Set an image's
    /// `color_space` to `linear`. The angle of directions of length 0 is 0.
    pub of: Input<Rgb>,
    /// Angle that is added, in full turns.
    #[schemars(range(min = -1e3, max = 1e3), extend("x-unit" = "turns"))]
    pub turns: f32,
}

impl Direction {
    /// Creates a texture of the rotations that the red and green of a color or texture encode.
    pub fn new(of: impl Into<Input<Rgb>>) -> Self {
        Self { of: of.into(), ..Self::default() }
    }
}

impl Default for Direction {
    fn default() -> Self {
        Self { of: Rgb::new(1.0, 0.5, 0.0).into(), turns: 0.0 }
    }
}

impl Texture for Direction {
    fn check(&self) -> Result<(), InvalidTexture> {
        check::color("of", &self.of)?;
        check::in_range("turns", self.turns, -1e3, 1e3)
    }

    fn compile(&self, resolver: &mut TextureResolver<'_>) -> Result<SharedTexture, TextureError> {
        Ok(Arc::new(CompiledDirection { of: resolver.color("of", &self.of)?, turns: self.turns }))
    }
}

/// A [`Direction`] with its name resolved.
#[derive(Clone, Debug)]
pub struct CompiledDirection {
    of: Slot<Rgb>,
    turns: f32,
}

impl CompiledTexture for CompiledDirection {
    fn eval(&self, textures: &TextureTable, at: &TextureLookup) -> Rgb {
        let color = textures.color(&self.of, at);
        let (x, y) = (2.0 * color.r - 1.0, 2.0 * color.g - 1.0);
        Rgb::splat(portable::atan2(y, x) / TAU + self.turns)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Direction {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let wild = Rgb::new(-1e37, 1e37, 0.0).into();
        vec![Self::default(), Self { of: wild, turns: -0.25 }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::reader;

    #[test]
    fn directions_become_turns() {
        for (of, turns, expected) in [
            ("[1, 0.5, 0]", 0.0, 0.0),
            ("[0.5, 1, 0.3]", 0.0, 0.25),
            ("[0.5, 0, 1]", 0.0, -0.25),
            ("[0.75, 0.75, 1]", 0.0, 0.125),
            ("[0.25, 0.25, 1]", 0.5, 0.125),
            // Length does not matter, except that there is no direction at 0.
            ("[0.51, 0.51, 1]", 1.0, 1.125),
            ("[0.5, 0.5, 1]", 0.75, 0.75),
        ] {
            let read = reader(&format!(r#"{{"direction": {{"of": {of}, "turns": {turns}}}}}"#));
            let found = read(&TextureLookup::default());
            assert!((found.g - expected).abs() < 1e-5 && found.r == found.g && found.g == found.b, "{of}: {found:?}");
        }
        let half = reader(r#"{"direction": {"of": [0, 0.5, 0]}}"#)(&TextureLookup::default()).g;
        assert!((half.abs() - 0.5).abs() < 1e-6, "{half}");
    }

    #[test]
    fn angles_are_taken_after_filtering() {
        // Directions slightly below and above half a turn: the mean of their angles would be 0.
        let json = |footprint: f32| {
            let of = r#"{"checker": {"even": [0, 0.51, 0], "odd": [0, 0.49, 0], "size": 1}}"#;
            let named = [
                ("of".to_owned(), serde_json::from_str(of).unwrap()),
                ("t".to_owned(), serde_json::from_str(r#"{"direction": {"of": "of"}}"#).unwrap()),
            ];
            let table = TextureTable::new(named);
            let slot = table.resolve::<Rgb>("t", &Input::Texture("t".into())).unwrap();
            let at = TextureLookup { uv_footprint: footprint, ..TextureLookup::default() };
            table.color(&slot, &at).g
        };
        for footprint in [0.0, 1e4] {
            assert!((json(footprint).abs() - 0.5).abs() < 0.01, "{footprint}: {}", json(footprint));
        }
    }

    #[test]
    fn invalid_fields_are_named() {
        for (json, field) in [(r#"{"turns": 1e4}"#, "turns"), (r#"{"of": 1e38}"#, "of")] {
            assert_eq!(serde_json::from_str::<Direction>(json).unwrap().check().unwrap_err().field, field);
        }
    }
}
