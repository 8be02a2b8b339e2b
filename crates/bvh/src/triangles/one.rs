//! One ray at the leaves: eight triangles at once.

use super::filter::Filter;
use super::meet::Lines;
use super::query::Query;
use super::{Block, TriangleHit};
use crate::Leaf;
use crate::lanes::{Bits, Lanes};
use crate::slabs::Slabs;
use crate::triangle::{Shear, TriangleTest};
use fearless_simd::prelude::*;
use juggler_math::Ray;
use std::ops::Range;

/// Visitor for one ray.
pub(super) struct One<'a, S: Simd, F> {
    simd: S,
    filter: F,
    blocks: &'a [Block],
    test: TriangleTest,
    shear: Shear,
    pub hit: Option<TriangleHit>,
}

impl<'a, S: Lanes, F: Filter> One<'a, S, F> {
    #[inline(always)]
    pub fn new(simd: S, query: Query<'a, F>, ray: &Ray, slabs: &Slabs) -> Self {
        Self {
            simd,
            filter: query.filter,
            blocks: &query.tree.blocks,
            test: query.tree.test,
            shear: Shear::of(ray, slabs.exact_inverse, slabs.signs),
            hit: None,
        }
    }
}

impl<S: Lanes, F: Filter> One<'_, S, F> {
    /// Lanes of the block that the ray may hit.
    #[inline(always)]
    fn candidates(&self, ray: &Ray, block: &Block, count: usize) -> u32 {
        let lines = Lines::of_one(self.simd, &self.shear, ray.t_min, ray.t_max);
        lines.candidates(self.simd, &block.corners(self.simd, self.shear.axes), (1 << count) - 1).0
    }
}

impl<S: Lanes, F: Filter> Leaf for One<'_, S, F> {
    #[inline(always)]
    fn closest(&mut self, number: usize, ray: &mut Ray, items: Range<u32>) {
        let block = &self.blocks[items.start as usize];
        for lane in Bits(self.candidates(ray, block, items.len())) {
            if let Some(hit) = block.hit(self.test, &self.shear, ray, lane)
                && hit.is_before(&self.hit)
                && self.filter.accepts(number, &hit)
            {
                self.hit = Some(hit);
                ray.t_max = hit.t;
            }
        }
    }

    #[inline(always)]
    fn any(&mut self, number: usize, ray: &Ray, items: Range<u32>) -> bool {
        let block = &self.blocks[items.start as usize];
        for lane in Bits(self.candidates(ray, block, items.len())) {
            let hit = block.hit(self.test, &self.shear, ray, lane);
            if hit.is_some_and(|hit| self.filter.accepts(number, &hit)) {
                return true;
            }
        }
        false
    }
}
