//! Eight rays at the leaves: one triangle at a time, or eight triangles for each ray when few rays are left.

use super::filter::Filter;
use super::meet::{Lines, settle, settle_fast, splat};
use super::query::Query;
use super::{Block, LANES, TriangleHit};
use crate::Leaf;
use crate::lanes::{Bits, Lanes, bits, min};
use crate::packet::{GROUP, Group, PACKET};
use crate::ray_lanes::RayLanes;
use crate::slabs::Bundle;
use crate::triangle::{FARTHEST, Shear, TriangleTest};
use fearless_simd::prelude::*;
use juggler_math::Ray;
use std::ops::Range;

/// Visitor for a group of packets, used again for the next group.
pub(super) struct Many<'a, S: Simd, F> {
    simd: S,
    filter: F,
    /// Number of the group's first ray.
    first: usize,
    blocks: &'a [Block],
    test: TriangleTest,
    packets: [Packet; GROUP / PACKET],
    pub hits: [Option<TriangleHit>; GROUP],
}

/// Rays that are longest along the same axis.
#[derive(Clone, Copy, Default)]
struct Packet {
    axes: [usize; 3],
    side: [usize; 3],
    origin: [[f32; LANES]; 3],
    factors: [[f32; LANES]; 3],
    inverse: [[f32; LANES]; 3],
    t_min: [f32; LANES],
    t_max: [f32; LANES],
    bundle: Bundle,
}

impl<'a, S: Lanes, F: Filter> Many<'a, S, F> {
    pub fn new(simd: S, query: Query<'a, F>) -> Self {
        let packets = [Packet::default(); GROUP / PACKET];
        let Query { tree, filter } = query;
        Self { simd, filter, first: 0, blocks: &tree.blocks, test: tree.test, packets, hits: [None; GROUP] }
    }

    /// Forgets what it has found and turns to other rays; `false` where those of a packet have no longest axis in
    /// common.
    #[inline(always)]
    pub fn fill(&mut self, first: usize, rays: &[Ray], group: &Group) -> bool {
        self.first = first;
        self.hits = [None; GROUP];
        for ((packet, rays), lanes) in self.packets.iter_mut().zip(rays.chunks(PACKET)).zip(group.packets()) {
            if !packet.fill(self.simd, rays, lanes) {
                return false;
            }
        }
        true
    }
}

impl Packet {
    #[inline(always)]
    fn fill<S: Lanes>(&mut self, simd: S, rays: &[Ray], lanes: &RayLanes) -> bool {
        let (x, y) = (simd.load(&lanes.direction[0]).abs(), simd.load(&lanes.direction[1]).abs());
        let z = simd.load(&lanes.direction[2]).abs();
        let first = bits(x.simd_ge(y) & x.simd_ge(z));
        let second = bits(y.simd_ge(z)) & !first;
        self.axes = match (first, second) {
            (0xff, 0) => [1, 2, 0],
            (0, 0xff) => [2, 0, 1],
            (0, 0) => [0, 1, 2],
            _ => return false,
        };
        let depth = simd.load(&lanes.inverse[self.axes[2]]);
        self.t_min = lanes.t_min;
        self.bundle = lanes.bundle;
        for (t_max, ray) in self.t_max.iter_mut().zip(rays) {
            *t_max = min(ray.t_max, FARTHEST);
        }
        for k in 0..3 {
            let axis = self.axes[k];
            self.side[k] = (lanes.signs >> axis) as usize & 1;
            self.origin[k] = lanes.origin[axis];
            self.inverse[k] = lanes.inverse[axis];
            self.factors[k] = if k < 2 { (simd.load(&lanes.direction[axis]) * depth).into() } else { depth.into() };
        }
        true
    }

