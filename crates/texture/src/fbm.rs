//! Fractional Brownian motion: octaves of noise, for clouds, dirt and rough ground (Musgrave in
//! Ebert et al., Texturing and Modeling, 2003, chapter 14).
//!
//! ```json
//! {"fbm": {"space": "local", "scale": 2, "octaves": 8, "gain": 0.6,
//! "low": "#3060c0", "high": [1, 1, 1]}}
//! ```

use super::CompiledTexture;
use super::noise_blend::{CompiledNoiseBlend, NoiseBlend};
use super::{
    Input, InvalidTexture, SharedTexture, Texture, TextureError, TextureLookup, TextureResolver, TextureTable,
};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Fractional Brownian motion: a sum of octaves of noise. Use it for clouds, dirt and rough ground.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Fbm {
    /// Colors, octaves and placement.
    #[serde(flatten)]
    pub noise_blend: NoiseBlend,
}

impl Fbm {
    /// Creates fractal noise between two colors.
    pub fn new(low: impl Into<Input<Rgb>>, high: impl Into<Input<Rgb>>) -> Self {
        Self { noise_blend: NoiseBlend::new(low, high) }
    }
}

impl Texture for Fbm {
    fn check(&self) -> Result<(), InvalidTexture> {
        self.noise_blend.check()
    }

    fn compile(&self, resolver: &mut TextureResolver<'_>) -> Result<SharedTexture, TextureError> {
        Ok(Arc::new(CompiledFbm(self.noise_blend.compile(resolver)?)))
    }
}

/// A [`Fbm`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledFbm(CompiledNoiseBlend);

impl CompiledTexture for CompiledFbm {
    fn eval(&self, textures: &TextureTable, at: &TextureLookup) -> Rgb {
        self.0.eval(textures, at, |octaves, pattern| 0.5 + 0.5 * octaves.fbm(pattern))
    }
}

#[cfg(any(test, feature = "testing"))]
impl Fbm {
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
    fn one_octave_is_noise_and_more_are_rougher() {
        let one = numbers(r#"{"fbm": {"space": "world", "octaves": 1}}"#);
        let many = numbers(r#"{"fbm": {"space": "world", "octaves": 8, "gain": 0.8}}"#);
        let length = |read: &dyn Fn(Vec3, f32) -> f32| -> f32 {
            let at = |i: i32| read(Vec3::new(i as f32 * 0.003, 0.4, 0.7), 0.0);
            (0..3000).map(|i| (at(i + 1) - at(i)).abs()).sum()
        };
        assert!(length(&many) > 3.0 * length(&one), "{} {}", length(&many), length(&one));
        keeps_its_mean(r#"{"fbm": {"space": "world"}}"#, 0.005);
    }
}
