//! Checkerboard of two materials in a coordinate plane of object space.
//!
//! ```json
//! {"checkerboard": {"size": 107, "even": {"phong": {"diffuse": [1, 1, 0]}},
//! "odd": {"phong": {"diffuse": [0, 1, 0]}}}}
//! ```
//!
//! In the plane `xz`, a point belongs to the even cells if ⌊x / size⌋ + ⌊z / size⌋ is even.

use super::error::in_range;
use super::{CompiledMaterial, Material, MaterialError, MaterialId, MaterialRef, MaterialResolver, Phong};
use juggler_math::Rgb;
use juggler_shape::surface::Surface;
use juggler_texture::is_odd_cell;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Checkerboard of two materials in a coordinate plane of object space. Use the texture `checker`
/// for two colors of one material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Checkerboard {
    /// Edge length of a cell, in units of object space.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
    pub size: f32,
    /// Coordinate plane of the cells. The pattern is constant along the third axis.
    pub plane: Plane,
    /// Material of the cell on the positive side of the origin.
    pub even: MaterialRef,
    /// Material of the adjacent cells.
    pub odd: MaterialRef,
}

impl Checkerboard {
    /// Creates a checkerboard of two materials, with squares of edge length 1.
    pub fn new(even: impl Into<MaterialRef>, odd: impl Into<MaterialRef>) -> Self {
        Self { even: even.into(), odd: odd.into(), ..Self::default() }
    }
}

/// Coordinate plane of object space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Plane {
    /// Horizontal ground.
    #[default]
    Xz,
    /// A wall that faces z.
    Xy,
    /// A wall that faces x.
    Yz,
}

impl Default for Checkerboard {
    fn default() -> Self {
        let gray = |v| Phong { diffuse: Rgb::splat(v).into(), ..Phong::default() }.into();
        Self { size: 1.0, plane: Plane::Xz, even: gray(0.8), odd: gray(0.2) }
    }
}

/// A [`Checkerboard`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledCheckerboard {
    size: f32,
    plane: Plane,
    even: MaterialId,
    odd: MaterialId,
}

impl Material for Checkerboard {
    fn compile(&self, resolver: &mut dyn MaterialResolver) -> Result<CompiledMaterial, MaterialError> {
        in_range("size", self.size, f32::MIN_POSITIVE, f32::MAX)?;
        let even = resolver.material("even", &self.even)?;
        let odd = resolver.material("odd", &self.odd)?;
        Ok(CompiledMaterial::Checkerboard(CompiledCheckerboard { size: self.size, plane: self.plane, even, odd }))
    }

    fn nested_materials(&self) -> Vec<(&'static str, &MaterialRef)> {
        vec![("even", &self.even), ("odd", &self.odd)]
    }

    fn scale_distances(&mut self, factor: f32) {
        self.even.scale_distances(factor);
        self.odd.scale_distances(factor);
    }
}

impl CompiledCheckerboard {
    /// Material at a point.
    pub fn pick(&self, surface: &Surface) -> MaterialId {
        let at = surface.local;
        let (a, b) = match self.plane {
            Plane::Xz => (at.x, at.z),
            Plane::Xy => (at.x, at.y),
            Plane::Yz => (at.y, at.z),
        };
        if is_odd_cell(a, self.size) == is_odd_cell(b, self.size) { self.even } else { self.odd }
    }

    /// Both materials.
    pub fn choices(&self) -> [MaterialId; 2] {
        [self.even, self.odd]
    }
}

#[cfg(any(test, feature = "testing"))]
impl Checkerboard {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let named = Self { even: MaterialRef::Name("red".into()), plane: Plane::Xy, ..Self::default() };
        vec![Self::default(), named, Self { size: 107.0, even: Self::default().into(), ..Self::default() }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::Random;
    use juggler_math::{Vec2, Vec3};

    const EVEN: MaterialId = MaterialId(1);
    const ODD: MaterialId = MaterialId(2);

    fn pick(size: f32, plane: Plane, at: Vec3) -> MaterialId {
        let board = CompiledCheckerboard { size, plane, even: EVEN, odd: ODD };
        board.pick(&Surface::new(at, 0.0, Vec3::Y, Vec2::ZERO))
    }

    #[test]
    fn cells_alternate_in_their_plane() {
        for (x, z, material) in [
            (0.0, 0.0, EVEN),
            (24.9, 24.9, EVEN),
            (25.0, 0.0, ODD),
            (-0.1, 0.0, ODD),
            (-0.1, -0.1, EVEN),
            (60.0, -30.0, EVEN),
        ] {
            assert_eq!(pick(25.0, Plane::Xz, Vec3::new(x, -1.0, z)), material, "{x} {z}");
            assert_eq!(pick(25.0, Plane::Xy, Vec3::new(x, z, -1.0)), material, "{x} {z}");
            assert_eq!(pick(25.0, Plane::Yz, Vec3::new(-1.0, x, z)), material, "{x} {z}");
        }
    }

    #[test]
    fn huge_coordinates_keep_their_parity() {
        // Compare with integer arithmetic: coordinates of 25 bits and more, cells of edge length 3.
        let mut random = Random::new(81);
        for _ in 0..1000 {
            let cell = |v: f32| (v as i64).div_euclid(3);
            let (x, z) = (random.range(-1e12, 1e12).trunc(), random.range(-1e9, 1e9).trunc());
            let expected = if (cell(x) + cell(z)) % 2 == 0 { EVEN } else { ODD };
            assert_eq!(pick(3.0, Plane::Xz, Vec3::new(x, 0.0, z)), expected, "{x} {z}");
        }
        // Beyond the precision of `f32` any cell will do, but always the same one.
        for far in [f32::MAX, f32::MIN, f32::INFINITY, f32::NAN] {
            let first = pick(1e-30, Plane::Xz, Vec3::new(far, 0.0, 1.0));
            assert_eq!(pick(1e-30, Plane::Xz, Vec3::new(far, 0.0, 1.0)), first);
        }
    }
}
