//! Brick wall in x and y of the pattern, with rows that are shifted against each other.
//!
//! ```json
//! {"brick": {"scale": 4, "width": 0.5, "height": 0.25, "mortar_width": 0.02,
//! "brick": "#a04030", "variation": 0.3}}
//! ```

use super::CompiledTexture;
use super::lattice::{filter_amplitude, filtered_pulse_train, hash};
use super::mapping::{CompiledMapping, PatternPoint};
use super::{
    Input, InvalidTexture, Mapping, SharedTexture, Slot, Space, Texture, TextureError, TextureLookup, TextureResolver,
    TextureTable, check,
};
use juggler_math::hash::unit_f32;
use juggler_math::{Rgb, portable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Brick wall in x and y of the pattern, with mortar joints.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Brick {
    /// Color of the bricks.
    pub brick: Input<Rgb>,
    /// Color of the mortar joints.
    pub mortar: Input<Rgb>,
    /// Width of a brick with its joint, in units of the pattern.
    #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "pattern units"))]
    pub width: f32,
    /// Height of a row with its joint, in units of the pattern.
    #[schemars(range(min = 1e-6, max = 1e6), extend("x-unit" = "pattern units"))]
    pub height: f32,
    /// Width of the mortar joints, in units of the pattern. At most `width` and `height`, which
    /// include it.
    #[schemars(range(min = 0, max = 1e6), extend("x-unit" = "pattern units"))]
    pub mortar_width: f32,
    /// Offset of each row against the row below, in brick widths, -1e6 to 1e6.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub shift: f32,
    /// Largest random darkening of bricks, as a share of their color. 0 makes all bricks equal.
    #[schemars(range(min = 0, max = 1))]
    pub variation: f32,
    /// Seed of the random darkening.
    pub seed: u32,
    /// Placement of the pattern: coordinate space, scale, rotation and offset.
    #[serde(flatten)]
    pub mapping: Mapping,
}

impl Brick {
    /// Creates a wall of bricks with mortar between them.
    pub fn new(brick: impl Into<Input<Rgb>>, mortar: impl Into<Input<Rgb>>) -> Self {
        Self { brick: brick.into(), mortar: mortar.into(), ..Self::default() }
    }
}

impl Default for Brick {
    fn default() -> Self {
        Self {
            brick: Rgb::new(0.45, 0.13, 0.08).into(),
            mortar: Rgb::splat(0.6).into(),
            width: 0.25,
            height: 0.125,
            mortar_width: 0.015,
            shift: 0.5,
            variation: 0.2,
            seed: 0,
            mapping: Mapping::default(),
        }
    }
}

impl Texture for Brick {
    fn check(&self) -> Result<(), InvalidTexture> {
        check::color("brick", &self.brick)?;
        check::color("mortar", &self.mortar)?;
        check::in_range("width", self.width, 1e-6, 1e6)?;
        check::in_range("height", self.height, 1e-6, 1e6)?;
        check::in_range("mortar_width", self.mortar_width, 0.0, self.width.min(self.height))?;
        check::in_range("shift", self.shift, -1e6, 1e6)?;
        check::in_range("variation", self.variation, 0.0, 1.0)?;
        self.mapping.check()
    }

    fn compile(&self, resolver: &mut TextureResolver<'_>) -> Result<SharedTexture, TextureError> {
        let (brick, mortar) = (resolver.color("brick", &self.brick)?, resolver.color("mortar", &self.mortar)?);
        let Self { width, height, mortar_width, shift, variation, seed, .. } = *self;
        let map = self.mapping.compile(Space::Uv);
        Ok(Arc::new(CompiledBrick { brick, mortar, width, height, mortar_width, shift, variation, seed, map }))
    }

    fn space(&self) -> Option<Space> {
        Some(self.mapping.space_or(Space::Uv))
    }
}

/// A [`Brick`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledBrick {
    brick: Slot<Rgb>,
    mortar: Slot<Rgb>,
    width: f32,
    height: f32,
    mortar_width: f32,
    shift: f32,
    variation: f32,
    seed: u32,
    map: CompiledMapping,
}

