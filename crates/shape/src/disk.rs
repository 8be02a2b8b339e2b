//! A flat ring or full disk in the plane y = 0.
//!
//! ```
//! use juggler_shape::{AnyShape, Disk};
//! let shape: AnyShape = serde_json::from_str(r#"{"disk": {"radius": 2, "inner_radius": 0.5}}"#)?;
//! assert_eq!(shape, Disk { radius: 2.0, inner_radius: 0.5 }.into());
//! # Ok::<(), serde_json::Error>(())
//! ```

use super::arithmetic::{azimuth_turns, in_range};
use super::derivatives::{SurfaceDerivatives, disk_derivatives};
use super::plane::intersect_ground;
use super::solid_angle::{area_pdf, area_sample};
use super::{Hit, InvalidShape, Shape, ShapeSample, SolidAngleShape, SurfacePoint, check};
use crate::surface::Surface;
use juggler_math::{Aabb, Ray, Vec2, Vec3, portable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f32::consts::PI;

/// A disk in the plane y = 0 around the origin, with or without a hole; its front faces +y.
///
/// Surface coordinates: u is the angle as a fraction of a turn (0 at +x, a quarter at -z), v goes
/// from 0 at the outer rim to 1 at the inner rim or the center.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Disk {
    /// Outer radius in scene units, above 0.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
    pub radius: f32,
    /// Radius of the hole in scene units, 0 to less than `radius`; 0 for no hole.
    #[schemars(range(min = 0), extend("x-unit" = "scene units"))]
    pub inner_radius: f32,
}

impl Disk {
    /// Creates a disk of a radius around the origin, without a hole.
    pub fn new(radius: f32) -> Self {
        Self { radius, ..Self::default() }
    }
}

impl Default for Disk {
    fn default() -> Self {
        Self { radius: 1.0, inner_radius: 0.0 }
    }
}

impl Shape for Disk {
    fn prepare(&mut self) -> Result<(), InvalidShape> {
        check::positive("radius", self.radius)?;
        if (0.0..self.radius).contains(&self.inner_radius) {
            return Ok(());
        }
        let message =
            format!("`inner_radius` must be from 0 to below `radius` {}, is {}", self.radius, self.inner_radius);
        Err(check::invalid("inner_radius", message))
    }

    fn bounds(&self) -> Aabb {
        let corner = Vec3::new(self.radius, 0.0, self.radius);
        Aabb { min: -corner, max: corner }
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let (t, point) = intersect_ground(ray);
        let hit = in_range(ray, t, 0)?;
        let (inner, outer) = (f64::from(self.inner_radius), f64::from(self.radius));
        (inner * inner..=outer * outer).contains(&point.length_squared()).then_some(hit)
    }

    fn surface(&self, ray: &Ray, _hit: &Hit) -> Surface {
        let edge = Vec3::splat(self.radius);
        let point = intersect_ground(ray).1.as_vec3().clamp(-edge, edge);
        let inwards = (self.radius - point.length()) / (self.radius - self.inner_radius);
        Surface::new(point, 0.0, Vec3::Y, Vec2::new(azimuth_turns(point.x, point.z), inwards.clamp(0.0, 1.0)))
    }

    fn derivatives(&self, local: Vec3, _hit: &Hit, _time: f32) -> Option<SurfaceDerivatives> {
        disk_derivatives(local, self.radius - self.inner_radius)
    }

    fn area(&self) -> f32 {
        PI * (self.radius - self.inner_radius) * (self.radius + self.inner_radius)
    }

    fn sample(&self, from: Vec3, u: Vec2) -> Option<ShapeSample> {
        let hole = self.inner_radius / self.radius;
        let distance = self.radius * (hole * hole + u.x * (1.0 - hole * hole)).sqrt();
        let (sin, cos) = portable::sin_cos_turns(u.y);
        area_sample(from, Vec3::new(cos, 0.0, sin) * distance, Vec3::Y, self.area())
    }

    fn pdf(&self, from: Vec3, at: &SurfacePoint) -> f32 {
        area_pdf(from, at, self.area())
    }

    fn solid_angle_shape(&self) -> Option<SolidAngleShape> {
        (self.inner_radius == 0.0).then_some(SolidAngleShape::Disk { radius: self.radius })
    }
}

#[cfg(any(test, feature = "testing"))]
impl Disk {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        [(1.0, 0.0), (2.0, 1.5), (1e-4, 0.0), (1e6, 1e5), (1.0, 0.999)]
            .map(|(radius, inner_radius)| Self { radius, inner_radius })
            .to_vec()
    }
}
