//! A sphere around the local origin.
//!
//! ```json
//! {"sphere": {"radius": 2}}
//! ```

use super::{Hit, InvalidShape, Shape, SurfaceSample};
use crate::surface::Surface;
use juggler_math::{Aabb, Ray, Vec2, Vec3, robust};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A sphere around the local origin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Sphere {
    /// Radius in scene units.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub radius: f32,
}

impl Default for Sphere {
    fn default() -> Self {
        Self { radius: 1.0 }
    }
}

impl Shape for Sphere {
    fn prepare(&mut self) -> Result<(), InvalidShape> {
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        Aabb { min: Vec3::splat(-self.radius), max: Vec3::splat(self.radius) }
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let a = ray.direction.length_squared();
        let b = -ray.origin.dot(ray.direction);
        let away = ray.origin + ray.direction * (b / a);
        let discriminant = self.radius * self.radius - away.length_squared();
        if discriminant < 0.0 {
            return None;
        }
        let q = b + (a * discriminant).sqrt().copysign(b);
        let c = ray.origin.length_squared() - self.radius * self.radius;
        let (near, far) = if q < 0.0 { (q / a, c / q) } else { (c / q, q / a) };
        let t = if near >= ray.t_min { near } else { far };
        (t >= ray.t_min && t <= ray.t_max).then_some(Hit { t, uv: Vec2::ZERO, part: 0 })
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let normal = ray.at(hit.t).normalize_or(Vec3::Y);
        Surface::new(normal * self.radius, robust::gamma(5) * self.radius, normal, Vec2::ZERO)
    }

    fn area(&self) -> f32 {
        4.0 * std::f32::consts::PI * self.radius * self.radius
    }

    fn sample(&self, _from: Vec3, _u: Vec2) -> Option<SurfaceSample> {
        None
    }

    fn pdf(&self, _from: Vec3, _direction: Vec3) -> f32 {
        0.0
    }
}

#[cfg(test)]
impl Sphere {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self { radius: 2.0 }]
    }
}
