//! One ray at a time: nearest child first for the closest hit, any order for any hit.

use crate::node::Child;
use crate::slabs::{Slabs, cull_distance};
use crate::stack::{LARGE, MEDIUM, SMALL, Stack};
use crate::{Bvh, Leaf};
use juggler_math::Ray;

impl Bvh {
    /// Shows the visitor every leaf that could hold the closest hit, near ones first. Lane 0.
    pub fn closest(&self, ray: &mut Ray, leaf: &mut impl Leaf) {
        self.closest_batch(std::slice::from_mut(ray), leaf);
    }

    /// Whether the visitor finds a hit. Lane 0.
    pub fn any(&self, ray: &Ray, leaf: &mut impl Leaf) -> bool {
        let mut occluded = [false];
        self.any_batch(std::slice::from_ref(ray), &mut occluded, leaf);
        occluded[0]
    }

    /// [`Bvh::closest`] for any number of unrelated rays; a ray's lane is its number in the slice.
    pub fn closest_batch(&self, rays: &mut [Ray], leaf: &mut impl Leaf) {
        match self.stats.stack {
            need if need <= SMALL => self.closest_each::<SMALL>(rays, leaf),
            need if need <= MEDIUM => self.closest_each::<MEDIUM>(rays, leaf),
            _ => self.closest_each::<LARGE>(rays, leaf),
        }
    }

    /// [`Bvh::any`] for any number of unrelated rays; a ray's lane is its number in the slice. The answers
    /// replace what `occluded` held; rays without a place in it are not traced.
    pub fn any_batch(&self, rays: &[Ray], occluded: &mut [bool], leaf: &mut impl Leaf) {
        match self.stats.stack {
            need if need <= SMALL => self.any_each::<SMALL>(rays, occluded, leaf),
            need if need <= MEDIUM => self.any_each::<MEDIUM>(rays, occluded, leaf),
            _ => self.any_each::<LARGE>(rays, occluded, leaf),
        }
    }

    fn closest_each<const SIZE: usize>(&self, rays: &mut [Ray], leaf: &mut impl Leaf) {
        let mut stack = Stack::<SIZE>::new();
        for (lane, ray) in rays.iter_mut().enumerate() {
            self.closest_below(Child::ROOT, &mut stack, lane, ray, leaf);
        }
    }

    fn any_each<const SIZE: usize>(&self, rays: &[Ray], occluded: &mut [bool], leaf: &mut impl Leaf) {
        let mut stack = Stack::<SIZE>::new();
        for (lane, (ray, occluded)) in rays.iter().zip(occluded).enumerate() {
            *occluded = self.any_below(Child::ROOT, &mut stack, lane, ray, leaf);
        }
    }

    /// Traces one ray through the subtree at `from`; what the stack holds already is left alone.
    pub(crate) fn closest_below<const SIZE: usize>(
        &self,
        from: Child,
        stack: &mut Stack<SIZE>,
        lane: usize,
        ray: &mut Ray,
        leaf: &mut impl Leaf,
    ) {
        let mut slabs = Slabs::of_ray(ray);
        let base = stack.len();
        let mut current = from;
        loop {
            if current.is_leaf() {
                leaf.closest(lane, ray, current.items());
                slabs.t_max = cull_distance(ray.t_max);
            } else {
                self.push_hits(current, &slabs, stack);
            }
            current = loop {
                if stack.len() == base {
                    return;
                }
                match stack.pop() {
                    Some((enter, word)) if enter <= slabs.t_max => break Child(word),
                    Some(_) => {}
                    None => return,
                }
            };
        }
    }

    /// Pushes the children that are met, the nearest last.
    #[inline(always)]
    pub(crate) fn push_hits<const SIZE: usize>(&self, node: Child, slabs: &Slabs, stack: &mut Stack<SIZE>) {
        let node = &self.nodes[node.0 as usize];
        let (mut mask, enter) = node.test(slabs);
        let base = stack.len();
        while mask != 0 {
            let slot = mask.trailing_zeros() as usize & 7;
            mask &= mask - 1;
            stack.insert(base, enter[slot], node.children[slot].0);
        }
    }

    /// Whether one ray hits something in the subtree at `from`; the stack is left as it was.
    pub(crate) fn any_below<const SIZE: usize>(
        &self,
        from: Child,
        stack: &mut Stack<SIZE>,
        lane: usize,
        ray: &Ray,
        leaf: &mut impl Leaf,
    ) -> bool {
        let slabs = Slabs::of_ray(ray);
        let base = stack.len();
        let mut current = from;
        loop {
            if !current.is_leaf() {
                let node = &self.nodes[current.0 as usize];
                let (mut mask, _) = node.test(&slabs);
                while mask != 0 {
                    let slot = mask.trailing_zeros() as usize & 7;
                    mask &= mask - 1;
                    stack.push(0.0, node.children[slot].0);
                }
            } else if leaf.any(lane, ray, current.items()) {
                stack.truncate(base);
                return true;
            }
            if stack.len() == base {
                return false;
            }
            let Some((_, word)) = stack.pop() else { return false };
            current = Child(word);
        }
    }
}
