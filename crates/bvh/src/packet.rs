//! Up to eight coherent rays together: one interval test a node, then each ray against the boxes that the
//! interval leaves.
//!
//! Neighbouring rays are almost one ray; where their interval misses all children of the root, all of them
//! have missed, for the price of one. The interval's test never misses what one of its rays meets. Where few
//! rays are left in a box they go on alone.

use crate::lanes::{Lanes, max};
use crate::node::{Child, WIDTH};
use crate::ray_lanes::RayLanes;
use crate::single::{Boxes, any_below, closest_below, first, nearest};
use crate::slabs::{Bundle, Extent, Slabs};
use crate::stack::{Stack, StackView, distance};
use crate::{Bvh, Leaf};
use fearless_simd::dispatch;
use juggler_math::{Aabb, Ray};

/// Most rays that are traced together.
pub const PACKET: usize = WIDTH;
/// Rays whose interval is tested as one: several packets, for the nodes on the way are mostly the same.
pub(crate) const GROUP: usize = PACKETS * PACKET;
pub(crate) const PACKETS: usize = 4;
/// Rays are neighbours when origins differ by less than this share of the scene, and directions of their length.
const NARROW: f32 = 0.25;
/// With so few rays left in a box they go on alone.
const FEW: u32 = 2;

/// Rays of one octant, packet by packet, and their interval. Used again for the next rays: nothing is copied.
pub(crate) struct Group {
    pub bundle: Bundle,
    packets: [RayLanes; PACKETS],
    count: usize,
    extent: Extent,
}

impl Group {
    pub fn new() -> Self {
        Self { bundle: Bundle::default(), packets: [RayLanes::default(); PACKETS], count: 0, extent: Extent::default() }
    }

    /// Takes at most [`GROUP`] rays in; `false` where their directions do not share an octant or a ray may start
    /// before its origin.
    #[inline(always)]
    pub fn fill<S: Lanes>(&mut self, simd: S, rays: &[Ray]) -> bool {
        let mut all: Option<Extent> = None;
        self.count = rays.len().div_ceil(PACKET).min(PACKETS);
        for (packet, rays) in self.packets.iter_mut().zip(rays.chunks(PACKET)) {
            let Some(extent) = packet.fill(simd, rays) else { return false };
            packet.bundle = extent.bundle(simd);
            match all.map_or(Some(extent), |all| all.union(simd, &extent)) {
                Some(extent) => all = Some(extent),
                None => return false,
            }
        }
        let Some(all) = all else { return false };
        (self.bundle, self.extent) = (all.bundle(simd), all);
        true
    }

    /// Whether the rays are neighbours: an interval around rays that share no more than an octant would meet most of
    /// the tree.
    #[inline(always)]
    pub fn is_narrow(&self, scene: &Aabb) -> bool {
        let Extent { low, high, .. } = &self.extent;
        let size = scene.extent().max_element();
        let length = (3..6).fold(0.0, |length, i| max(max(high[i].abs(), low[i].abs()), length));
        let is_near = (0..3).all(|i| high[i] - low[i] <= size * NARROW);
        is_near && (3..6).all(|i| high[i] - low[i] <= length * NARROW)
    }

    /// The origin of all rays, where it is one.
    #[inline(always)]
    pub fn common_origin(&self) -> Option<[f32; 3]> {
        let Extent { low, high, .. } = &self.extent;
        (low[..3] == high[..3]).then_some([low[0], low[1], low[2]])
    }

    /// The packets that hold rays.
    #[inline(always)]
    pub fn packets(&self) -> &[RayLanes] {
        &self.packets[..self.count]
    }

    /// Which of the rays in `among` meet the box in `slot` of the bounds.
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
    /// [`Bvh::closest`] for rays that go the same way; a ray's lane is its number in the slice. They
    /// are taken 32 at a time, [`PACKET`] side by side. Rays that are no neighbours are traced alone.
    pub fn closest_packet(&self, rays: &mut [Ray], leaf: &mut impl Leaf) {
        dispatch!(self.level, simd => self.closest_groups(simd, rays, leaf));
    }

