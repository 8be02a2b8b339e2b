//! Eight rays at the leaves: one triangle at a time, or eight triangles for each ray when few rays are left.

use super::meet::Lines;
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
        let best = &mut self.hits[lane];
        if best.is_none_or(|best| hit.t < best.t || hit.t == best.t && hit.index < best.index) {
            *best = Some(hit);
            ray.t_max = hit.t;
            self.t_max[lane & (LANES - 1)] = hit.t;
        }
    }

    /// All active rays and one triangle.
    #[inline(always)]
    fn triangle(&self, block: &Block, number: usize, active: u32) -> (u32, [f32; 8], [f32; 8], [f32; 8]) {
        let corners = block.permuted(number, self.axes);
        let lines = self.lines();
        let splat = |corner: [f32; 3]| super::meet::splat(self.simd, corner);
        let Some(meeting) = lines.meet(self.simd, [splat(corners[0]), splat(corners[1]), splat(corners[2])], active)
        else {
            return (0, [0.0; 8], [0.0; 8], [0.0; 8]);
        };
        let mut t = self.simd.load(&meeting.t);
        for axis in 0..3 {
            let near = Shear::near(&corners, axis, self.side[axis]);
            let enter = (self.simd.splat(near) - lines.origin[axis]) * self.simd.load(&self.inverse[axis]);
            t = self.simd.most(enter, t);
        }
        let mask = meeting.mask & bits(lines.t_min.simd_le(t) & t.simd_le(lines.t_max));
        (mask, t.into(), meeting.u, meeting.v)
    }
}

impl<S: Lanes> Many<'_, S> {
    /// Where one of the rays meets the triangles in `among`.
    #[inline(always)]
    fn alone(&self, lane: usize, ray: &Ray, block: &Block, among: u32, mut hit: impl FnMut(TriangleHit)) {
        let shear = self.shear(lane);
        let lines = Lines::of_one(self.simd, &shear, ray.t_min, ray.t_max);
        let corners = block.corners(self.simd, self.axes);
        let Some(meeting) = lines.meet(self.simd, corners, among) else { return };
        for number in Bits(meeting.mask) {
            let t = shear.clamp(meeting.t[number], block.permuted(number, self.axes));
            if ray.t_min <= t && t <= ray.t_max {
                hit(TriangleHit { t, u: meeting.u[number], v: meeting.v[number], index: block.index[number] });
            }
        }
    }

    #[inline(never)]
    fn closest_alone(&mut self, lane: usize, ray: &mut Ray, block: &Block, among: u32) {
        let mut best = self.hits[lane];
        self.simd.vectorize(
            #[inline(always)]
            || {
                self.alone(
                    lane,
                    ray,
                    block,
                    among,
                    #[inline(always)]
                    |hit| {
                        if best.is_none_or(|best| hit.t < best.t || hit.t == best.t && hit.index < best.index) {
                            best = Some(hit);
                        }
                    },
                );
            },
        );
        if let Some(hit) = best {
            self.hits[lane] = best;
            ray.t_max = hit.t;
            self.t_max[lane & (LANES - 1)] = hit.t;
        }
    }

    #[inline(never)]
    fn any_alone(&self, lane: usize, ray: &Ray, block: &Block, among: u32) -> bool {
        let mut found = false;
        self.simd.vectorize(
            #[inline(always)]
            || {
                self.alone(
                    lane,
                    ray,
                    block,
                    among,
                    #[inline(always)]
                    |_| found = true,
                );
            },
        );
        found
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
        let blocks = self.blocks;
        self.closest_alone(lane, ray, &blocks[items.start as usize], (1 << items.len()) - 1);
    }

    #[inline(always)]
    fn any(&mut self, lane: usize, ray: &Ray, items: Range<u32>) -> bool {
        self.any_alone(lane, ray, &self.blocks[items.start as usize], (1 << items.len()) - 1)
    }

    #[inline(always)]
    fn closest_many(&mut self, _first: usize, active: u32, rays: &mut [Ray], items: Range<u32>) {
        let blocks = self.blocks;
        let block = &blocks[items.start as usize];
        let among = self.candidates(block, items.len());
        if active.count_ones() * 2 <= among.count_ones() {
            for lane in Bits(active) {
                self.closest_alone(lane, &mut rays[lane], block, among);
            }
            return;
        }
        for number in Bits(among) {
            let (mask, t, u, v) = self.triangle(block, number, active);
            for lane in Bits(mask) {
                let hit = TriangleHit { t: t[lane], u: u[lane], v: v[lane], index: block.index[number] };
                self.keep(lane, hit, &mut rays[lane]);
            }
        }
    }

    #[inline(always)]
    fn any_many(&mut self, _first: usize, active: u32, rays: &[Ray], items: Range<u32>) -> u32 {
        let block = &self.blocks[items.start as usize];
        let among = self.candidates(block, items.len());
        let mut found = 0;
        if active.count_ones() * 2 <= among.count_ones() {
            for lane in Bits(active) {
                found |= u32::from(self.any_alone(lane, &rays[lane], block, among)) << lane;
            }
            return found;
        }
        for number in Bits(among) {
            found |= self.triangle(block, number, active & !found).0;
        }
        found
    }
}
