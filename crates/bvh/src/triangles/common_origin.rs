//! Common-origin packets, such as a pinhole camera's rays: work that the rays share is done once
//! per leaf (Wald, Slusallek, Benthin, Wagner 2001, "Interactive Rendering with Coherent Ray
//! Tracing", section 4).
//!
//! All rays start at the frame's origin, and z is the largest component of their directions. After
//! a shear along the central direction, a vertex `c` lies at `(cx, cy, cz)`; for a ray whose shear
//! differs by `(dx, dy)` it lies at `(cx - dx cz, cy - dy cz)`. The edge function of the watertight
//! test is then affine in that difference: for the edge from `b` to `c`
//!
//! ```text
//! e(dx, dy) = (cx by - cy bx) + dx (cy bz - cz by) + dy (cz bx - cx bz) = e + dx p + dy q
//! ```
//!
//! `e`, `p` and `q` are computed for eight triangles at once. Testing a packet's rays then takes
//! two multiplications per edge.
//!
//! The test only rejects; the few triangles that pass are tested again exactly. Let `u` be half an
//! ulp of 1, `m` the largest depth of the triangle and `r` the largest distance of its vertices
//! from any ray's axis. A coordinate here differs from that of the exact test by at most
//! `u (2 m + 3 r)`, so edge functions differ by `4 r` times that, and rounding here adds `20 u r²`,
//! with fused multiply-add or without: together `u (8 m r + 32 r²)`. The margin is four times that.

use super::simd_test::Corner;
use super::{Block, LANES};
use crate::lanes::{Lanes, bits, max};
use crate::packet::PACKETS;
use fearless_simd::f32x8;
use fearless_simd::prelude::*;

/// Error bound of edge functions relative to `r (m + 4 r)`: 32 u.
const MARGIN: f32 = 16.0 * f32::EPSILON;
/// Lower bound of the margin, for products that underflow.
const LEAST_MARGIN: f32 = 64.0 * f32::MIN_POSITIVE;
/// Factor that covers the rounding of half widths.
const ROOM: f32 = 1.0 + 4.0 * f32::EPSILON;

/// Rays of one origin, and the edge functions of the current block.
#[derive(Clone, Copy, Default)]
pub(super) struct CommonOrigin {
    /// Object-space axes that are x, y and z of the frame.
    axes: [usize; 3],
    origin: [f32; 3],
    /// Central direction along x and y for 1 along z.
    center: [f32; 2],
    /// Largest difference of a ray's direction from the central one, along x or y.
    max_offset: f32,
    /// Sign of the rays' directions along z: 1 or -1.
    sign: f32,
    packets: [Offsets; PACKETS],
    edges: Edges,
    /// Number of the block that `edges` belongs to.
    block: u32,
    is_filled: bool,
}

/// Directions of a packet's rays relative to the central one, with their interval.
#[derive(Clone, Copy, Default)]
struct Offsets {
    xy: [[f32; LANES]; 2],
    middle: [f32; 2],
    half_width: [f32; 2],
    /// Smallest magnitude of the reciprocal directions along z.
    least_inverse: f32,
}

/// Edge functions of eight triangles: `e + dx p + dy q`.
#[derive(Clone, Copy, Default)]
struct Edges {
    e: [[f32; LANES]; 3],
    p: [[f32; LANES]; 3],
    q: [[f32; LANES]; 3],
    /// Error bound of the edge functions.
    margin: [f32; LANES],
    /// Depth of the nearest vertex along the rays.
    near: [f32; LANES],
}

/// Rays of a packet in the frame: directions along x and y for 1 along z, and reciprocals along z.
pub(super) type Directions = [[f32; LANES]; 3];

impl CommonOrigin {
    /// Discards rays and edge functions.
    #[inline(always)]
    pub fn clear(&mut self) {
        (self.block, self.is_filled) = (u32::MAX, false);
    }

    #[inline(always)]
    pub fn is_filled(&self) -> bool {
        self.is_filled
    }

    /// Whether the edge functions are those of this block.
    #[inline(always)]
    pub fn has_edges_of(&self, block: u32) -> bool {
        self.block == block
    }

