//! Up to eight rays in SoA layout, tested against one box.

use crate::lanes::{Lanes, bits, max};
use crate::node::WIDTH;
use crate::slabs::{Bundle, MARGIN, RayExtremes, SLACK, WIDEN, cull_distance};
use crate::triangle::FARTHEST;
use fearless_simd::f32x8;
use fearless_simd::prelude::*;
use juggler_math::Ray;

/// Lanes of a ray's row that must be finite: origin and direction.
const ORIGIN_AND_DIRECTION: u32 = 0x3f;

/// Up to eight rays of one octant in SoA layout.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RayLanes {
    pub origin: [[f32; WIDTH]; 3],
    pub direction: [[f32; WIDTH]; 3],
    /// Reciprocal directions; NaN where the reciprocal of a nonzero component overflows.
    pub inverse: [[f32; WIDTH]; 3],
    pub t_min: [f32; WIDTH],
    /// `t_max` of the rays, limited to finite numbers.
    pub ray_t_max: [f32; WIDTH],
    /// `t_max` for culling, see [`cull_distance`].
    t_max: [f32; WIDTH],
    /// Maximum of `t_max`.
    pub farthest: f32,
    /// Direction signs, a bit per axis.
    pub signs: u32,
    /// Interval of the rays.
    pub bundle: Bundle,
}

impl RayLanes {
    /// Loads up to eight rays in place and returns their extremes; unused lanes intersect nothing.
    /// `None` if the directions do not share an octant, a ray may start before its origin, or a ray
    /// is infinite.
    #[inline(always)]
    pub fn fill<S: Lanes>(&mut self, simd: S, rays: &[Ray]) -> Option<RayExtremes> {
        let first = row(simd, rays.first()?);
        let mut rows = [first; WIDTH];
        for (row, ray) in rows.iter_mut().zip(rays) {
            *row = self::row(simd, ray);
        }
        let (low, high) = extremes(simd, &rows)?;
        let [ox, oy, oz, dx, dy, dz, t_min, t_max] = transposed(rows);
        self.signs = 0;
        for axis in 0..3 {
            let direction = [dx, dy, dz][axis];
            let exact = simd.splat(1.0) / direction;
            let overflows = exact.abs().simd_gt(f32::MAX) & !direction.simd_eq(0.0);
            self.origin[axis] = [ox, oy, oz][axis].into();
            self.direction[axis] = direction.into();
            self.inverse[axis] = overflows.select(simd.splat(f32::NAN), exact).into();
            match bits(exact.simd_lt(0.0)) {
                0 => {}
                0xff => self.signs |= 1 << axis,
                _ => return None,
            }
        }
        if low[6] < 0.0 {
            return None;
        }
        self.t_min = t_min.into();
        self.ray_t_max = simd.least(t_max, simd.splat(FARTHEST)).into();
        self.t_max = cull_distances(simd, t_max).into();
        self.farthest = cull_distance(high[7]);
        for lane in rays.len()..WIDTH {
            (self.t_min[lane], self.t_max[lane]) = (f32::INFINITY, f32::NEG_INFINITY);
        }
        Some(RayExtremes { low, high, signs: self.signs })
    }

    /// Updates `t_max` of the active rays.
    #[inline(always)]
    pub fn shorten(&mut self, active: u32, rays: &[Ray]) {
        for (lane, ray) in rays.iter().enumerate().take(WIDTH) {
            if active >> lane & 1 != 0 {
                self.t_max[lane] = cull_distance(ray.t_max);
            }
        }
        self.farthest = self.t_max.iter().fold(f32::NEG_INFINITY, |a, &b| max(b, a));
    }

    /// [`RayLanes::shorten`] for all rays from an array of `t_max`; unused lanes still intersect
    /// nothing.
    #[inline(always)]
    pub fn shorten_to<S: Lanes>(&mut self, simd: S, t_max: &[f32; WIDTH]) {
        let t_max = simd.least(cull_distances(simd, simd.load(t_max)), simd.load(&self.t_max));
        self.t_max = t_max.into();
        self.farthest = t_max.reduce_max();
    }

    /// Bit mask of the rays that intersect the box in `slot` of the bounds.
    #[inline(always)]
    pub fn test<S: Lanes>(&self, simd: S, bounds: &[[[f32; WIDTH]; 2]; 3], slot: usize) -> u32 {
        let slot = slot & (WIDTH - 1);
        let mut enter = simd.load(&self.t_min);
        let mut leave = simd.splat(f32::MAX);
        for (axis, planes) in bounds.iter().enumerate() {
            let side = (self.signs >> axis) as usize & 1;
            let (near, far) = (planes[side][slot], planes[side ^ 1][slot]);
            let (origin, inverse) = (simd.load(&self.origin[axis]), simd.load(&self.inverse[axis]));
            // Operand order matters: a NaN leaves the interval unchanged.
            enter = simd.most((simd.splat(near) - origin) * inverse, enter);
            leave = simd.least((simd.splat(far) - origin) * inverse, leave);
        }
        let leave = leave * WIDEN + MARGIN;
        bits(enter.simd_le(simd.least(leave, simd.load(&self.t_max))))
    }
}

/// [`cull_distance`] of eight rays.
#[inline(always)]
fn cull_distances<S: Lanes>(simd: S, t_max: f32x8<S>) -> f32x8<S> {
    simd.least(t_max * SLACK + MARGIN, simd.splat(f32::MAX))
}

#[inline(always)]
fn row<S: Lanes>(simd: S, ray: &Ray) -> f32x8<S> {
    let (o, d) = (ray.origin, ray.direction);
    [o.x, o.y, o.z, d.x, d.y, d.z, ray.t_min, ray.t_max].simd_into(simd)
}

/// Minimum and maximum of each component; `None` where a ray is infinite. Rays with a NaN may be
/// ignored or also give `None`.
#[inline(always)]
fn extremes<S: Lanes>(simd: S, rows: &[f32x8<S>; WIDTH]) -> Option<([f32; WIDTH], [f32; WIDTH])> {
    let [a, b, c, d, e, f, g, h] = *rows;
    let low =
        simd.least(simd.least(simd.least(a, b), simd.least(c, d)), simd.least(simd.least(e, f), simd.least(g, h)));
    let high = simd.most(simd.most(simd.most(a, b), simd.most(c, d)), simd.most(simd.most(e, f), simd.most(g, h)));
    let is_finite = low.abs().simd_lt(f32::INFINITY) & high.abs().simd_lt(f32::INFINITY);
    (bits(is_finite) & ORIGIN_AND_DIRECTION == ORIGIN_AND_DIRECTION).then(
        #[inline(always)]
        || (low.into(), high.into()),
    )
}

/// Transposes an 8 × 8 matrix by three perfect shuffles.
#[inline(always)]
fn transposed<S: Simd>(mut rows: [f32x8<S>; WIDTH]) -> [f32x8<S>; WIDTH] {
    for _ in 0..3 {
        let [a, b, c, d, e, f, g, h] = rows;
        rows = [
            a.zip_low(e),
            a.zip_high(e),
            b.zip_low(f),
            b.zip_high(f),
            c.zip_low(g),
            c.zip_high(g),
            d.zip_low(h),
            d.zip_high(h),
        ];
    }
    rows
}
