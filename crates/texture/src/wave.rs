//! Waves: bands across x or rings about the origin, straight or bent by noise.
//!
//! ```json
//! {"wave": {"space": "world", "shape": "rings", "profile": "sine", "distortion": 0.5, "low": 0, "high": "#2080ff"}}
//! ```
//!
//! The phase is p.x or |p|, plus `distortion` · fbm(p); the colour follows its fraction by the profile.

use super::CompiledTexture;
use super::compiled::Pair;
use super::lattice::{kept, pulses};
use super::mapping::Map;
use super::{
    Compiled, Input, InvalidTexture, Lookup, Mapping, Octaves, Resolver, Space, Texture, TextureError, TextureTable,
    check,
};
use juggler_math::{Rgb, fun};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Waves: bands or rings, one a unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Wave {
    /// Colour of the troughs.
    pub low: Input<Rgb>,
    /// Colour of the crests.
    pub high: Input<Rgb>,
    /// Which way waves run.
    pub shape: WaveShape,
    /// What one wave is like.
    pub profile: WaveProfile,
    /// How far waves are bent, in lengths of a wave.
    #[schemars(range(min = 0, max = 1000))]
    pub distortion: f32,
    /// The noise that bends them.
    #[serde(flatten)]
    pub octaves: Octaves,
    /// Where the pattern lies.
    #[serde(flatten)]
    pub mapping: Mapping,
}

/// Which way waves run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WaveShape {
    /// Along the pattern's x axis.
    #[default]
    Bands,
    /// Away from the pattern's origin; over (u, v) circles.
    Rings,
}

/// What one wave is like, over its length from 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WaveProfile {
    /// Round: the trough at 0, the crest in the middle.
    #[default]
    Sine,
    /// Rises evenly and falls at once.
    Saw,
    /// Rises evenly to the middle, and falls as evenly.
    Triangle,
    /// The crest in the first half, the trough in the second.
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
            octaves: Octaves { octaves: 3, ..Octaves::default() },
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

    fn compile(&self, resolver: &mut Resolver<'_>) -> Result<Compiled, TextureError> {
        let colors = Pair { low: resolver.color("low", &self.low)?, high: resolver.color("high", &self.high)? };
        let Self { shape, profile, distortion, octaves, .. } = *self;
        Ok(Arc::new(CompiledWave { colors, shape, profile, distortion, octaves, map: self.mapping.compile(Space::Uv) }))
    }
}

/// A [`Wave`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledWave {
    colors: Pair,
    shape: WaveShape,
    profile: WaveProfile,
    distortion: f32,
    octaves: Octaves,
    map: Map,
}

impl WaveProfile {
    /// The height at a phase, from 0 to 1 and 1/2 in the mean; `width` is that of the footprint.
    fn height(self, phase: f32, width: f32) -> f32 {
        let at = phase - phase.floor();
        let sharp = match self {
            Self::Sine => 0.5 - 0.5 * fun::sin_cos_turns(at).1,
            Self::Saw => at,
            Self::Triangle => 1.0 - (2.0 * at - 1.0).abs(),
            Self::Square => return pulses(phase, 0.5, width),
        };
        0.5 + (sharp - 0.5) * kept(width)
    }
}

impl CompiledTexture for CompiledWave {
    fn eval(&self, textures: &TextureTable, at: &Lookup) -> Rgb {
        let place = self.map.place(at);
        let straight = match self.shape {
            WaveShape::Bands => place.point.x,
            WaveShape::Rings => place.point.length(),
        };
        let bent = if self.distortion > 0.0 { self.distortion * self.octaves.signed(place) } else { 0.0 };
        let phase = straight + bent;
        let phase = if phase.is_finite() { phase } else { 0.0 };
        self.colors.at(self.profile.height(phase, place.width), textures, at)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Wave {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        let rings = Self { shape: WaveShape::Rings, distortion: 5.0, ..Self::default() };
        let profiles = [WaveProfile::Sine, WaveProfile::Saw, WaveProfile::Triangle, WaveProfile::Square];
        let mapping = Mapping::of(Space::World);
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
            // The noise lies on the same lattice as the waves: not all phases are quite as frequent.
            keeps_its_mean(
                &format!(r#"{{"wave": {{"space": "world", "profile": "{profile}", "distortion": 2}}}}"#),
                0.02,
            );
        }
    }

    #[test]
    fn says_what_is_wrong() {
        let wrong: Wave = serde_json::from_str(r#"{"distortion": 1e9}"#).unwrap();
        assert_eq!(wrong.check().unwrap_err().field, "distortion");
    }
}
