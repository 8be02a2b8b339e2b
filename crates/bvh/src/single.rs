//! One ray at a time: nearest child first for the closest hit, any order for any hit.

use crate::lanes::Lanes;
use crate::node::{Child, Node};
use crate::slabs::{Slabs, cull_distance};
use crate::stack::{Stack, distance, entry};
use crate::{Bvh, Leaf};
use fearless_simd::{dispatch, f32x8};
use juggler_math::Ray;

/// So many rays are made ready together: each is a chain of latencies, which then overlap.
const AHEAD: usize = 8;

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
        dispatch!(self.level, simd => self.closest_each(simd, rays, leaf));
    }

    /// [`Bvh::any`] for any number of unrelated rays; a ray's lane is its number in the slice. The answers
    /// replace what `occluded` held; rays without a place in it are not traced.
    pub fn any_batch(&self, rays: &[Ray], occluded: &mut [bool], leaf: &mut impl Leaf) {
        dispatch!(self.level, simd => self.any_each(simd, rays, occluded, leaf));
    }

    #[inline(always)]
    fn closest_each<S: Lanes>(&self, simd: S, rays: &mut [Ray], leaf: &mut impl Leaf) {
        let (mut stack, mut ready) = (Stack::new(), [Slabs::default(); AHEAD]);
        for (number, rays) in rays.chunks_mut(AHEAD).enumerate() {
            for (slabs, ray) in ready.iter_mut().zip(&*rays) {
                slabs.fill(simd, ray);
            }
            for (lane, (ray, slabs)) in rays.iter_mut().zip(&mut ready).enumerate() {
                let lane = number * AHEAD + lane;
                closest_below(simd, &*self.nodes, Child::ROOT, &mut stack, (lane, ray), *slabs, leaf);
            }
        }
    }

    #[inline(always)]
    fn any_each<S: Lanes>(&self, simd: S, rays: &[Ray], occluded: &mut [bool], leaf: &mut impl Leaf) {
        let (mut stack, mut ready) = (Stack::new(), [Slabs::default(); AHEAD]);
        for (number, (rays, occluded)) in rays.chunks(AHEAD).zip(occluded.chunks_mut(AHEAD)).enumerate() {
            for (slabs, ray) in ready.iter_mut().zip(rays) {
                slabs.fill(simd, ray);
            }
            for (lane, ((ray, occluded), slabs)) in rays.iter().zip(occluded).zip(&ready).enumerate() {
                let lane = number * AHEAD + lane;
                *occluded = any_below(simd, &*self.nodes, Child::ROOT, &mut stack, (lane, ray), slabs, leaf);
            }
        }
    }
}

/// The boxes of a tree's nodes, which may lie elsewhere than in the nodes.
pub(crate) trait Boxes: Copy {
    /// The node with this number.
    fn node(&self, number: usize) -> &Node;

    /// [`Node::test`] with its boxes.
    fn test<S: Lanes>(&self, simd: S, number: usize, slabs: &Slabs) -> (u32, f32x8<S>);
}

impl Boxes for &[Node] {
    #[inline(always)]
    fn node(&self, number: usize) -> &Node {
        &self[number]
    }

    #[inline(always)]
    fn test<S: Lanes>(&self, simd: S, number: usize, slabs: &Slabs) -> (u32, f32x8<S>) {
        self[number].test(simd, slabs)
    }
}

/// Traces one ray through the subtree at `from`; what the stack holds already is left alone.
#[inline(always)]
pub(crate) fn closest_below<S: Lanes>(
    simd: S,
    boxes: impl Boxes,
    from: Child,
    stack: &mut Stack,
    (lane, ray): (usize, &mut Ray),
    mut slabs: Slabs,
    leaf: &mut impl Leaf,
) {
    let base = stack.len();
    let mut current = from;
    loop {
        while !current.is_leaf() {
            let (mask, enter) = boxes.test(simd, current.0 as usize, &slabs);
            let node = boxes.node(current.0 as usize);
            let next = nearest(
                mask,
                &enter.into(),
                stack,
                #[inline(always)]
                |slot| node.children[slot].0,
            );
            current = match next {
                Some(word) => Child(word),
                None => match next_below(stack, base, slabs.t_max) {
                    Some(child) => child,
                    None => return,
                },
            };
        }
        leaf.closest(lane, ray, current.items());
        slabs.t_max = cull_distance(ray.t_max);
        let Some(next) = next_below(stack, base, slabs.t_max) else { return };
        current = next;
    }
}

/// Whether one ray hits something in the subtree at `from`; the stack is left as it was.
#[inline(always)]
pub(crate) fn any_below<S: Lanes>(
    simd: S,
    boxes: impl Boxes,
    from: Child,
    stack: &mut Stack,
    (lane, ray): (usize, &Ray),
    slabs: &Slabs,
    leaf: &mut impl Leaf,
) -> bool {
    let base = stack.len();
    let mut current = from;
    loop {
        while !current.is_leaf() {
            let (mask, _) = boxes.test(simd, current.0 as usize, slabs);
            let next = first(boxes.node(current.0 as usize), mask, stack);
            let Some(next) = next.or_else(
                #[inline(always)]
                || next_below(stack, base, f32::INFINITY),
            ) else {
                return false;
            };
            current = next;
        }
        if leaf.any(lane, ray, current.items()) {
            stack.truncate(base);
            return true;
        }
        let Some(next) = next_below(stack, base, f32::INFINITY) else { return false };
        current = next;
    }
}

/// The largest of the children that are met, which the builder puts last: it most likely holds a hit. The others go
/// onto the stack.
#[inline(always)]
pub(crate) fn first(node: &Node, mut mask: u32, stack: &mut Stack) -> Option<Child> {
    if mask == 0 {
        return None;
    }
    let last = mask.ilog2();
    mask ^= 1 << last;
    while mask != 0 {
        stack.push(entry(0.0, node.children[mask.trailing_zeros() as usize & 7].0));
        mask &= mask - 1;
    }
    Some(node.children[last as usize & 7])
}

/// The next child on the stack that is entered before `t_max`.
#[inline(always)]
pub(crate) fn next_below(stack: &mut Stack, base: usize, t_max: f32) -> Option<Child> {
    while stack.len() > base {
        let entry = stack.pop()?;
        if distance(entry) <= t_max {
            return Some(Child(entry as u32));
        }
    }
    None
}

/// The word of the nearest of the children that are met; the others go onto the stack, farthest first. One and
/// two are the rule and stand apart: branches let the processor guess the next node and fetch it before the
/// boxes are tested, selections would not.
#[inline(always)]
pub(crate) fn nearest(mut mask: u32, enter: &[f32; 8], stack: &mut Stack, word: impl Fn(usize) -> u32) -> Option<u32> {
    if mask == 0 {
        return None;
    }
    let slot = mask.trailing_zeros() as usize & 7;
    mask &= mask - 1;
    if mask == 0 {
        return Some(word(slot));
    }
    let first = entry(enter[slot], word(slot));
    let slot = mask.trailing_zeros() as usize & 7;
    mask &= mask - 1;
    let second = entry(enter[slot], word(slot));
    if mask == 0 {
        if first <= second {
            stack.push(second);
            return Some(first as u32);
        }
        stack.push(first);
        return Some(second as u32);
    }
    let base = stack.len();
    let (near, far) = if first <= second { (first, second) } else { (second, first) };
    stack.push(far);
    stack.push(near);
    while mask != 0 {
        let slot = mask.trailing_zeros() as usize & 7;
        mask &= mask - 1;
        stack.insert(base, entry(enter[slot], word(slot)));
    }
    stack.pop().map(|top| top as u32)
}
