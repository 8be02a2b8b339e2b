//! Axis-aligned boxes.

use crate::Ray;
use glam::Vec3;

/// An axis-aligned box; empty when a `min` is above its `max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Least corner.
    pub min: Vec3,
    /// Greatest corner.
    pub max: Vec3,
}

impl Aabb {
    /// The box of no point at all: the neutral element of [`Aabb::union`].
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };
    /// The box of every point.
    pub const INFINITE: Self = Self { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };

    /// The smallest box around the points.
    pub fn from_points(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::with_point)
    }

    /// The box grown to hold `point`.
    pub fn with_point(self, point: Vec3) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    /// The smallest box around both.
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Whether no point is inside.
    pub fn is_empty(&self) -> bool {
        self.min.cmpgt(self.max).any()
    }

    /// Whether all corners are finite (an empty box is not).
    pub fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }

    /// Whether the point lies inside or on the border.
    pub fn contains(&self, point: Vec3) -> bool {
        point.cmpge(self.min).all() && point.cmple(self.max).all()
    }

    /// The middle of a finite box.
    pub fn center(&self) -> Vec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// Edge lengths; negative somewhere when empty.
    pub fn extent(&self) -> Vec3 {
        self.max - self.min
    }

    /// Surface area; 0 when empty.
    pub fn area(&self) -> f32 {
        let e = self.extent().max(Vec3::ZERO);
        2.0 * (e.x * e.y + e.y * e.z + e.z * e.x)
    }

    /// Every side moved outwards by `by`.
    pub fn grown(self, by: f32) -> Self {
        Self { min: self.min - Vec3::splat(by), max: self.max + Vec3::splat(by) }
    }

    /// The eight corners.
    pub fn corners(&self) -> [Vec3; 8] {
        let pick = |i: usize, bit: usize, axis: usize| if i >> bit & 1 == 0 { self.min[axis] } else { self.max[axis] };
        std::array::from_fn(|i| Vec3::new(pick(i, 0, 0), pick(i, 1, 1), pick(i, 2, 2)))
    }

    /// Where the ray enters and leaves, clipped to its own range; `None` when it misses. The scalar
    /// reference for every faster test (slabs: Kay and Kajiya 1986; the far side widened by 4 ulp so that
    /// rounding never loses a hit: Ize 2013).
    pub fn clip(&self, ray: &Ray) -> Option<(f32, f32)> {
        let (mut enter, mut leave) = (ray.t_min, ray.t_max);
        for axis in 0..3 {
            let inverse = 1.0 / ray.direction[axis];
            let a = (self.min[axis] - ray.origin[axis]) * inverse;
            let b = (self.max[axis] - ray.origin[axis]) * inverse;
            let (near, far) = if inverse < 0.0 { (b, a) } else { (a, b) };
            // A NaN (0 · infinity: origin on a slab's plane, ray inside it) must not shrink the range.
            if near > enter {
                enter = near;
            }
            let far = far * (1.0 + 4.0 * f32::EPSILON);
            if far < leave {
                leave = far;
            }
        }
        (enter <= leave).then_some((enter, leave))
    }
}
