//! Two colors blended by octaves of noise: the common part of [`Fbm`](super::Fbm) and
//! [`Turbulence`](super::Turbulence).

use super::compiled::ColorBlend;
use super::mapping::{CompiledMapping, PatternPoint};
use super::{
    Input, InvalidTexture, Mapping, Octaves, Space, TextureError, TextureLookup, TextureResolver, TextureTable, check,
};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Two colors blended by octaves of noise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct NoiseBlend {
    /// Color where the noise is lowest.
    pub low: Input<Rgb>,
    /// Color where the noise is highest.
    pub high: Input<Rgb>,
    /// Octaves of the noise.
    #[serde(flatten)]
    pub octaves: Octaves,
    /// Placement of the pattern: coordinate space, scale, rotation and offset.
    #[serde(flatten)]
    pub mapping: Mapping,
}

impl Default for NoiseBlend {
    fn default() -> Self {
        let (octaves, mapping) = (Octaves::default(), Mapping::default());
        Self { low: Rgb::BLACK.into(), high: Rgb::WHITE.into(), octaves, mapping }
    }
}

impl NoiseBlend {
    /// Creates a blend of two colors.
    pub fn new(low: impl Into<Input<Rgb>>, high: impl Into<Input<Rgb>>) -> Self {
        Self { low: low.into(), high: high.into(), ..Self::default() }
    }

    /// Checks all values.
    pub(super) fn check(&self) -> Result<(), InvalidTexture> {
        check::color("low", &self.low)?;
        check::color("high", &self.high)?;
        self.octaves.check()?;
        self.mapping.check()
    }

    /// Resolves all names.
    pub(super) fn compile(&self, resolver: &mut TextureResolver<'_>) -> Result<CompiledNoiseBlend, TextureError> {
        let colors = ColorBlend { low: resolver.color("low", &self.low)?, high: resolver.color("high", &self.high)? };
        Ok(CompiledNoiseBlend { colors, octaves: self.octaves, map: self.mapping.compile(Space::Local) })
    }
}

/// [`NoiseBlend`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledNoiseBlend {
    colors: ColorBlend,
    octaves: Octaves,
    map: CompiledMapping,
}

impl CompiledNoiseBlend {
    /// Color at a point. `height` computes the blend weight, 0 to 1, from the octaves at a place.
    #[inline]
    pub(super) fn eval(
        &self,
        textures: &TextureTable,
        at: &TextureLookup,
        height: impl Fn(&Octaves, PatternPoint) -> f32,
    ) -> Rgb {
        self.colors.eval(height(&self.octaves, self.map.pattern_point(at)), textures, at)
    }
}

#[cfg(any(test, feature = "testing"))]
impl NoiseBlend {
    /// Examples for the contract tests.
    pub fn examples() -> [Self; 2] {
        let rough = Octaves { octaves: 16, lacunarity: 3.5, gain: 1.0, seed: 9 };
        let colors = Self { low: Rgb::new(0.5, 0.1, 0.2).into(), high: Rgb::splat(0.7).into(), ..Self::default() };
        [Self::default(), Self { octaves: rough, mapping: Mapping::in_space(Space::Local), ..colors }]
    }
}

#[cfg(test)]
mod tests {
    use crate::AnyTexture;

    #[test]
    fn invalid_fields_are_named() {
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
