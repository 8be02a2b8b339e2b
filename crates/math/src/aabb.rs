//! Axis-aligned bounding boxes.

use crate::Ray;
use glam::Vec3;

/// An axis-aligned bounding box; empty if any component of `min` exceeds that of `max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Minimum corner.
    pub min: Vec3,
    /// Maximum corner.
    pub max: Vec3,
}

impl Aabb {
    /// The empty box: the neutral element of [`Aabb::union`].
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };
    /// The box that contains every point.
    pub const INFINITE: Self = Self { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };

    /// Smallest box that contains all points.
    pub fn from_points(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::with_point)
    }

    /// Smallest box that contains `self` and `point`.
    pub fn with_point(self, point: Vec3) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    /// Smallest box that contains both boxes.
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Whether the box contains no point.
    pub fn is_empty(&self) -> bool {
        self.min.cmpgt(self.max).any()
    }

    /// Whether both corners are finite. False for [`Aabb::EMPTY`].
    pub fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }

    /// Whether the point lies inside or on the boundary.
    pub fn contains(&self, point: Vec3) -> bool {
        point.cmpge(self.min).all() && point.cmple(self.max).all()
    }

    /// Center of a finite box.
    pub fn center(&self) -> Vec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// Edge lengths; at least one is negative for an empty box.
    pub fn extent(&self) -> Vec3 {
        self.max - self.min
    }

    /// Surface area; 0 when empty.
    pub fn area(&self) -> f32 {
        let e = self.extent().max(Vec3::ZERO);
        2.0 * (e.x * e.y + e.y * e.z + e.z * e.x)
    }

    /// The box with each face moved outward by `by`.
    pub fn grown(self, by: f32) -> Self {
        Self { min: self.min - Vec3::splat(by), max: self.max + Vec3::splat(by) }
    }

    /// The eight corners.
    pub fn corners(&self) -> [Vec3; 8] {
        let pick = |i: usize, bit: usize, axis: usize| if i >> bit & 1 == 0 { self.min[axis] } else { self.max[axis] };
        std::array::from_fn(|i| Vec3::new(pick(i, 0, 0), pick(i, 1, 1), pick(i, 2, 2)))
    }

    /// Interval of `t` in which the ray is inside the box, clipped to the ray's own interval;
    /// `None` for a miss. Scalar reference for the SIMD tests of the acceleration structures
    /// (slabs: Kay and Kajiya 1986; far distances enlarged by 4 ulps so that rounding never loses a
    /// hit: Ize 2013).
    pub fn clip(&self, ray: &Ray) -> Option<(f32, f32)> {
        let (mut enter, mut leave) = (ray.t_min, ray.t_max);
        for axis in 0..3 {
            let inverse = 1.0 / ray.direction[axis];
            let a = (self.min[axis] - ray.origin[axis]) * inverse;
            let b = (self.max[axis] - ray.origin[axis]) * inverse;
            let (near, far) = if inverse < 0.0 { (b, a) } else { (a, b) };
            // A NaN (0 · infinity: the origin lies in a slab's plane and the ray is parallel to it)
            // leaves the interval unchanged.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Random, close};

    fn random_box(random: &mut Random) -> Aabb {
        let flat = random.below(4);
        let (a, mut b) = (random.point(3.0), random.point(3.0));
        if flat < 3 {
            b[flat] = a[flat];
        }
        Aabb::from_points([a, b])
    }

    fn random_ray(random: &mut Random) -> Ray {
        let mut ray = random.ray(5.0);
        for axis in 0..3 {
            if random.below(6) == 0 {
                ray.direction[axis] = if random.below(2) == 0 { 0.0 } else { -0.0 };
            }
        }
        if ray.direction == Vec3::ZERO { Ray::new(ray.origin, Vec3::X) } else { ray }
    }

    /// Slab test in double precision with divisions in place of reciprocals.
    fn reference(aabb: &Aabb, ray: &Ray, grow: f64) -> Option<(f64, f64)> {
        let (mut enter, mut leave) = (0.0f64, f64::INFINITY);
        for axis in 0..3 {
            let (o, d) = (f64::from(ray.origin[axis]), f64::from(ray.direction[axis]));
            let (low, high) = (f64::from(aabb.min[axis]) - grow, f64::from(aabb.max[axis]) + grow);
            if d == 0.0 {
                if o < low || o > high {
                    return None;
                }
                continue;
            }
            let (a, b) = ((low - o) / d, (high - o) / d);
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        (enter <= leave).then_some((enter, leave))
    }

    #[test]
    fn clip_never_misses_a_hit_and_rarely_reports_false_hits() {
        let mut random = Random::new(81);
        let mut hits = 0;
        for _ in 0..100_000 {
            let (aabb, ray) = (random_box(&mut random), random_ray(&mut random));
            let clipped = aabb.clip(&ray);
            if reference(&aabb, &ray, 0.0).is_some() {
                let (near, far) = clipped.unwrap_or_else(|| panic!("{aabb:?} lost {ray:?}"));
                let truth = reference(&aabb, &ray, 0.0).unwrap();
                assert!(
                    close(near, truth.0 as f32, 1e-5) && (far == truth.1 as f32 || close(far, truth.1 as f32, 1e-5))
                );
                hits += 1;
            } else if clipped.is_some() {
                assert!(reference(&aabb, &ray, 1e-5).is_some(), "{aabb:?} invented {ray:?}");
            }
        }
        assert!(hits > 1_000, "{hits}");
    }

    #[test]
    fn clip_respects_the_ray_interval_and_handles_origins_in_box_planes() {
        let unit = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
        let ray = Ray::new(Vec3::new(-1.0, 0.0, 0.5), Vec3::X);
        let (near, far) = unit.clip(&ray).expect("a ray in a face touches the box");
        assert!(near == 1.0 && close(far, 2.0, 1e-6));
        assert_eq!(unit.clip(&ray.with_t_max(0.5)), None);
        assert_eq!(unit.clip(&Ray { t_min: 1.5, ..ray }).map(|r| r.0), Some(1.5));
        assert_eq!(Aabb::EMPTY.clip(&ray), None);
        assert_eq!(Aabb::INFINITE.clip(&ray), Some((0.0, f32::INFINITY)));
    }

    #[test]
    fn bounding_box_contains_its_points() {
        let mut random = Random::new(82);
        for _ in 0..200 {
            let points: Vec<Vec3> = (0..5).map(|_| random.point(10.0)).collect();
            let aabb = Aabb::from_points(points.iter().copied());
            assert!(points.iter().chain(&aabb.corners()).all(|&p| aabb.contains(p)) && aabb.contains(aabb.center()));
            assert!(!aabb.contains(aabb.max + 0.1) && aabb.grown(0.2).contains(aabb.max + 0.1));
            assert_eq!(aabb.union(Aabb::EMPTY), aabb);
            assert_eq!(Aabb::from_points(aabb.corners()), aabb);
        }
        assert!(Aabb::EMPTY.is_empty() && !Aabb::EMPTY.is_finite() && !Aabb::INFINITE.is_finite());
        assert_eq!((Aabb::EMPTY.area(), Aabb { min: Vec3::ZERO, max: Vec3::new(1.0, 2.0, 3.0) }.area()), (0.0, 22.0));
    }
}
