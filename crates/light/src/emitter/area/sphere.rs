//! A sphere that shines: even over the cone that it fills (Shirley, Wang, Zimmerman, Monte Carlo Techniques for Direct
//! Lighting Calculations, 1996; PBR 4th ed., section 6.2.4).

use super::{AreaSample, area_density, seen};
use juggler_math::{Aabb, DVec3, Vec2, Vec3, fun};
use std::f64::consts::{PI, TAU};

/// So close to the surface, in units of the largest coordinate, a point counts as on it.
const TOUCHING: f64 = 1e-6;

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereEmitter {
    center: DVec3,
    radius: f64,
}

impl SphereEmitter {
    /// A sphere in world space; `None` unless its radius is above 0 and all is finite.
    pub fn new(center: Vec3, radius: f32) -> Option<Self> {
        let usable = radius > 0.0 && radius < f32::INFINITY && center.is_finite();
        usable.then(|| Self { center: center.as_dvec3(), radius: f64::from(radius) })
    }

    /// 1 - cos of the half angle under which it is seen, and the squared sine; `None` from within and from the surface
    /// itself, where rounding decides on which side a point lies: who stands inside must see the other wall.
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
        let (sin, cos) = fun::sin_cos_f64(v * TAU);
        let Some((size, sin_squared)) = self.cone(squared) else {
            let z = 1.0 - 2.0 * u;
            let ring = (1.0 - z * z).max(0.0).sqrt();
            let normal = DVec3::new(ring * cos, ring * sin, z);
            let point = self.center + normal * self.radius;
            return seen(from, point, normal, area_density(from, point, normal, self.area()));
        };
        // The angle at `from`, then the one at the centre between the axis and the place.
        let fall = u * size;
        let fall_sin_squared = fall * (2.0 - fall);
        let edge = (1.0 - fall_sin_squared / sin_squared).max(0.0).sqrt();
        let cos_center = (fall_sin_squared / sin_squared.sqrt() + (1.0 - fall) * edge).min(1.0);
        let sin_center = (1.0 - cos_center * cos_center).sqrt();
        let axis = -to_center / squared.sqrt();
        let (tangent, bitangent) = axis.any_orthonormal_pair();
        let normal = (tangent * cos + bitangent * sin) * sin_center + axis * cos_center;
        seen(from, self.center + normal * self.radius, normal, 1.0 / (TAU * size))
    }

    pub(super) fn pdf(&self, from: Vec3, point: Vec3) -> f32 {
        let from = from.as_dvec3();
        if let Some((size, _)) = self.cone((self.center - from).length_squared()) {
            return (1.0 / (TAU * size)) as f32;
        }
        let normal = (point.as_dvec3() - self.center).normalize_or_zero();
        area_density(from, self.center + normal * self.radius, normal, self.area()) as f32
    }

    pub(super) fn area(&self) -> f64 {
        4.0 * PI * self.radius * self.radius
    }

    pub(super) fn bounds(&self) -> Aabb {
        super::box_around([self.center - self.radius, self.center + self.radius])
    }
}
