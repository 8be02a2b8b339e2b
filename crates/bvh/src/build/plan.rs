//! Which nodes of the binary tree become children of which wide node: the cheapest choice of all by dynamic
//! programming (Ylitie, Karras, Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed
//! Wide BVHs", section 3.1). Subtrees of few items may become leaves.

use super::binary::BinaryNode;
use crate::node::WIDTH;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// Levels of the binary tree whose two sides are priced at the same time.
const TASK_LEVELS: usize = 10;
/// Trees of fewer nodes are priced by one thread.
const SMALL: usize = 1 << 13;
/// A choice takes so many bits.
const BITS: usize = 4;
/// The choice to take the node itself as one child.
const ITSELF: u32 = 8;

/// Beside the choices: the subtree, taken as one child, becomes a leaf.
const JOINED: u32 = 1 << 31;

/// A share of the whole that no area falls below, so that even points fill wide nodes.
const LEAST_AREA: f32 = 1e-30;

/// The cheapest cost of a subtree when it may become up to so many children: number 0 is for one child.
type Costs = [f32; WIDTH];

/// What is known of a subtree.
struct Below {
    costs: Costs,
    items: u32,
}

/// For each node and each number of children from two to eight, how many go to the left side; zero if one
/// fewer is as good.
pub(super) struct Plan<'a> {
    nodes: &'a [BinaryNode],
    choices: Vec<AtomicU32>,
    leaf_size: u32,
    block: u32,
    inverse_area: f64,
}

impl<'a> Plan<'a> {
    /// `block` items cost as much as a node.
    pub fn new(nodes: &'a [BinaryNode], leaf_size: usize, block: usize) -> Self {
        let choices = (0..nodes.len()).map(|_| AtomicU32::new(0)).collect();
        let area = nodes.first().map_or(0.0, BinaryNode::half_area);
        let inverse_area = if area > 0.0 { area.recip() } else { 0.0 };
        let plan = Self { nodes, choices, leaf_size: leaf_size as u32, block: block as u32, inverse_area };
        if !nodes.is_empty() {
            plan.price(0, if nodes.len() < SMALL { 0 } else { TASK_LEVELS });
        }
        plan
    }

    fn price(&self, number: usize, levels: usize) -> Below {
        let node = &self.nodes[number];
        let area = ((node.half_area() * self.inverse_area) as f32).max(LEAST_AREA);
        if node.is_leaf() {
            return Below { costs: [area * self.blocks(node.count); WIDTH], items: node.count };
        }
        let (left, right) = (node.first as usize, node.first as usize + 1);
        let (left, right) = if levels > 0 {
            rayon::join(|| self.price(left, levels - 1), || self.price(right, levels - 1))
        } else {
            (self.price(left, 0), self.price(right, 0))
        };
        let items = left.items.saturating_add(right.items);
        let as_leaf = if items <= self.leaf_size { area * self.blocks(items) } else { f32::INFINITY };
        let (costs, choices) = shares(area, as_leaf, &left.costs, &right.costs);
        self.choices[number].store(choices, Relaxed);
        Below { costs, items }
    }

    fn blocks(&self, items: u32) -> f32 {
        items.div_ceil(self.block) as f32
    }

    /// The items of a leaf, as first position and count; `None` for a node.
    pub fn leaf(&self, number: usize) -> Option<(usize, usize)> {
        let node = &self.nodes[number];
        if node.is_leaf() {
            return Some((node.first as usize, node.count as usize));
        }
        let joined = self.choices[number].load(Relaxed) & JOINED != 0;
        // The items of the right side follow those of the left.
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

    /// Calls `add` with the binary nodes that become children of the wide node in place of `number`.
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

/// The costs of a node from those of its two sides, and the choices that lead to them.
fn shares(area: f32, as_leaf: f32, left: &Costs, right: &Costs) -> (Costs, u32) {
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
