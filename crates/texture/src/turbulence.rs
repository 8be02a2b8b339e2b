//! Turbulence: octaves of absolute noise, with sharp creases between round bulges, for flames and
//! crumpled metal (Perlin, An Image Synthesizer, 1985).
//!
//! ```json
//! {"turbulence": {"space": "local", "scale": 3, "octaves": 5,
//! "low": "#301008", "high": "#ffc040"}}
//! ```

use super::CompiledTexture;
use super::noise_blend::{CompiledNoiseBlend, NoiseBlend};
use super::{
    Input, InvalidTexture, Octaves, SharedTexture, Texture, TextureError, TextureLookup, TextureResolver, TextureTable,
};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Turbulence: octaves of absolute noise, with sharp creases between round bulges. Use it for
/// flames and crumpled metal.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Turbulence {
    /// Colors, octaves and placement.
    #[serde(flatten)]
    pub noise_blend: NoiseBlend,
}

impl Turbulence {
    /// Creates turbulence between two colors.
    pub fn new(low: impl Into<Input<Rgb>>, high: impl Into<Input<Rgb>>) -> Self {
        Self { noise_blend: NoiseBlend::new(low, high) }
    }
}

impl Texture for Turbulence {
    fn check(&self) -> Result<(), InvalidTexture> {
        self.noise_blend.check()
    }

    fn compile(&self, resolver: &mut TextureResolver<'_>) -> Result<SharedTexture, TextureError> {
        Ok(Arc::new(CompiledTurbulence(self.noise_blend.compile(resolver)?)))
    }
}

/// A [`Turbulence`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledTurbulence(CompiledNoiseBlend);

impl CompiledTexture for CompiledTurbulence {
    fn eval(&self, textures: &TextureTable, at: &TextureLookup) -> Rgb {
        self.0.eval(textures, at, Octaves::turbulence)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Turbulence {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        NoiseBlend::examples().map(|noise_blend| Self { noise_blend }).to_vec()
    }
}

#[cfg(test)]
mod tests {
    use crate::contract::{keeps_its_mean, numbers};
    use juggler_math::Vec3;

    #[test]
    fn turbulence_has_creases_at_zero_and_keeps_its_mean() {
        let read = numbers(r#"{"turbulence": {"space": "world", "octaves": 1}}"#);
        let values: Vec<f32> = (0..20_000).map(|i| read(Vec3::new(i as f32 * 0.002, 0.3, 0.6), 0.0)).collect();
        // Where noise changes sign, its absolute value has a kink: the second difference is twice
        // the slope.
        let bend = values.windows(3).map(|v| (v[0] - 2.0 * v[1] + v[2]).abs()).fold(0.0, f32::max);
        let least = values.iter().fold(1.0f32, |a, b| a.min(*b));
        assert!(bend > 0.002 && (0.0..0.002).contains(&least), "{bend} {least}");
        keeps_its_mean(r#"{"turbulence": {"space": "world"}}"#, 0.01);
    }
}