    /// All rays.
    #[inline(always)]
    fn lines<S: Lanes>(&self, simd: S) -> Lines<S> {
        let [x, y, z] = &self.origin;
        let [f, g, h] = &self.factors;
        Lines {
            origin: [simd.load(x), simd.load(y), simd.load(z)],
            factors: [simd.load(f), simd.load(g), simd.load(h)],
            t_min: simd.load(&self.t_min),
            t_max: simd.load(&self.t_max),
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

    /// Active rays that hit the triangle in a lane of the block, and where.
    #[inline(always)]
    fn rays_at<S: Lanes>(
        &self,
        simd: S,
        test: TriangleTest,
        block: &Block,
        (number, active): (usize, u32),
    ) -> (u32, [[f32; LANES]; 3]) {
        let corners = block.permuted(number, self.axes);
        let [a, b, c] = corners;
        let lines = self.lines(simd);
        let splats = [splat(simd, a), splat(simd, b), splat(simd, c)];
        let (candidates, points) = lines.candidates(simd, &splats, active);
        if candidates == 0 {
            return (0, [[0.0; LANES]; 3]);
        }
        let [t, u, v] = match test {
            TriangleTest::Watertight => settle(points),
            TriangleTest::Fast => settle_fast(simd, points),
        };
        let found = simd.load(&t);
        let mut clamped = found;
        for axis in 0..3 {
            let near = simd.splat(Shear::near(&corners, axis, self.side[axis]));
            let enter = (near - lines.origin[axis]) * simd.load(&self.inverse[axis]);
            clamped = simd.most(enter, clamped);
        }
        let in_range = found.simd_le(lines.t_max) & lines.t_min.simd_le(clamped) & clamped.simd_le(lines.t_max);
        (candidates & bits(in_range), [clamped.into(), u, v])
    }
}

impl<S: Lanes, F: Filter> Many<'_, S, F> {
    #[inline(always)]
    fn keep(&mut self, lane: usize, hit: TriangleHit, ray: &mut Ray) {
        if hit.is_before(&self.hits[lane]) && self.filter.accepts(self.first + lane, &hit) {
            self.hits[lane] = Some(hit);
            ray.t_max = hit.t;
            self.packets[lane / LANES].t_max[lane % LANES] = hit.t;
        }
    }

    /// Triangles of a block that a packet may meet.
    #[inline(always)]
    fn candidates(&self, block: &Block, first: usize, count: usize) -> u32 {
        block.test_bundle(self.simd, &self.packets[first / LANES].bundle) & ((1 << count) - 1)
    }

    /// One ray, and the triangles of a block that it may hit.
    #[inline(always)]
    fn alone(&self, lane: usize, ray: &Ray, block: &Block, count: usize) -> (Shear, u32) {
        let shear = self.packets[lane / LANES].shear(lane % LANES);
        let lines = Lines::of_one(self.simd, &shear, ray.t_min, ray.t_max);
        let corners = block.corners(self.simd, shear.axes);
        (shear, lines.candidates(self.simd, &corners, (1 << count) - 1).0)
    }
}

impl<S: Lanes, F: Filter> Leaf for Many<'_, S, F> {
    #[inline(always)]
    fn closest(&mut self, lane: usize, ray: &mut Ray, items: Range<u32>) {
        let blocks = self.blocks;
        let block = &blocks[items.start as usize];
        let (shear, candidates) = self.alone(lane, ray, block, items.len());
        for number in Bits(candidates) {
            if let Some(hit) = block.hit(self.test, &shear, ray, number) {
                self.keep(lane, hit, ray);
            }
        }
    }

    #[inline(always)]
    fn any(&mut self, lane: usize, ray: &Ray, items: Range<u32>) -> bool {
        let block = &self.blocks[items.start as usize];
        let (shear, candidates) = self.alone(lane, ray, block, items.len());
        for number in Bits(candidates) {
            let hit = block.hit(self.test, &shear, ray, number);
            if hit.is_some_and(|hit| self.filter.accepts(self.first + lane, &hit)) {
                return true;
            }
        }
        false
    }

    #[inline(always)]
    fn closest_many(&mut self, first: usize, active: u32, rays: &mut [Ray], items: Range<u32>) {
        let blocks = self.blocks;
        let block = &blocks[items.start as usize];
        for number in Bits(self.candidates(block, first, items.len())) {
            let packet = &self.packets[first / LANES];
            let (mask, [t, u, v]) = packet.rays_at(self.simd, self.test, block, (number, active));
            for lane in Bits(mask) {
                let hit = TriangleHit { t: t[lane], u: u[lane], v: v[lane], index: block.index[number] };
                self.keep(first + lane, hit, &mut rays[lane]);
            }
        }
    }

    #[inline(always)]
    fn any_many(&mut self, first: usize, active: u32, _rays: &[Ray], items: Range<u32>) -> u32 {
        let block = &self.blocks[items.start as usize];
        let packet = &self.packets[first / LANES];
        let mut found = 0;
        for number in Bits(self.candidates(block, first, items.len())) {
            let (mask, [t, u, v]) = packet.rays_at(self.simd, self.test, block, (number, active & !found));
            if F::ALL {
                found |= mask;
                continue;
            }
            for lane in Bits(mask) {
                let hit = TriangleHit { t: t[lane], u: u[lane], v: v[lane], index: block.index[number] };
                found |= u32::from(self.filter.accepts(self.first + first + lane, &hit)) << lane;
            }
        }
        found
    }
}
