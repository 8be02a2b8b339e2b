//! Gradient noise of one frequency (Perlin, Improving Noise, 2002).
//!
//! ```json
//! {"noise": {"space": "local", "scale": 4, "low": "#203010", "high": "#80a040"}}
//! ```

use super::CompiledTexture;
use super::compiled::ColorBlend;
use super::mapping::CompiledMapping;
use super::{
    Input, InvalidTexture, Mapping, SharedTexture, Space, Texture, TextureError, TextureLookup, TextureResolver,
    TextureTable, check, lattice,
};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Gradient noise of one frequency, with features about one unit of the pattern wide.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Noise {
    /// Color where the noise is lowest.
    pub low: Input<Rgb>,
    /// Color where the noise is highest.
    pub high: Input<Rgb>,
    /// Seed of the noise. Another seed gives another pattern of the same kind.
    pub seed: u32,
    /// Placement of the pattern: coordinate space, scale, rotation and offset.
    #[serde(flatten)]
    pub mapping: Mapping,
}

impl Noise {
    /// Creates smooth noise between two colors.
    pub fn new(low: impl Into<Input<Rgb>>, high: impl Into<Input<Rgb>>) -> Self {
        Self { low: low.into(), high: high.into(), ..Self::default() }
    }
}

impl Default for Noise {
    fn default() -> Self {
        Self { low: Rgb::BLACK.into(), high: Rgb::WHITE.into(), seed: 0, mapping: Mapping::default() }
    }
}

impl Texture for Noise {
    fn check(&self) -> Result<(), InvalidTexture> {
        check::color("low", &self.low)?;
        check::color("high", &self.high)?;
        self.mapping.check()
    }

    fn compile(&self, resolver: &mut TextureResolver<'_>) -> Result<SharedTexture, TextureError> {
        let colors = ColorBlend { low: resolver.color("low", &self.low)?, high: resolver.color("high", &self.high)? };
        Ok(Arc::new(CompiledNoise { colors, seed: self.seed, map: self.mapping.compile(Space::Local) }))
    }

    fn space(&self) -> Option<Space> {
        Some(self.mapping.space_or(Space::Local))
    }
}

/// A [`Noise`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledNoise {
    colors: ColorBlend,
    seed: u32,
    map: CompiledMapping,
}

impl CompiledTexture for CompiledNoise {
    fn eval(&self, textures: &TextureTable, at: &TextureLookup) -> Rgb {
        let pattern = self.map.pattern_point(at);
        let share = 0.5 + 0.5 * lattice::noise(pattern.point, self.seed) * lattice::filter_amplitude(pattern.width);
        self.colors.eval(share, textures, at)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Noise {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let world = Self { low: Rgb::new(0.5, 0.1, 0.2).into(), high: Rgb::splat(0.7).into(), ..Self::default() };
        vec![Self::default(), Self { mapping: Mapping::in_space(Space::World), seed: 5, ..world }]
    }
}

#[cfg(test)]
mod tests {
    use crate::contract::{keeps_its_mean, numbers};
    use juggler_math::Vec3;

    #[test]
    fn noise_is_one_half_at_lattice_points_and_follows_the_mapping() {
        let plain = numbers(r#"{"noise": {"space": "world"}}"#);
        let mapped = numbers(r#"{"noise": {"space": "world", "scale": 3, "offset": [1, 2, 3]}}"#);
        assert_eq!(plain(Vec3::new(3.0, -7.0, 12.0), 0.0), 0.5);
        for p in [Vec3::new(0.3, 0.6, 0.1), Vec3::new(-5.2, 3.3, 0.9)] {
            assert!((plain(p * 3.0, 0.0) - mapped(p + Vec3::new(1.0, 2.0, 3.0), 0.0)).abs() < 1e-4);
            assert_ne!(plain(p, 0.0), 0.5);
            assert_eq!((plain(p, 1.0), mapped(p, 0.3)), (0.5, 0.5));
        }
        keeps_its_mean(r#"{"noise": {"space": "world"}}"#, 0.005);
    }
}
