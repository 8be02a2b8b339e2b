//! Two colours between which a sum of noises chooses: what [`Fbm`](super::Fbm) and [`Turbulence`](super::Turbulence)
//! have in common.

use super::compiled::Pair;
use super::mapping::{Map, Place};
use super::{Input, InvalidTexture, Lookup, Mapping, Octaves, Resolver, Space, TextureError, TextureTable, check};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Two colours, and the sum of noises that chooses between them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Heights {
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

impl Default for Heights {
    fn default() -> Self {
        let (octaves, mapping) = (Octaves::default(), Mapping::default());
        Self { low: Rgb::BLACK.into(), high: Rgb::WHITE.into(), octaves, mapping }
    }
}

impl Heights {
    /// Checks numbers.
    pub(super) fn check(&self) -> Result<(), InvalidTexture> {
        check::color("low", &self.low)?;
        check::color("high", &self.high)?;
        self.octaves.check()?;
        self.mapping.check()
    }

    /// With names looked up.
    pub(super) fn compile(&self, resolver: &mut Resolver<'_>) -> Result<CompiledHeights, TextureError> {
        let colors = Pair { low: resolver.color("low", &self.low)?, high: resolver.color("high", &self.high)? };
        Ok(CompiledHeights { colors, octaves: self.octaves, map: self.mapping.compile(Space::Local) })
    }
}

/// [`Heights`] with their names looked up.
#[derive(Clone, Debug)]
pub struct CompiledHeights {
    colors: Pair,
    octaves: Octaves,
    map: Map,
}

impl CompiledHeights {
    /// The colour at a point, where `height`, from 0 to 1, is made of the noises there.
    #[inline]
    pub(super) fn at(&self, textures: &TextureTable, at: &Lookup, height: impl Fn(&Octaves, Place) -> f32) -> Rgb {
        self.colors.at(height(&self.octaves, self.map.place(at)), textures, at)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Heights {
    /// For the contract tests.
    pub fn examples() -> [Self; 2] {
        let rough = Octaves { octaves: 16, lacunarity: 3.5, gain: 1.0, seed: 9 };
        let colors = Self { low: Rgb::new(0.5, 0.1, 0.2).into(), high: Rgb::splat(0.7).into(), ..Self::default() };
        [Self::default(), Self { octaves: rough, mapping: Mapping::of(Space::Local), ..colors }]
    }
}

#[cfg(test)]
mod tests {
    use crate::AnyTexture;

    #[test]
    fn says_what_is_wrong() {
        for (fields, field) in [
            (r#""octaves": 17"#, "octaves"),
            (r#""octaves": 0"#, "octaves"),
            (r#""lacunarity": 0.5"#, "lacunarity"),
            (r#""gain": 1.5"#, "gain"),
            (r#""scale": 0"#, "scale"),
            (r#""low": 1e38"#, "low"),
        ] {
            for kind in ["fbm", "turbulence"] {
                let json = format!(r#"{{"{kind}": {{{fields}}}}}"#);
                let texture: AnyTexture = serde_json::from_str(&json).unwrap();
                assert_eq!(texture.check().unwrap_err().field, field, "{json}");
            }
        }
    }
}
