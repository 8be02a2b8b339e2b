//! Rays of one origin at the leaves, such as those of a pinhole camera: what they have in common is computed once per
//! leaf, not once per ray (common-origin packets: Wald, Slusallek, Benthin, Wagner 2001, "Interactive Rendering with
//! Coherent Ray Tracing", section 4).
//!
//! All rays start at the origin of the frame and are longest along its z. Sheared along the center's direction, a corner
//! `c` lies at `(cx, cy, cz)`, and a ray whose shear differs by `(dx, dy)` has it at `(cx - dx cz, cy - dy cz)`. The edge
//! function of the watertight test is then affine in that difference: for the edge from `b` to `c`
//!
//! ```text
//! e(dx, dy) = (cx by - cy bx) + dx (cy bz - cz by) + dy (cz bx - cx bz) = e + dx p + dy q
//! ```
//!
//! So `e`, `p` and `q` are made for eight triangles at once; a packet's rays are tested by two multiplications an edge.
//!
//! The test only refuses: the few triangles that pass are tested anew, exactly. Let `u` be half an ulp of 1, `m` the
//! largest depth of the triangle and `r` the largest distance of its corners from any ray's axis. A coordinate here and
//! in the exact test differ by at most `u (2 m + 3 r)`, so edge functions by `4 r` times that, and rounding here adds
//! `20 u r²`, with fused multiplication or without: together `u (8 m r + 32 r²)`. Four times as much is allowed for.

use super::meet::Corner;
use super::{Block, LANES};
use crate::lanes::{Lanes, bits, max};
use crate::packet::PACKETS;
use fearless_simd::f32x8;
use fearless_simd::prelude::*;

/// What edge functions may be off by, of `r (m + 4 r)`: 32 u.
const MARGIN: f32 = 16.0 * f32::EPSILON;
/// At least so much, for products that underflow.
const LEAST_MARGIN: f32 = 64.0 * f32::MIN_POSITIVE;
/// Room for the rounding of half widths.
const ROOM: f32 = 1.0 + 4.0 * f32::EPSILON;

/// Rays of one origin, and the leaf that they look at.
#[derive(Clone, Copy, Default)]
pub(super) struct CommonOrigin {
    /// The axes that are x, y and z of the frame.
    axes: [usize; 3],
    origin: [f32; 3],
    /// The center's direction along x and y, along z it is 1.
    center: [f32; 2],
    /// Most by which a ray's direction differs from the center's, along x or y.
    reach: f32,
    /// Of the rays' directions along z: 1 or -1.
    sign: f32,
    packets: [Offsets; PACKETS],
    edges: Edges,
    /// Number of the block whose edges these are.
    block: u32,
    is_filled: bool,
}

/// The rays of a packet: by what their directions differ from the center's.
#[derive(Clone, Copy, Default)]
struct Offsets {
    xy: [[f32; LANES]; 2],
    middle: [f32; 2],
    half_width: [f32; 2],
    /// The least inverse of a direction along z, without its sign.
    least_inverse: f32,
}

/// The edge functions of eight triangles: `e + dx p + dy q`.
#[derive(Clone, Copy, Default)]
struct Edges {
    e: [[f32; LANES]; 3],
    p: [[f32; LANES]; 3],
    q: [[f32; LANES]; 3],
    /// What the functions may be off by.
    margin: [f32; LANES],
    /// Depth of the nearest corner, along the rays.
    near: [f32; LANES],
}

/// Rays of a packet in the frame: directions along x and y for 1 along z, and the inverse along z.
pub(super) type Directions = [[f32; LANES]; 3];

impl CommonOrigin {
    /// Forgets the rays.
    #[inline(always)]
    pub fn clear(&mut self) {
        (self.block, self.is_filled) = (u32::MAX, false);
    }

    #[inline(always)]
    pub fn is_filled(&self) -> bool {
        self.is_filled
    }

    /// Whether the edges of this block are made.
    #[inline(always)]
    pub fn looks_at(&self, block: u32) -> bool {
        self.block == block
    }

    /// Turns to other rays: packets of one origin that are longest along the same axis, which is the last of `axes`.
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
        self.reach = 0.0;
        for (offsets, [x, y, inverse]) in self.packets.iter_mut().zip(packets) {
            for (axis, direction) in [x, y].into_iter().enumerate() {
                let offset = simd.load(direction) - self.center[axis];
                let (low, high) = (offset.reduce_min(), offset.reduce_max());
                let middle = (low + high) * 0.5;
                let half_width = max(high - middle, middle - low) * ROOM;
                offsets.xy[axis] = offset.into();
                (offsets.middle[axis], offsets.half_width[axis]) = (middle, half_width);
                self.reach = max((middle.abs() + half_width) * ROOM, self.reach);
            }
            self.sign = inverse[0].signum();
            offsets.least_inverse = simd.load(inverse).abs().reduce_min();
        }
    }

    /// Makes the edges of a block's triangles, unless they are made.
    #[inline(always)]
    pub fn look_at<S: Lanes>(&mut self, simd: S, number: u32, block: &Block) {
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
        // Bound the rounding of edge functions.
        let (mut depth, mut distance) = (simd.splat(0.0), simd.splat(0.0));
        for [x, y, z] in [a, b, c] {
            distance = simd.most(simd.most(x.abs(), y.abs()), distance);
            depth = simd.most(z.abs(), depth);
        }
        let distance = distance + depth * self.reach;
        edges.margin = (distance * (depth + distance * 4.0) * MARGIN + LEAST_MARGIN).into();
        let [a, b, c] = [a[2] * self.sign, b[2] * self.sign, c[2] * self.sign];
        edges.near = simd.least(a, simd.least(b, c)).into();
    }

    /// A corner of eight triangles in the frame, sheared along the center.
    #[inline(always)]
    fn shear<S: Lanes>(&self, simd: S, corner: &Corner<S>) -> Corner<S> {
        let [x, y, z] = [corner[0] - self.origin[0], corner[1] - self.origin[1], corner[2] - self.origin[2]];
        let [slope_x, slope_y] = self.center.map(
            #[inline(always)]
            |slope| -slope,
        );
        [z.mul_add(simd.splat(slope_x), x), z.mul_add(simd.splat(slope_y), y), z]
    }

    /// Triangles of the block (bit per lane) that a ray of a packet may hit before `t_max`, the farthest end of its rays.
    #[inline(always)]
    pub fn triangles<S: Lanes>(&self, simd: S, packet: usize, t_max: f32) -> u32 {
        let (Offsets { middle, half_width, least_inverse, .. }, edges) = (&self.packets[packet], &self.edges);
        let margin = simd.load(&edges.margin);
        let (mut least, mut most) = (simd.splat(f32::INFINITY), simd.splat(f32::NEG_INFINITY));
        for edge in 0..3 {
            let (p, q) = (simd.load(&edges.p[edge]), simd.load(&edges.q[edge]));
            let middle = affine(simd.load(&edges.e[edge]), (p, simd.splat(middle[0])), (q, simd.splat(middle[1])));
            let range = affine(margin, (p.abs(), simd.splat(half_width[0])), (q.abs(), simd.splat(half_width[1])));
            // The edge that all rays pass farthest on the one side, and on the other.
            least = simd.least(middle + range, least);
            most = simd.most(middle - range, most);
        }
        let misses = least.simd_lt(0.0) & most.simd_gt(0.0);
        let is_behind = (simd.load(&edges.near) * *least_inverse).simd_gt(t_max);
        !bits(misses | is_behind) & 0xff
    }

    /// Rays of a packet (bit per lane) that may hit the triangle in a lane of the block.
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
