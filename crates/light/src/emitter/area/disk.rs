//! A flat disk that shines: even by area (the solid angle of a disk has no simple map).

use super::{AreaSample, area_density, seen};
use juggler_math::{Aabb, DVec3, Vec2, Vec3, warp};
use std::f64::consts::PI;

/// A flat, full disk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiskEmitter {
    center: DVec3,
    normal: DVec3,
    radius: f64,
}

impl DiskEmitter {
    /// A disk in world space with the normal of its front, any length; `None` unless its radius is above 0, its normal
    /// has a length, and all is finite.
    pub fn new(center: Vec3, normal: Vec3, radius: f32) -> Option<Self> {
        let unit = normal.as_dvec3().normalize_or_zero();
        let usable = radius > 0.0 && radius < f32::INFINITY && center.is_finite() && unit != DVec3::ZERO;
        usable.then(|| Self { center: center.as_dvec3(), normal: unit, radius: f64::from(radius) })
    }

    pub(super) fn sample(&self, from: Vec3, u: Vec2) -> Option<AreaSample> {
        let from = from.as_dvec3();
        let place = warp::concentric_disk(u).as_dvec2() * self.radius;
        let (tangent, bitangent) = self.normal.any_orthonormal_pair();
        let point = self.center + tangent * place.x + bitangent * place.y;
        seen(from, point, self.normal, area_density(from, point, self.normal, self.area()))
    }

    pub(super) fn pdf(&self, from: Vec3, point: Vec3) -> f32 {
        area_density(from.as_dvec3(), point.as_dvec3(), self.normal, self.area()) as f32
    }

    pub(super) fn area(&self) -> f64 {
        PI * self.radius * self.radius
    }

    pub(super) fn normal(&self) -> Vec3 {
        self.normal.as_vec3()
    }

    pub(super) fn bounds(&self) -> Aabb {
        let half = (DVec3::ONE - self.normal * self.normal).max(DVec3::ZERO);
        let half = DVec3::new(half.x.sqrt(), half.y.sqrt(), half.z.sqrt()) * (self.radius * (1.0 + 1e-6));
        super::box_around([self.center - half, self.center + half])
    }
}
