//! Plan of the collapse: chooses which binary nodes become children of which wide node at the
//! lowest SAH cost, by dynamic programming (Ylitie, Karras, Laine 2017, "Efficient Incoherent Ray
//! Traversal on GPUs Through Compressed Wide BVHs", section 3.1). Small subtrees may become leaves.

use super::binary::BinaryNode;
use crate::node::WIDTH;
use juggler_math::BuildControl;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// Number of binary levels whose two sides are evaluated in parallel.
const TASK_LEVELS: usize = 10;
/// Number of nodes below which one thread evaluates the tree.
const SMALL: usize = 1 << 13;
/// Bits per choice.
const BITS: usize = 4;
/// Choice to keep the node as one child.
const ITSELF: u32 = 8;

/// Flag beside the choices: the subtree, kept as one child, becomes a leaf.
const JOINED: u32 = 1 << 31;

/// Lower bound of relative areas, so that even points fill wide nodes.
const LEAST_AREA: f32 = 1e-30;

/// Lowest costs of a subtree as up to `i + 1` children, for index `i`.
type Costs = [f32; WIDTH];

/// Result for a subtree.
struct SubtreeCosts {
    costs: Costs,
    items: u32,
}

/// Choices of each node for two to eight children: the number of children given to the left side;
/// zero if one fewer is as good.
pub(super) struct Plan<'a> {
    nodes: &'a [BinaryNode],
    choices: Vec<AtomicU32>,
    leaf_size: u32,
    block: u32,
    inverse_area: f64,
    control: &'a BuildControl,
}

impl<'a> Plan<'a> {
    /// Evaluates all nodes, not all if `control` is cancelled. `block` is the number of items per leaf
    /// block, which costs as much as a node.
    pub fn new(nodes: &'a [BinaryNode], leaf_size: usize, block: usize, control: &'a BuildControl) -> Self {
        let choices = (0..nodes.len()).map(|_| AtomicU32::new(0)).collect();
        let area = nodes.first().map_or(0.0, BinaryNode::half_area);
        let inverse_area = if area > 0.0 { area.recip() } else { 0.0 };
        let plan = Self { nodes, choices, leaf_size: leaf_size as u32, block: block as u32, inverse_area, control };
        if !nodes.is_empty() {
            plan.evaluate(0, if nodes.len() < SMALL { 0 } else { TASK_LEVELS });
        }
        plan
    }

    fn evaluate(&self, number: usize, levels: usize) -> SubtreeCosts {
        if levels > 0 && self.control.is_cancelled() {
            return SubtreeCosts { costs: [0.0; WIDTH], items: 0 };
        }
        let node = &self.nodes[number];
        let area = ((node.half_area() * self.inverse_area) as f32).max(LEAST_AREA);
        if node.is_leaf() {
            return SubtreeCosts { costs: [area * self.blocks(node.count); WIDTH], items: node.count };
        }
        let (left, right) = (node.first as usize, node.first as usize + 1);
        let (left, right) = if levels > 0 {
            rayon::join(|| self.evaluate(left, levels - 1), || self.evaluate(right, levels - 1))
        } else {
            (self.evaluate(left, 0), self.evaluate(right, 0))
        };
        let items = left.items.saturating_add(right.items);
        let as_leaf = if items <= self.leaf_size { area * self.blocks(items) } else { f32::INFINITY };
        let (costs, choices) = combine_costs(area, as_leaf, &left.costs, &right.costs);
        self.choices[number].store(choices, Relaxed);
        SubtreeCosts { costs, items }
    }

    fn blocks(&self, items: u32) -> f32 {
        items.div_ceil(self.block) as f32
    }

    /// First position and number of items if the node becomes a leaf; `None` for a wide node.
    pub fn leaf(&self, number: usize) -> Option<(usize, usize)> {
        let node = &self.nodes[number];
        if node.is_leaf() {
            return Some((node.first as usize, node.count as usize));
        }
        let joined = self.choices[number].load(Relaxed) & JOINED != 0;
        // The items of the right side follow those of the left side.
        joined.then(|| {
            let first = node.first as usize;
            let [left, right] = [first, first + 1].map(|side| self.items(side));
            (left.0, left.1 + right.1)
        })
    }

    fn items(&self, number: usize) -> (usize, usize) {
        let node = &self.nodes[number];
        if node.is_leaf() {
            return (node.first as usize, node.count as usize);
        }
        let [left, right] = [0, 1].map(|side| self.items(node.first as usize + side));
        (left.0, left.1 + right.1)
    }

    /// Calls `add` with the binary nodes that become the children of the wide node at `number`.
    pub fn children(&self, number: usize, add: &mut impl FnMut(usize)) {
        if self.leaf(number).is_some() {
            add(number);
        } else {
            self.open(number, WIDTH, add);
        }
    }

    fn open(&self, number: usize, mut slots: usize, add: &mut impl FnMut(usize)) {
        let choices = self.choices[number].load(Relaxed);
        let left = loop {
            match choice(choices, slots) & !ITSELF {
                0 if slots > 2 => slots -= 1,
                left => break left.max(1) as usize,
            }
        };
        let first = self.nodes[number].first as usize;
        for (child, slots) in [(first, left), (first + 1, slots - left)] {
            let itself = slots == 1 || choice(self.choices[child].load(Relaxed), slots) & ITSELF != 0;
            if itself || self.nodes[child].is_leaf() {
                add(child);
            } else {
                self.open(child, slots, add);
            }
        }
    }
}

fn choice(choices: u32, slots: usize) -> u32 {
    choices >> ((slots - 2) * BITS) & 0xf
}

/// Costs of a node from those of its two children, and the choices that attain them.
fn combine_costs(area: f32, as_leaf: f32, left: &Costs, right: &Costs) -> (Costs, u32) {
    let (mut costs, mut choices) = ([f32::INFINITY; WIDTH], 0);
    for slots in 2..=WIDTH {
        let mut best = costs[slots - 2];
        let mut choice = 0;
        for share in 1..slots {
            let cost = left[share - 1] + right[slots - share - 1];
            if cost < best {
                (best, choice) = (cost, share as u32);
            }
        }
        costs[slots - 1] = best;
        choices |= choice << ((slots - 2) * BITS);
    }
    let as_node = area + costs[WIDTH - 1];
    let itself = as_node.min(as_leaf);
    if as_leaf <= as_node {
        choices |= JOINED;
    }
    costs[0] = itself;
    for slots in 2..=WIDTH {
        if itself <= costs[slots - 1] {
            costs[slots - 1] = itself;
            choices |= ITSELF << ((slots - 2) * BITS);
        }
    }
    (costs, choices)
}
