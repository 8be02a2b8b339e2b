//! Noises of many sizes added up: clouds, dirt, rough ground (fractional Brownian motion; Musgrave in Ebert et al.,
//! Texturing and Modeling, 2003, chapter 14).
//!
//! ```json
//! {"fbm": {"space": "local", "scale": 2, "octaves": 8, "gain": 0.6, "low": "#3060c0", "high": [1, 1, 1]}}
//! ```

use super::CompiledTexture;
use super::heights::{CompiledHeights, Heights};
use super::{Compiled, InvalidTexture, Lookup, Resolver, Texture, TextureError, TextureTable};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Noises of many sizes added up: clouds, dirt, rough ground.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Fbm {
    /// Between which colours, of which noises, and where.
    #[serde(flatten)]
    pub heights: Heights,
}

impl Texture for Fbm {
    fn check(&self) -> Result<(), InvalidTexture> {
        self.heights.check()
    }

    fn compile(&self, resolver: &mut Resolver<'_>) -> Result<Compiled, TextureError> {
        Ok(Arc::new(CompiledFbm(self.heights.compile(resolver)?)))
    }
}

/// A [`Fbm`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledFbm(CompiledHeights);

impl CompiledTexture for CompiledFbm {
    fn eval(&self, textures: &TextureTable, at: &Lookup) -> Rgb {
        self.0.at(textures, at, |octaves, place| 0.5 + 0.5 * octaves.signed(place))
    }
}

#[cfg(any(test, feature = "testing"))]
impl Fbm {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        Heights::examples().map(|heights| Self { heights }).to_vec()
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
