//! One ray at the leaves: eight triangles at once.

use super::meet::Lines;
use super::{Block, TriangleHit};
use crate::Leaf;
use crate::lanes::{Bits, Lanes};
use crate::slabs::Slabs;
use crate::triangle::Shear;
use fearless_simd::prelude::*;
use juggler_math::Ray;
use std::ops::Range;

/// Visitor for one ray.
pub(super) struct One<'a, S: Simd> {
    simd: S,
    blocks: &'a [Block],
    shear: Shear,
    pub hit: Option<TriangleHit>,
}

impl<'a, S: Lanes> One<'a, S> {
    #[inline(always)]
    pub fn new(simd: S, blocks: &'a [Block], ray: &Ray, slabs: &Slabs) -> Self {
        Self { simd, blocks, shear: Shear::of(ray, slabs.exact_inverse, slabs.signs), hit: None }
    }
}

impl<S: Lanes> Leaf for One<'_, S> {
    #[inline(always)]
    fn closest(&mut self, _lane: usize, ray: &mut Ray, items: Range<u32>) {
        let block = &self.blocks[items.start as usize];
        let corners = block.corners(self.simd, self.shear.axes);
        let lines = Lines::of_one(self.simd, &self.shear, ray.t_min, ray.t_max);
        let Some(meeting) = lines.meet(self.simd, corners, (1 << items.len()) - 1) else { return };
        for lane in Bits(meeting.mask) {
            let t = self.shear.clamp(meeting.t[lane], block.permuted(lane, self.shear.axes));
            let index = block.index[lane];
            let nearer = t < ray.t_max || t == ray.t_max && self.hit.is_none_or(|best| index < best.index);
            if ray.t_min <= t && nearer {
                self.hit = Some(TriangleHit { t, u: meeting.u[lane], v: meeting.v[lane], index });
                ray.t_max = t;
            }
        }
    }

    #[inline(always)]
    fn prefetch(&self, items: Range<u32>) {
        if let Some(block) = self.blocks.get(items.start as usize) {
            crate::lanes::prefetch(block);
        }
    }

    #[inline(always)]
    fn any(&mut self, _lane: usize, ray: &Ray, items: Range<u32>) -> bool {
        let block = &self.blocks[items.start as usize];
        let corners = block.corners(self.simd, self.shear.axes);
        let lines = Lines::of_one(self.simd, &self.shear, ray.t_min, ray.t_max);
        let Some(meeting) = lines.meet(self.simd, corners, (1 << items.len()) - 1) else { return false };
        Bits(meeting.mask).any(|lane| {
            let t = self.shear.clamp(meeting.t[lane], block.permuted(lane, self.shear.axes));
            ray.t_min <= t && t <= ray.t_max
        })
    }
}
