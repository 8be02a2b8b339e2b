//! Wood: wavy growth rings around the pattern's y axis, with fibers along it.
//!
//! ```json
//! {"wood": {"space": "local", "scale": 8, "rotate_degrees": [0, 0, 80],
//! "light": "#c08040", "dark": "#603010"}}
//! ```
//!
//! Each ring darkens slowly from early wood to late wood, and the next ring starts abruptly.
//! Peachey (Solid Texturing of Complex Surfaces, 1985) has rings around an axis; the profile and
//! the fibers are our own.

use super::CompiledTexture;
use super::compiled::ColorBlend;
use super::lattice::{filter_amplitude, noise, smoothstep};
use super::mapping::{CompiledMapping, PatternPoint};
use super::{
    Input, InvalidTexture, Mapping, Octaves, SharedTexture, Space, Texture, TextureError, TextureLookup,
    TextureResolver, TextureTable, check,
};
use juggler_math::hash::combine;
use juggler_math::{Rgb, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Share of a ring that is early wood.
const EARLY_WOOD_SHARE: f32 = 0.8;
/// Number of fibers in the width of a ring.
const FIBERS_PER_RING: f32 = 12.0;
/// Length of fibers over their thickness.
const FIBER_ASPECT: f32 = 30.0;

/// Wood: wavy growth rings around the pattern's y axis, one per unit, with fibers along it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Wood {
    /// Color of early wood.
    pub light: Input<Rgb>,
    /// Color of late wood, at the end of each ring.
    pub dark: Input<Rgb>,
    /// Amplitude of the rings' distortion, in widths of a ring. 0 makes them circular.
    #[schemars(range(min = 0, max = 1000))]
    pub distortion: f32,
    /// Strength of the fibers. 0 hides them.
    #[schemars(range(min = 0, max = 1))]
    pub grain: f32,
    /// Noise that distorts the rings.
    #[serde(flatten)]
    pub octaves: Octaves,
    /// Placement of the pattern: coordinate space, scale, rotation and offset.
    #[serde(flatten)]
    pub mapping: Mapping,
}

impl Wood {
    /// Creates wood with light and dark rings.
    pub fn new(light: impl Into<Input<Rgb>>, dark: impl Into<Input<Rgb>>) -> Self {
        Self { light: light.into(), dark: dark.into(), ..Self::default() }
    }
}

impl Default for Wood {
    fn default() -> Self {
        Self {
            light: Rgb::new(0.55, 0.3, 0.13).into(),
            dark: Rgb::new(0.2, 0.08, 0.03).into(),
            distortion: 0.6,
            grain: 0.2,
            octaves: Octaves::default(),
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

    fn compile(&self, resolver: &mut TextureResolver<'_>) -> Result<SharedTexture, TextureError> {
        let colors =
            ColorBlend { low: resolver.color("light", &self.light)?, high: resolver.color("dark", &self.dark)? };
        let Self { distortion, grain, octaves, .. } = *self;
        Ok(Arc::new(CompiledWood { colors, distortion, grain, octaves, map: self.mapping.compile(Space::Local) }))
    }

    fn space(&self) -> Option<Space> {
        Some(self.mapping.space_or(Space::Local))
    }
}

/// A [`Wood`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledWood {
    colors: ColorBlend,
    distortion: f32,
    grain: f32,
    octaves: Octaves,
    map: CompiledMapping,
}

/// Darkness of a ring at a fraction of its width, 0 to 1 with mean 1/2.
fn ring(at: f32) -> f32 {
    if at < EARLY_WOOD_SHARE {
        smoothstep(0.0, EARLY_WOOD_SHARE, at)
    } else {
        1.0 - smoothstep(EARLY_WOOD_SHARE, 1.0, at)
    }
}

impl CompiledWood {
    fn fiber(&self, pattern: PatternPoint) -> f32 {
        let filter = filter_amplitude(pattern.width * FIBERS_PER_RING);
        let p = pattern.point * Vec3::new(FIBERS_PER_RING, FIBERS_PER_RING / FIBER_ASPECT, FIBERS_PER_RING);
        if self.grain > 0.0 && filter > 0.0 && p.is_finite() {
            self.grain * filter * noise(p, combine(self.octaves.seed, 77))
        } else {
            0.0
        }
    }
}

impl CompiledTexture for CompiledWood {
    fn eval(&self, textures: &TextureTable, at: &TextureLookup) -> Rgb {
        let pattern = self.map.pattern_point(at);
        let p = pattern.point;
        let bent = (p.x * p.x + p.z * p.z).sqrt() + self.distortion * self.octaves.fbm(pattern);
        let bent = if bent.is_finite() { bent } else { 0.0 };
        let rings = 0.5 + (ring(bent - bent.floor()) - 0.5) * filter_amplitude(pattern.width);
        let share = rings + self.fiber(pattern);
        self.colors.eval(share.clamp(0.0, 1.0), textures, at)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Wood {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let mapping = Mapping::in_space(Space::Local);
        vec![Self::default(), Self { mapping, distortion: 1000.0, grain: 1.0, ..Self::default() }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::{keeps_its_mean, numbers};

    #[test]
    fn wood_rings_are_concentric_about_y_with_unit_spacing() {
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
    fn fibers_run_along_y() {
        let read = numbers(r#"{"wood": {"space": "world", "distortion": 0, "grain": 0.5, "light": 0, "dark": 1}}"#);
        let change = |step: Vec3| -> f32 {
            let p = |i: i32| Vec3::new(0.3, 0.1, 0.2) + Vec3::Y * i as f32 * 0.11;
            (0..200).map(|i| (read(p(i) + step, 0.0) - read(p(i), 0.0)).abs()).sum()
        };
        // Along z, the ring itself changes little compared with its fibers.
        assert!(change(Vec3::Z * 0.04) > 4.0 * change(Vec3::Y * 0.04));
    }

    #[test]
    fn invalid_fields_are_named() {
        for (json, field) in [(r#"{"grain": 1.1}"#, "grain"), (r#"{"distortion": -1}"#, "distortion")] {
            assert_eq!(serde_json::from_str::<Wood>(json).unwrap().check().unwrap_err().field, field);
        }
    }
}
