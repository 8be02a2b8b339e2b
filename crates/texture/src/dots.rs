//! Dots in the cells of a grid: circles over (u, v), balls in space.
//!
//! ```json
//! {"dots": {"scale": 20, "radius": 0.3, "jitter": 1, "dot": "#ffffff", "ground": "#c02030"}}
//! ```

use super::CompiledTexture;
use super::compiled::Pair;
use super::lattice::{cell, hash, kept, numbers, smoothstep};
use super::mapping::Map;
use super::{
    Compiled, Input, InvalidTexture, Lookup, Mapping, Resolver, Space, Texture, TextureError, TextureTable, check,
};
use juggler_math::{Rgb, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f32::consts::PI;
use std::sync::Arc;

/// Dots, one a cell of the pattern's grid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Dots {
    /// Colour of the dots.
    pub dot: Input<Rgb>,
    /// Colour between them.
    pub ground: Input<Rgb>,
    /// Radius of a dot; cells are 1 wide.
    #[schemars(range(min = 0, max = 0.5))]
    pub radius: f32,
    /// Share of the radius over which a dot fades out.
    #[schemars(range(min = 0, max = 1))]
    pub softness: f32,
    /// How far dots are moved off the middle of their cells: at 1 they may touch its border.
    #[schemars(range(min = 0, max = 1))]
    pub jitter: f32,
    /// Another number, other places.
    pub seed: u32,
    /// Where the pattern lies.
    #[serde(flatten)]
    pub mapping: Mapping,
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

    fn compile(&self, resolver: &mut Resolver<'_>) -> Result<Compiled, TextureError> {
        let colors = Pair { low: resolver.color("ground", &self.ground)?, high: resolver.color("dot", &self.dot)? };
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
        // Shells of a dot, by their areas.
        let shell = |i: u32| {
            let r = (i as f32 + 0.5) / 64.0 * radius;
            let size = if flat { 2.0 * PI * r } else { 4.0 * PI * r * r };
            compiled.profile(r, 0.0) * size * radius / 64.0
        };
        compiled.mean = (0..64).map(shell).sum();
        Ok(Arc::new(compiled))
    }
}

/// A [`Dots`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledDots {
    colors: Pair,
    radius: f32,
    softness: f32,
    jitter: f32,
    seed: u32,
    /// Whether dots are circles, not balls.
    flat: bool,
    /// Share of dots in the whole.
    mean: f32,
    map: Map,
}

impl CompiledDots {
    /// How much of a dot there is at a distance from its middle.
    fn profile(&self, distance: f32, width: f32) -> f32 {
        let inner = self.radius * (1.0 - self.softness) - 0.5 * width;
        1.0 - smoothstep(inner, self.radius + 0.5 * width, distance)
    }
}

impl CompiledTexture for CompiledDots {
    fn eval(&self, textures: &TextureTable, at: &Lookup) -> Rgb {
        let place = self.map.place(at);
        let (cell, within) = cell(if self.flat { place.point.with_z(0.0) } else { place.point });
        let way = (numbers(hash(cell, self.seed)) - 0.5) * (self.jitter * (1.0 - 2.0 * self.radius));
        let off = within - (Vec3::splat(0.5) + way);
        let off = if self.flat { off.with_z(0.0) } else { off };
        let share = self.profile(off.length(), place.width);
        self.colors.at(self.mean + (share - self.mean) * kept(place.width), textures, at)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Dots {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        let balls = Self { mapping: Mapping::of(Space::Local), jitter: 1.0, softness: 1.0, ..Self::default() };
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
    fn over_uv_they_are_circles_that_cover_their_share() {
        let read = reader(r#"{"dots": {"scale": 4, "radius": 0.4, "jitter": 1, "dot": 1, "ground": 0}}"#);
        let at = |i: u32, j: u32| Lookup { uv: Vec2::new(i as f32, j as f32) / 200.0, ..Lookup::default() };
        let count =
            (0..800).flat_map(|i| (0..800).map(move |j| (i, j))).filter(|(i, j)| read(&at(*i, *j)).r == 1.0).count();
        let share = count as f32 / 640_000.0;
        assert!((share - PI * 0.16).abs() < 0.005, "{share}");
        let far = read(&Lookup { uv_footprint: 1.0, ..Lookup::default() }).r;
        assert!((far - PI * 0.16).abs() < 0.002, "{far}");
    }

    #[test]
    fn says_what_is_wrong() {
        for (json, field) in [(r#"{"radius": 0.6}"#, "radius"), (r#"{"softness": -1}"#, "softness")] {
            assert_eq!(serde_json::from_str::<Dots>(json).unwrap().check().unwrap_err().field, field);
        }
    }
}
