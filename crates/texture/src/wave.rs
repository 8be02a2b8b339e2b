//! Waves: bands across x or rings around the origin, optionally distorted by noise.
//!
//! ```json
//! {"wave": {"space": "world", "shape": "rings", "profile": "sine", "distortion": 0.5,
//! "low": 0, "high": "#2080ff"}}
//! ```
//!
//! The phase is p.x or |p|, plus `distortion` · fBm(p). The profile maps its fractional part to a
//! blend weight of both colors.

use super::CompiledTexture;
use super::compiled::ColorBlend;
use super::lattice::{filter_amplitude, filtered_pulse_train};
use super::mapping::CompiledMapping;
use super::{
    Input, InvalidTexture, Mapping, Octaves, SharedTexture, Space, Texture, TextureError, TextureLookup,
    TextureResolver, TextureTable, check,
};
use juggler_math::{Rgb, portable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Waves with a period of one unit of the pattern: bands or rings, optionally distorted by noise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Wave {
    /// Color of the troughs.
    pub low: Input<Rgb>,
    /// Color of the crests.
    pub high: Input<Rgb>,
    /// Direction of the waves.
    pub shape: WaveShape,
    /// Shape of one period.
    pub profile: WaveProfile,
    /// Amplitude of the distortion, in wavelengths. 0 keeps waves regular.
    #[schemars(range(min = 0, max = 1000))]
    pub distortion: f32,
    /// Noise that distorts the waves.
    #[serde(flatten)]
    pub octaves: Octaves,
    /// Placement of the pattern: coordinate space, scale, rotation and offset.
    #[serde(flatten)]
    pub mapping: Mapping,
}

impl Wave {
    /// Creates a wave between two colors.
    pub fn new(low: impl Into<Input<Rgb>>, high: impl Into<Input<Rgb>>) -> Self {
        Self { low: low.into(), high: high.into(), ..Self::default() }
    }
}

/// Direction of waves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum WaveShape {
    /// Along the pattern's x axis.
    #[default]
    Bands,
    /// Away from the pattern's origin: spheres in space, circles over (u, v).
    Rings,
}

/// Shape of one period of a wave, whose phase runs from 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum WaveProfile {
    /// Sine: trough at 0, crest at 1/2.
    #[default]
    Sine,
    /// Sawtooth: rises linearly and drops at 1.
    Saw,
    /// Triangle: rises linearly up to 1/2, then falls linearly.
    Triangle,
    /// Square: crest in the first half, trough in the second.
    Square,
}

impl Default for Wave {
    fn default() -> Self {
        Self {
            low: Rgb::BLACK.into(),
            high: Rgb::WHITE.into(),
            shape: WaveShape::Bands,
            profile: WaveProfile::Sine,
            distortion: 0.0,
            octaves: Octaves::default(),
            mapping: Mapping::default(),
        }
    }
}

impl Texture for Wave {
    fn check(&self) -> Result<(), InvalidTexture> {
        check::color("low", &self.low)?;
        check::color("high", &self.high)?;
        check::in_range("distortion", self.distortion, 0.0, 1000.0)?;
        self.octaves.check()?;
        self.mapping.check()
    }

    fn compile(&self, resolver: &mut TextureResolver<'_>) -> Result<SharedTexture, TextureError> {
        let colors = ColorBlend { low: resolver.color("low", &self.low)?, high: resolver.color("high", &self.high)? };
        let Self { shape, profile, distortion, octaves, .. } = *self;
        Ok(Arc::new(CompiledWave { colors, shape, profile, distortion, octaves, map: self.mapping.compile(Space::Uv) }))
    }

    fn space(&self) -> Option<Space> {
        Some(self.mapping.space_or(Space::Uv))
    }
}

/// A [`Wave`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledWave {
    colors: ColorBlend,
    shape: WaveShape,
    profile: WaveProfile,
    distortion: f32,
    octaves: Octaves,
    map: CompiledMapping,
}

impl WaveProfile {
    /// Height at a phase, 0 to 1 with mean 1/2, filtered over a footprint of diameter `width`.
    fn height(self, phase: f32, width: f32) -> f32 {
        let at = phase - phase.floor();
        let unfiltered = match self {
            Self::Sine => 0.5 - 0.5 * portable::sin_cos_turns(at).1,
            Self::Saw => at,
            Self::Triangle => 1.0 - (2.0 * at - 1.0).abs(),
            Self::Square => return filtered_pulse_train(phase, 0.5, width),
        };
        0.5 + (unfiltered - 0.5) * filter_amplitude(width)
    }
}

impl CompiledTexture for CompiledWave {
    fn eval(&self, textures: &TextureTable, at: &TextureLookup) -> Rgb {
        let pattern = self.map.pattern_point(at);
        let straight = match self.shape {
            WaveShape::Bands => pattern.point.x,
            WaveShape::Rings => pattern.point.length(),
        };
        let bent = if self.distortion > 0.0 { self.distortion * self.octaves.fbm(pattern) } else { 0.0 };
        let phase = straight + bent;
        let phase = if phase.is_finite() { phase } else { 0.0 };
        self.colors.eval(self.profile.height(phase, pattern.width), textures, at)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Wave {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let rings = Self { shape: WaveShape::Rings, distortion: 5.0, ..Self::default() };
        let profiles = [WaveProfile::Sine, WaveProfile::Saw, WaveProfile::Triangle, WaveProfile::Square];
        let mapping = Mapping::in_space(Space::World);
        profiles
            .map(|profile| Self { profile, mapping, ..rings.clone() })
            .into_iter()
            .chain([Self::default()])
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::{keeps_its_mean, numbers};
    use juggler_math::Vec3;

    #[test]
    fn profiles_have_their_heights_and_repeat() {
        for (profile, heights) in [
            ("sine", [0.0, 0.5, 1.0, 0.5]),
            ("saw", [0.0, 0.25, 0.5, 0.75]),
            ("triangle", [0.0, 0.5, 1.0, 0.5]),
            ("square", [1.0, 1.0, 0.0, 0.0]),
        ] {
            let read = |shape: &str| {
                numbers(&format!(r#"{{"wave": {{"space": "world", "profile": "{profile}", "shape": "{shape}"}}}}"#))
            };
            let (bands, rings) = (read("bands"), read("rings"));
            for (i, height) in heights.into_iter().enumerate() {
                let x = i as f32 * 0.25;
                for x in [x, x + 3.0, x - 8.0] {
                    assert!((bands(Vec3::new(x, 7.0, 1.3), 0.0) - height).abs() < 1e-6, "{profile} {x}");
                }
                let radius = x + 5.1;
                let ring = rings(Vec3::new(0.0, radius * 0.6, radius * 0.8), 0.0);
                assert!((ring - bands(Vec3::X * radius, 0.0)).abs() < 1e-5, "{profile} {radius}");
            }
            // Noise and waves share a lattice, so that phases are not quite equally frequent.
            keeps_its_mean(
                &format!(r#"{{"wave": {{"space": "world", "profile": "{profile}", "distortion": 2}}}}"#),
                0.02,
            );
        }
    }

    #[test]
    fn invalid_fields_are_named() {
        let wrong: Wave = serde_json::from_str(r#"{"distortion": 1e9}"#).unwrap();
        assert_eq!(wrong.check().unwrap_err().field, "distortion");
    }
}
