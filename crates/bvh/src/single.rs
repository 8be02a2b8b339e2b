//! Single-ray traversal: ordered by distance for the closest hit, unordered for any hit.

use crate::lanes::{Bits, Lanes};
use crate::node::{Child, Node};
use crate::slabs::{Slabs, cull_distance};
use crate::stack::{Stack, StackView, distance, entry};
use crate::{Bvh, Leaf};
use fearless_simd::{dispatch, f32x8};
use juggler_math::Ray;

/// Number of rays prepared together, so that their dependency chains overlap.
const AHEAD: usize = 8;

impl Bvh {
    /// Finds the closest hit: visits the leaves that may contain it, nearest first. The lane is 0.
    pub fn closest(&self, ray: &mut Ray, leaf: &mut impl Leaf) {
        self.closest_batch(std::slice::from_mut(ray), leaf);
    }

    /// Whether the visitor reports a hit in any leaf. The lane is 0.
    pub fn any(&self, ray: &Ray, leaf: &mut impl Leaf) -> bool {
        let mut occluded = [false];
        self.any_batch(std::slice::from_ref(ray), &mut occluded, leaf);
        occluded[0]
    }

    /// [`Bvh::closest`] for any number of incoherent rays; a ray's lane is its index in the slice.
    pub fn closest_batch(&self, rays: &mut [Ray], leaf: &mut impl Leaf) {
        dispatch!(self.level, simd => self.closest_each(simd, rays, leaf));
    }

    /// [`Bvh::any`] for any number of incoherent rays; a ray's lane is its index in the slice.
    /// Overwrites `occluded`. If `occluded` is shorter than `rays`, the remaining rays are not
    /// traced.
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
                closest_below(simd, &*self.nodes, Child::ROOT, stack.view(), (lane, ray), *slabs, leaf);
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
                *occluded = any_below(simd, &*self.nodes, Child::ROOT, stack.view(), (lane, ray), slabs, leaf);
            }
        }
    }
}

/// Memory that a traversal reads: nodes and their boxes, which may be stored elsewhere.
pub(crate) trait TraversalMemory: Copy {
    /// Node with this index.
    fn node(&self, number: usize) -> &Node;

    /// [`Node::test`] against the boxes of node `number`.
    fn test<S: Lanes>(&self, simd: S, number: usize, slabs: &Slabs) -> (u32, f32x8<S>);

    /// Prefetches the memory of a child.
    ///
    /// Called for all intersected children before the branch on the nearest one. Gains 3 to 25 %
    /// incoherent rays per second for trees larger than the L2 cache (Intel, 2 MiB) and nothing for
    /// smaller trees or on Zen 4.
    #[inline(always)]
    fn prefetch(&self, _child: Child) {}
}

impl TraversalMemory for &[Node] {
    #[inline(always)]
    fn node(&self, number: usize) -> &Node {
        &self[number]
    }

    #[inline(always)]
    fn test<S: Lanes>(&self, simd: S, number: usize, slabs: &Slabs) -> (u32, f32x8<S>) {
        self[number].test(simd, slabs)
    }
}

/// Traverses the subtree at `from` with one ray, starting with an empty stack.
#[inline(always)]
pub(crate) fn closest_below<S: Lanes>(
    simd: S,
    memory: impl TraversalMemory,
    from: Child,
    mut stack: StackView,
    (lane, ray): (usize, &mut Ray),
    mut slabs: Slabs,
    leaf: &mut impl Leaf,
) {
    let mut current = from;
    loop {
        let ray_slabs = reloaded(&slabs);
        while !current.is_leaf() {
            let (mask, enter) = memory.test(simd, current.0 as usize, &ray_slabs);
            let node = memory.node(current.0 as usize);
            let next = nearest(
                mask,
                &enter.into(),
                &mut stack,
                #[inline(always)]
                |slot| {
                    memory.prefetch(node.children[slot]);
                    node.children[slot].0
                },
            );
            current = match next {
                Some(word) => Child(word),
                None => match pop_nearer_than(&mut stack, ray_slabs.t_max) {
                    Some(child) => child,
                    None => return,
                },
            };
        }
        leaf.closest(lane, ray, current.items());
        slabs.t_max = cull_distance(ray.t_max);
        let Some(next) = pop_nearer_than(&mut stack, slabs.t_max) else { return };
        current = next;
    }
}

