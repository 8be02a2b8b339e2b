//! An infinite cylinder around the y axis: `x² + z² = r²`.
//!
//! ```
//! use juggler_shape::{AnyShape, Tube};
//! let shape: AnyShape = serde_json::from_str(r#"{"tube": {"radius": 0.5}}"#)?;
//! assert_eq!(shape, Tube { radius: 0.5 }.into());
//! # Ok::<(), serde_json::Error>(())
//! ```

use super::arithmetic::{azimuth_turns, first_in_range, intersect_infinite_cylinder, rounded_surface, to_f64};
use super::derivatives::{SurfaceDerivatives, dpdu_about_y};
use super::{Hit, InvalidShape, Shape, ShapeSample, SurfacePoint, check};
use crate::surface::Surface;
use juggler_math::{Aabb, DVec3, Ray, Vec2, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An infinite circular cylinder around the y axis.
///
/// Surface coordinates: u is the angle as a fraction of a turn (0 at +x, a quarter at -z), v is y
/// in scene units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Tube {
    /// Radius in scene units, above 0.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
    pub radius: f32,
}

impl Tube {
    /// Creates an infinite tube of a radius around the y axis.
    pub fn new(radius: f32) -> Self {
        Self { radius }
    }
}

impl Default for Tube {
    fn default() -> Self {
        Self { radius: 1.0 }
    }
}

/// Surface of an infinite cylinder at a hit: `hit.primitive` is 0 where the ray enters and 1 where
/// it leaves.
pub fn infinite_cylinder_surface(radius: f32, ray: &Ray, hit: &Hit) -> Surface {
    let (origin, direction) = to_f64(ray);
    let radius = f64::from(radius);
    let t = intersect_infinite_cylinder(origin, direction, radius)
        .map_or(f64::from(hit.t), |(near, far)| if hit.primitive == 0 { near } else { far });
    let found = origin + direction * t;
    let normal = DVec3::new(found.x, 0.0, found.z).normalize_or(DVec3::X);
    // The cylinder extends beyond the range of floats.
    let end = f64::from(f32::MAX);
    let point = normal * radius + DVec3::Y * found.y.clamp(-end, end);
    rounded_surface(point, normal, Vec2::new(azimuth_turns(normal.x as f32, normal.z as f32), point.y as f32))
}

impl Shape for Tube {
    fn prepare(&mut self) -> Result<(), InvalidShape> {
        check::positive("radius", self.radius)
    }

    fn bounds(&self) -> Aabb {
        Aabb::INFINITE
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let (origin, direction) = to_f64(ray);
        let (near, far) = intersect_infinite_cylinder(origin, direction, f64::from(self.radius))?;
        first_in_range(ray, [(near, 0), (far, 1)])
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        infinite_cylinder_surface(self.radius, ray, hit)
    }

    fn derivatives(&self, local: Vec3, _hit: &Hit, _time: f32) -> Option<SurfaceDerivatives> {
        SurfaceDerivatives::new(dpdu_about_y(local), Vec3::Y)
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
}

#[cfg(any(test, feature = "testing"))]
impl Tube {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        [1.0, 0.3, 1e-4, 1e5].map(|radius| Self { radius }).to_vec()
    }
}
