//! A ray, or several at once, made ready for box tests.
//!
//! The slab test (Kay and Kajiya 1986): a box is entered at the last of its three near planes and left at
//! the first of its far planes. Three rules make it safe to cull by:
//!
//! - The far distances are widened by 8 ulp. Rounding of the test itself can cost 3.5 (Ize 2013), the rest
//!   covers the rounding of what lies in the box. A single ray's planes are also moved outwards by a few ulp of the
//!   origin, so that the test may be one multiplication and subtraction, fused or not.
//! - A direction component of zero gives an infinite inverse, and `0 · infinity` (the origin lies in a plane
//!   of the box) a NaN, which must not narrow the range. A component so small that its inverse overflows
//!   would give wrong distances; its inverse is made NaN, so that this axis never narrows anything. A single ray takes
//!   a large finite inverse instead and planes moved outwards (`Slabs::parallel`), for its offsets must be finite.
//! - Distances up to `t_max` and a hair more count, so that hits whose distance is rounded the other way
//!   than their box's are still seen, whatever the order.
//!
//! For several rays of one octant the same six planes are tested with the extreme origins and inverses
//! (interval arithmetic: Boulos, Wald, Shirley, "Geometric and Arithmetic Culling Methods for Entire Ray
//! Packets", 2006). Rounding is monotonic, so the interval's result bounds that of each ray exactly.

use crate::lanes::Lanes;
use crate::node::WIDTH;
use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x8, u32x8};
use juggler_math::{Ray, Vec3};

pub(crate) const WIDEN: f32 = 1.0 + 8.0 * f32::EPSILON;
pub(crate) const SLACK: f32 = 1.0 + 32.0 * f32::EPSILON;

/// How much of its offset a plane may be off by: rounding of the inverse and of the offset, 2 ulp with room.
const OFFSET: f32 = 4.0 * f32::EPSILON;

/// One ray, ready for [`meet`](crate::node::meet): a plane at `p` is met at
/// `p * inverse + offset`, with both rounded to the safe side. The fourth of each four means nothing.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Slabs {
    /// Bit per axis: 0 where the minimum is the near plane, 1 where the maximum is.
    pub signs: u32,
    /// Of the direction as it is: infinite where it is zero, NaN where only the inverse overflows.
    pub exact_inverse: [f32; 4],
    pub inverse: [f32; 4],
    pub near_offset: [f32; 4],
    pub far_inverse: [f32; 4],
    pub far_offset: [f32; 4],
    pub t_min: f32,
    pub t_max: f32,
}

/// The interval of several rays, ready for [`Node::test_bundle`](crate::node::Node::test_bundle): a plane at `p` is
/// met at `(p - origin) * inverse`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Bundle {
    /// Per axis 0 where the minimum is the near plane, 1 where the maximum is.
    pub side: [usize; 3],
    /// Of the rays that enter first: origin and direction. (The other two mean nothing.)
    pub near: [f32; WIDTH],
    /// Of the rays that leave last.
    pub far: [f32; WIDTH],
    /// The inverses of these, as [`inverses`] gives them.
    pub near_inverse: [f32; WIDTH],
    pub far_inverse: [f32; WIDTH],
    pub t_min: f32,
    pub t_max: f32,
}

/// The distance up to which boxes are opened for hits up to `t_max`.
#[inline(always)]
pub(crate) fn cull_distance(t_max: f32) -> f32 {
    // Never infinite: planes parallel to the ray and beside it lie at infinity.
    (t_max * SLACK).min(f32::MAX)
}

/// The inverses of a direction's components, NaN where one overflows though the component is not zero.
#[inline(always)]
pub(crate) fn inverses(direction: Vec3) -> Vec3 {
    let inverses = Vec3::ONE / direction;
    if inverses.is_finite() { inverses } else { exceptional(direction) }
}

#[cold]
#[inline(never)]
fn exceptional(direction: Vec3) -> Vec3 {
    Vec3::from(direction.to_array().map(inverse))
}

fn inverse(component: f32) -> f32 {
    let inverse = 1.0 / component;
    if inverse.is_infinite() && component != 0.0 { f32::NAN } else { inverse }
}

impl Slabs {
    #[inline(always)]
    pub fn of_ray<S: Lanes>(simd: S, ray: &Ray) -> Self {
        let mut slabs = Self::default();
        slabs.fill(simd, ray);
        slabs
    }

    /// Takes a ray in, in place: a copy by wide loads would wait for the narrow stores before it.
    #[inline(always)]
    pub fn fill<S: Lanes>(&mut self, simd: S, ray: &Ray) {
        let (o, d) = (ray.origin, ray.direction);
        let origin: f32x4<S> = [o.x, o.y, o.z, d.x].simd_into(simd);
        let direction: f32x4<S> = [d.x, d.y, d.z, ray.t_min].simd_into(simd);
        let inverse = f32x4::splat(simd, 1.0) / direction;
        let offset = origin * inverse;
        let is_finite = offset.abs().simd_lt(f32::INFINITY) & direction.abs().simd_lt(f32::INFINITY);
        if is_finite.to_bitmask() & 7 != 7 {
            *self = Self::parallel(*ray);
            return;
        }
        let pad = offset.abs() * OFFSET;
        *self = Self {
            signs: direction.simd_lt(0.0).to_bitmask() as u32,
            exact_inverse: inverse.into(),
            inverse: inverse.into(),
            near_offset: (-offset - pad).into(),
            far_inverse: (inverse * WIDEN).into(),
            far_offset: (pad - offset * WIDEN).into(),
            t_min: ray.t_min,
            t_max: cull_distance(ray.t_max),
        };
    }

