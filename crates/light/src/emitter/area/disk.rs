//! Disk emitter, sampled uniformly by area (the solid angle of a disk has no simple mapping).

use super::{AreaSample, area_sample, uniform_area_pdf};
use juggler_math::{Aabb, DVec3, Vec2, Vec3, warp};
use std::f64::consts::PI;

/// Flat, full disk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiskEmitter {
    center: DVec3,
    normal: DVec3,
    radius: f64,
}

impl DiskEmitter {
    /// Creates a disk in world space; `normal` is the normal of its front, of any length. `None`
    /// unless the radius is above 0, the normal is not zero, and all numbers are finite.
    pub fn new(center: Vec3, normal: Vec3, radius: f32) -> Option<Self> {
        let unit = normal.as_dvec3().normalize_or_zero();
        let usable = radius > 0.0 && radius < f32::INFINITY && center.is_finite() && unit != DVec3::ZERO;
        usable.then(|| Self { center: center.as_dvec3(), normal: unit, radius: f64::from(radius) })
    }

    pub(super) fn sample(&self, from: Vec3, u: Vec2) -> Option<AreaSample> {
        let from = from.as_dvec3();
        let offset = warp::concentric_disk(u).as_dvec2() * self.radius;
        let (tangent, bitangent) = self.normal.any_orthonormal_pair();
        let point = self.center + tangent * offset.x + bitangent * offset.y;
        area_sample(from, point, self.normal, uniform_area_pdf(from, point, self.normal, self.area()))
    }

    pub(super) fn pdf(&self, from: Vec3, point: Vec3) -> f32 {
        uniform_area_pdf(from.as_dvec3(), point.as_dvec3(), self.normal, self.area()) as f32
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
