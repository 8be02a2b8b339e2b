//! Packet traversal of coherent rays: one interval test per node for a group of rays, then each ray
//! against the boxes that the interval intersects.
//!
//! Where the interval misses all children of a node, all rays of the group miss them for the cost
//! of one test. The interval test is conservative: it never misses a box that one of its rays
//! intersects. Where few rays remain active, they are traversed singly.

use crate::lanes::{Lanes, max};
use crate::node::{Child, WIDTH};
use crate::ray_lanes::RayLanes;
use crate::single::{TraversalMemory, any_below, closest_below, last_child, nearest};
use crate::slabs::{Bundle, RayExtremes, Slabs};
use crate::stack::{Stack, StackView, distance};
use crate::{Bvh, Leaf};
use fearless_simd::dispatch;
use juggler_math::{Aabb, Ray};

/// Maximum number of rays in a packet.
pub const PACKET: usize = WIDTH;
/// Maximum number of rays in a group, which shares one interval. A group has several packets,
/// because neighboring packets visit mostly the same nodes.
pub(crate) const GROUP: usize = PACKETS * PACKET;
pub(crate) const PACKETS: usize = 4;
/// Coherence limit: origins may differ by this fraction of the scene's size, directions by this
/// fraction of their length.
const NARROW: f32 = 0.25;
/// Number of active rays up to which they are traversed singly.
const MAX_SINGLE_RAYS: u32 = 2;

/// Rays of one octant in packets, and their interval. Reused for the next rays without copying.
pub(crate) struct Group {
    pub bundle: Bundle,
    packets: [RayLanes; PACKETS],
    count: usize,
    extremes: RayExtremes,
}

impl Group {
    pub fn new() -> Self {
        Self {
            bundle: Bundle::default(),
            packets: [RayLanes::default(); PACKETS],
            count: 0,
            extremes: RayExtremes::default(),
        }
    }

    /// Loads up to [`GROUP`] rays. Returns `false` if their directions do not share an octant, a
    /// ray may start before its origin, or a ray is infinite.
    #[inline(always)]
    pub fn fill<S: Lanes>(&mut self, simd: S, rays: &[Ray]) -> bool {
        let mut all: Option<RayExtremes> = None;
        self.count = rays.len().div_ceil(PACKET).min(PACKETS);
        for (packet, rays) in self.packets.iter_mut().zip(rays.chunks(PACKET)) {
            let Some(extremes) = packet.fill(simd, rays) else { return false };
            packet.bundle = extremes.bundle(simd);
            match all.map_or(Some(extremes), |all| all.union(simd, &extremes)) {
                Some(extremes) => all = Some(extremes),
                None => return false,
            }
        }
        let Some(all) = all else { return false };
        (self.bundle, self.extremes) = (all.bundle(simd), all);
        true
    }

    /// Whether the rays are coherent. The interval of rays that only share an octant would
    /// intersect most of the tree.
    #[inline(always)]
    pub fn is_narrow(&self, scene: &Aabb) -> bool {
        let RayExtremes { low, high, .. } = &self.extremes;
        let size = scene.extent().max_element();
        let length = (3..6).fold(0.0, |length, i| max(max(high[i].abs(), low[i].abs()), length));
        let is_near = (0..3).all(|i| high[i] - low[i] <= size * NARROW);
        is_near && (3..6).all(|i| high[i] - low[i] <= length * NARROW)
    }

    /// Common origin of all rays, if there is one.
    #[inline(always)]
    pub fn common_origin(&self) -> Option<[f32; 3]> {
        let RayExtremes { low, high, .. } = &self.extremes;
        (low[..3] == high[..3]).then_some([low[0], low[1], low[2]])
    }

    /// Packets that contain rays.
    #[inline(always)]
    pub fn packets(&self) -> &[RayLanes] {
        &self.packets[..self.count]
    }

    /// Bit mask of the rays in `among` that intersect the box in `slot` of the bounds.
    #[inline(always)]
    fn test<S: Lanes>(&self, simd: S, bounds: &[[[f32; WIDTH]; 2]; 3], slot: usize, among: u32) -> u32 {
        let mut active = 0;
        for (number, lanes) in self.packets().iter().enumerate() {
            if among >> (number * WIDTH) & 0xff != 0 {
                active |= lanes.test(simd, bounds, slot) << (number * WIDTH);
            }
        }
        active & among
    }
}

