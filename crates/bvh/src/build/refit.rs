//! New bounds for an old tree: what moves a little need not be built anew.

use super::item::{Extent, Item};
use crate::Bvh;
use crate::node::{Child, Node, WIDTH};
use juggler_math::Aabb;
use rayon::prelude::*;
use std::fmt;

/// So many nodes are taken at once by a thread.
const CHUNK: usize = 1 << 8;

/// Why a tree cannot take new bounds and must be built anew.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RefitError {
    /// Not as many as the tree was built over.
    Count {
        /// How many the tree was built over.
        expected: usize,
        /// How many came.
        found: usize,
    },
    /// This one was left out of the tree because no ray could meet it; now one could.
    LeftOut {
        /// Its number.
        item: usize,
    },
}

impl fmt::Display for RefitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Count { expected, found } => write!(f, "the tree holds {expected} items, not {found}"),
            Self::LeftOut { item } => write!(f, "item {item} was left out of the tree, but now has a size"),
        }
    }
}

impl std::error::Error for RefitError {}

impl Bvh {
    /// Gives the items new boxes; item `i` has box `i`, as in [`Bvh::build`]. The tree keeps its shape, so
    /// rays take longer the more the items have moved; the same boxes as before change nothing. An item
    /// whose box has become empty is not met. Runs on the threads of the current rayon pool.
    pub fn refit(&mut self, boxes: &[Aabb]) -> Result<(), RefitError> {
        let usable = |item: usize| Item::new(Extent::raw(&boxes[item]), 0).is_some();
        self.check_refit(boxes.len(), self.order.iter().copied(), usable)?;
        let order = &self.order;
        self.bounds = refit(&mut self.nodes, |leaf| {
            let items = &order[leaf.items().start as usize..leaf.items().end as usize];
            items.iter().fold(Extent::EMPTY, |all, &item| all.union(extent(Extent::raw(&boxes[item as usize]))))
        });
        self.update_cost();
        Ok(())
    }

    /// Makes the statistics tell of the nodes as they are.
    pub(crate) fn update_cost(&mut self) {
        self.stats.sah_cost = sah_cost(&self.nodes, self.stats.block);
    }

    /// Whether this many items can be those of the tree, which holds `items`.
    pub(crate) fn check_refit(
        &self,
        count: usize,
        items: impl Iterator<Item = u32>,
        usable: impl Fn(usize) -> bool + Sync,
    ) -> Result<(), RefitError> {
        let expected = self.stats.items + self.stats.left_out;
        if count != expected {
            return Err(RefitError::Count { expected, found: count });
        }
        if self.stats.left_out > 0 {
            let mut held = vec![false; count];
            for item in items {
                if let Some(held) = held.get_mut(item as usize) {
                    *held = true;
                }
            }
            let new = held.par_iter().enumerate().find_first(|&(item, held)| !held && usable(item));
            if let Some((item, _)) = new {
                return Err(RefitError::LeftOut { item });
            }
        }
        Ok(())
    }
}

/// The box as the builder takes it, empty where it would leave it out.
pub(crate) fn extent(bounds: Extent) -> Extent {
    Item::new(bounds, 0).map_or(Extent::EMPTY, |item| item.extent())
}

/// New boxes for all nodes from those of the leaves; returns the box of all.
pub(crate) fn refit(nodes: &mut [Node], leaf: impl Fn(Child) -> Extent + Sync) -> Aabb {
    nodes.par_iter_mut().with_min_len(CHUNK).for_each(|node| {
        for slot in 0..node.count as usize {
            let child = node.children[slot];
            if child.is_leaf() {
                let bounds = leaf(child).aabb();
                node.set_bounds(slot, bounds.min.to_array(), bounds.max.to_array());
            }
        }
    });
    // Children lie behind their parents.
    for number in (0..nodes.len()).rev() {
        let (before, behind) = nodes.split_at_mut(number + 1);
        let node = &mut before[number];
        for slot in 0..node.count as usize {
            let child = node.children[slot];
            if !child.is_leaf() {
                let (low, high) = around(&behind[child.0 as usize - number - 1]);
                node.set_bounds(slot, low, high);
            }
        }
    }
    let (low, high) = nodes.first().map_or(([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]), around);
    Aabb { min: low.into(), max: high.into() }
}

/// The box of all that is below a node.
fn around(node: &Node) -> ([f32; 3], [f32; 3]) {
    let low = |axis: usize| node.bounds[axis][0].iter().fold(f32::INFINITY, |a, &b| a.min(b));
    let high = |axis: usize| node.bounds[axis][1].iter().fold(f32::NEG_INFINITY, |a, &b| a.max(b));
    (std::array::from_fn(low), std::array::from_fn(high))
}

/// Expected cost of a random ray that meets the box of all: nodes and leaf blocks of `block` items, each
/// counted as one.
pub(super) fn sah_cost(nodes: &[Node], block: usize) -> f64 {
    let cost = |node: &Node| -> f64 {
        let blocks = |child: Child| if child.is_leaf() { child.items().len().div_ceil(block) } else { 1 };
        (0..node.count as usize).map(|slot| half_area(node, slot) * blocks(node.children[slot]) as f64).sum()
    };
    let chunks: Vec<f64> = nodes.par_chunks(CHUNK).map(|nodes| nodes.iter().map(cost).sum()).collect();
    let root = nodes.first().map_or(0.0, |root| {
        let (low, high) = around(root);
        let mut node = Node::EMPTY;
        node.add(low, high, Child::ROOT);
        half_area(&node, 0)
    });
    if root > 0.0 { 1.0 + chunks.iter().sum::<f64>() / root } else { 0.0 }
}

fn half_area(node: &Node, slot: usize) -> f64 {
    let [x, y, z] = std::array::from_fn(|axis| {
        let [low, high] = [0, 1].map(|side: usize| f64::from(node.bounds[axis][side][slot % WIDTH]));
        (high - low).max(0.0)
    });
    x * y + y * z + z * x
}
