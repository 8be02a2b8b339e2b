//! Eight rays at the leaves: one triangle at a time, or eight triangles for each ray when few rays are left.

use super::meet::{Lines, splat};
use super::{Block, LANES, TriangleHit};
use crate::Leaf;
use crate::lanes::{Bits, Lanes, bits};
use crate::ray_lanes::RayLanes;
use crate::slabs::Bundle;
use crate::triangle::Shear;
use fearless_simd::prelude::*;
use juggler_math::Ray;
use std::ops::Range;

/// Visitor for a packet whose rays are longest along the same axis.
pub(super) struct Many<'a, S: Simd> {
    simd: S,
    blocks: &'a [Block],
    axes: [usize; 3],
    side: [usize; 3],
    origin: [[f32; LANES]; 3],
    factors: [[f32; LANES]; 3],
    inverse: [[f32; LANES]; 3],
    t_min: [f32; LANES],
    t_max: [f32; LANES],
    bundle: Bundle,
    hits: &'a mut [Option<TriangleHit>],
}

impl<'a, S: Lanes> Many<'a, S> {
    /// `None` where the rays have no longest axis in common.
    #[inline(always)]
    pub fn new(
        simd: S,
        blocks: &'a [Block],
        rays: &[Ray],
        lanes: &RayLanes,
        bundle: &Bundle,
        hits: &'a mut [Option<TriangleHit>],
    ) -> Option<Self> {
        let size = |axis: usize| simd.load(&lanes.direction[axis]).abs();
        let (x, y, z) = (size(0), size(1), size(2));
        let present = (1u32 << rays.len()) - 1;
        let first = bits(x.simd_ge(y) & x.simd_ge(z)) & present;
        let second = bits(y.simd_ge(z)) & present & !first;
        let axes = match present {
            all if first == all => [1, 2, 0],
            all if second == all => [2, 0, 1],
            _ if first | second == 0 => [0, 1, 2],
            _ => return None,
        };
        let [x, y, z] = axes;
        let depth = simd.load(&lanes.inverse[z]);
        let mut t_max = [f32::NEG_INFINITY; LANES];
        for (t_max, ray) in t_max.iter_mut().zip(rays) {
            *t_max = ray.t_max;
        }
        let side = |axis: usize| (lanes.signs >> axis) as usize & 1;
        Some(Self {
            simd,
            blocks,
            axes,
            side: [side(x), side(y), side(z)],
            origin: [lanes.origin[x], lanes.origin[y], lanes.origin[z]],
            factors: [
                (simd.load(&lanes.direction[x]) * depth).into(),
                (simd.load(&lanes.direction[y]) * depth).into(),
                depth.into(),
            ],
            inverse: [lanes.inverse[x], lanes.inverse[y], lanes.inverse[z]],
            t_min: lanes.t_min,
            t_max,
            bundle: *bundle,
            hits,
        })
    }

    /// All rays.
    #[inline(always)]
    fn lines(&self) -> Lines<S> {
        let load = |numbers: &[[f32; LANES]; 3]| {
            [self.simd.load(&numbers[0]), self.simd.load(&numbers[1]), self.simd.load(&numbers[2])]
        };
        Lines {
            origin: load(&self.origin),
            factors: load(&self.factors),
            t_min: self.simd.load(&self.t_min),
            t_max: self.simd.load(&self.t_max),
        }
    }

    /// One of the rays.
    #[inline(always)]
    fn shear(&self, lane: usize) -> Shear {
        let lane = lane & (LANES - 1);
        let pick = |numbers: &[[f32; LANES]; 3]| [numbers[0][lane], numbers[1][lane], numbers[2][lane]];
        Shear {
            axes: self.axes,
            origin: pick(&self.origin),
            factors: pick(&self.factors),
            inverse: pick(&self.inverse),
            side: self.side,
        }
    }

    #[inline(always)]
    fn keep(&mut self, lane: usize, hit: TriangleHit, ray: &mut Ray) {
        if hit.is_before(&self.hits[lane]) {
            self.hits[lane] = Some(hit);
            ray.t_max = hit.t;
            self.t_max[lane & (LANES - 1)] = hit.t;
        }
    }

    /// Active rays that may hit the triangle in a lane of the block.
    #[inline(always)]
    fn rays_at(&self, block: &Block, number: usize, active: u32) -> u32 {
        let [a, b, c] = block.permuted(number, self.axes);
        self.lines().candidates(self.simd, [splat(self.simd, a), splat(self.simd, b), splat(self.simd, c)], active)
    }

    /// Triangles of a block that the packet may meet.
    #[inline(always)]
    fn candidates(&self, block: &Block, count: usize) -> u32 {
        block.test_bundle(self.simd, &self.bundle) & ((1 << count) - 1)
    }
}

impl<S: Lanes> Leaf for Many<'_, S> {
    #[inline(always)]
    fn closest(&mut self, lane: usize, ray: &mut Ray, items: Range<u32>) {
        let (blocks, shear) = (self.blocks, self.shear(lane));
        let block = &blocks[items.start as usize];
        let lines = Lines::of_one(self.simd, &shear, ray.t_min, ray.t_max);
        let candidates = lines.candidates(self.simd, block.corners(self.simd, self.axes), (1 << items.len()) - 1);
        for number in Bits(candidates) {
            if let Some(hit) = block.hit(&shear, ray.t_min, ray.t_max, number) {
                self.keep(lane, hit, ray);
            }
        }
    }

    #[inline(always)]
    fn any(&mut self, lane: usize, ray: &Ray, items: Range<u32>) -> bool {
        let (block, shear) = (&self.blocks[items.start as usize], self.shear(lane));
        let lines = Lines::of_one(self.simd, &shear, ray.t_min, ray.t_max);
        let candidates = lines.candidates(self.simd, block.corners(self.simd, self.axes), (1 << items.len()) - 1);
        for number in Bits(candidates) {
            if block.hit(&shear, ray.t_min, ray.t_max, number).is_some() {
                return true;
            }
        }
        false
    }

    #[inline(always)]
    fn closest_many(&mut self, _first: usize, active: u32, rays: &mut [Ray], items: Range<u32>) {
        let blocks = self.blocks;
        let block = &blocks[items.start as usize];
        for number in Bits(self.candidates(block, items.len())) {
            for lane in Bits(self.rays_at(block, number, active)) {
                if let Some(hit) = block.hit(&self.shear(lane), rays[lane].t_min, rays[lane].t_max, number) {
                    self.keep(lane, hit, &mut rays[lane]);
                }
            }
        }
    }

    #[inline(always)]
    fn any_many(&mut self, _first: usize, active: u32, rays: &[Ray], items: Range<u32>) -> u32 {
        let block = &self.blocks[items.start as usize];
        let mut found = 0;
        for number in Bits(self.candidates(block, items.len())) {
            for lane in Bits(self.rays_at(block, number, active & !found)) {
                let hit = block.hit(&self.shear(lane), rays[lane].t_min, rays[lane].t_max, number);
                found |= u32::from(hit.is_some()) << lane;
            }
        }
        found
    }
}