impl Bvh {
    /// [`Bvh::closest`] for coherent rays; a ray's lane is its index in the slice. Rays are traced
    /// in groups of 32, packets of [`PACKET`] in SIMD. Groups that are not coherent are traversed
    /// singly.
    pub fn closest_packet(&self, rays: &mut [Ray], leaf: &mut impl Leaf) {
        dispatch!(self.level, simd => self.closest_groups(simd, rays, leaf));
    }

    /// [`Bvh::any`] for coherent rays; see [`Bvh::closest_packet`] and [`Bvh::any_batch`].
    pub fn any_packet(&self, rays: &[Ray], occluded: &mut [bool], leaf: &mut impl Leaf) {
        dispatch!(self.level, simd => self.any_groups(simd, rays, occluded, leaf));
    }

    #[inline(always)]
    fn closest_groups<S: Lanes>(&self, simd: S, rays: &mut [Ray], leaf: &mut impl Leaf) {
        let (mut stack, mut group) = (Stack::new(), Group::new());
        for (number, rays) in rays.chunks_mut(GROUP).enumerate() {
            let first = number * GROUP;
            if group.fill(simd, rays) && group.is_narrow(&self.bounds) {
                self.closest_group(simd, &*self.nodes, &mut stack, (first, rays), &mut group, leaf);
            } else {
                self.closest_singly(simd, &mut stack, first, rays, leaf);
            }
        }
    }

    #[inline(always)]
    fn any_groups<S: Lanes>(&self, simd: S, rays: &[Ray], occluded: &mut [bool], leaf: &mut impl Leaf) {
        let (mut stack, mut group) = (Stack::new(), Group::new());
        occluded.fill(false);
        for (number, (rays, occluded)) in rays.chunks(GROUP).zip(occluded.chunks_mut(GROUP)).enumerate() {
            let rays = &rays[..rays.len().min(occluded.len())];
            let first = number * GROUP;
            let found = if group.fill(simd, rays) {
                self.any_group(simd, &*self.nodes, &mut stack, (first, rays), &group, leaf)
            } else {
                self.any_singly(simd, &*self.nodes, Child::ROOT, stack.view(), (first, u32::MAX, rays), leaf)
            };
            for (lane, occluded) in occluded.iter_mut().enumerate() {
                *occluded = found >> lane & 1 != 0;
            }
        }
    }

    /// Traverses the tree with the group's interval and tests single rays at the leaves.
    #[inline(always)]
    pub(crate) fn closest_group<S: Lanes>(
        &self,
        simd: S,
        memory: impl TraversalMemory,
        stack: &mut Stack,
        (first, rays): (usize, &mut [Ray]),
        group: &mut Group,
        leaf: &mut impl Leaf,
    ) {
        let nodes = &*self.nodes;
        let mut stack = stack.view();
        let mut next = self.nearest_slot(simd, memory, Child::ROOT, &group.bundle, &mut stack);
        loop {
            let place = match next {
                Some(place) => place as usize,
                None => match stack.pop() {
                    Some(top) if distance(top) > group.bundle.t_max => continue,
                    Some(top) => top as u32 as usize,
                    None => return,
                },
            };
            let (parent, slot) = (&nodes[place / WIDTH], place % WIDTH);
            let child = parent.children[slot];
            if !child.is_leaf() {
                next = self.nearest_slot(simd, memory, child, &group.bundle, &mut stack);
                continue;
            }
            next = None;
            let mut t_max = f32::NEG_INFINITY;
            for (number, (lanes, rays)) in group.packets.iter_mut().zip(rays.chunks_mut(WIDTH)).enumerate() {
                let active = lanes.test(simd, &parent.bounds, slot);
                if active != 0 && leaf.closest_many(first + number * WIDTH, active, rays, child.items()) {
                    match leaf.packet_t_max(first + number * WIDTH) {
                        Some(t_max) => lanes.shorten_to(simd, t_max),
                        None => lanes.shorten(active, rays),
                    }
                }
                t_max = max(lanes.farthest, t_max);
            }
            group.bundle.t_max = t_max;
        }
    }

