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

use crate::lanes::{self, less_or_equal, max, min};
use crate::node::WIDTH;
use juggler_math::{Aabb, Ray};

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

/// Extremes of several rays: origin, direction, `t_min`, `t_max`, side by side in eight lanes, and which of them
/// have the sign bit.
struct Interval {
    low: [f32; WIDTH],
    high: [f32; WIDTH],
    any_negative: [u32; WIDTH],
    all_negative: [u32; WIDTH],
}

impl Interval {
    #[inline(always)]
    fn of(ray: &Ray) -> Self {
        let numbers = Self::numbers(ray);
        let bits = numbers.map(f32::to_bits);
        Self { low: numbers, high: numbers, any_negative: bits, all_negative: bits }
    }

    #[inline(always)]
    fn numbers(ray: &Ray) -> [f32; WIDTH] {
        let ([ox, oy, oz], [dx, dy, dz]) = (ray.origin.to_array(), ray.direction.to_array());
        [ox, oy, oz, dx, dy, dz, ray.t_min, ray.t_max]
    }

    #[inline(always)]
    fn add(&mut self, ray: &Ray) {
        let numbers = Self::numbers(ray);
        for (i, number) in numbers.into_iter().enumerate() {
            self.low[i] = min(number, self.low[i]);
            self.high[i] = max(number, self.high[i]);
            self.any_negative[i] |= number.to_bits();
            self.all_negative[i] &= number.to_bits();
        }
    }

    /// Distances below `t_min >= 0` are cut off anyway, so the near planes only need their smallest positive
    /// distance (smallest inverse) and the far planes their largest.
    #[inline(always)]
    fn slabs(&self) -> Option<Slabs> {
        let mixed = (3..6).any(|lane| (self.any_negative[lane] ^ self.all_negative[lane]) >> 31 != 0);
        if mixed || self.low[6] < 0.0 {
            return None;
        }
        let side: [usize; 3] = std::array::from_fn(|axis| (self.any_negative[axis + 3] >> 31) as usize);
        let pick = |near: [&[f32; WIDTH]; 2], first: usize| std::array::from_fn(|axis| near[side[axis]][first + axis]);
        let direction: [[f32; 3]; 2] = [pick([&self.high, &self.low], 3), pick([&self.low, &self.high], 3)];
        Some(Slabs {
            side,
            near_origin: pick([&self.high, &self.low], 0),
            far_origin: pick([&self.low, &self.high], 0),
            near_inverse: direction[0].map(inverse),
            far_inverse: direction[1].map(|d| inverse(d) * WIDEN),
            t_min: self.low[6],
            t_max: cull_distance(self.high[7]),
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
                lanes.origin[axis][lane] = ray.origin[axis];
                lanes.inverse[axis][lane] = ray.direction[axis];
            }
            lanes.t_min[lane] = ray.t_min;
            lanes.t_max[lane] = ray.t_max;
        }
        for (axis, inverses) in lanes.inverse.iter_mut().enumerate() {
            lanes.side[axis] = usize::from(inverses[0].is_sign_negative());
            *inverses = lanes::inverse(inverses);
        }
        lanes.t_max = lanes.t_max.map(cull_distance);
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
