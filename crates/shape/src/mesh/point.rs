//! Rare data of a mesh at one point: the second set of surface coordinates and attributes.
//! Surfaces do not carry them; textures that ask for them evaluate them here.

use super::MeshData;
use juggler_math::Vec2;

/// Point of a triangle of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshPoint<'m> {
    /// Arrays of the mesh.
    arrays: &'m MeshData,
    triangle: u32,
    /// Barycentrics of the second and third corner.
    barycentrics: Vec2,
}

impl<'m> MeshPoint<'m> {
    /// Point of a triangle at barycentrics of its second and third corner.
    pub fn new(arrays: &'m MeshData, triangle: u32, barycentrics: Vec2) -> Self {
        Self { arrays, triangle, barycentrics }
    }

    fn corners(&self) -> Option<[u32; 3]> {
        self.arrays.triangles.get(self.triangle as usize).copied()
    }

    /// Values of an array at the corners.
    fn at_corners<T: Copy>(&self, values: &[T]) -> Option<[T; 3]> {
        super::data::at_corners(values, self.corners()?)
    }

    /// Attribute: red, green, blue and alpha; `None` if the mesh has none of this name.
    pub fn attribute(&self, name: &str) -> Option<[f32; 4]> {
        Some(self.arrays.attributes.get(name)?.value(self.triangle as usize, self.corners()?, self.barycentrics))
    }

    /// Coordinates of the second set.
    pub fn uv1(&self) -> Option<Vec2> {
        let (at, [a, b, c]) = (self.barycentrics, self.at_corners(&self.arrays.uvs1)?);
        Some(a * (1.0 - at.x - at.y) + b * at.x + c * at.y)
    }

    /// Area of the triangle in coordinates of the second set over that in the first set; the square
    /// root converts footprints. `None` if the triangle has no area in the first set.
    pub fn uv1_area_ratio(&self) -> Option<f32> {
        let area = |[a, b, c]: [Vec2; 3]| {
            let [to_b, to_c] = [b - a, c - a].map(|edge| edge.as_dvec2());
            to_b.perp_dot(to_c).abs()
        };
        let ratio = area(self.at_corners(&self.arrays.uvs1)?) / area(self.uvs()?);
        ratio.is_finite().then_some(ratio as f32)
    }

    /// Surface coordinates of the corners; the barycentrics without `uvs`.
    fn uvs(&self) -> Option<[Vec2; 3]> {
        if self.arrays.uvs.is_empty() {
            Some([Vec2::ZERO, Vec2::X, Vec2::Y])
        } else {
            self.at_corners(&self.arrays.uvs)
        }
    }

    /// The point moved by `offset` in surface coordinates of the first set, perhaps beyond the
    /// triangle; unmoved if they do not span it.
    #[must_use]
    pub fn moved(&self, offset: Vec2) -> Self {
        let Some([a, b, c]) = self.uvs().map(|uvs| uvs.map(|uv| uv.as_dvec2())) else { return *self };
        let (to_b, to_c, offset) = (b - a, c - a, offset.as_dvec2());
        let determinant = to_b.perp_dot(to_c);
        let step = juggler_math::DVec2::new(offset.perp_dot(to_c), to_b.perp_dot(offset)) / determinant;
        let moved = self.barycentrics + step.as_vec2();
        if moved.is_finite() { Self { barycentrics: moved, ..*self } } else { *self }
    }
}