    /// Nearest child that the bundle may intersect, encoded by [`encode_slot`]; pushes the others.
    #[inline(always)]
    fn nearest_slot<S: Lanes>(
        &self,
        simd: S,
        memory: impl TraversalMemory,
        node: Child,
        bundle: &Bundle,
        stack: &mut StackView,
    ) -> Option<u32> {
        let (mask, enter) = self.nodes[node.0 as usize].test_bundle(simd, bundle);
        nearest(
            mask,
            &enter.into(),
            stack,
            #[inline(always)]
            |slot| {
                memory.prefetch(self.nodes[node.0 as usize].children[slot]);
                encode_slot(node, slot)
            },
        )
    }

    /// Last child that the bundle may intersect, encoded by [`encode_slot`]: the largest and most
    /// likely one to be hit. Pushes the others.
    #[inline(always)]
    fn last_slot<S: Lanes>(
        &self,
        simd: S,
        memory: impl TraversalMemory,
        node: Child,
        bundle: &Bundle,
        stack: &mut StackView,
    ) -> Option<u32> {
        let (mask, _) = self.nodes[node.0 as usize].test_bundle(simd, bundle);
        let last = last_child(
            mask,
            stack,
            #[inline(always)]
            |slot| {
                memory.prefetch(self.nodes[node.0 as usize].children[slot]);
                encode_slot(node, slot)
            },
        )?;
        Some(encode_slot(node, last))
    }

    /// Traverses the rays singly.
    #[inline(never)]
    fn closest_singly<S: Lanes>(
        &self,
        simd: S,
        stack: &mut Stack,
        first: usize,
        rays: &mut [Ray],
        leaf: &mut impl Leaf,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                for (lane, ray) in rays.iter_mut().enumerate() {
                    let slabs = Slabs::of_ray(simd, ray);
                    closest_below(simd, &*self.nodes, Child::ROOT, stack.view(), (first + lane, ray), slabs, leaf);
                }
            },
        );
    }

    /// Bit mask of the rays that hit something.
    #[inline(always)]
    pub(crate) fn any_group<S: Lanes>(
        &self,
        simd: S,
        memory: impl TraversalMemory,
        stack: &mut Stack,
        (first, rays): (usize, &[Ray]),
        group: &Group,
        leaf: &mut impl Leaf,
    ) -> u32 {
        let nodes = &*self.nodes;
        let all = u32::MAX >> (GROUP - rays.len());
        let mut found = 0;
        let mut stack = stack.view();
        let mut next = self.last_slot(simd, memory, Child::ROOT, &group.bundle, &mut stack);
        while found != all {
            let place = match next {
                Some(place) => place as usize,
                None => match stack.pop() {
                    Some(top) => top as u32 as usize,
                    None => return found,
                },
            };
            next = None;
            let (parent, slot) = (&nodes[place / WIDTH], place % WIDTH);
            let child = parent.children[slot];
            let active = group.test(simd, &parent.bounds, slot, all & !found);
            if active == 0 {
                continue;
            }
            if child.is_leaf() {
                for (number, rays) in rays.chunks(WIDTH).enumerate() {
                    let shift = number * WIDTH;
                    let active = active >> shift & 0xff;
                    if active != 0 {
                        found |= leaf.any_many(first + shift, active, rays, child.items()) << shift;
                    }
                }
            } else if active.count_ones() > MAX_SINGLE_RAYS {
                next = self.last_slot(simd, memory, child, &group.bundle, &mut stack);
            } else {
                found |= self.any_singly(simd, memory, child, stack.above(), (first, active, rays), leaf);
            }
        }
        stack.clear();
        found
    }

    /// Bit mask of the `active` rays that hit something in the subtree at `from`, traversed singly.
    /// The stack is empty.
    #[inline(never)]
    fn any_singly<S: Lanes>(
        &self,
        simd: S,
        memory: impl TraversalMemory,
        from: Child,
        mut stack: StackView,
        (base, active, rays): (usize, u32, &[Ray]),
        leaf: &mut impl Leaf,
    ) -> u32 {
        simd.vectorize(
            #[inline(always)]
            || {
                let mut found = 0;
                for (lane, ray) in rays.iter().enumerate() {
                    if active >> lane & 1 != 0 {
                        let slabs = Slabs::of_ray(simd, ray);
                        let ray = (base + lane, ray);
                        let hit = any_below(simd, memory, from, stack.above(), ray, &slabs, leaf);
                        found |= u32::from(hit) << lane;
                    }
                }
                found
            },
        )
    }
}

/// Encodes a node and a slot in one number.
#[inline(always)]
fn encode_slot(node: Child, slot: usize) -> u32 {
    node.0 * WIDTH as u32 + slot as u32
}