    /// For rays that run parallel, or almost, to an axis plane: along that axis the ray stays where it is, so
    /// planes lie far behind or far ahead. The offset is exact, a power of two times the origin, and a plane
    /// through the origin counts as before and behind. Planes a step of rounding beside the origin lie 2^100 away:
    /// of such a ray hits beyond that (1.3e30 lengths of its direction) may be missed.
    ///
    /// A ray from nowhere, or to nowhere (not a number, infinite), meets nothing, not even empty boxes: their planes lie
    /// at infinity, and zero times infinity would never end a traversal.
    #[cold]
    #[inline(never)]
    fn parallel(ray: Ray) -> Self {
        const FAR: f32 = (1u128 << 125) as f32;
        const PAD: f32 = (1u128 << 104) as f32;
        if !(ray.origin.is_finite() && ray.direction.is_finite()) {
            return Self { t_min: f32::INFINITY, t_max: f32::NEG_INFINITY, ..Self::default() };
        }
        let mut slabs = Self {
            signs: 0,
            exact_inverse: [0.0; 4],
            inverse: [0.0; 4],
            near_offset: [0.0; 4],
            far_inverse: [0.0; 4],
            far_offset: [0.0; 4],
            t_min: ray.t_min,
            t_max: cull_distance(ray.t_max),
        };
        for axis in 0..3 {
            let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
            let exact = inverse(direction);
            let offset = origin * exact;
            slabs.signs |= u32::from(direction.is_sign_negative()) << axis;
            slabs.exact_inverse[axis] = exact;
            let (inverse, far_inverse, offset, pad) = if offset.is_finite() {
                (exact, exact * WIDEN, offset, offset.abs() * OFFSET)
            } else {
                let exponent = origin.abs().clamp(1.0, FAR).to_bits() >> 23;
                let inverse = (FAR / f32::from_bits((exponent + 1) << 23)).copysign(direction);
                (inverse, inverse, origin * inverse, PAD)
            };
            slabs.inverse[axis] = inverse;
            slabs.near_offset[axis] = -offset - pad;
            slabs.far_inverse[axis] = far_inverse;
            slabs.far_offset[axis] = pad - offset * (far_inverse / inverse);
        }
        slabs
    }
}

/// Extremes of several rays: origin, direction, `t_min`, `t_max`; and the signs that all directions have.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Extent {
    pub low: [f32; WIDTH],
    pub high: [f32; WIDTH],
    /// Bit per axis.
    pub signs: u32,
}

impl Extent {
    /// Of both; `None` where the directions do not share an octant.
    #[inline(always)]
    pub fn union<S: Lanes>(&self, simd: S, other: &Self) -> Option<Self> {
        let low = simd.least(simd.load(&self.low), simd.load(&other.low)).into();
        let high = simd.most(simd.load(&self.high), simd.load(&other.high)).into();
        (self.signs == other.signs).then_some(Self { low, high, signs: self.signs })
    }

    /// What this misses, every one of the rays misses.
    ///
    /// Distances below `t_min >= 0` are cut off anyway, so the near planes only need their smallest positive
    /// distance (smallest inverse) and the far planes their largest.
    #[inline(always)]
    pub fn bundle<S: Lanes>(&self, simd: S) -> Bundle {
        let (low, high) = (simd.load(&self.low), simd.load(&self.high));
        let axis: u32x8<S> = [1, 2, 4, 1, 2, 4, 0, 0].simd_into(simd);
        let is_positive = (axis & u32x8::splat(simd, self.signs)).simd_eq(0);
        let (near, far) = (is_positive.select(high, low), is_positive.select(low, high));
        Bundle {
            side: [0, 1, 2].map(
                #[inline(always)]
                |axis| (self.signs >> axis) as usize & 1,
            ),
            near: near.into(),
            far: far.into(),
            near_inverse: inverses_of(simd, near).into(),
            far_inverse: (inverses_of(simd, far) * WIDEN).into(),
            t_min: self.low[6],
            t_max: cull_distance(self.high[7]),
        }
    }
}

/// [`inverses`], eight at a time.
#[inline(always)]
pub(crate) fn inverses_of<S: Lanes>(simd: S, components: f32x8<S>) -> f32x8<S> {
    let inverses = simd.splat(1.0) / components;
    let overflows = inverses.abs().simd_gt(f32::MAX) & !components.simd_eq(0.0);
    overflows.select(simd.splat(f32::NAN), inverses)
}
