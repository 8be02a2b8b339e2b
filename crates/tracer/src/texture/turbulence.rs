//! Folded noises of many sizes added up: sharp creases between round bulges, flames, crumpled metal (Perlin, An Image
//! Synthesizer, 1985).
//!
//! ```json
//! {"turbulence": {"space": "local", "scale": 3, "octaves": 5, "low": "#301008", "high": "#ffc040"}}
//! ```

use super::compiled::Pair;
use super::mapping::Map;
use super::{
    Compiled, Input, InvalidTexture, Lookup, Mapping, Octaves, Resolver, Texture, TextureError, TextureTable, check,
};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Folded noises of many sizes added up: sharp creases between round bulges.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Turbulence {
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

impl Default for Turbulence {
    fn default() -> Self {
        let (octaves, mapping) = (Octaves::default(), Mapping::default());
        Self { low: Rgb::BLACK.into(), high: Rgb::WHITE.into(), octaves, mapping }
    }
}

impl Texture for Turbulence {
    fn check(&self) -> Result<(), InvalidTexture> {
        check::color("low", &self.low)?;
        check::color("high", &self.high)?;
        self.octaves.check()?;
        self.mapping.check()
    }

    fn compile(&self, resolver: &mut Resolver<'_>) -> Result<Compiled, TextureError> {
        let colors = Pair { low: resolver.color("low", &self.low)?, high: resolver.color("high", &self.high)? };
        Ok(Compiled::Turbulence(CompiledTurbulence { colors, octaves: self.octaves, map: self.mapping.compile() }))
    }
}

/// A [`Turbulence`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledTurbulence {
    colors: Pair,
    octaves: Octaves,
    map: Map,
}

impl CompiledTurbulence {
    /// The colour at a point: `low` at the creases.
    pub fn eval(&self, textures: &TextureTable, at: &Lookup) -> Rgb {
        self.colors.at(self.octaves.unsigned(self.map.place(at)), textures, at)
    }
}

#[cfg(test)]
impl Turbulence {
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
    fn it_has_creases_at_zero_and_keeps_its_mean() {
        let read = numbers(r#"{"turbulence": {"space": "world", "octaves": 1}}"#);
        let values: Vec<f32> = (0..20_000).map(|i| read(Vec3::new(i as f32 * 0.002, 0.3, 0.6), 0.0)).collect();
        // Where noise changes its sign, its fold has a bend: the second difference is as large as twice the slope.
        let bend = values.windows(3).map(|v| (v[0] - 2.0 * v[1] + v[2]).abs()).fold(0.0, f32::max);
        let least = values.iter().fold(1.0f32, |a, b| a.min(*b));
        assert!(bend > 0.002 && (0.0..0.002).contains(&least), "{bend} {least}");
        keeps_its_mean(r#"{"turbulence": {"space": "world"}}"#, 0.01);
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
            assert_eq!(serde_json::from_str::<Turbulence>(json).unwrap().check().unwrap_err().field, field);
        }
    }
}
