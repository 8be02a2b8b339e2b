//! One ray at a time: nearest child first for the closest hit, any order for any hit.

use crate::lanes::{Bits, Lanes};
use crate::node::{Child, Node};
use crate::slabs::{Slabs, cull_distance};
use crate::stack::{Stack, StackView, distance, entry};
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

/// What a traversal reads: the nodes of a tree, whose boxes may lie elsewhere, and what its leaves hold.
pub(crate) trait Boxes: Copy {
    /// The node with this number.
    fn node(&self, number: usize) -> &Node;

    /// [`Node::test`] with its boxes.
    fn test<S: Lanes>(&self, simd: S, number: usize, slabs: &Slabs) -> (u32, f32x8<S>);

    /// Asks for a child's memory, which is read soon.
    ///
    /// All children that a ray meets are asked for, before the processor has to guess which is the nearest: 3 to 25 % more
    /// incoherent rays a second where trees are larger than the second cache (Intel, 2 MiB), the same number where they
    /// are not. (On Zen 4 it made no difference.)
    #[inline(always)]
    fn prefetch(&self, _child: Child) {}
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

/// Traces one ray through the subtree at `from`, on an empty stack.
#[inline(always)]
pub(crate) fn closest_below<S: Lanes>(
    simd: S,
    boxes: impl Boxes,
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
            let (mask, enter) = boxes.test(simd, current.0 as usize, &ray_slabs);
            let node = boxes.node(current.0 as usize);
            let next = nearest(
                mask,
                &enter.into(),
                &mut stack,
                #[inline(always)]
                |slot| {
                    boxes.prefetch(node.children[slot]);
                    node.children[slot].0
                },
            );
            current = match next {
                Some(word) => Child(word),
                None => match next_below(&mut stack, ray_slabs.t_max) {
                    Some(child) => child,
                    None => return,
                },
            };
        }
        leaf.closest(lane, ray, current.items());
        slabs.t_max = cull_distance(ray.t_max);
        let Some(next) = next_below(&mut stack, slabs.t_max) else { return };
        current = next;
    }
}

/// Whether one ray hits something in the subtree at `from`, on an empty stack.
#[inline(always)]
pub(crate) fn any_below<S: Lanes>(
    simd: S,
    boxes: impl Boxes,
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
            let (mask, _) = boxes.test(simd, current.0 as usize, &slabs);
            let node = boxes.node(current.0 as usize);
            let next = first(
                mask,
                &mut stack,
                #[inline(always)]
                |slot| {
                    boxes.prefetch(node.children[slot]);
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

/// A copy that the compiler believes to be new. Otherwise it makes the slabs' vectors once per ray, runs out of registers
/// at the leaves, and loads them from the stack at every node; a copy after each leaf keeps them in registers between
/// nodes (17 % fewer instructions a ray).
#[inline(always)]
fn reloaded(slabs: &Slabs) -> Slabs {
    *std::hint::black_box(slabs)
}

/// The slot of the largest of the children that are met, which the builder puts last: it most likely holds a hit. The
/// words of the others go onto the stack.
#[inline(always)]
pub(crate) fn first(mut mask: u32, stack: &mut StackView, word: impl Fn(usize) -> u32) -> Option<usize> {
    let last = mask.checked_ilog2()?;
    mask ^= 1 << last;
    for slot in Bits(mask) {
        stack.push(entry(0.0, word(slot)));
    }
    Some(last as usize)
}

/// The next child on the stack that is entered before `t_max`.
#[inline(always)]
pub(crate) fn next_below(stack: &mut StackView, t_max: f32) -> Option<Child> {
    while let Some(entry) = stack.pop() {
        if distance(entry) <= t_max {
            return Some(Child(entry as u32));
        }
    }
    None
}

/// The word of the nearest of the children that are met; the others go onto the stack, farthest first.
///
/// One and two children are the rule and stand apart: branches let the processor guess the next node and fetch it before
/// the boxes are tested, selections would not. Three and four are sorted by compare-exchanges in registers. The nearest
/// never goes through memory, where its load would wait for its store.
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

/// Two entries, the smaller first, without a branch.
#[inline(always)]
fn ordered(a: u64, b: u64) -> (u64, u64) {
    (a.min(b), a.max(b))
}
