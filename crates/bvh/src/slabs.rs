//! A ray, or several at once, made ready for box tests.
//!
//! The slab test (Kay and Kajiya 1986): a box is entered at the last of its three near planes and left at
//! the first of its far planes. Three rules make it safe to cull by:
//!
//! - The far distances are widened by 8 ulp. Rounding of the test itself can cost 3.5 (Ize 2013), the rest
//!   covers the rounding of what lies in the box.
//! - A direction component of zero gives an infinite inverse, and `0 · infinity` (the origin lies in a plane
//!   of the box) a NaN, which must not narrow the range. A component so small that its inverse overflows
//!   would give wrong distances; its inverse is made NaN, so that this axis never narrows anything.
//! - Distances up to `t_max` and a hair more count, so that hits whose distance is rounded the other way
//!   than their box's are still seen, whatever the order.
//!
//! For several rays of one octant the same six planes are tested with the extreme origins and inverses
//! (interval arithmetic: Boulos, Wald, Shirley, "Geometric and Arithmetic Culling Methods for Entire Ray
//! Packets", 2006). Rounding is monotonic, so the interval's result bounds that of each ray exactly.

use crate::lanes::{less_or_equal, max, min};
use crate::node::WIDTH;
use juggler_math::{Aabb, Ray, Vec3};

const WIDEN: f32 = 1.0 + 8.0 * f32::EPSILON;
const SLACK: f32 = 1.0 + 32.0 * f32::EPSILON;

/// One ray or the interval of several, ready for [`Node::test`](crate::node::Node::test).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slabs {
    /// Per axis 0 where the minimum is the near plane, 1 where the maximum is.
    pub side: [usize; 3],
    pub near_origin: [f32; 3],
    pub far_origin: [f32; 3],
    pub near_inverse: [f32; 3],
    pub far_inverse: [f32; 3],
    pub t_min: f32,
    pub t_max: f32,
}

/// The distance up to which boxes are opened for hits up to `t_max`.
#[inline(always)]
pub(crate) fn cull_distance(t_max: f32) -> f32 {
    // Never infinite: planes parallel to the ray and beside it lie at infinity.
    (t_max * SLACK).min(f32::MAX)
}

/// The inverse of a direction's component, NaN where it overflows though the component is not zero.
#[inline(always)]
fn inverse(component: f32) -> f32 {
    let inverse = 1.0 / component;
    if inverse.is_infinite() && component != 0.0 { f32::NAN } else { inverse }
}

impl Slabs {
    #[inline(always)]
    pub fn of_ray(ray: &Ray) -> Self {
        let origin = ray.origin.to_array();
        let near_inverse = ray.direction.to_array().map(inverse);
        Self {
            side: ray.direction.to_array().map(|d| usize::from(d.is_sign_negative())),
            near_origin: origin,
            far_origin: origin,
            near_inverse,
            far_inverse: near_inverse.map(|i| i * WIDEN),
            t_min: ray.t_min,
            t_max: cull_distance(ray.t_max),
        }
    }

    /// The interval of several rays; `None` where their directions do not share an octant or a ray may
    /// start before its origin. What it misses, every one of the rays misses.
    #[inline(always)]
    pub fn of_rays(rays: &[Ray]) -> Option<Self> {
        let first = rays.first()?;
        let mut interval = Interval::of(first);
        for ray in rays {
            interval.add(ray);
        }
        interval.slabs()
    }
}

/// Extremes of several rays.
struct Interval {
    origin: Aabb,
    direction: Aabb,
    any_negative: [u32; 3],
    all_negative: [u32; 3],
    t_min: f32,
    t_max: f32,
}

impl Interval {
    #[inline(always)]
    fn of(ray: &Ray) -> Self {
        let point = |p: Vec3| Aabb { min: p, max: p };
        let bits = ray.direction.to_array().map(f32::to_bits);
        let (t_min, t_max) = (ray.t_min, ray.t_max);
        let (origin, direction) = (point(ray.origin), point(ray.direction));
        Self { origin, direction, any_negative: bits, all_negative: bits, t_min, t_max }
    }

    #[inline(always)]
    fn add(&mut self, ray: &Ray) {
        self.origin = self.origin.with_point(ray.origin);
        self.direction = self.direction.with_point(ray.direction);
        for (axis, component) in ray.direction.to_array().into_iter().enumerate() {
            self.any_negative[axis] |= component.to_bits();
            self.all_negative[axis] &= component.to_bits();
        }
        self.t_min = self.t_min.min(ray.t_min);
        self.t_max = self.t_max.max(ray.t_max);
    }

