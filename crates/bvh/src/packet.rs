//! Up to eight coherent rays together: one interval test a node, then each ray against the boxes that the
//! interval leaves.
//!
//! Rays through one pixel are almost one ray; where their interval misses all children of the root, all of
//! them have missed, for the price of one. The interval's test never misses what one of its rays meets, and
//! before a leaf is visited each ray is tested against the leaf's own box exactly as it would be alone. So
//! the visitor finds the same hits as for single rays.

use crate::node::{Child, WIDTH};
use crate::slabs::{Lanes, Slabs};
use crate::stack::{LARGE, MEDIUM, SMALL, Stack};
use crate::{Bvh, Leaf};
use juggler_math::Ray;

/// Most rays that are traced together.
pub const PACKET: usize = WIDTH;
/// With so few rays left in a box they go on alone.
const FEW: u32 = 2;

impl Bvh {
    /// [`Bvh::closest`] for rays that go the same way; a ray's lane is its number in the slice. More than
    /// [`PACKET`] rays are taken in groups of as many. Rays that do not share an octant are traced alone.
    pub fn closest_packet(&self, rays: &mut [Ray], leaf: &mut impl Leaf) {
        match self.stats.stack {
            need if need <= SMALL => self.closest_groups::<SMALL>(rays, leaf),
            need if need <= MEDIUM => self.closest_groups::<MEDIUM>(rays, leaf),
            _ => self.closest_groups::<LARGE>(rays, leaf),
        }
    }

    /// [`Bvh::any`] for rays that go the same way; see [`Bvh::closest_packet`] and [`Bvh::any_batch`].
    pub fn any_packet(&self, rays: &[Ray], occluded: &mut [bool], leaf: &mut impl Leaf) {
        match self.stats.stack {
            need if need <= SMALL => self.any_groups::<SMALL>(rays, occluded, leaf),
            need if need <= MEDIUM => self.any_groups::<MEDIUM>(rays, occluded, leaf),
            _ => self.any_groups::<LARGE>(rays, occluded, leaf),
        }
    }

    fn closest_groups<const SIZE: usize>(&self, rays: &mut [Ray], leaf: &mut impl Leaf) {
        let mut stack = Stack::<SIZE>::new();
        for (group, rays) in rays.chunks_mut(PACKET).enumerate() {
            self.closest_group(&mut stack, group * PACKET, rays, leaf);
        }
    }

    fn any_groups<const SIZE: usize>(&self, rays: &[Ray], occluded: &mut [bool], leaf: &mut impl Leaf) {
        let mut stack = Stack::<SIZE>::new();
        occluded.fill(false);
        for (group, (rays, occluded)) in rays.chunks(PACKET).zip(occluded.chunks_mut(PACKET)).enumerate() {
            self.any_group(&mut stack, group * PACKET, rays, occluded, leaf);
        }
    }

    fn closest_group<const SIZE: usize>(
        &self,
        stack: &mut Stack<SIZE>,
        base: usize,
        rays: &mut [Ray],
        leaf: &mut impl Leaf,
    ) {
        let Some(mut interval) = Slabs::of_rays(rays) else {
            for (lane, ray) in rays.iter_mut().enumerate() {
                self.closest_below(Child::ROOT, stack, base + lane, ray, leaf);
            }
            return;
        };
        self.push_slots(Child::ROOT, &interval, stack);
        if stack.len() == 0 {
            return;
        }
        let mut lanes = Lanes::new(rays);
        while let Some((enter, place)) = stack.pop() {
            if enter > interval.t_max {
                continue;
            }
            let (node, slot) = (&self.nodes[place as usize / WIDTH], place as usize % WIDTH);
            let mut active = lanes.test(&node.bounds, slot);
            let child = node.children[slot];
            if child.is_leaf() {
                while active != 0 {
                    let lane = active.trailing_zeros() as usize;
                    active &= active - 1;
                    leaf.closest(base + lane, &mut rays[lane], child.items());
                    lanes.shorten(lane, rays[lane].t_max);
                }
                interval.t_max = lanes.t_max();
            } else if active.count_ones() > FEW {
                self.push_slots(child, &interval, stack);
            } else {
                while active != 0 {
                    let lane = active.trailing_zeros() as usize;
                    active &= active - 1;
                    self.closest_below(child, stack, base + lane, &mut rays[lane], leaf);
                    lanes.shorten(lane, rays[lane].t_max);
                }
                interval.t_max = lanes.t_max();
            }
        }
    }

    /// Pushes the places (node and slot in one number) of the children that are met, the nearest last.
    #[inline(always)]
    fn push_slots<const SIZE: usize>(&self, node: Child, slabs: &Slabs, stack: &mut Stack<SIZE>) {
        let (mut mask, enter) = self.nodes[node.0 as usize].test(slabs);
        let base = stack.len();
        while mask != 0 {
            let slot = mask.trailing_zeros();
            mask &= mask - 1;
            stack.insert(base, enter[slot as usize & 7], node.0 * WIDTH as u32 + slot);
        }
    }

    fn any_group<const SIZE: usize>(
        &self,
        stack: &mut Stack<SIZE>,
        base: usize,
        rays: &[Ray],
        occluded: &mut [bool],
        leaf: &mut impl Leaf,
    ) {
        let count = rays.len().min(occluded.len());
        let (rays, occluded) = (&rays[..count], &mut occluded[..count]);
        let Some(interval) = Slabs::of_rays(rays) else {
            for (lane, (ray, occluded)) in rays.iter().zip(occluded).enumerate() {
                *occluded = self.any_below(Child::ROOT, stack, base + lane, ray, leaf);
            }
            return;
        };
        self.push_slots(Child::ROOT, &interval, stack);
        if stack.len() == 0 {
            return;
        }
        let lanes = Lanes::new(rays);
        let mut waiting: u32 = (1 << count) - 1;
        while let Some((_, place)) = stack.pop() {
            let (node, slot) = (&self.nodes[place as usize / WIDTH], place as usize % WIDTH);
            let mut active = waiting & lanes.test(&node.bounds, slot);
            let child = node.children[slot];
            if active.count_ones() > FEW && !child.is_leaf() {
                self.push_slots(child, &interval, stack);
                continue;
            }
            while active != 0 {
                let lane = active.trailing_zeros() as usize;
                active &= active - 1;
                occluded[lane] = match child.is_leaf() {
                    true => leaf.any(base + lane, &rays[lane], child.items()),
                    false => self.any_below(child, stack, base + lane, &rays[lane], leaf),
                };
                waiting &= !(u32::from(occluded[lane]) << lane);
            }
            if waiting == 0 {
                stack.truncate(0);
                return;
            }
        }
    }
}
