//! Which nodes of the binary tree become children of which wide node: the cheapest choice of all by dynamic
//! programming (Ylitie, Karras, Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed
//! Wide BVHs", section 3.1). Leaves stay what they are.

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

/// A share of the whole that no area falls below, so that even points fill wide nodes.
const LEAST_AREA: f32 = 1e-30;

/// The cheapest cost of a subtree when it may become up to so many children: number 0 is for one child.
type Costs = [f32; WIDTH];

/// For each node and each number of children from two to eight, how many go to the left side; zero if one
/// fewer is as good.
pub(super) struct Plan<'a> {
    nodes: &'a [BinaryNode],
    choices: Vec<AtomicU32>,
    block: u32,
    inverse_area: f64,
}

impl<'a> Plan<'a> {
    /// `block` items cost as much as a node.
    pub fn new(nodes: &'a [BinaryNode], block: usize) -> Self {
        let choices = (0..nodes.len()).map(|_| AtomicU32::new(0)).collect();
        let area = nodes.first().map_or(0.0, BinaryNode::half_area);
        let inverse_area = if area > 0.0 { area.recip() } else { 0.0 };
        let plan = Self { nodes, choices, block: block as u32, inverse_area };
        if !nodes.is_empty() {
            plan.price(0, if nodes.len() < SMALL { 0 } else { TASK_LEVELS });
        }
        plan
    }

    fn price(&self, number: usize, levels: usize) -> Costs {
        let node = &self.nodes[number];
        let area = ((node.half_area() * self.inverse_area) as f32).max(LEAST_AREA);
        if node.is_leaf() {
            return [area * node.count.div_ceil(self.block) as f32; WIDTH];
        }
        let (left, right) = (node.first as usize, node.first as usize + 1);
        let (left, right) = if levels > 0 {
            rayon::join(|| self.price(left, levels - 1), || self.price(right, levels - 1))
        } else {
            (self.price(left, 0), self.price(right, 0))
        };
        let (costs, choices) = shares(area, &left, &right);
        self.choices[number].store(choices, Relaxed);
        costs
    }

    /// Calls `add` with the binary nodes that become children of the wide node in place of `number`.
    pub fn children(&self, number: usize, add: &mut impl FnMut(usize)) {
        if self.nodes[number].is_leaf() {
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
fn shares(area: f32, left: &Costs, right: &Costs) -> (Costs, u32) {
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
    let itself = area + costs[WIDTH - 1];
    costs[0] = itself;
    for slots in 2..=WIDTH {
        if itself <= costs[slots - 1] {
            costs[slots - 1] = itself;
            choices |= ITSELF << ((slots - 2) * BITS);
        }
    }
    (costs, choices)
}
