//! A flat convex polygon.
//!
//! A ray hits its plane at `t = n·(c - o) / n·d`, and the polygon if the point is on the inner side
//! of every edge.
//!
//! ```
//! use juggler_shape::{AnyShape, Polygon};
//! let shape: AnyShape = serde_json::from_str(
//!     r#"{"polygon": {"vertices": [[0, 0, 0], [2, 0, 0], [3, 2, 0], [0, 1, 0]]}}"#,
//! )?;
//! let vertices = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 2.0, 0.0], [0.0, 1.0, 0.0]];
//! assert_eq!(shape, Polygon::new(vertices.map(Into::into)).into());
//! # Ok::<(), serde_json::Error>(())
//! ```

use super::SurfaceDerivatives;
use super::arithmetic::{in_range, rounded_surface, to_f64};
use super::solid_angle::{area_pdf, area_sample, select_by_weight};
use super::{Hit, InvalidShape, Shape, ShapeSample, SurfacePoint};
use crate::surface::Surface;
use geometry::PolygonGeometry;
use juggler_math::{Aabb, DVec3, Ray, Vec2, Vec3, warp};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

mod geometry;

/// A flat convex polygon. Its vertices run counter-clockwise seen from the front.
///
/// Surface coordinates in scene units from the first vertex: u along the first edge, v at right
/// angles to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Polygon {
    /// At least three corners in order, in scene units: coplanar, convex, no corner twice.
    #[schemars(with = "Vec<[f32; 3]>", length(min = 3), extend("x-unit" = "scene units"))]
    pub vertices: Vec<Vec3>,
    /// Data that [`Shape::prepare`] derives.
    #[serde(skip)]
    geometry: PolygonGeometry,
}

impl Polygon {
    /// A polygon with these corners.
    pub fn new(vertices: impl Into<Vec<Vec3>>) -> Self {
        Self { vertices: vertices.into(), geometry: PolygonGeometry::default() }
    }
}

impl Shape for Polygon {
    fn prepare(&mut self) -> Result<(), InvalidShape> {
        self.geometry = PolygonGeometry::new(&self.vertices)?;
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        self.geometry.bounds
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let (t, point) = self.geometry.intersect_plane(ray);
        let hit = in_range(ray, t, 0)?;
        self.geometry.contains(point).then_some(hit)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let (origin, direction) = to_f64(ray);
        let (t, point) = self.geometry.intersect_plane(ray);
        let point = if t.is_finite() { point } else { origin + direction * f64::from(hit.t) };
        let from_first = point - self.vertices.first().map_or(DVec3::ZERO, |v| v.as_dvec3());
        let uv = Vec2::new(from_first.dot(self.geometry.along) as f32, from_first.dot(self.geometry.across()) as f32);
        let surface = rounded_surface(self.geometry.onto_plane(point), self.geometry.normal, uv);
        Surface { position_error: surface.position_error + self.geometry.rounding, ..surface }
    }

    fn derivatives(&self, _local: Vec3, _hit: &Hit, _time: f32) -> Option<SurfaceDerivatives> {
        SurfaceDerivatives::new(self.geometry.along.as_vec3(), self.geometry.across().as_vec3())
    }

    fn area(&self) -> f32 {
        self.geometry.areas.last().map_or(0.0, |&area| area as f32)
    }

    fn sample(&self, from: Vec3, u: Vec2) -> Option<ShapeSample> {
        let (index, rest) = select_by_weight(&self.geometry.areas, u.x)?;
        let barycentrics = warp::uniform_triangle(Vec2::new(rest, u.y)).as_dvec3();
        let corner = |i: usize| self.vertices.get(i).map(|v| v.as_dvec3());
        let (a, b, c) = (corner(0)?, corner(index + 1)?, corner(index + 2)?);
        let point = self.geometry.onto_plane(a * barycentrics.x + b * barycentrics.y + c * barycentrics.z);
        area_sample(from, point.as_vec3(), self.geometry.normal.as_vec3(), self.area())
    }

    fn pdf(&self, from: Vec3, at: &SurfacePoint) -> f32 {
        area_pdf(from, at, self.area())
    }

    fn heap_bytes(&self) -> usize {
        size_of_val(self.vertices.as_slice()) + self.geometry.heap_bytes()
    }
}

#[cfg(any(test, feature = "testing"))]
impl Polygon {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let circle = |count: usize, radius: f32, center: Vec3| {
            let corner = |i: usize| {
                let (sin, cos) = juggler_math::portable::sin_cos_turns(i as f32 / count as f32);
                center + radius * (Vec3::new(0.6, 0.0, 0.8) * cos + Vec3::Y * sin)
            };
            Self::new((0..count).map(corner).collect::<Vec<_>>())
        };
        vec![
            Self::new([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 2.0, 0.0], [0.0, 1.0, 0.0]].map(Vec3::from)),
            circle(3, 1.0, Vec3::ZERO),
            circle(64, 2.0, Vec3::new(5.0, -3.0, 1.0)),
            circle(7, 1e-4, Vec3::ZERO),
            circle(5, 1e6, Vec3::new(1e6, 0.0, 0.0)),
            Self::new([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 0.0, -0.01]].map(Vec3::from)),
        ]
    }
}
