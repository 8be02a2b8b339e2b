//! The infinite plane y = 0; a ray hits it at `t = -o.y / d.y`.
//!
//! ```
//! use juggler_shape::{AnyShape, Plane};
//! let shape: AnyShape = serde_json::from_str(r#"{"plane": {}}"#)?;
//! assert_eq!(shape, Plane {}.into());
//! # Ok::<(), serde_json::Error>(())
//! ```

use super::SurfaceDerivatives;
use super::arithmetic::in_range;
use super::{Hit, InvalidShape, Shape, ShapeSample, SurfacePoint};
use crate::surface::Surface;
use juggler_math::{Aabb, DVec3, Ray, Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The infinite plane y = 0; its front faces +y.
///
/// Surface coordinates: u is x, v is z, in scene units.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
#[schemars(rename = "PlaneShape")]
pub struct Plane {}

/// Distance and point where a ray crosses the plane y = 0; the point is exactly on the plane.
#[inline]
pub fn intersect_ground(ray: &Ray) -> (f64, DVec3) {
    let (origin, direction) = super::arithmetic::to_f64(ray);
    let t = -origin.y / direction.y;
    (t, DVec3::new(origin.x + direction.x * t, 0.0, origin.z + direction.z * t))
}

impl Shape for Plane {
    fn prepare(&mut self) -> Result<(), InvalidShape> {
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        Aabb::INFINITE
    }

    #[inline]
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        in_range(ray, -f64::from(ray.origin.y) / f64::from(ray.direction.y), 0)
    }

    fn surface(&self, ray: &Ray, _hit: &Hit) -> Surface {
        // The plane extends beyond the range of floats.
        let end = Vec3::splat(f32::MAX);
        let point = intersect_ground(ray).1.as_vec3().clamp(-end, end);
        Surface::new(point, 0.0, Vec3::Y, Vec2::new(point.x, point.z))
    }

    fn derivatives(&self, _local: Vec3, _hit: &Hit, _time: f32) -> Option<SurfaceDerivatives> {
        SurfaceDerivatives::new(Vec3::X, Vec3::Z)
    }

    fn area(&self) -> f32 {
        f32::INFINITY
    }

    fn sample(&self, _from: Vec3, _u: Vec2) -> Option<ShapeSample> {
        None
    }

    fn pdf(&self, _from: Vec3, _at: &SurfacePoint) -> f32 {
        0.0
    }

    fn is_plane(&self) -> bool {
        true
    }
}

#[cfg(any(test, feature = "testing"))]
impl Plane {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self {}]
    }
}
