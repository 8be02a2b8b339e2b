//! Leaf visitor for packets: each triangle against eight rays.

use super::common_origin::CommonOrigin;
use super::filter::Filter;
use super::query::Query;
use super::simd_test::{RayFrames, intersect_double, intersect_single, splat};
use super::{Block, LANES, TriangleHit};
use crate::Leaf;
use crate::lanes::{Bits, Lanes, bits};
use crate::node::{Bounds, intersect_bundle};
use crate::packet::{Group, PACKET, PACKETS};
use crate::ray_lanes::RayLanes;
use crate::slabs::Bundle;
use crate::triangle::{Shear, TriangleTest};
use fearless_simd::prelude::*;
use fearless_simd::{mask32x8, u32x8};
use juggler_math::Ray;
use std::ops::Range;

/// Number of candidate triangles up to which edge functions are not worth their setup.
const MAX_WITHOUT_EDGES: u32 = 4;

/// Leaf visitor for a group of packets, reused for the next group.
pub(super) struct PacketVisitor<'a, S: Simd, F> {
    simd: S,
    filter: F,
    /// Index of the group's first ray.
    first: usize,
    blocks: &'a [Block],
    test: TriangleTest,
    packets: [Packet; PACKETS],
    /// Number of packets that hold rays.
    count: usize,
    hits: [PacketHits; PACKETS],
    /// Boxes of the triangles of block `boxes_of`.
    boxes: Bounds,
    boxes_of: u32,
    /// Origin of all rays, if it is common and they share a dominant axis.
    origin: Option<[f32; 3]>,
    /// Filled when a leaf has several candidate triangles for a packet.
    common_origin: CommonOrigin,
}

/// A packet of rays with the same dominant axis.
#[derive(Clone, Copy, Default)]
struct Packet {
    axes: [usize; 3],
    side: [usize; 3],
    origin: [[f32; LANES]; 3],
    factors: [[f32; LANES]; 3],
    inverse: [[f32; LANES]; 3],
    t_min: [f32; LANES],
    t_max: [f32; LANES],
    /// Maximum of `t_max`.
    farthest: f32,
    bundle: Bundle,
}

impl<'a, S: Lanes, F: Filter> PacketVisitor<'a, S, F> {
    pub fn new(simd: S, query: Query<'a, F>) -> Self {
        let packets = [Packet::default(); PACKETS];
        let Query { tree, filter } = query;
        Self {
            simd,
            filter,
            first: 0,
            blocks: &tree.blocks,
            test: tree.test,
            packets,
            count: 0,
            hits: [PacketHits::NONE; PACKETS],
            boxes: [[[0.0; LANES]; 2]; 3],
            boxes_of: u32::MAX,
            origin: None,
            common_origin: CommonOrigin::default(),
        }
    }

    /// Discards the hits and loads the rays of a group; `false` if the rays of a packet do not
    /// share a dominant axis.
    #[inline(always)]
    pub fn fill(&mut self, first: usize, group: &Group) -> bool {
        self.first = first;
        self.hits = [PacketHits::NONE; PACKETS];
        for (packet, lanes) in self.packets.iter_mut().zip(group.packets()) {
            if !packet.fill(self.simd, lanes) {
                return false;
            }
        }
        self.count = group.packets().len();
        self.common_origin.clear();
        let axes = self.packets[0].axes;
        let packets = &self.packets[..group.packets().len()];
        self.origin = group.common_origin().filter(|_| packets.iter().all(|packet| packet.axes == axes));
        true
    }
}

impl Packet {
    #[inline(always)]
    fn fill<S: Lanes>(&mut self, simd: S, lanes: &RayLanes) -> bool {
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
        self.t_max = lanes.ray_t_max;
        self.farthest = lanes.bundle.t_max;
        for k in 0..3 {
            let axis = self.axes[k];
            self.side[k] = (lanes.signs >> axis) as usize & 1;
            self.origin[k] = lanes.origin[axis];
            self.inverse[k] = lanes.inverse[axis];
            self.factors[k] = if k < 2 { (simd.load(&lanes.direction[axis]) * depth).into() } else { depth.into() };
        }
        true
    }

    /// All rays of the packet.
    #[inline(always)]
    fn frames<S: Lanes>(&self, simd: S) -> RayFrames<S> {
        let [x, y, z] = &self.origin;
        let [f, g, h] = &self.factors;
        RayFrames {
            origin: [simd.load(x), simd.load(y), simd.load(z)],
            factors: [simd.load(f), simd.load(g), simd.load(h)],
            t_min: simd.load(&self.t_min),
            t_max: simd.load(&self.t_max),
        }
    }

