//! Sphere emitter, sampled uniformly over the cone that it subtends (Shirley, Wang, Zimmerman,
//! Monte Carlo Techniques for Direct Lighting Calculations, 1996; PBR 4th ed., section 6.2.4).

use super::{AreaSample, area_sample, uniform_area_pdf};
use juggler_math::{Aabb, DVec3, Vec2, Vec3, portable};
use std::f64::consts::{PI, TAU};

/// Distance below which a point counts as on the surface, relative to the largest coordinate.
const TOUCHING: f64 = 1e-6;

/// Sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereEmitter {
    center: DVec3,
    radius: f64,
}

impl SphereEmitter {
    /// Creates a sphere in world space; `None` unless the radius is above 0 and all numbers are
    /// finite.
    pub fn new(center: Vec3, radius: f32) -> Option<Self> {
        let usable = radius > 0.0 && radius < f32::INFINITY && center.is_finite();
        usable.then(|| Self { center: center.as_dvec3(), radius: f64::from(radius) })
    }

    /// 1 - cos and the squared sine of the half angle that the sphere subtends. `None` from inside
    /// and from the surface itself, where rounding decides the side: a point inside must see the
    /// opposite wall.
    fn cone(&self, squared_distance: f64) -> Option<(f64, f64)> {
        let sin_squared = self.radius * self.radius / squared_distance;
        let near = self.radius + TOUCHING * self.center.abs().max_element().max(self.radius);
        (squared_distance > near * near).then(|| (sin_squared / (1.0 + (1.0 - sin_squared).sqrt()), sin_squared))
    }

    pub(super) fn sample(&self, from: Vec3, u: Vec2) -> Option<AreaSample> {
        let from = from.as_dvec3();
        let to_center = self.center - from;
        let squared = to_center.length_squared();
        let (u, v) = (f64::from(u.x), f64::from(u.y));
        let (sin, cos) = portable::sin_cos_f64(v * TAU);
        let Some((size, sin_squared)) = self.cone(squared) else {
            let z = 1.0 - 2.0 * u;
            let ring = (1.0 - z * z).max(0.0).sqrt();
            let normal = DVec3::new(ring * cos, ring * sin, z);
            let point = self.center + normal * self.radius;
            return area_sample(from, point, normal, uniform_area_pdf(from, point, normal, self.area()));
        };
        // Compute the angle at `from`, then the angle at the center between the axis and the
        // sampled point.
        let one_minus_cos = u * size;
        let sampled_sin_squared = one_minus_cos * (2.0 - one_minus_cos);
        let edge = (1.0 - sampled_sin_squared / sin_squared).max(0.0).sqrt();
        let cos_center = (sampled_sin_squared / sin_squared.sqrt() + (1.0 - one_minus_cos) * edge).min(1.0);
        let sin_center = (1.0 - cos_center * cos_center).sqrt();
        let axis = -to_center / squared.sqrt();
        let (tangent, bitangent) = axis.any_orthonormal_pair();
        let normal = (tangent * cos + bitangent * sin) * sin_center + axis * cos_center;
        area_sample(from, self.center + normal * self.radius, normal, 1.0 / (TAU * size))
    }

    pub(super) fn pdf(&self, from: Vec3, point: Vec3) -> f32 {
        let from = from.as_dvec3();
        if let Some((size, _)) = self.cone((self.center - from).length_squared()) {
            return (1.0 / (TAU * size)) as f32;
        }
        let normal = (point.as_dvec3() - self.center).normalize_or_zero();
        uniform_area_pdf(from, self.center + normal * self.radius, normal, self.area()) as f32
    }

    pub(super) fn area(&self) -> f64 {
        4.0 * PI * self.radius * self.radius
    }

    pub(super) fn bounds(&self) -> Aabb {
        super::box_around([self.center - self.radius, self.center + self.radius])
    }
}
