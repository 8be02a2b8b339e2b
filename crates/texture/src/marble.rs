//! Marble: parallel veins distorted by turbulence (Perlin, An Image Synthesizer, 1985).
//!
//! ```json
//! {"marble": {"space": "local", "scale": 2, "distortion": 3,
//! "stone": "#e8e4dc", "vein": "#302c38"}}
//! ```
//!
//! With p a point of the pattern, the weight of the vein color is (1/2 + 1/2 sin 2π(p.x +
//! `distortion` · turbulence(p)))^`sharpness`.

use super::CompiledTexture;
use super::compiled::ColorBlend;
use super::lattice::filter_amplitude;
use super::mapping::CompiledMapping;
use super::{
    Input, InvalidTexture, Mapping, Octaves, SharedTexture, Space, Texture, TextureError, TextureLookup,
    TextureResolver, TextureTable, check,
};
use juggler_math::{Rgb, portable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Marble: parallel veins, one per unit of the pattern along x, distorted by turbulence.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Marble {
    /// Color between the veins.
    pub stone: Input<Rgb>,
    /// Color of the veins.
    pub vein: Input<Rgb>,
    /// Amplitude of the distortion, in distances between veins. 0 keeps veins straight.
    #[schemars(range(min = 0, max = 1000))]
    pub distortion: f32,
    /// Exponent of the vein profile. 1 makes veins as wide as the stone between them, larger values
    /// make them thinner.
    #[schemars(range(min = 0.01, max = 1000))]
    pub sharpness: f32,
    /// Turbulence that distorts the veins.
    #[serde(flatten)]
    pub octaves: Octaves,
    /// Placement of the pattern: coordinate space, scale, rotation and offset.
    #[serde(flatten)]
    pub mapping: Mapping,
}

impl Marble {
    /// Creates marble of a stone with veins.
    pub fn new(stone: impl Into<Input<Rgb>>, vein: impl Into<Input<Rgb>>) -> Self {
        Self { stone: stone.into(), vein: vein.into(), ..Self::default() }
    }
}

impl Default for Marble {
    fn default() -> Self {
        Self {
            stone: Rgb::splat(0.85).into(),
            vein: Rgb::new(0.2, 0.2, 0.25).into(),
            distortion: 2.0,
            sharpness: 4.0,
            octaves: Octaves::default(),
            mapping: Mapping::default(),
        }
    }
}

impl Texture for Marble {
    fn check(&self) -> Result<(), InvalidTexture> {
        check::color("stone", &self.stone)?;
        check::color("vein", &self.vein)?;
        check::in_range("distortion", self.distortion, 0.0, 1000.0)?;
        check::in_range("sharpness", self.sharpness, 0.01, 1000.0)?;
        self.octaves.check()?;
        self.mapping.check()
    }

    fn compile(&self, resolver: &mut TextureResolver<'_>) -> Result<SharedTexture, TextureError> {
        let colors =
            ColorBlend { low: resolver.color("stone", &self.stone)?, high: resolver.color("vein", &self.vein)? };
        let Self { distortion, sharpness, octaves, .. } = *self;
        let mean = (0..256).map(|i| profile((i as f32 + 0.5) / 256.0, sharpness)).sum::<f32>() / 256.0;
        let map = self.mapping.compile(Space::Local);
        Ok(Arc::new(CompiledMarble { colors, distortion, sharpness, mean, octaves, map }))
    }

    fn space(&self) -> Option<Space> {
        Some(self.mapping.space_or(Space::Local))
    }
}

/// Weight of the vein color at a phase, in turns.
fn profile(turns: f32, sharpness: f32) -> f32 {
    portable::powf(0.5 + 0.5 * portable::sin_cos_turns(turns - turns.floor()).0, sharpness)
}

/// A [`Marble`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledMarble {
    colors: ColorBlend,
    distortion: f32,
    sharpness: f32,
    /// Mean weight of the vein color.
    mean: f32,
    octaves: Octaves,
    map: CompiledMapping,
}

impl CompiledTexture for CompiledMarble {
    fn eval(&self, textures: &TextureTable, at: &TextureLookup) -> Rgb {
        let pattern = self.map.pattern_point(at);
        let unfiltered = profile(pattern.point.x + self.distortion * self.octaves.turbulence(pattern), self.sharpness);
        let share = self.mean + (unfiltered - self.mean) * filter_amplitude(pattern.width);
        self.colors.eval(share, textures, at)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Marble {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let mapping = Mapping::in_space(Space::Local);
        vec![Self::default(), Self { mapping, distortion: 1000.0, sharpness: 0.01, ..Self::default() }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::{keeps_its_mean, numbers};
    use juggler_math::Vec3;

    #[test]
    fn without_distortion_veins_are_straight() {
        let json = r#"{"marble": {"space": "world", "distortion": 0, "sharpness": 2, "stone": 0, "vein": 1}}"#;
        let read = numbers(json);
        for (x, share) in [(0.25, 1.0), (0.75, 0.0), (0.0, 0.25), (-3.75, 1.0), (7.5, 0.25)] {
            assert!((read(Vec3::new(x, 5.0 * x, -2.0), 0.0) - share).abs() < 1e-6, "{x}");
        }
        // The mean of (1/2 + 1/2 sin)² is 3/8.
        assert!((read(Vec3::ZERO, 1e3) - 0.375).abs() < 1e-6);
        keeps_its_mean(json, 0.01);
    }

    #[test]
    fn distortion_bends_veins_and_keeps_the_mean() {
        let json = r#"{"marble": {"space": "world", "distortion": 4, "stone": 0, "vein": 1}}"#;
        let read = numbers(json);
        let column: Vec<f32> = (0..50).map(|i| read(Vec3::new(0.25, i as f32 * 0.37, 0.1), 0.0)).collect();
        assert!(column.iter().any(|v| *v < 0.1) && column.iter().any(|v| *v > 0.8), "{column:?}");
        keeps_its_mean(json, 0.02);
    }

    #[test]
    fn invalid_fields_are_named() {
        for (json, field) in [(r#"{"sharpness": 0}"#, "sharpness"), (r#"{"distortion": -1}"#, "distortion")] {
            assert_eq!(serde_json::from_str::<Marble>(json).unwrap().check().unwrap_err().field, field);
        }
    }
}
