//! A ray: a half line with the stretch of it that counts.

use glam::Vec3;

/// A ray `origin + t · direction` for `t_min <= t <= t_max`.
///
/// World-space rays have a unit `direction`. A ray taken into object space by
/// [`Transform::ray_to_local`](crate::Transform::ray_to_local) keeps its `t`, so its direction has the
/// length that the transform gives it: shapes must not assume unit length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where the ray starts, in scene units.
    pub origin: Vec3,
    /// Where it goes; every component finite, not all zero.
    pub direction: Vec3,
    /// Smallest distance that counts, at least 0.
    pub t_min: f32,
    /// Largest distance that counts; infinite for a ray without end.
    pub t_max: f32,
    /// When: 0 as the shutter opens, 1 as it closes.
    pub time: f32,
}

impl Ray {
    /// A ray without end at time zero.
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, direction, t_min: 0.0, t_max: f32::INFINITY, time: 0.0 }
    }

    /// The same ray, cut off at `t_max`.
    pub fn up_to(self, t_max: f32) -> Self {
        Self { t_max, ..self }
    }

    /// The point at distance `t`.
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}
