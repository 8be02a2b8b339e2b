//! Dots in the cells of a grid: circles over (u, v), spheres in space.
//!
//! ```json
//! {"dots": {"scale": 20, "radius": 0.3, "jitter": 1, "dot": "#ffffff", "ground": "#c02030"}}
//! ```

use super::CompiledTexture;
use super::compiled::ColorBlend;
use super::lattice::{cell, filter_amplitude, hash, smoothstep, unit_cube_point};
use super::mapping::CompiledMapping;
use super::{
    Input, InvalidTexture, Mapping, SharedTexture, Space, Texture, TextureError, TextureLookup, TextureResolver,
    TextureTable, check,
};
use juggler_math::{Rgb, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f32::consts::PI;
use std::sync::Arc;

/// Dots, one per unit cell of the pattern: circles over (u, v), spheres in space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Dots {
    /// Color of the dots.
    pub dot: Input<Rgb>,
    /// Color between the dots.
    pub ground: Input<Rgb>,
    /// Radius of a dot, in cell widths.
    #[schemars(range(min = 0, max = 0.5))]
    pub radius: f32,
    /// Share of the radius over which a dot fades out. 0 makes its edge sharp.
    #[schemars(range(min = 0, max = 1))]
    pub softness: f32,
    /// Random offset of dots from the centers of their cells, as a share of the room in the cell:
    /// at 1, dots may touch its border.
    #[schemars(range(min = 0, max = 1))]
    pub jitter: f32,
    /// Seed of the random offsets.
    pub seed: u32,
    /// Placement of the pattern: coordinate space, scale, rotation and offset.
    #[serde(flatten)]
    pub mapping: Mapping,
}

impl Dots {
    /// Creates a pattern of dots on a ground.
    pub fn new(dot: impl Into<Input<Rgb>>, ground: impl Into<Input<Rgb>>) -> Self {
        Self { dot: dot.into(), ground: ground.into(), ..Self::default() }
    }
}

impl Default for Dots {
    fn default() -> Self {
        Self {
            dot: Rgb::WHITE.into(),
            ground: Rgb::splat(0.1).into(),
            radius: 0.25,
            softness: 0.0,
            jitter: 0.0,
            seed: 0,
            mapping: Mapping::default(),
        }
    }
}

impl Texture for Dots {
    fn check(&self) -> Result<(), InvalidTexture> {
        check::color("dot", &self.dot)?;
        check::color("ground", &self.ground)?;
        check::in_range("radius", self.radius, 0.0, 0.5)?;
        check::in_range("softness", self.softness, 0.0, 1.0)?;
        check::in_range("jitter", self.jitter, 0.0, 1.0)?;
        self.mapping.check()
    }

    fn compile(&self, resolver: &mut TextureResolver<'_>) -> Result<SharedTexture, TextureError> {
        let colors =
            ColorBlend { low: resolver.color("ground", &self.ground)?, high: resolver.color("dot", &self.dot)? };
        let Self { radius, softness, jitter, seed, .. } = *self;
        let flat = self.mapping.space_or(Space::Uv) == Space::Uv;
        let mut compiled = CompiledDots {
            colors,
            radius,
            softness,
            jitter,
            seed,
            flat,
            mean: 0.0,
            map: self.mapping.compile(Space::Uv),
        };
        // Integrate the profile over shells of a dot.
        let shell = |i: u32| {
            let r = (i as f32 + 0.5) / 64.0 * radius;
            let size = if flat { 2.0 * PI * r } else { 4.0 * PI * r * r };
            compiled.profile(r, 0.0) * size * radius / 64.0
        };
        compiled.mean = (0..64).map(shell).sum();
        Ok(Arc::new(compiled))
    }

    fn space(&self) -> Option<Space> {
        Some(self.mapping.space_or(Space::Uv))
    }
}

/// A [`Dots`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledDots {
    colors: ColorBlend,
    radius: f32,
    softness: f32,
    jitter: f32,
    seed: u32,
    /// Whether dots are circles instead of spheres.
    flat: bool,
    /// Mean weight of the dot color.
    mean: f32,
    map: CompiledMapping,
}

