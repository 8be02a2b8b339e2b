//! A checkerboard of two colors: squares on a surface or cubes in space.
//!
//! ```json
//! {"checker": {"size": 25, "even": [1, 1, 0], "odd": [0, 1, 0], "space": "local", "axes": "xz"}}
//! ```
//!
//! A point is even if the sum of ⌊(x - offset) / size⌋ over its `axes` is even. On a flat surface,
//! leave out the axis of its normal, along which rounding would choose the cell.

use super::CompiledTexture;
use super::{
    Input, InvalidTexture, SharedTexture, Slot, Space, Texture, TextureError, TextureLookup, TextureResolver,
    TextureTable, check,
};
use juggler_math::{Rgb, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Checkerboard of two colors: squares over (u, v) or on a plane, cubes in space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Checker {
    /// Edge length of a cell, in units of `space`.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "units of space"))]
    pub size: f32,
    /// Color of the cell on the positive side of `offset`.
    pub even: Input<Rgb>,
    /// Color of the adjacent cells.
    pub odd: Input<Rgb>,
    /// Coordinate space of the cells.
    pub space: Space,
    /// Axes along which the colors alternate. The pattern is constant along all others.
    pub axes: Axes,
    /// Position of a corner of the cells, in `space`.
    #[schemars(with = "[f32; 3]", extend("x-unit" = "units of space"))]
    pub offset: Vec3,
}

impl Checker {
    /// Creates a checkerboard of two colors, with cells of edge length 1.
    pub fn new(even: impl Into<Input<Rgb>>, odd: impl Into<Input<Rgb>>) -> Self {
        Self { even: even.into(), odd: odd.into(), ..Self::default() }
    }
}

/// Axes along which the colors of a checkerboard alternate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Axes {
    /// All three axes: cubes in space, squares over (u, v).
    #[default]
    Xyz,
    /// Squares on horizontal ground.
    Xz,
    /// Squares on a wall that faces z.
    Xy,
    /// Squares on a wall that faces x.
    Yz,
}

impl Default for Checker {
    fn default() -> Self {
        Self {
            size: 1.0,
            even: Rgb::splat(0.8).into(),
            odd: Rgb::splat(0.2).into(),
            space: Space::Uv,
            axes: Axes::Xyz,
            offset: Vec3::ZERO,
        }
    }
}

/// Whether ⌊x / size⌋ is odd. The division in double precision puts adjacent floats into the right
/// cells even if coordinates exceed the size by a factor of millions.
#[inline]
pub fn is_odd_cell(x: f32, size: f32) -> bool {
    let cells = f64::from(x) / f64::from(size);
    // Truncate and correct: a single instruction, where `floor` may be a call.
    let towards_zero = cells as i64;
    (towards_zero ^ i64::from(cells < towards_zero as f64)) & 1 == 1
}

impl Texture for Checker {
    fn check(&self) -> Result<(), InvalidTexture> {
        if !(self.size > 0.0 && self.size.is_finite()) {
            return Err(InvalidTexture::new("size", format!("`size` must be above 0, it is {}", self.size)));
        }
        check::color("even", &self.even)?;
        check::color("odd", &self.odd)?;
        check::vector("offset", self.offset)
    }

    fn compile(&self, resolver: &mut TextureResolver<'_>) -> Result<SharedTexture, TextureError> {
        Ok(Arc::new(CompiledChecker {
            size: self.size,
            even: resolver.color("even", &self.even)?,
            odd: resolver.color("odd", &self.odd)?,
            space: self.space,
            axes: self.axes,
            offset: self.offset,
        }))
    }

    fn space(&self) -> Option<Space> {
        Some(self.space)
    }
}

/// A [`Checker`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledChecker {
    size: f32,
    even: Slot<Rgb>,
    odd: Slot<Rgb>,
    space: Space,
    axes: Axes,
    offset: Vec3,
}

impl CompiledTexture for CompiledChecker {
    fn eval(&self, textures: &TextureTable, at: &TextureLookup) -> Rgb {
        let p = at.point(self.space) - self.offset;
        let odd = |x: f32| is_odd_cell(x, self.size);
        let odd = match self.axes {
            Axes::Xyz => odd(p.x) ^ odd(p.y) ^ odd(p.z),
            Axes::Xz => odd(p.x) ^ odd(p.z),
            Axes::Xy => odd(p.x) ^ odd(p.y),
            Axes::Yz => odd(p.y) ^ odd(p.z),
        };
        textures.color(if odd { &self.odd } else { &self.even }, at)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Checker {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let ground = Self { size: 107.0, space: Space::World, axes: Axes::Xz, ..Self::default() };
        vec![Self::default(), ground, Self { space: Space::Local, offset: Vec3::ONE, ..Self::default() }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::color;
    use juggler_math::Vec2;
    use juggler_math::testing::Random;

    #[test]
    fn cell_parity_matches_integer_arithmetic() {
        let mut random = Random::new(71);
        for _ in 0..10_000 {
            let size = (random.below(1000) + 1) as f32;
            let x = (random.range(-1.0, 1.0) * 2f32.powi(random.below(53) as i32)).trunc();
            let exact = (x as i64).div_euclid(size as i64) & 1 == 1;
            assert_eq!(is_odd_cell(x, size), exact, "{x} {size}");
        }
    }

    #[test]
    fn cell_boundaries_belong_to_the_upper_cell() {
        let cells = [-2.0, -1.0, -1e-30, -0.0, 0.0, 1f32.next_down(), 1.0, 2.0].map(|x| is_odd_cell(x, 1.0));
        assert_eq!(cells, [false, true, true, false, false, false, true, false]);
        assert!(!is_odd_cell(107.0 * 6.0, 107.0) && is_odd_cell(107.0 * 7.0, 107.0));
        for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN] {
            assert_eq!(is_odd_cell(x, 1e-38), is_odd_cell(x, 1e-38));
        }
    }

    #[test]
    fn checker_uses_its_space_axes_and_offset() {
        let (uv, local) = (Vec2::new(1.5, 0.5), Vec3::new(0.5, 1.5, 2.5));
        let at = TextureLookup { uv, local, world: Vec3::splat(1.5), ..TextureLookup::default() };
        let odd = |space, axes, offset| {
            let checker =
                Checker { space, axes, offset, even: Rgb::BLACK.into(), odd: Rgb::WHITE.into(), ..Checker::default() };
            color(&checker.into(), &at) == Rgb::WHITE
        };
        assert!(odd(Space::Uv, Axes::Xyz, Vec3::ZERO) && !odd(Space::Uv, Axes::Xyz, Vec3::X * 0.6));
        assert!(odd(Space::Local, Axes::Xyz, Vec3::ZERO) && !odd(Space::Local, Axes::Xz, Vec3::ZERO));
        assert!(odd(Space::Local, Axes::Xy, Vec3::ZERO) && odd(Space::Local, Axes::Yz, Vec3::ZERO));
        assert!(odd(Space::World, Axes::Xyz, Vec3::ZERO) && !odd(Space::World, Axes::Xz, Vec3::ZERO));
    }

    #[test]
    fn invalid_fields_are_named() {
        let json = [
            (r#"{"size": 0}"#, "size"),
            (r#"{"odd": [0, 1e39, 0]}"#, "odd"),
            (r#"{"offset": [1e39, 0, 0]}"#, "offset"),
        ];
        for (json, field) in json {
            assert_eq!(serde_json::from_str::<Checker>(json).unwrap().check().unwrap_err().field, field);
        }
    }
}
