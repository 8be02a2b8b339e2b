//! A rectangle in the plane y = 0 around the origin.
//!
//! ```
//! use juggler_shape::{AnyShape, Rectangle};
//! let shape: AnyShape = serde_json::from_str(r#"{"rectangle": {"size": [4, 3]}}"#)?;
//! assert_eq!(shape, Rectangle { size: [4.0, 3.0] }.into());
//! # Ok::<(), serde_json::Error>(())
//! ```

use super::SurfaceDerivatives;
use super::arithmetic::in_range;
use super::plane::intersect_ground;
use super::solid_angle::{area_pdf, area_sample};
use super::{Hit, InvalidShape, Shape, ShapeSample, SolidAngleShape, SurfacePoint, check};
use crate::surface::Surface;
use juggler_math::{Aabb, Ray, Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A rectangle in the plane y = 0, centered on the origin; its front faces +y.
///
/// Surface coordinates from 0 to 1: u grows with x, v with -z, so that an image is upright seen
/// from above with -z up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Rectangle {
    /// Edge lengths along x and z in scene units, above 0.
    #[schemars(extend("items" = {"type": "number", "format": "float", "exclusiveMinimum": 0}))]
    #[schemars(extend("x-unit" = "scene units"))]
    pub size: [f32; 2],
}

impl Default for Rectangle {
    fn default() -> Self {
        Self { size: [1.0, 1.0] }
    }
}

impl Rectangle {
    /// Creates a rectangle around the origin with edges of these lengths along x and z.
    pub fn new(size: [f32; 2]) -> Self {
        Self { size }
    }

    fn corner(&self) -> Vec3 {
        Vec3::new(0.5 * self.size[0], 0.0, 0.5 * self.size[1])
    }
}

impl Shape for Rectangle {
    fn prepare(&mut self) -> Result<(), InvalidShape> {
        check::positive("size[0]", self.size[0])?;
        check::positive("size[1]", self.size[1])
    }

    fn bounds(&self) -> Aabb {
        Aabb { min: -self.corner(), max: self.corner() }
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let (t, point) = intersect_ground(ray);
        let hit = in_range(ray, t, 0)?;
        point.abs().cmple(self.corner().as_dvec3()).all().then_some(hit)
    }

    fn surface(&self, ray: &Ray, _hit: &Hit) -> Surface {
        let corner = self.corner();
        let point = intersect_ground(ray).1.as_vec3().clamp(-corner, corner);
        let uv = Vec2::new(0.5 + point.x / self.size[0], 0.5 - point.z / self.size[1]);
        Surface::new(point, 0.0, Vec3::Y, uv)
    }

    fn derivatives(&self, _local: Vec3, _hit: &Hit, _time: f32) -> Option<SurfaceDerivatives> {
        SurfaceDerivatives::new(Vec3::X * self.size[0], Vec3::NEG_Z * self.size[1])
    }

    fn area(&self) -> f32 {
        self.size[0] * self.size[1]
    }

    fn sample(&self, from: Vec3, u: Vec2) -> Option<ShapeSample> {
        let point = Vec3::new((u.x - 0.5) * self.size[0], 0.0, (u.y - 0.5) * self.size[1]);
        area_sample(from, point, Vec3::Y, self.area())
    }

    fn pdf(&self, from: Vec3, at: &SurfacePoint) -> f32 {
        area_pdf(from, at, self.area())
    }

    fn solid_angle_shape(&self) -> Option<SolidAngleShape> {
        Some(SolidAngleShape::Rectangle { size: self.size })
    }
}

#[cfg(any(test, feature = "testing"))]
impl Rectangle {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        [[1.0, 1.0], [4.0, 3.0], [1e-3, 2.0], [1e6, 1e6], [1e-4, 2e-4]].map(|size| Self { size }).to_vec()
    }
}