impl CompiledBrick {
    /// Share of brick in the footprint, and brightness of the brick at its center. Rows inside one
    /// footprint count as not shifted against each other.
    fn at(&self, pattern: PatternPoint) -> (f32, f32) {
        let (width, height) = (f64::from(self.width), f64::from(self.height));
        let y = f64::from(pattern.point.y) / height;
        let row = portable::floor_f64(y);
        let shift = f64::from(self.shift) * row;
        let x = f64::from(pattern.point.x) / width - (shift - portable::floor_f64(shift));
        // Center the joint on the border between bricks.
        let along = |at: f64, size: f32| {
            let share = self.mortar_width / size;
            filtered_pulse_train((at - portable::floor_f64(at)) as f32 - 0.5 * share, 1.0 - share, pattern.width / size)
        };
        let bricks = along(x, self.width) * along(y, self.height);
        let random = unit_f32(hash([portable::floor_f64(x) as i64, row as i64, 0], self.seed));
        let random = 0.5 + (random - 0.5) * filter_amplitude(pattern.width / self.width.min(self.height));
        (bricks, 1.0 - self.variation * random)
    }
}

impl CompiledTexture for CompiledBrick {
    fn eval(&self, textures: &TextureTable, at: &TextureLookup) -> Rgb {
        let (bricks, bright) = self.at(self.map.pattern_point(at));
        let color =
            |share: f32, slot: &Slot<Rgb>| if share > 0.0 { textures.color(slot, at) * share } else { Rgb::BLACK };
        color(1.0 - bricks, &self.mortar) + color(bricks, &self.brick) * bright
    }
}

#[cfg(any(test, feature = "testing"))]
impl Brick {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default(), Self { width: 1e-6, height: 1e-6, mortar_width: 1e-6, variation: 1.0, ..Self::default() }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::{keeps_its_mean, numbers, reader};
    use juggler_math::Vec3;

    const WALL: &str = r#"{"brick": {"space": "world", "width": 2, "height": 1, "mortar_width": 0.2, "brick": 1, "mortar": 0,
        "variation": 0}}"#;

    #[test]
    fn bricks_lie_between_joints_and_rows_are_shifted() {
        let read = numbers(WALL);
        for (x, y, share) in [
            (0.05, 0.5, 0.0),
            (0.15, 0.5, 1.0),
            (1.85, 0.5, 1.0),
            (1.95, 0.5, 0.0),
            (1.0, 0.05, 0.0),
            (1.0, 0.95, 0.0),
            (1.0, 1.5, 0.0),
            (0.0, 1.5, 1.0),
            (-1.0, -0.5, 0.0),
            (0.0, -3.5, 0.0),
            (4.0, -2.5, 1.0),
        ] {
            assert_eq!(read(Vec3::new(x, y, 9.0), 0.0), share, "{x} {y}");
        }
        assert!((read(Vec3::new(0.1, 0.5, 0.0), 0.1) - 0.5).abs() < 1e-4, "half a joint in the footprint");
        assert!((read(Vec3::ZERO, 1e4) - 0.9 * 0.8).abs() < 1e-3);
        keeps_its_mean(WALL, 0.01);
    }

    #[test]
    fn bricks_vary_one_by_one() {
        let read = numbers(&WALL.replace(r#""variation": 0"#, r#""variation": 0.5"#));
        let brick = |i: i32| read(Vec3::new(2.0 * i as f32 + 1.0, 0.5, 0.0), 0.0);
        let colors: Vec<f32> = (0..200).map(brick).collect();
        assert!(
            colors.iter().all(|v| (0.5..=1.0).contains(v)) && colors.windows(2).filter(|w| w[0] == w[1]).count() < 3
        );
        let mean = colors.iter().sum::<f32>() / 200.0;
        assert!((mean - 0.75).abs() < 0.04, "{mean}");
        assert_eq!(brick(7), read(Vec3::new(14.3, 0.8, 0.0), 0.0));
        keeps_its_mean(&WALL.replace(r#""variation": 0"#, r#""variation": 0.5"#), 0.01);
    }

    #[test]
    fn brick_and_mortar_have_their_given_colors() {
        let read = reader(r#"{"brick": {"brick": [0.5, 0.25, 0.1], "mortar": [0.1, 0.2, 0.3], "variation": 0}}"#);
        assert_eq!(read(&TextureLookup::default()), Rgb::new(0.1, 0.2, 0.3));
        let uv = juggler_math::Vec2::new(0.125, 0.06);
        assert_eq!(read(&TextureLookup { uv, ..TextureLookup::default() }), Rgb::new(0.5, 0.25, 0.1));
    }

    #[test]
    fn invalid_fields_are_named() {
        for (json, field) in
            [(r#"{"mortar_width": 0.2}"#, "mortar_width"), (r#"{"width": 0}"#, "width"), (r#"{"shift": 1e9}"#, "shift")]
        {
            assert_eq!(serde_json::from_str::<Brick>(json).unwrap().check().unwrap_err().field, field);
        }
    }
}
