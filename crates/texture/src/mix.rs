//! Blend of two textures or colors: mixed, added, multiplied and so on.
//!
//! ```json
//! {"mix": {"a": "wood", "b": "#402010", "amount": "scratches", "mode": "multiply"}}
//! ```
//!
//! The color is a + amount · (f(a, b) - a), with f the blend mode, in linear light and per channel
//! (the separable blend modes of W3C, Compositing and Blending Level 1, section 9).

use super::CompiledTexture;
use super::{
    Input, InvalidTexture, SharedTexture, Slot, Texture, TextureError, TextureLookup, TextureResolver, TextureTable,
    check,
};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Blend of two textures or colors, in linear light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Mix {
    /// Base color a.
    pub a: Input<Rgb>,
    /// Color b that is blended with the base color.
    pub b: Input<Rgb>,
    /// Weight of the blend, 0 to 1; of a texture, the luminance. 0 leaves `a` unchanged.
    pub amount: Input<f32>,
    /// Blend mode.
    pub mode: MixMode,
}

impl Mix {
    /// Creates a blend of two colors; 0 for `amount` shows `a`, 1 shows `b`.
    pub fn new(a: impl Into<Input<Rgb>>, b: impl Into<Input<Rgb>>, amount: impl Into<Input<f32>>) -> Self {
        Self { a: a.into(), b: b.into(), amount: amount.into(), ..Self::default() }
    }
}

/// Blend mode of two colors a and b, per channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum MixMode {
    /// b.
    #[default]
    Mix,
    /// a + b.
    Add,
    /// a - b, at least 0.
    Subtract,
    /// a · b.
    Multiply,
    /// a + b - a · b, which lightens.
    Screen,
    /// Absolute difference of a and b.
    Difference,
    /// Larger of a and b.
    Lighten,
    /// Smaller of a and b.
    Darken,
}

impl Default for Mix {
    fn default() -> Self {
        Self { a: Rgb::BLACK.into(), b: Rgb::WHITE.into(), amount: 0.5.into(), mode: MixMode::Mix }
    }
}

impl MixMode {
    fn blend(self, a: f32, b: f32) -> f32 {
        match self {
            Self::Mix => b,
            Self::Add => a + b,
            Self::Subtract => (a - b).max(0.0),
            Self::Multiply => a * b,
            Self::Screen => a + b - a * b,
            Self::Difference => (a - b).abs(),
            Self::Lighten => a.max(b),
            Self::Darken => a.min(b),
        }
    }
}

impl Texture for Mix {
    fn check(&self) -> Result<(), InvalidTexture> {
        check::color("a", &self.a)?;
        check::color("b", &self.b)?;
        match self.amount.constant_factor() {
            Some(amount) => check::in_range("amount", amount, 0.0, 1.0),
            None => Ok(()),
        }
    }

    fn compile(&self, resolver: &mut TextureResolver<'_>) -> Result<SharedTexture, TextureError> {
        let (a, b) = (resolver.color("a", &self.a)?, resolver.color("b", &self.b)?);
        let amount = resolver.number("amount", &self.amount)?;
        Ok(Arc::new(CompiledMix { a, b, amount, mode: self.mode }))
    }
}

/// A [`Mix`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledMix {
    a: Slot<Rgb>,
    b: Slot<Rgb>,
    amount: Slot<f32>,
    mode: MixMode,
}

impl CompiledTexture for CompiledMix {
    fn eval(&self, textures: &TextureTable, at: &TextureLookup) -> Rgb {
        let amount = textures.number(&self.amount, at).clamp(0.0, 1.0);
        let a = textures.color(&self.a, at);
        if amount <= 0.0 {
            return a;
        }
        let b = textures.color(&self.b, at);
        let channel = |a: f32, b: f32| {
            let mixed = a + amount * (self.mode.blend(a, b) - a);
            // Nested products may overflow.
            if mixed.is_finite() { mixed } else { a }
        };
        Rgb::new(channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b))
    }
}

#[cfg(any(test, feature = "testing"))]
impl Mix {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let huge = Self { a: Rgb::splat(1e37).into(), b: Rgb::splat(-1e37).into(), ..Self::default() };
        let modes = [MixMode::Multiply, MixMode::Screen, MixMode::Difference];
        let mut examples = modes.map(|mode| Self { mode, ..huge.clone() }).to_vec();
        examples.push(Self { b: Rgb::new(0.5, 0.25, 0.125).into(), a: Rgb::splat(0.1).into(), ..Self::default() });
        examples
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::reader;

    #[test]
    fn blend_modes_match_their_formulas() {
        for (mode, red, green) in [
            ("mix", 0.5, 0.25),
            ("add", 0.75, 2.25),
            ("subtract", 0.0, 1.75),
            ("multiply", 0.125, 0.5),
            ("screen", 0.625, 1.75),
            ("difference", 0.25, 1.75),
            ("lighten", 0.5, 2.0),
            ("darken", 0.25, 0.25),
        ] {
            let at = |amount: f32| {
                let json =
                    format!(r#"{{"a": [0.25, 2, 0], "b": [0.5, 0.25, 0], "mode": "{mode}", "amount": {amount}}}"#);
                reader(&format!(r#"{{"mix": {json}}}"#))(&TextureLookup::default())
            };
            assert_eq!(at(1.0), Rgb::new(red, green, 0.0), "{mode}");
            assert_eq!(at(0.0), Rgb::new(0.25, 2.0, 0.0), "{mode}");
            assert_eq!(at(0.5), Rgb::new((red + 0.25) * 0.5, (green + 2.0) * 0.5, 0.0), "{mode}");
        }
    }

    #[test]
    fn invalid_fields_are_named() {
        for (json, field) in [(r#"{"amount": 1.5}"#, "amount"), (r#"{"b": 1e38}"#, "b")] {
            assert_eq!(serde_json::from_str::<Mix>(json).unwrap().check().unwrap_err().field, field);
        }
    }
}
