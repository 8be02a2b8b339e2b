//! Noises of many sizes added up: clouds, dirt, rough ground (fractional Brownian motion; Musgrave in Ebert et al.,
//! Texturing and Modeling, 2003, chapter 14).
//!
//! ```json
//! {"fbm": {"space": "local", "scale": 2, "octaves": 8, "gain": 0.6, "low": "#3060c0", "high": [1, 1, 1]}}
//! ```

use super::compiled::Pair;
use super::mapping::Map;
use super::{
    Compiled, Input, InvalidTexture, Lookup, Mapping, Octaves, Resolver, Texture, TextureError, TextureTable, check,
};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Noises of many sizes added up: clouds, dirt, rough ground.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Fbm {
    /// Colour of the lowest places.
    pub low: Input<Rgb>,
    /// Colour of the highest places.
    pub high: Input<Rgb>,
    /// How noises of several sizes are added up.
    #[serde(flatten)]
    pub octaves: Octaves,
    /// Where the pattern lies.
    #[serde(flatten)]
    pub mapping: Mapping,
}

impl Default for Fbm {
    fn default() -> Self {
        let (octaves, mapping) = (Octaves::default(), Mapping::default());
        Self { low: Rgb::BLACK.into(), high: Rgb::WHITE.into(), octaves, mapping }
    }
}

impl Texture for Fbm {
    fn check(&self) -> Result<(), InvalidTexture> {
        check::color("low", &self.low)?;
        check::color("high", &self.high)?;
        self.octaves.check()?;
        self.mapping.check()
    }

    fn compile(&self, resolver: &mut Resolver<'_>) -> Result<Compiled, TextureError> {
        let colors = Pair { low: resolver.color("low", &self.low)?, high: resolver.color("high", &self.high)? };
        Ok(Compiled::Fbm(CompiledFbm { colors, octaves: self.octaves, map: self.mapping.compile() }))
    }
}

/// A [`Fbm`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledFbm {
    colors: Pair,
    octaves: Octaves,
    map: Map,
}

impl CompiledFbm {
    /// The colour at a point; octaves that a footprint covers have faded.
    pub fn eval(&self, textures: &TextureTable, at: &Lookup) -> Rgb {
        self.colors.at(0.5 + 0.5 * self.octaves.signed(self.map.place(at)), textures, at)
    }
}

#[cfg(test)]
impl Fbm {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        let rough = Octaves { octaves: 16, lacunarity: 3.5, gain: 1.0, seed: 9 };
        let colors = Self { low: Rgb::new(0.5, 0.1, 0.2).into(), high: Rgb::splat(0.7).into(), ..Self::default() };
        vec![Self::default(), Self { octaves: rough, mapping: Mapping::of(crate::texture::Space::Local), ..colors }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::contract::{keeps_its_mean, numbers};
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

    #[test]
    fn says_what_is_wrong() {
        for (json, field) in [
            (r#"{"octaves": 17}"#, "octaves"),
            (r#"{"octaves": 0}"#, "octaves"),
            (r#"{"lacunarity": 0.5}"#, "lacunarity"),
            (r#"{"gain": 1.5}"#, "gain"),
            (r#"{"scale": 0}"#, "scale"),
            (r#"{"low": 1e38}"#, "low"),
        ] {
            assert_eq!(serde_json::from_str::<Fbm>(json).unwrap().check().unwrap_err().field, field);
        }
    }
}
