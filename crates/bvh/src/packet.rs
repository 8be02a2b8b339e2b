//! Up to eight coherent rays together: one interval test a node, then each ray against the boxes that the
//! interval leaves.
//!
//! Neighbouring rays are almost one ray; where their interval misses all children of the root, all of them
//! have missed, for the price of one. The interval's test never misses what one of its rays meets. Where few
//! rays are left in a box they go on alone.

use crate::lanes::{Bits, Lanes};
use crate::node::{Child, WIDTH};
use crate::ray_lanes::RayLanes;
use crate::slabs::{Bundle, Slabs};
use crate::single::nearest;
use crate::stack::{Stack, distance};
use crate::{Bvh, Leaf};
use fearless_simd::dispatch;
use juggler_math::Ray;

/// Most rays that are traced together.
pub const PACKET: usize = WIDTH;
/// With so few rays left in a box they go on alone.
const FEW: u32 = 2;

impl Bvh {
    /// [`Bvh::closest`] for rays that go the same way; a ray's lane is its number in the slice. More than
    /// [`PACKET`] rays are taken in groups of as many. Rays that do not share an octant are traced alone.
    pub fn closest_packet(&self, rays: &mut [Ray], leaf: &mut impl Leaf) {
        dispatch!(self.level, simd => self.closest_groups(simd, rays, leaf));
    }

    /// [`Bvh::any`] for rays that go the same way; see [`Bvh::closest_packet`] and [`Bvh::any_batch`].
    pub fn any_packet(&self, rays: &[Ray], occluded: &mut [bool], leaf: &mut impl Leaf) {
        dispatch!(self.level, simd => self.any_groups(simd, rays, occluded, leaf));
    }

    #[inline(always)]
    fn closest_groups<S: Lanes>(&self, simd: S, rays: &mut [Ray], leaf: &mut impl Leaf) {
        let mut stack = Stack::new();
        for (group, rays) in rays.chunks_mut(PACKET).enumerate() {
            match RayLanes::of_rays(simd, rays) {
                Some((mut lanes, bundle)) => {
                    self.closest_group(simd, &mut stack, group * PACKET, rays, bundle, &mut lanes, leaf);
                }
                None => self.closest_alone(simd, Child::ROOT, &mut stack, group * PACKET, u32::MAX, rays, leaf),
            }
        }
    }

    #[inline(always)]
    fn any_groups<S: Lanes>(&self, simd: S, rays: &[Ray], occluded: &mut [bool], leaf: &mut impl Leaf) {
        let mut stack = Stack::new();
        occluded.fill(false);
        for (group, (rays, occluded)) in rays.chunks(PACKET).zip(occluded.chunks_mut(PACKET)).enumerate() {
            let rays = &rays[..rays.len().min(occluded.len())];
            let found = match RayLanes::of_rays(simd, rays) {
                Some((lanes, bundle)) => {
                    self.any_group(simd, &mut stack, group * PACKET, rays, &bundle, &lanes, leaf)
                }
                None => self.any_alone(simd, Child::ROOT, &mut stack, group * PACKET, u32::MAX, rays, leaf),
            };
            for lane in Bits(found) {
                occluded[lane] = true;
            }
        }
    }

    /// Traces the rays of a group as one, each from the leaves on and where few are left alone.
    #[allow(clippy::too_many_arguments)]
    #[inline(always)]
    pub(crate) fn closest_group<S: Lanes>(
        &self,
        simd: S,
        stack: &mut Stack,
        base: usize,
        rays: &mut [Ray],
        mut bundle: Bundle,
        lanes: &mut RayLanes,
        leaf: &mut impl Leaf,
    ) {
        let nodes = &*self.nodes;
        let mut next = self.nearest_slot(simd, Child::ROOT, &bundle, stack);
        loop {
            let place = match next {
                Some(place) => place as usize,
                None => match stack.pop() {
                    Some(top) if distance(top) > bundle.t_max => continue,
                    Some(top) => top as u32 as usize,
                    None => return,
                },
            };
            let (parent, slot) = (&nodes[place / WIDTH], place % WIDTH);
            let child = parent.children[slot];
            if !child.is_leaf() {
                next = self.nearest_slot(simd, child, &bundle, stack);
                continue;
            }
            next = None;
            let active = lanes.test(simd, &parent.bounds, slot);
            if active == 0 {
                continue;
            }
            leaf.closest_many(base, active, rays, child.items());
            for lane in Bits(active) {
                lanes.shorten(lane, rays[lane].t_max);
            }
            bundle.t_max = lanes.t_max();
        }
    }