impl CompiledDots {
    /// Weight of the dot color at a distance from the center, filtered over a footprint of diameter
    /// `width`.
    fn profile(&self, distance: f32, width: f32) -> f32 {
        let inner = self.radius * (1.0 - self.softness) - 0.5 * width;
        1.0 - smoothstep(inner, self.radius + 0.5 * width, distance)
    }
}

impl CompiledTexture for CompiledDots {
    fn eval(&self, textures: &TextureTable, at: &TextureLookup) -> Rgb {
        let pattern = self.map.pattern_point(at);
        let (cell, within) = cell(if self.flat { pattern.point.with_z(0.0) } else { pattern.point });
        let offset = (unit_cube_point(hash(cell, self.seed)) - 0.5) * (self.jitter * (1.0 - 2.0 * self.radius));
        let off = within - (Vec3::splat(0.5) + offset);
        let off = if self.flat { off.with_z(0.0) } else { off };
        let share = self.profile(off.length(), pattern.width);
        self.colors.eval(self.mean + (share - self.mean) * filter_amplitude(pattern.width), textures, at)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Dots {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let balls = Self { mapping: Mapping::in_space(Space::Local), jitter: 1.0, softness: 1.0, ..Self::default() };
        vec![Self::default(), balls, Self { radius: 0.0, dot: Rgb::new(0.5, 0.1, 0.2).into(), ..Self::default() }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::{keeps_its_mean, numbers as read_numbers, reader};
    use juggler_math::Vec2;

    #[test]
    fn dots_are_round_and_in_the_middle_of_their_cells() {
        let read = read_numbers(r#"{"dots": {"space": "world", "radius": 0.3, "dot": 1, "ground": 0}}"#);
        let middle = Vec3::new(4.5, -2.5, 0.5);
        for (off, share) in
            [(Vec3::X * 0.29, 1.0), (Vec3::Y * -0.31, 0.0), (Vec3::splat(0.17), 1.0), (Vec3::splat(0.18), 0.0)]
        {
            assert_eq!(read(middle + off, 0.0), share, "{off}");
        }
        // An edge is blurred over the footprint.
        assert!((read(middle + Vec3::X * 0.3, 0.1) - 0.5).abs() < 1e-3);
        for jitter in [0.0, 1.0] {
            let json = format!(
                r#"{{"dots": {{"space": "world", "radius": 0.4, "jitter": {jitter}, "dot": 1, "ground": 0}}}}"#
            );
            keeps_its_mean(&json, 0.01);
        }
        keeps_its_mean(r#"{"dots": {"space": "world", "radius": 0.5, "softness": 0.7, "dot": 1, "ground": 0}}"#, 0.01);
    }

    #[test]
    fn dots_over_uv_are_circles_with_their_area() {
        let read = reader(r#"{"dots": {"scale": 4, "radius": 0.4, "jitter": 1, "dot": 1, "ground": 0}}"#);
        let at =
            |i: u32, j: u32| TextureLookup { uv: Vec2::new(i as f32, j as f32) / 200.0, ..TextureLookup::default() };
        let count =
            (0..800).flat_map(|i| (0..800).map(move |j| (i, j))).filter(|(i, j)| read(&at(*i, *j)).r == 1.0).count();
        let share = count as f32 / 640_000.0;
        assert!((share - PI * 0.16).abs() < 0.005, "{share}");
        let far = read(&TextureLookup { uv_footprint: 1.0, ..TextureLookup::default() }).r;
        assert!((far - PI * 0.16).abs() < 0.002, "{far}");
    }

    #[test]
    fn invalid_fields_are_named() {
        for (json, field) in [(r#"{"radius": 0.6}"#, "radius"), (r#"{"softness": -1}"#, "softness")] {
            assert_eq!(serde_json::from_str::<Dots>(json).unwrap().check().unwrap_err().field, field);
        }
    }
}