/// Whether one ray hits anything in the subtree at `from`, starting with an empty stack.
#[inline(always)]
pub(crate) fn any_below<S: Lanes>(
    simd: S,
    memory: impl TraversalMemory,
    from: Child,
    mut stack: StackView,
    (lane, ray): (usize, &Ray),
    slabs: &Slabs,
    leaf: &mut impl Leaf,
) -> bool {
    let mut current = from;
    loop {
        let slabs = reloaded(slabs);
        while !current.is_leaf() {
            let (mask, _) = memory.test(simd, current.0 as usize, &slabs);
            let node = memory.node(current.0 as usize);
            let next = last_child(
                mask,
                &mut stack,
                #[inline(always)]
                |slot| {
                    memory.prefetch(node.children[slot]);
                    node.children[slot].0
                },
            );
            current = match next {
                Some(slot) => node.children[slot & 7],
                None => match stack.pop() {
                    Some(entry) => Child(entry as u32),
                    None => return false,
                },
            };
        }
        if leaf.any(lane, ray, current.items()) {
            stack.clear();
            return true;
        }
        let Some(next) = stack.pop() else { return false };
        current = Child(next as u32);
    }
}

/// Copies the slabs in a way that the optimizer cannot see through. Otherwise it broadcasts the
/// vectors once per ray, spills them at the leaves and reloads them at every node; a copy after
/// each leaf keeps them in registers between nodes (17 % fewer instructions per ray).
#[inline(always)]
fn reloaded(slabs: &Slabs) -> Slabs {
    *std::hint::black_box(slabs)
}

/// Slot of the last intersected child, which the builder makes the largest and so the most likely
/// one to be hit. Pushes the words of the others.
#[inline(always)]
pub(crate) fn last_child(mut mask: u32, stack: &mut StackView, word: impl Fn(usize) -> u32) -> Option<usize> {
    let last = mask.checked_ilog2()?;
    mask ^= 1 << last;
    for slot in Bits(mask) {
        stack.push(entry(0.0, word(slot)));
    }
    Some(last as usize)
}

/// Pops the next child that is entered at or before `t_max`.
#[inline(always)]
pub(crate) fn pop_nearer_than(stack: &mut StackView, t_max: f32) -> Option<Child> {
    while let Some(entry) = stack.pop() {
        if distance(entry) <= t_max {
            return Some(Child(entry as u32));
        }
    }
    None
}

/// Word of the nearest intersected child; pushes the others, farthest first.
///
/// One and two children are the common cases and use branches: the processor then predicts the next
/// node and loads it speculatively, before the boxes are tested. Three and four children are sorted
/// by compare-exchange in registers. The nearest child never goes through memory, which would add
/// store-to-load latency.
#[inline(always)]
pub(crate) fn nearest(mask: u32, enter: &[f32; 8], stack: &mut StackView, word: impl Fn(usize) -> u32) -> Option<u32> {
    let mut entries = Bits(mask).map(
        #[inline(always)]
        |slot| entry(enter[slot], word(slot)),
    );
    let a = entries.next()?;
    let Some(b) = entries.next() else { return Some(a as u32) };
    let Some(c) = entries.next() else {
        let (near, far) = if a <= b { (a, b) } else { (b, a) };
        stack.push(far);
        return Some(near as u32);
    };
    let (a, b) = ordered(a, b);
    let Some(d) = entries.next() else {
        let (a, c) = ordered(a, c);
        let (b, c) = ordered(b, c);
        stack.push(c);
        stack.push(b);
        return Some(a as u32);
    };
    let (c, d) = ordered(c, d);
    let ((mut a, c), (b, d)) = (ordered(a, c), ordered(b, d));
    let (b, c) = ordered(b, c);
    stack.push(d);
    stack.push(c);
    stack.push(b);
    let mut sorted = 3;
    for e in entries {
        let (near, far) = ordered(a, e);
        stack.insert(sorted, far);
        (a, sorted) = (near, sorted + 1);
    }
    Some(a as u32)
}

/// Sorts two entries without a branch.
#[inline(always)]
fn ordered(a: u64, b: u64) -> (u64, u64) {
    (a.min(b), a.max(b))
}
