//! Wood: rings about the pattern's y axis, where the heart of the trunk is, wavy and with fibres along it.
//!
//! ```json
//! {"wood": {"space": "local", "scale": 8, "rotate_degrees": [0, 0, 80], "light": "#c08040", "dark": "#603010"}}
//! ```
//!
//! Within each ring early wood darkens slowly towards late wood, and the next ring starts abruptly (Peachey, Solid Texturing
//! of Complex Surfaces, 1985, has rings about an axis; the profile and the fibres are ours).

use super::CompiledTexture;
use super::compiled::Pair;
use super::lattice::{kept, noise, smoothstep};
use super::mapping::{Map, Place};
use super::{
    Compiled, Input, InvalidTexture, Lookup, Mapping, Octaves, Resolver, Space, Texture, TextureError, TextureTable,
    check,
};
use juggler_math::hash::combine;
use juggler_math::{Rgb, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Share of a ring that early wood takes.
const EARLY: f32 = 0.8;
/// Fibres in a ring's width, and how many times as long as thick they are.
const FIBRES: f32 = 12.0;
const SLENDER: f32 = 30.0;

/// Wood: rings about the pattern's y axis, one a unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Wood {
    /// Colour of early wood.
    pub light: Input<Rgb>,
    /// Colour of late wood, at the end of each ring.
    pub dark: Input<Rgb>,
    /// How far rings are from being round, in widths of a ring.
    #[schemars(range(min = 0, max = 1000))]
    pub distortion: f32,
    /// How much fibres show.
    #[schemars(range(min = 0, max = 1))]
    pub grain: f32,
    /// The noise that bends the rings.
    #[serde(flatten)]
    pub octaves: Octaves,
    /// Where the pattern lies.
    #[serde(flatten)]
    pub mapping: Mapping,
}

impl Default for Wood {
    fn default() -> Self {
        Self {
            light: Rgb::new(0.55, 0.3, 0.13).into(),
            dark: Rgb::new(0.2, 0.08, 0.03).into(),
            distortion: 0.6,
            grain: 0.2,
            octaves: Octaves { octaves: 3, ..Octaves::default() },
            mapping: Mapping::default(),
        }
    }
}

impl Texture for Wood {
    fn check(&self) -> Result<(), InvalidTexture> {
        check::color("light", &self.light)?;
        check::color("dark", &self.dark)?;
        check::in_range("distortion", self.distortion, 0.0, 1000.0)?;
        check::in_range("grain", self.grain, 0.0, 1.0)?;
        self.octaves.check()?;
        self.mapping.check()
    }

    fn compile(&self, resolver: &mut Resolver<'_>) -> Result<Compiled, TextureError> {
        let colors = Pair { low: resolver.color("light", &self.light)?, high: resolver.color("dark", &self.dark)? };
        let Self { distortion, grain, octaves, .. } = *self;
        Ok(Arc::new(CompiledWood { colors, distortion, grain, octaves, map: self.mapping.compile(Space::Local) }))
    }
}

/// A [`Wood`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledWood {
    colors: Pair,
    distortion: f32,
    grain: f32,
    octaves: Octaves,
    map: Map,
}

/// How dark a ring is at a share of its width; 1/2 in the mean.
fn ring(at: f32) -> f32 {
    if at < EARLY { smoothstep(0.0, EARLY, at) } else { 1.0 - smoothstep(EARLY, 1.0, at) }
}

impl CompiledWood {
    fn fibre(&self, place: Place) -> f32 {
        let kept = kept(place.width * FIBRES);
        let p = place.point * Vec3::new(FIBRES, FIBRES / SLENDER, FIBRES);
        if self.grain > 0.0 && kept > 0.0 && p.is_finite() {
            self.grain * kept * noise(p, combine(self.octaves.seed, 77))
        } else {
            0.0
        }
    }
}

impl CompiledTexture for CompiledWood {
    fn eval(&self, textures: &TextureTable, at: &Lookup) -> Rgb {
        let place = self.map.place(at);
        let p = place.point;
        let bent = (p.x * p.x + p.z * p.z).sqrt() + self.distortion * self.octaves.signed(place);
        let bent = if bent.is_finite() { bent } else { 0.0 };
        let rings = 0.5 + (ring(bent - bent.floor()) - 0.5) * kept(place.width);
        let share = rings + self.fibre(place);
        self.colors.at(share.clamp(0.0, 1.0), textures, at)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Wood {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        let mapping = Mapping::of(Space::Local);
        vec![Self::default(), Self { mapping, distortion: 1000.0, grain: 1.0, ..Self::default() }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::{keeps_its_mean, numbers};

    #[test]
    fn rings_are_round_about_y_and_one_a_unit() {
        let json = r#"{"wood": {"space": "world", "distortion": 0, "grain": 0, "light": 0, "dark": 1}}"#;
        let read = numbers(json);
        for (radius, share) in [(0.0, 0.0), (0.4, 0.5), (0.8, 1.0), (0.9, 0.5), (1.0, 0.0), (7.8, 1.0)] {
            let there = [Vec3::X, Vec3::Z, Vec3::new(0.6, 3.0, 0.8), Vec3::new(-0.8, -9.0, 0.6)];
            let read = there.map(|p| read(Vec3::new(p.x * radius, p.y, p.z * radius), 0.0));
            assert!(read.iter().all(|v| (v - share).abs() < 1e-4), "{radius}: {read:?}");
        }
        keeps_its_mean(json, 0.01);
        keeps_its_mean(r#"{"wood": {"space": "world", "light": 0, "dark": 1}}"#, 0.02);
    }

    #[test]
    fn fibres_run_along_y() {
        let read = numbers(r#"{"wood": {"space": "world", "distortion": 0, "grain": 0.5, "light": 0, "dark": 1}}"#);
        let change = |step: Vec3| -> f32 {
            let p = |i: i32| Vec3::new(0.3, 0.1, 0.2) + Vec3::Y * i as f32 * 0.11;
            (0..200).map(|i| (read(p(i) + step, 0.0) - read(p(i), 0.0)).abs()).sum()
        };
        // Along z the ring itself changes little beside its fibres.
        assert!(change(Vec3::Z * 0.04) > 4.0 * change(Vec3::Y * 0.04));
    }

    #[test]
    fn says_what_is_wrong() {
        for (json, field) in [(r#"{"grain": 1.1}"#, "grain"), (r#"{"distortion": -1}"#, "distortion")] {
            assert_eq!(serde_json::from_str::<Wood>(json).unwrap().check().unwrap_err().field, field);
        }
    }
}
