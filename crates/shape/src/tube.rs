//! A round tube around the y axis, without end: `x² + z² = r²`.
//!
//! ```
//! use juggler_shape::{AnyShape, Tube};
//! let shape: AnyShape = serde_json::from_str(r#"{"tube": {"radius": 0.5}}"#)?;
//! assert_eq!(shape, Tube { radius: 0.5 }.into());
//! # Ok::<(), serde_json::Error>(())
//! ```

use super::arithmetic::{cross_tube, double, first_in_range, rounded_surface, turn};
use super::derivatives::{Derivatives, about_y};
use super::{Hit, InvalidShape, Shape, SurfacePoint, SurfaceSample, check};
use crate::surface::Surface;
use juggler_math::{Aabb, DVec3, Ray, Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A round tube around the y axis, without end.
///
/// Surface coordinates: u is the angle as a fraction of a turn (0 at +x, a quarter at -z), v is y in scene units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Tube {
    /// Radius in scene units.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub radius: f32,
}

impl Default for Tube {
    fn default() -> Self {
        Self { radius: 1.0 }
    }
}

/// The side of a round tube at a hit: `hit.part` is 0 where the ray enters and 1 where it leaves.
pub fn tube_surface(radius: f32, ray: &Ray, hit: &Hit) -> Surface {
    let (origin, direction) = double(ray);
    let radius = f64::from(radius);
    let t = cross_tube(origin, direction, radius)
        .map_or(f64::from(hit.t), |(near, far)| if hit.part == 0 { near } else { far });
    let found = origin + direction * t;
    let normal = DVec3::new(found.x, 0.0, found.z).normalize_or(DVec3::X);
    // A tube goes on where floats end.
    let end = f64::from(f32::MAX);
    let point = normal * radius + DVec3::Y * found.y.clamp(-end, end);
    rounded_surface(point, normal, Vec2::new(turn(normal.x as f32, normal.z as f32), point.y as f32))
}

impl Shape for Tube {
    fn prepare(&mut self) -> Result<(), InvalidShape> {
        check::positive("radius", self.radius)
    }

    fn bounds(&self) -> Aabb {
        Aabb::INFINITE
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let (origin, direction) = double(ray);
        let (near, far) = cross_tube(origin, direction, f64::from(self.radius))?;
        first_in_range(ray, [(near, 0), (far, 1)])
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        tube_surface(self.radius, ray, hit)
    }

    fn derivatives(&self, local: Vec3, _hit: &Hit, _time: f32) -> Option<Derivatives> {
        Derivatives::new(about_y(local), Vec3::Y)
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
impl Tube {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        [1.0, 0.3, 1e-4, 1e5].map(|radius| Self { radius }).to_vec()
    }
}