    /// The ray in a lane.
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

    /// Bit mask of the active rays that hit the triangle in a lane of the block, with `(t, u, v)`
    /// of the hits.
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
        let frames = self.frames(simd);
        let splats = [splat(simd, a), splat(simd, b), splat(simd, c)];
        let (candidates, points) = frames.candidates(simd, &splats, active);
        if candidates == 0 {
            return (0, [[0.0; LANES]; 3]);
        }
        let [t, u, v] = match test {
            TriangleTest::Watertight => intersect_double(simd, points, candidates),
            TriangleTest::Fast => intersect_single(simd, points),
        };
        let found = simd.load(&t);
        if test == TriangleTest::Fast {
            let in_range = frames.t_min.simd_le(found) & found.simd_le(frames.t_max);
            return (candidates & bits(in_range), [t, u, v]);
        }
        let mut clamped = found;
        for axis in 0..3 {
            let near = simd.splat(Shear::near(&corners, axis, self.side[axis]));
            let enter = (near - frames.origin[axis]) * simd.load(&self.inverse[axis]);
            clamped = simd.most(enter, clamped);
        }
        let in_range = found.simd_le(frames.t_max) & frames.t_min.simd_le(clamped) & clamped.simd_le(frames.t_max);
        (candidates & bits(in_range), [clamped.into(), u, v])
    }
}

/// Closest hits of a packet's rays.
#[derive(Clone, Copy)]
struct PacketHits {
    t: [f32; LANES],
    u: [f32; LANES],
    v: [f32; LANES],
    /// Triangle index; `u32::MAX` for no hit.
    index: [u32; LANES],
}

impl PacketHits {
    const NONE: Self = Self { t: [f32::INFINITY; LANES], u: [0.0; LANES], v: [0.0; LANES], index: [u32::MAX; LANES] };

    #[inline(always)]
    fn get(&self, lane: usize) -> Option<TriangleHit> {
        let hit = TriangleHit { t: self.t[lane], u: self.u[lane], v: self.v[lane], index: self.index[lane] };
        (hit.index != u32::MAX).then_some(hit)
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, hit: TriangleHit) {
        (self.t[lane], self.u[lane], self.v[lane], self.index[lane]) = (hit.t, hit.u, hit.v, hit.index);
    }

    /// Keeps the hits on one triangle of the rays in `mask`, where they are closer than the present
    /// ones; returns the lanes.
    #[inline(always)]
    fn keep<S: Lanes>(&mut self, simd: S, mask: u32, [t, u, v]: &[[f32; LANES]; 3], index: u32) -> mask32x8<S> {
        let (new_t, old_t) = (simd.load(t), simd.load(&self.t));
        let (new, old): (u32x8<S>, u32x8<S>) = (u32x8::splat(simd, index), self.index.simd_into(simd));
        let is_closer = new_t.simd_lt(old_t) | (new_t.simd_eq(old_t) & new.simd_lt(old));
        let lane: u32x8<S> = [1, 2, 4, 8, 16, 32, 64, 128].simd_into(simd);
        let in_mask = !(lane & u32x8::splat(simd, mask)).simd_eq(0);
        let kept = is_closer & in_mask;
        self.t = kept.select(new_t, old_t).into();
        self.u = kept.select(simd.load(u), simd.load(&self.u)).into();
        self.v = kept.select(simd.load(v), simd.load(&self.v)).into();
        self.index = kept.select(new, old).into();
        kept
    }
}