    /// [`Bvh::any`] for rays that go the same way; see [`Bvh::closest_packet`] and [`Bvh::any_batch`].
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
                self.closest_alone(simd, &mut stack, first, rays, leaf);
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
                self.any_alone(simd, &*self.nodes, Child::ROOT, stack.view(), (first, u32::MAX, rays), leaf)
            };
            for (lane, occluded) in occluded.iter_mut().enumerate() {
                *occluded = found >> lane & 1 != 0;
            }
        }
    }

    /// Traces the rays of a group as one, each from the leaves on.
    #[inline(always)]
    pub(crate) fn closest_group<S: Lanes>(
        &self,
        simd: S,
        boxes: impl Boxes,
        stack: &mut Stack,
        (first, rays): (usize, &mut [Ray]),
        group: &mut Group,
        leaf: &mut impl Leaf,
    ) {
        let nodes = &*self.nodes;
        let mut stack = stack.view();
        let mut next = self.nearest_slot(simd, boxes, Child::ROOT, &group.bundle, &mut stack);
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
                next = self.nearest_slot(simd, boxes, child, &group.bundle, &mut stack);
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

    /// The nearest child that the bundle may meet, as a place (node and slot in one number); pushes the others.
    #[inline(always)]
    fn nearest_slot<S: Lanes>(
        &self,
        simd: S,
        boxes: impl Boxes,
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
                boxes.prefetch(self.nodes[node.0 as usize].children[slot]);
                place_of(node, slot)
            },
        )
    }

    /// The last of the children that the bundle may meet, as a place: the largest one, which most likely holds a hit.
    /// Pushes the others.
    #[inline(always)]
    fn last_slot<S: Lanes>(
        &self,
        simd: S,
        boxes: impl Boxes,
        node: Child,
        bundle: &Bundle,
        stack: &mut StackView,
    ) -> Option<u32> {
        let (mask, _) = self.nodes[node.0 as usize].test_bundle(simd, bundle);
        let last = first(
            mask,
            stack,
            #[inline(always)]
            |slot| {
                boxes.prefetch(self.nodes[node.0 as usize].children[slot]);
                place_of(node, slot)
            },
        )?;
        Some(place_of(node, last))
    }

    /// Traces the rays one by one.
    #[inline(never)]
    fn closest_alone<S: Lanes>(
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

    /// Which of the rays hit something (bit per lane).
    #[inline(always)]
    pub(crate) fn any_group<S: Lanes>(
        &self,
        simd: S,
        boxes: impl Boxes,
        stack: &mut Stack,
        (first, rays): (usize, &[Ray]),
        group: &Group,
        leaf: &mut impl Leaf,
    ) -> u32 {
        let nodes = &*self.nodes;
        let all = u32::MAX >> (GROUP - rays.len());
        let mut found = 0;
        let mut stack = stack.view();
        let mut next = self.last_slot(simd, boxes, Child::ROOT, &group.bundle, &mut stack);
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
            } else if active.count_ones() > FEW {
                next = self.last_slot(simd, boxes, child, &group.bundle, &mut stack);
            } else {
                found |= self.any_alone(simd, boxes, child, stack.above(), (first, active, rays), leaf);
            }
        }
        stack.clear();
        found
    }

    /// Which of the active rays, each on its own, hit something in the subtree at `from`; the stack is empty.
    #[inline(never)]
    fn any_alone<S: Lanes>(
        &self,
        simd: S,
        boxes: impl Boxes,
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
                        let hit = any_below(simd, boxes, from, stack.above(), ray, &slabs, leaf);
                        found |= u32::from(hit) << lane;
                    }
                }
                found
            },
        )
    }
}

/// A child's node and slot in one number.
#[inline(always)]
fn place_of(node: Child, slot: usize) -> u32 {
    node.0 * WIDTH as u32 + slot as u32
}
