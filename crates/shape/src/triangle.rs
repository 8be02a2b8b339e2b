//! One triangle.
//!
//! ```
//! use juggler_shape::{AnyShape, Triangle};
//! let shape: AnyShape = serde_json::from_str(
//!     r#"{"triangle": {"vertices": [[0, 0, 0], [2, 0, 0], [0, 2, 0]]}}"#,
//! )?;
//! let vertices = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
//! assert_eq!(shape, Triangle::new(vertices.map(Into::into)).into());
//! # Ok::<(), serde_json::Error>(())
//! ```

use super::SurfaceDerivatives;
use super::arithmetic::clamp_to_f32_range;
use super::solid_angle::{area_pdf, area_sample};
use super::triangle_geometry::TriangleGeometry;
use super::{Hit, InvalidShape, Shape, ShapeSample, SolidAngleShape, SurfacePoint, check};
use crate::surface::Surface;
use juggler_bvh::intersect_triangle;
use juggler_math::{Aabb, Ray, Vec2, Vec3, warp};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A triangle. Its vertices run counter-clockwise seen from the front.
///
/// Surface coordinates: those of `uvs`; without them (0, 0), (1, 0) and (0, 1) at the vertices.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Triangle {
    /// The three corners in scene units, not collinear.
    #[schemars(with = "[[f32; 3]; 3]", extend("x-unit" = "scene units"))]
    pub vertices: [Vec3; 3],
    /// Shading normals at the corners, of any length above 0, interpolated over the triangle.
    /// Without them, the triangle is shaded flat.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<[[f32; 3]; 3]>")]
    pub normals: Option<[Vec3; 3]>,
    /// Surface coordinates of the corners, interpolated over the triangle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<[[f32; 2]; 3]>")]
    pub uvs: Option<[Vec2; 3]>,
}

impl Triangle {
    /// Triangle without shading normals and surface coordinates.
    pub fn new(vertices: [Vec3; 3]) -> Self {
        Self { vertices, normals: None, uvs: None }
    }

    pub(crate) fn geometry(&self) -> TriangleGeometry {
        TriangleGeometry { corners: self.vertices, normals: self.normals, uvs: self.uvs }
    }
}

impl Shape for Triangle {
    fn prepare(&mut self) -> Result<(), InvalidShape> {
        for i in 0..3 {
            check::point(&format!("vertices[{i}]"), self.vertices[i])?;
            let field = format!("normals[{i}]");
            let normal = self.normals.map_or(Vec3::Y, |normals| normals[i]);
            check::point(&field, normal)?;
            if normal == Vec3::ZERO {
                return Err(check::invalid(&field, format!("`{field}` must not be zero")));
            }
            check::point(&format!("uvs[{i}]"), self.uvs.map_or(Vec2::ZERO, |uvs| uvs[i]).extend(0.0))?;
        }
        if self.geometry().area() > 0.0 {
            return Ok(());
        }
        Err(check::invalid("vertices", "`vertices` enclose no area: they lie on one line"))
    }

    fn bounds(&self) -> Aabb {
        Aabb::from_points(self.vertices)
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let [a, b, c] = self.vertices;
        let (t, u, v) = intersect_triangle(&clamp_to_f32_range(ray), a, b, c)?;
        Some(Hit { t, uv: Vec2::new(u, v), primitive: 0 })
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.geometry().surface(ray, hit.uv)
    }

    fn derivatives(&self, _local: Vec3, _hit: &Hit, _time: f32) -> Option<SurfaceDerivatives> {
        self.geometry().derivatives()
    }

    fn area(&self) -> f32 {
        self.geometry().area() as f32
    }

    fn sample(&self, from: Vec3, u: Vec2) -> Option<ShapeSample> {
        let (point, normal) = self.geometry().point(warp::uniform_triangle(u).truncate().as_dvec2());
        area_sample(from, point, normal, self.area())
    }

    fn pdf(&self, from: Vec3, at: &SurfacePoint) -> f32 {
        area_pdf(from, at, self.area())
    }

    fn triangles(&self) -> usize {
        1
    }

    fn solid_angle_shape(&self) -> Option<SolidAngleShape> {
        Some(SolidAngleShape::Triangle { vertices: self.vertices })
    }
}

#[cfg(any(test, feature = "testing"))]
impl Triangle {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let made = |vertices: [[f32; 3]; 3]| Self::new(vertices.map(Vec3::from));
        let smooth = Self {
            normals: Some([[-1.0, 0.1, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 0.3]].map(Vec3::from)),
            uvs: Some([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]].map(Vec2::from)),
            ..made([[0.0, 0.0, 0.0], [2.0, 0.1, 0.0], [0.3, 1.0, 0.5]])
        };
        vec![
            smooth,
            made([[50.0, 20.0, -30.0], [51.0, 20.0, -30.0], [50.0, 20.0, -29.0]]),
            made([[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.001, 0.0]]),
            made([[0.0, 0.0, 0.0], [1e-4, 1e-5, 0.0], [0.0, 1e-4, 2e-5]]),
            made([[0.0, 1e6, 0.0], [1e6, -1e6, 3e5], [0.0, 0.0, 2e6]]),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::Random;

    /// A ray that leaves a slender triangle does not hit it again, and starts no farther off than
    /// from other triangles.
    #[test]
    fn slender_triangles_need_no_larger_ray_offsets_than_others() {
        let mut random = Random::new(35);
        for (slender, far) in [1.0f32, 30.0, 1e3, 1e5].into_iter().flat_map(|s| [0.0, 1.0, 100.0].map(|far| (s, far))) {
            for _ in 0..5_000 {
                let (a, along) = (random.unit_vector() * far, random.unit_vector());
                let c = a + along * random.f32() + random.unit_vector() / slender;
                let triangle = Triangle::new([a, a + along, c]);
                let at = warp::uniform_triangle(random.vec2()).truncate().as_dvec2();
                let (point, normal) = triangle.geometry().point(at);
                let aim = Ray::new(point + random.unit_vector(), Vec3::ZERO);
                let aim = Ray { direction: point - aim.origin, ..aim };
                let Some(hit) = triangle.intersect(&aim) else { continue };
                let surface = triangle.surface(&aim, &hit);
                let direction = random.unit_vector();
                if direction.dot(normal).abs() < 1e-4 {
                    continue;
                }
                let ray = surface.spawn_ray(direction, 0.0);
                assert!(triangle.intersect(&ray).is_none(), "{triangle:?} {surface:?} {direction}");
                let moved = ray.origin.distance(surface.point);
                assert!(moved <= 12.0 * f32::EPSILON * (far + 1.0), "{triangle:?} {surface:?}: {moved}");
            }
        }
    }
}