    /// The nearest child that the bundle may meet, as a place (node and slot in one number); pushes the others.
    #[inline(always)]
    fn nearest_slot<S: Lanes>(&self, simd: S, node: Child, bundle: &Bundle, stack: &mut Stack) -> Option<u32> {
        let (mask, enter) = self.nodes[node.0 as usize].test_bundle(simd, bundle);
        nearest(
            mask,
            &enter.into(),
            stack,
            #[inline(always)]
            |slot| node.0 * WIDTH as u32 + slot as u32,
        )
    }

    /// Traces the active rays one by one through the subtree at `from`.
    #[allow(clippy::too_many_arguments)]
    #[inline(never)]
    fn closest_alone<S: Lanes>(
        &self,
        simd: S,
        from: Child,
        stack: &mut Stack,
        base: usize,
        active: u32,
        rays: &mut [Ray],
        leaf: &mut impl Leaf,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                for (lane, ray) in rays.iter_mut().enumerate() {
                    if active >> lane & 1 != 0 {
                        let slabs = Slabs::of_ray(simd, ray);
                        self.closest_below(simd, from, stack, base + lane, ray, slabs, leaf);
                    }
                }
            },
        );
    }

    /// Which of the rays hit something (bit per lane).
    #[allow(clippy::too_many_arguments)]
    #[inline(always)]
    pub(crate) fn any_group<S: Lanes>(
        &self,
        simd: S,
        stack: &mut Stack,
        base: usize,
        rays: &[Ray],
        bundle: &Bundle,
        lanes: &RayLanes,
        leaf: &mut impl Leaf,
    ) -> u32 {
        let nodes = &*self.nodes;
        let all = (1u32 << rays.len()) - 1;
        let mut found = 0;
        let mut next = self.nearest_slot(simd, Child::ROOT, bundle, stack);
        loop {
            let place = match next.or_else(|| stack.pop().map(|top| top as u32)) {
                Some(place) => place as usize,
                None => return found,
            };
            next = None;
            let (parent, slot) = (&nodes[place / WIDTH], place % WIDTH);
            let child = parent.children[slot];
            let active = lanes.test(simd, &parent.bounds, slot) & all & !found;
            if active == 0 {
                continue;
            }
            if child.is_leaf() {
                found |= leaf.any_many(base, active, rays, child.items());
            } else if active.count_ones() > FEW {
                next = self.nearest_slot(simd, child, bundle, stack);
                continue;
            } else {
                found |= self.any_alone(simd, child, stack, base, active, rays, leaf);
            }
            if found == all {
                stack.truncate(0);
                return found;
            }
        }
    }

    /// Which of the active rays, each on its own, hit something in the subtree at `from`.
    #[allow(clippy::too_many_arguments)]
    #[inline(never)]
    fn any_alone<S: Lanes>(
        &self,
        simd: S,
        from: Child,
        stack: &mut Stack,
        base: usize,
        active: u32,
        rays: &[Ray],
        leaf: &mut impl Leaf,
    ) -> u32 {
        simd.vectorize(
            #[inline(always)]
            || {
                let mut found = 0;
                for (lane, ray) in rays.iter().enumerate() {
                    if active >> lane & 1 != 0 {
                        let slabs = Slabs::of_ray(simd, ray);
                        let hit = self.any_below(simd, from, stack, base + lane, ray, &slabs, leaf);
                        found |= u32::from(hit) << lane;
                    }
                }
                found
            },
        )
    }
}
