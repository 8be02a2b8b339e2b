//! Rare data of a surface at one point: the second set of surface coordinates, and attributes of a
//! mesh or of the instances that place a shape. Surfaces do not carry them; textures that ask for them
//! evaluate them here.

use super::MeshData;
use juggler_math::Vec2;

/// Attributes of the instances that place shapes.
pub trait InstanceValues {
    /// Value of an attribute for the shape of this index: red, green, blue and alpha. `at` is a point
    /// of the shape, (0, v) at the surface coordinate v. `None` if no instance has an attribute of the
    /// name.
    fn value(&self, shape_index: u32, name: &str, at: Vec2) -> Option<[f32; 4]>;
}

/// Point of a triangle of a mesh, of a shape whose instances have attributes, or of both.
#[derive(Clone, Copy, Default)]
pub struct MeshPoint<'m> {
    /// Arrays of the mesh; `None` for a shape without any.
    arrays: Option<&'m MeshData>,
    triangle: u32,
    /// Barycentrics of the second and third corner.
    barycentrics: Vec2,
    instances: Option<InstancePoint<'m>>,
}

/// Point of a shape whose instances have attributes.
#[derive(Clone, Copy)]
struct InstancePoint<'m> {
    values: &'m dyn InstanceValues,
    shape_index: u32,
    /// As in [`InstanceValues::value`].
    at: Vec2,
}

impl<'m> MeshPoint<'m> {
    /// Point of a triangle at barycentrics of its second and third corner.
    pub fn new(arrays: &'m MeshData, triangle: u32, barycentrics: Vec2) -> Self {
        Self { arrays: Some(arrays), triangle, barycentrics, instances: None }
    }

    /// Adds the attributes of the instances that place the shape of this index. `v` is the surface
    /// coordinate of the point.
    #[must_use]
    pub fn with_instances(self, values: &'m dyn InstanceValues, shape_index: u32, v: f32) -> Self {
        Self { instances: Some(InstancePoint { values, shape_index, at: Vec2::new(0.0, v.clamp(0.0, 1.0)) }), ..self }
    }

    fn corners(&self) -> Option<[u32; 3]> {
        self.arrays?.triangles.get(self.triangle as usize).copied()
    }

    /// Values of an array at the corners.
    fn at_corners<T: Copy>(&self, values: &[T]) -> Option<[T; 3]> {
        super::data::at_corners(values, self.corners()?)
    }

    /// Attribute: red, green, blue and alpha; that of the mesh, or else that of the innermost instances.
    /// `None` if there is none of this name.
    pub fn attribute(&self, name: &str) -> Option<[f32; 4]> {
        self.mesh_attribute(name).or_else(|| {
            let InstancePoint { values, shape_index, at } = self.instances?;
            values.value(shape_index, name, at)
        })
    }

    fn mesh_attribute(&self, name: &str) -> Option<[f32; 4]> {
        let attribute = self.arrays?.attributes.get(name)?;
        Some(attribute.value(self.triangle as usize, self.corners()?, self.barycentrics))
    }

    /// Coordinates of the second set.
    pub fn uv1(&self) -> Option<Vec2> {
        let (at, [a, b, c]) = (self.barycentrics, self.at_corners(&self.arrays?.uvs1)?);
        Some(a * (1.0 - at.x - at.y) + b * at.x + c * at.y)
    }

    /// Area of the triangle in coordinates of the second set over that in the first set; the square
    /// root converts footprints. `None` if the triangle has no area in the first set.
    pub fn uv1_area_ratio(&self) -> Option<f32> {
        let area = |[a, b, c]: [Vec2; 3]| {
            let [to_b, to_c] = [b - a, c - a].map(|edge| edge.as_dvec2());
            to_b.perp_dot(to_c).abs()
        };
        let ratio = area(self.at_corners(&self.arrays?.uvs1)?) / area(self.uvs()?);
        ratio.is_finite().then_some(ratio as f32)
    }

    /// Surface coordinates of the corners; the barycentrics without `uvs`.
    fn uvs(&self) -> Option<[Vec2; 3]> {
        match self.arrays.map(|arrays| &arrays.uvs).filter(|uvs| !uvs.is_empty()) {
            None => Some([Vec2::ZERO, Vec2::X, Vec2::Y]),
            Some(uvs) => self.at_corners(uvs),
        }
    }

    /// The point moved by `offset` in surface coordinates of the first set, perhaps beyond the
    /// triangle; unmoved if they do not span it.
    #[must_use]
    pub fn moved(&self, offset: Vec2) -> Self {
        let instances = self.instances.map(|point| InstancePoint { at: point.at + offset, ..point });
        let point = Self { instances: instances.filter(|point| point.at.is_finite()).or(self.instances), ..*self };
        let Some([a, b, c]) = self.uvs().map(|uvs| uvs.map(|uv| uv.as_dvec2())) else { return point };
        let (to_b, to_c, offset) = (b - a, c - a, offset.as_dvec2());
        let determinant = to_b.perp_dot(to_c);
        let step = juggler_math::DVec2::new(offset.perp_dot(to_c), to_b.perp_dot(offset)) / determinant;
        let moved = self.barycentrics + step.as_vec2();
        if moved.is_finite() { Self { barycentrics: moved, ..point } } else { point }
    }
}

impl std::fmt::Debug for MeshPoint<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { triangle, barycentrics, instances, .. } = self;
        let instances = instances.map(|point| (point.shape_index, point.at));
        f.debug_struct("MeshPoint")
            .field("triangle", triangle)
            .field("barycentrics", barycentrics)
            .field("instances", &instances)
            .finish_non_exhaustive()
    }
}

/// Points are equal if they are the same point of the same arrays.
impl PartialEq for MeshPoint<'_> {
    fn eq(&self, other: &Self) -> bool {
        let key = |point: &Self| {
            let instances =
                point.instances.map(|at| (std::ptr::from_ref(at.values).cast::<()>(), at.shape_index, at.at));
            (point.arrays.map(std::ptr::from_ref), point.triangle, point.barycentrics, instances)
        };
        key(self) == key(other)
    }
}
