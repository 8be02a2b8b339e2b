//! A ray with the interval of `t` in which it is intersected.

use glam::Vec3;

/// A ray `origin + t · direction` for `t_min <= t <= t_max`.
///
/// World-space rays have a unit `direction`.
/// [`Transform::ray_to_local`](crate::Transform::ray_to_local) keeps `t` and does not normalize, so
/// shapes must not assume a unit direction in object space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Origin, in scene units.
    pub origin: Vec3,
    /// Direction; finite components, not all zero.
    pub direction: Vec3,
    /// Lower end of the interval, at least 0.
    pub t_min: f32,
    /// Upper end of the interval; infinite for an unbounded ray.
    pub t_max: f32,
    /// Shutter time: 0 when the shutter opens, 1 when it closes.
    pub time: f32,
}

impl Ray {
    /// An unbounded ray at time 0.
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, direction, t_min: 0.0, t_max: f32::INFINITY, time: 0.0 }
    }

    /// The same ray with another `t_max`.
    pub fn with_t_max(self, t_max: f32) -> Self {
        Self { t_max, ..self }
    }

    /// Point at parameter `t`.
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}