    /// Loads packets of rays with one origin and the same dominant axis, the last of `axes`.
    #[inline(always)]
    pub fn fill<'a, S: Lanes>(
        &mut self,
        simd: S,
        (axes, origin): ([usize; 3], [f32; 3]),
        packets: impl Iterator<Item = &'a Directions> + Clone,
    ) {
        (self.axes, self.origin, self.is_filled) = (axes, origin, true);
        if let Some([x, y, _]) = packets.clone().next() {
            self.center = [x[0], y[0]];
        }
        self.max_offset = 0.0;
        for (offsets, [x, y, inverse]) in self.packets.iter_mut().zip(packets) {
            for (axis, direction) in [x, y].into_iter().enumerate() {
                let offset = simd.load(direction) - self.center[axis];
                let (low, high) = (offset.reduce_min(), offset.reduce_max());
                let middle = (low + high) * 0.5;
                let half_width = max(high - middle, middle - low) * ROOM;
                offsets.xy[axis] = offset.into();
                (offsets.middle[axis], offsets.half_width[axis]) = (middle, half_width);
                self.max_offset = max((middle.abs() + half_width) * ROOM, self.max_offset);
            }
            self.sign = inverse[0].signum();
            offsets.least_inverse = simd.load(inverse).abs().reduce_min();
        }
    }

    /// Computes the edge functions of a block's triangles, unless they are current.
    #[inline(always)]
    pub fn load_block<S: Lanes>(&mut self, simd: S, number: u32, block: &Block) {
        if self.block == number {
            return;
        }
        self.block = number;
        let corners = block.corners(simd, self.axes);
        let (a, b, c) = (self.shear(simd, &corners[0]), self.shear(simd, &corners[1]), self.shear(simd, &corners[2]));
        let edges = &mut self.edges;
        for (edge, (b, c)) in [(&b, &c), (&c, &a), (&a, &b)].into_iter().enumerate() {
            edges.e[edge] = (c[0] * b[1] - c[1] * b[0]).into();
            edges.p[edge] = (c[1] * b[2] - c[2] * b[1]).into();
            edges.q[edge] = (c[2] * b[0] - c[0] * b[2]).into();
        }
        // Bound the rounding error of the edge functions.
        let (mut depth, mut distance) = (simd.splat(0.0), simd.splat(0.0));
        for [x, y, z] in [a, b, c] {
            distance = simd.most(simd.most(x.abs(), y.abs()), distance);
            depth = simd.most(z.abs(), depth);
        }
        let distance = distance + depth * self.max_offset;
        edges.margin = (distance * (depth + distance * 4.0) * MARGIN + LEAST_MARGIN).into();
        let [a, b, c] = [a[2] * self.sign, b[2] * self.sign, c[2] * self.sign];
        edges.near = simd.least(a, simd.least(b, c)).into();
    }

    /// One vertex of eight triangles in the frame, sheared along the central direction.
    #[inline(always)]
    fn shear<S: Lanes>(&self, simd: S, corner: &Corner<S>) -> Corner<S> {
        let [x, y, z] = [corner[0] - self.origin[0], corner[1] - self.origin[1], corner[2] - self.origin[2]];
        let [slope_x, slope_y] = self.center.map(
            #[inline(always)]
            |slope| -slope,
        );
        [z.mul_add(simd.splat(slope_x), x), z.mul_add(simd.splat(slope_y), y), z]
    }

    /// Bit mask of the block's triangles that a ray of the packet may hit before `t_max`, the
    /// largest of its rays.
    #[inline(always)]
    pub fn triangles<S: Lanes>(&self, simd: S, packet: usize, t_max: f32) -> u32 {
        let (Offsets { middle, half_width, least_inverse, .. }, edges) = (&self.packets[packet], &self.edges);
        let margin = simd.load(&edges.margin);
        let (mut least, mut most) = (simd.splat(f32::INFINITY), simd.splat(f32::NEG_INFINITY));
        for edge in 0..3 {
            let (p, q) = (simd.load(&edges.p[edge]), simd.load(&edges.q[edge]));
            let middle = affine(simd.load(&edges.e[edge]), (p, simd.splat(middle[0])), (q, simd.splat(middle[1])));
            let range = affine(margin, (p.abs(), simd.splat(half_width[0])), (q.abs(), simd.splat(half_width[1])));
            // Keep the edge that all rays pass farthest on either side.
            least = simd.least(middle + range, least);
            most = simd.most(middle - range, most);
        }
        let misses = least.simd_lt(0.0) & most.simd_gt(0.0);
        let is_behind = (simd.load(&edges.near) * *least_inverse).simd_gt(t_max);
        !bits(misses | is_behind) & 0xff
    }

    /// Bit mask of a packet's rays that may hit the triangle in a lane of the block.
    #[inline(always)]
    pub fn rays<S: Lanes>(&self, simd: S, packet: usize, lane: usize) -> u32 {
        let [x, y] = &self.packets[packet].xy;
        let (x, y, lane) = (simd.load(x), simd.load(y), lane & (LANES - 1));
        let Edges { e, p, q, margin, .. } = &self.edges;
        let first = affine(simd.splat(e[0][lane]), (x, simd.splat(p[0][lane])), (y, simd.splat(q[0][lane])));
        let second = affine(simd.splat(e[1][lane]), (x, simd.splat(p[1][lane])), (y, simd.splat(q[1][lane])));
        let third = affine(simd.splat(e[2][lane]), (x, simd.splat(p[2][lane])), (y, simd.splat(q[2][lane])));
        let least = simd.least(first, simd.least(second, third));
        let most = simd.most(first, simd.most(second, third));
        !bits(least.simd_lt(-margin[lane]) & most.simd_gt(margin[lane])) & 0xff
    }
}

/// `e + p x + q y`.
#[inline(always)]
fn affine<S: Lanes>(e: f32x8<S>, (p, x): (f32x8<S>, f32x8<S>), (q, y): (f32x8<S>, f32x8<S>)) -> f32x8<S> {
    q.mul_add(y, p.mul_add(x, e))
}
