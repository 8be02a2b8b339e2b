//! The plane y = 0, without end: a ray meets it at `t = -o.y / d.y`.
//!
//! ```
//! use juggler_shape::{AnyShape, Plane};
//! let shape: AnyShape = serde_json::from_str(r#"{"plane": {}}"#)?;
//! assert_eq!(shape, Plane {}.into());
//! # Ok::<(), serde_json::Error>(())
//! ```

use super::Derivatives;
use super::arithmetic::in_range;
use super::{Hit, InvalidShape, Shape, SurfacePoint, SurfaceSample};
use crate::surface::Surface;
use juggler_math::{Aabb, DVec3, Ray, Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The plane y = 0, without end; its front is above.
///
/// Surface coordinates: u is x, v is z, in scene units.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Plane {}

/// Where a ray meets the plane y = 0: the distance and the point, exactly on the plane.
#[inline]
pub fn cross_ground(ray: &Ray) -> (f64, DVec3) {
    let (origin, direction) = super::arithmetic::double(ray);
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
        // A plane goes on where floats end.
        let end = Vec3::splat(f32::MAX);
        let point = cross_ground(ray).1.as_vec3().clamp(-end, end);
        Surface::new(point, 0.0, Vec3::Y, Vec2::new(point.x, point.z))
    }

    fn derivatives(&self, _local: Vec3, _hit: &Hit, _time: f32) -> Option<Derivatives> {
        Derivatives::new(Vec3::X, Vec3::Z)
    }

    fn area(&self) -> f32 {
        f32::INFINITY
    }

    fn sample(&self, _from: Vec3, _u: Vec2) -> Option<SurfaceSample> {
        None
    }

    fn pdf(&self, _from: Vec3, _at: &SurfacePoint) -> f32 {
        0.0
    }
}

#[cfg(any(test, feature = "testing"))]
impl Plane {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self {}]
    }
}
