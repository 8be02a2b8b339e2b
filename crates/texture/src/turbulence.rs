//! Folded noises of many sizes added up: sharp creases between round bulges, flames, crumpled metal (Perlin, An Image
//! Synthesizer, 1985).
//!
//! ```json
//! {"turbulence": {"space": "local", "scale": 3, "octaves": 5, "low": "#301008", "high": "#ffc040"}}
//! ```

use super::CompiledTexture;
use super::heights::{CompiledHeights, Heights};
use super::{Compiled, InvalidTexture, Lookup, Octaves, Resolver, Texture, TextureError, TextureTable};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Folded noises of many sizes added up: sharp creases between round bulges.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Turbulence {
    /// Between which colours, of which noises, and where.
    #[serde(flatten)]
    pub heights: Heights,
}

impl Texture for Turbulence {
    fn check(&self) -> Result<(), InvalidTexture> {
        self.heights.check()
    }

    fn compile(&self, resolver: &mut Resolver<'_>) -> Result<Compiled, TextureError> {
        Ok(Arc::new(CompiledTurbulence(self.heights.compile(resolver)?)))
    }
}

/// A [`Turbulence`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledTurbulence(CompiledHeights);

impl CompiledTexture for CompiledTurbulence {
    fn eval(&self, textures: &TextureTable, at: &Lookup) -> Rgb {
        self.0.at(textures, at, Octaves::unsigned)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Turbulence {
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
    fn it_has_creases_at_zero_and_keeps_its_mean() {
        let read = numbers(r#"{"turbulence": {"space": "world", "octaves": 1}}"#);
        let values: Vec<f32> = (0..20_000).map(|i| read(Vec3::new(i as f32 * 0.002, 0.3, 0.6), 0.0)).collect();
        // Where noise changes its sign, its fold has a bend: the second difference is as large as twice the slope.
        let bend = values.windows(3).map(|v| (v[0] - 2.0 * v[1] + v[2]).abs()).fold(0.0, f32::max);
        let least = values.iter().fold(1.0f32, |a, b| a.min(*b));
        assert!(bend > 0.002 && (0.0..0.002).contains(&least), "{bend} {least}");
        keeps_its_mean(r#"{"turbulence": {"space": "world"}}"#, 0.01);
    }
}
