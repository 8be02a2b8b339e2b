//! A ray, or the interval of several rays, prepared for box tests.
//!
//! Slab test (Kay and Kajiya 1986): a ray enters a box at the last of its three near planes and
//! leaves it at the first of its three far planes. These rules make the test conservative:
//!
//! - Far distances are enlarged by 8 ulps. The rounding of the test itself costs up to 3.5 (Ize
//!   2013); the rest covers the rounding of the items in the box. A single ray's planes are also
//!   moved outward by a few ulps of the origin, so that a multiply-add, fused or not, suffices per
//!   plane.
//! - A zero direction component has an infinite reciprocal, and `0 · infinity` (the origin lies in
//!   a plane of the box) is a NaN, which must not narrow the interval. The reciprocal of a
//!   component so small that it overflows would give wrong distances and is replaced by NaN, so
//!   that its axis never narrows the interval. A single ray uses a large finite reciprocal and
//!   planes moved outward instead (`Slabs::parallel`), since its offsets must be finite.
//! - All these margins are relative and vanish among subnormal distances, which are rounded to
//!   multiples of 2^-149. So far planes and `t_max` are moved outward by the smallest normal number
//!   as well.
//! - Boxes are entered up to slightly beyond `t_max`, so that a hit is found in any order of
//!   traversal even if its distance and that of its box round differently.
//!
//! For several rays of one octant, the same planes are tested with the extreme origins and
//! reciprocals (interval arithmetic: Boulos, Wald, Shirley, "Geometric and Arithmetic Culling
//! Methods for Entire Ray Packets", 2006). Rounding is monotonic, so the interval's result bounds
//! that of each ray exactly.

use crate::lanes::Lanes;
use crate::node::WIDTH;
use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x8, u32x8};
use juggler_math::{Ray, Vec3};

pub(crate) const WIDEN: f32 = 1.0 + 8.0 * f32::EPSILON;
pub(crate) const SLACK: f32 = 1.0 + 32.0 * f32::EPSILON;

/// Absolute margin of the distances of box tests, which relative margins do not widen enough when
/// the distances are subnormal. The margin itself is a normal number, since subnormal operands are
/// slow on some processors.
pub(crate) const MARGIN: f32 = f32::MIN_POSITIVE;

/// Relative error bound of a plane's offset: 2 ulps for the rounding of reciprocal and offset,
/// doubled.
const OFFSET: f32 = 4.0 * f32::EPSILON;

/// A ray prepared for [`intersect_boxes`](crate::node::intersect_boxes): the distance to a plane at
/// `p` is `p * inverse + offset`, rounded to the conservative side. The fourth element of each
/// array is unused.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Slabs {
    /// Bit per axis: 0 if the minimum is the near plane, 1 if the maximum is.
    pub signs: u32,
    /// Reciprocal direction: infinite for a zero component, NaN where only the reciprocal
    /// overflows.
    pub exact_inverse: [f32; 4],
    pub inverse: [f32; 4],
    pub near_offset: [f32; 4],
    pub far_inverse: [f32; 4],
    pub far_offset: [f32; 4],
    pub t_min: f32,
    pub t_max: f32,
}

/// Interval of several rays, prepared for [`Node::test_bundle`](crate::node::Node::test_bundle):
/// the distance to a plane at `p` is `(p - origin) * inverse`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Bundle {
    /// Per axis: 0 if the minimum is the near plane, 1 if the maximum is.
    pub side: [usize; 3],
    /// Origin and direction that enter first; the last two elements are unused.
    pub near: [f32; WIDTH],
    /// Origin and direction that leave last; the last two elements are unused.
    pub far: [f32; WIDTH],
    /// Reciprocals of `near`, see [`inverses`].
    pub near_inverse: [f32; WIDTH],
    pub far_inverse: [f32; WIDTH],
    pub t_min: f32,
    pub t_max: f32,
}

/// Distance up to which boxes are entered to find hits up to `t_max`.
#[inline(always)]
pub(crate) fn cull_distance(t_max: f32) -> f32 {
    // Never infinite: planes parallel to the ray that it misses lie at infinity.
    (t_max * SLACK + MARGIN).min(f32::MAX)
}

/// Reciprocals of a direction's components; NaN where that of a nonzero component overflows.
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

    /// Loads a ray in place: a copy by wide loads would stall on the narrow stores before it.
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
        let pad = offset.abs() * OFFSET + MARGIN;
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

    /// Prepares a ray that is parallel, or nearly so, to a coordinate plane. Along the axis in
    /// question the ray does not move, so planes lie far behind or far ahead. The offset is exact,
    /// a power of two times the origin, and a plane through the origin counts as both. Planes one
    /// ulp beside the origin lie at a distance of 2^100; hits of such a ray beyond that (1.3e30
    /// times its direction's length) may be missed.
    ///
    /// A ray that is not finite intersects nothing, not even empty boxes: their planes lie at
    /// infinity, and a NaN from zero times infinity would keep the traversal from ending.
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
                (exact, exact * WIDEN, offset, offset.abs() * OFFSET + MARGIN)
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

/// Extremes of several rays: origin, direction, `t_min`, `t_max`; and their common direction signs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RayExtremes {
    pub low: [f32; WIDTH],
    pub high: [f32; WIDTH],
    /// Common direction signs, a bit per axis.
    pub signs: u32,
}

impl RayExtremes {
    /// Union of two extremes; `None` if the directions do not share an octant.
    #[inline(always)]
    pub fn union<S: Lanes>(&self, simd: S, other: &Self) -> Option<Self> {
        let low = simd.least(simd.load(&self.low), simd.load(&other.low)).into();
        let high = simd.most(simd.load(&self.high), simd.load(&other.high)).into();
        (self.signs == other.signs).then_some(Self { low, high, signs: self.signs })
    }

    /// Conservative interval: a box that it misses is missed by every ray.
    ///
    /// Distances below `t_min >= 0` are clipped anyway, so the near planes only need their smallest
    /// positive distance (smallest reciprocal) and the far planes their largest.
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

/// [`inverses`] of eight components.
#[inline(always)]
pub(crate) fn inverses_of<S: Lanes>(simd: S, components: f32x8<S>) -> f32x8<S> {
    let inverses = simd.splat(1.0) / components;
    let overflows = inverses.abs().simd_gt(f32::MAX) & !components.simd_eq(0.0);
    overflows.select(simd.splat(f32::NAN), inverses)
}
