//! Leaf visitor for one ray: eight triangles at once.

use super::filter::Filter;
use super::query::Query;
use super::simd_test::{RayFrames, intersect_single};
use super::{Block, TriangleHit};
use crate::Leaf;
use crate::lanes::{Bits, Lanes, bits, min};
use crate::slabs::Slabs;
use crate::triangle::{FARTHEST, Shear, TriangleTest};
use fearless_simd::prelude::*;
use juggler_math::Ray;
use std::ops::Range;

/// Leaf visitor for one ray.
pub(super) struct RayVisitor<'a, S: Simd, F> {
    simd: S,
    filter: F,
    blocks: &'a [Block],
    test: TriangleTest,
    shear: Shear,
    pub hit: Option<TriangleHit>,
}

impl<'a, S: Lanes, F: Filter> RayVisitor<'a, S, F> {
    #[inline(always)]
    pub fn new(simd: S, query: Query<'a, F>, ray: &Ray, slabs: &Slabs) -> Self {
        Self {
            simd,
            filter: query.filter,
            blocks: &query.tree.blocks,
            test: query.tree.test,
            shear: Shear::new(ray, slabs.exact_inverse, slabs.signs),
            hit: None,
        }
    }
}

impl<S: Lanes, F: Filter> Leaf for RayVisitor<'_, S, F> {
    #[inline(always)]
    fn closest(&mut self, number: usize, ray: &mut Ray, items: Range<u32>) {
        let block = &self.blocks[items.start as usize];
        let (mut closest, filter) = (self.hit, self.filter);
        block.hits(
            self.simd,
            (self.test, &self.shear, ray),
            items.len(),
            #[inline(always)]
            |hit| {
                if hit.is_before(&closest) && filter.accepts(number, &hit) {
                    closest = Some(hit);
                }
                false
            },
        );
        if let Some(hit) = closest {
            self.hit = closest;
            ray.t_max = hit.t;
        }
    }

    #[inline(always)]
    fn any(&mut self, number: usize, ray: &Ray, items: Range<u32>) -> bool {
        let block = &self.blocks[items.start as usize];
        block.hits(
            self.simd,
            (self.test, &self.shear, ray),
            items.len(),
            #[inline(always)]
            |hit| self.filter.accepts(number, &hit),
        )
    }
}

impl Block {
    /// Intersects one ray with the first `count` triangles and passes each hit to `is_last`, until
    /// it returns `true`. Returns whether it did.
    #[inline(always)]
    pub fn hits<S: Lanes>(
        &self,
        simd: S,
        (test, shear, ray): (TriangleTest, &Shear, &Ray),
        count: usize,
        mut is_last: impl FnMut(TriangleHit) -> bool,
    ) -> bool {
        let frames = RayFrames::broadcast(simd, shear, ray.t_min, min(ray.t_max, FARTHEST));
        let (candidates, points) = frames.candidates(simd, &self.corners(simd, shear.axes), (1 << count) - 1);
        if candidates == 0 {
            return false;
        }
        match test {
            TriangleTest::Watertight => {
                for lane in Bits(candidates) {
                    if let Some(hit) = self.hit(shear, ray, lane)
                        && is_last(hit)
                    {
                        return true;
                    }
                }
            }
            TriangleTest::Fast => {
                let [t, u, v] = intersect_single(simd, points);
                let found = simd.load(&t);
                let in_range = found.simd_ge(frames.t_min) & found.simd_le(frames.t_max);
                for lane in Bits(candidates & bits(in_range)) {
                    if is_last(TriangleHit { t: t[lane], u: u[lane], v: v[lane], index: self.index[lane] }) {
                        return true;
                    }
                }
            }
        }
        false
    }
}