impl<S: Lanes, F: Filter> PacketVisitor<'_, S, F> {
    /// Writes the hits and shortens the rays to them.
    #[inline(always)]
    pub fn write_hits(&self, rays: &mut [Ray], hits: &mut [Option<TriangleHit>]) {
        let packets = rays.chunks_mut(PACKET).zip(hits.chunks_mut(PACKET));
        for (found, (rays, hits)) in self.hits.iter().zip(packets) {
            for (lane, (ray, hit)) in rays.iter_mut().zip(hits).enumerate() {
                *hit = found.get(lane);
                if let Some(hit) = hit {
                    ray.t_max = hit.t;
                }
            }
        }
    }

    /// Keeps the hits on one triangle of a packet's rays in `mask`, where they are closer and the
    /// filter accepts them.
    #[inline(always)]
    fn keep(&mut self, number: usize, mask: u32, [t, u, v]: &[[f32; LANES]; 3], index: u32) {
        let (simd, packet, hits) = (self.simd, &mut self.packets[number], &mut self.hits[number]);
        if F::ALL {
            let kept = hits.keep(simd, mask, &[*t, *u, *v], index);
            let t_max = kept.select(simd.load(t), simd.load(&packet.t_max));
            (packet.t_max, packet.farthest) = (t_max.into(), t_max.reduce_max());
            return;
        }
        for lane in Bits(mask) {
            let hit = TriangleHit { t: t[lane], u: u[lane], v: v[lane], index };
            let ray = self.first + number * LANES + lane;
            if hit.is_before(&hits.get(lane)) && self.filter.accepts(ray, &hit) {
                hits.set(lane, hit);
                packet.t_max[lane] = hit.t;
            }
        }
        packet.farthest = simd.load(&packet.t_max).reduce_max();
    }

    /// Bit mask of a leaf's triangles that a packet may hit. Computes the triangles' boxes for the
    /// group's first packet.
    #[inline(always)]
    fn candidates(&mut self, first: usize, items: &Range<u32>) -> u32 {
        if self.boxes_of != items.start {
            self.boxes = self.blocks[items.start as usize].boxes(self.simd);
            self.boxes_of = items.start;
        }
        let packet = &self.packets[first / LANES];
        let (mask, _) = intersect_bundle(self.simd, &self.boxes, &packet.bundle);
        let mask = mask & ((1 << items.len()) - 1);
        match self.origin {
            Some(origin) if mask.count_ones() > MAX_WITHOUT_EDGES || self.common_origin.has_edges_of(items.start) => {
                self.narrowed(origin, items.start, first / LANES, mask)
            }
            _ => mask,
        }
    }

    /// Removes triangles from `mask` by their edge functions. Not inlined: most leaves have few
    /// candidate triangles.
    #[inline(never)]
    fn narrowed(&mut self, origin: [f32; 3], number: u32, packet: usize, mask: u32) -> u32 {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || {
                if !self.common_origin.is_filled() {
                    let axes = self.packets[0].axes;
                    let origin = axes.map(|axis| origin[axis]);
                    let packets = self.packets[..self.count].iter().map(|packet| &packet.factors);
                    self.common_origin.fill(simd, (axes, origin), packets);
                }
                self.common_origin.load_block(simd, number, &self.blocks[number as usize]);
                mask & self.common_origin.triangles(simd, packet, self.packets[packet].farthest)
            },
        )
    }
}

impl<S: Lanes, F: Filter> Leaf for PacketVisitor<'_, S, F> {
    #[inline(always)]
    fn closest(&mut self, lane: usize, ray: &mut Ray, items: Range<u32>) {
        self.closest_many(lane - lane % LANES, 1 << (lane % LANES), &mut [], items);
        ray.t_max = self.packets[lane / LANES].t_max[lane % LANES];
    }

    #[inline(always)]
    fn any(&mut self, lane: usize, ray: &Ray, items: Range<u32>) -> bool {
        let block = &self.blocks[items.start as usize];
        let shear = self.packets[lane / LANES].shear(lane % LANES);
        block.hits(
            self.simd,
            (self.test, &shear, ray),
            items.len(),
            #[inline(always)]
            |hit| self.filter.accepts(self.first + lane, &hit),
        )
    }

    #[inline(always)]
    fn packet_t_max(&self, first: usize) -> Option<&[f32; PACKET]> {
        Some(&self.packets[first / LANES].t_max)
    }

    #[inline(always)]
    fn closest_many(&mut self, first: usize, active: u32, _rays: &mut [Ray], items: Range<u32>) -> bool {
        let blocks = self.blocks;
        let block = &blocks[items.start as usize];
        let mut is_hit = false;
        for number in Bits(self.candidates(first, &items)) {
            let mut active = active;
            if self.common_origin.has_edges_of(items.start) {
                active &= self.common_origin.rays(self.simd, first / LANES, number);
                if active == 0 {
                    continue;
                }
            }
            let packet = &self.packets[first / LANES];
            let (mask, hits) = packet.rays_at(self.simd, self.test, block, (number, active));
            if mask != 0 {
                self.keep(first / LANES, mask, &hits, block.index[number]);
                is_hit = true;
            }
        }
        is_hit
    }

    #[inline(always)]
    fn any_many(&mut self, first: usize, active: u32, _rays: &[Ray], items: Range<u32>) -> u32 {
        let blocks = self.blocks;
        let block = &blocks[items.start as usize];
        let mut found = 0;
        for number in Bits(self.candidates(first, &items)) {
            if active & !found == 0 {
                break;
            }
            let packet = &self.packets[first / LANES];
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