    /// Distances below `t_min >= 0` are cut off anyway, so the near planes only need their smallest positive
    /// distance (smallest inverse) and the far planes their largest.
    #[inline(always)]
    fn slabs(&self) -> Option<Slabs> {
        let mixed = (0..3).any(|axis| (self.any_negative[axis] ^ self.all_negative[axis]) >> 31 != 0);
        if mixed || self.t_min < 0.0 {
            return None;
        }
        let side = self.any_negative.map(|bits| (bits >> 31) as usize);
        let pick =
            |low: Vec3, high: Vec3| std::array::from_fn(|axis| if side[axis] == 0 { low[axis] } else { high[axis] });
        Some(Slabs {
            side,
            near_origin: pick(self.origin.max, self.origin.min),
            far_origin: pick(self.origin.min, self.origin.max),
            near_inverse: pick(self.direction.max, self.direction.min).map(inverse),
            far_inverse: pick(self.direction.min, self.direction.max).map(|d| inverse(d) * WIDEN),
            t_min: self.t_min,
            t_max: cull_distance(self.t_max),
        })
    }
}

/// Up to eight rays of one octant side by side, to test all against one box.
pub(crate) struct Lanes {
    side: [usize; 3],
    origin: [[f32; WIDTH]; 3],
    inverse: [[f32; WIDTH]; 3],
    t_min: [f32; WIDTH],
    t_max: [f32; WIDTH],
}

impl Lanes {
    /// Lanes without a ray meet nothing.
    pub fn new(rays: &[Ray]) -> Self {
        let mut lanes = Self {
            side: [0; 3],
            origin: [[0.0; WIDTH]; 3],
            inverse: [[1.0; WIDTH]; 3],
            t_min: [f32::INFINITY; WIDTH],
            t_max: [f32::NEG_INFINITY; WIDTH],
        };
        for (lane, ray) in rays.iter().take(WIDTH).enumerate() {
            for axis in 0..3 {
                lanes.side[axis] = usize::from(ray.direction[axis].is_sign_negative());
                lanes.origin[axis][lane] = ray.origin[axis];
                lanes.inverse[axis][lane] = inverse(ray.direction[axis]);
            }
            lanes.t_min[lane] = ray.t_min;
            lanes.t_max[lane] = cull_distance(ray.t_max);
        }
        lanes
    }

    /// Tells how far the ray of a lane still goes.
    #[inline(always)]
    pub fn shorten(&mut self, lane: usize, t_max: f32) {
        self.t_max[lane & (WIDTH - 1)] = cull_distance(t_max);
    }

    /// The farthest that any ray goes, in the sense of [`cull_distance`].
    #[inline(always)]
    pub fn t_max(&self) -> f32 {
        self.t_max.iter().fold(f32::NEG_INFINITY, |a, &b| max(b, a))
    }

    /// Which rays meet the box in `slot` of the bounds (bit per lane): bit by bit what
    /// [`Node::test`](crate::node::Node::test) says of each ray alone.
    #[inline(always)]
    pub fn test(&self, bounds: &[[[f32; WIDTH]; 2]; 3], slot: usize) -> u32 {
        let slot = slot & (WIDTH - 1);
        let mut enter = self.t_min;
        let mut leave = self.t_max;
        for (axis, sides) in bounds.iter().enumerate() {
            let side = self.side[axis] & 1;
            let (near, far) = (sides[side][slot], sides[side ^ 1][slot]);
            for i in 0..WIDTH {
                let n = (near - self.origin[axis][i]) * self.inverse[axis][i];
                let f = (far - self.origin[axis][i]) * (self.inverse[axis][i] * WIDEN);
                enter[i] = max(n, enter[i]);
                leave[i] = min(f, leave[i]);
            }
        }
        less_or_equal(&enter, &leave)
    }
}

/// Where the ray's line enters the box, as the traversal computes it.
pub(crate) fn entry(ray: &Ray, bounds: &Aabb) -> f32 {
    let mut enter = f32::NEG_INFINITY;
    for axis in 0..3 {
        let direction = ray.direction[axis];
        let near = if direction.is_sign_negative() { bounds.max[axis] } else { bounds.min[axis] };
        let n = (near - ray.origin[axis]) * inverse(direction);
        enter = max(n, enter);
    }
    enter
}
