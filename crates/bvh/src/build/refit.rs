//! Refitting: new bounds for a tree of unchanged topology.

use super::item::{Item, SimdBox};
use crate::Bvh;
use crate::node::{Child, Node, WIDTH};
use juggler_math::Aabb;
use rayon::prelude::*;
use std::fmt;

/// Number of nodes per parallel task.
const CHUNK: usize = 1 << 8;

/// Reason why a tree cannot be refitted and must be rebuilt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RefitError {
    /// The number of items differs from that of the build.
    Count {
        /// Number of items in the build.
        expected: usize,
        /// Number of items given.
        found: usize,
    },
    /// An item that the build left out can now be hit.
    LeftOut {
        /// Index of the item.
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
    /// Assigns new boxes; item `i` has box `i`, as in [`Bvh::build`]. The topology does not change,
    /// so traversal slows down the more the items have moved; unchanged boxes change nothing. Items
    /// whose box is now empty are not hit. Uses the threads of the current rayon pool.
    pub fn refit(&mut self, boxes: &[Aabb]) -> Result<(), RefitError> {
        let usable = |item: usize| Item::new(SimdBox::raw(&boxes[item]), 0).is_some();
        self.check_refit(boxes.len(), self.order.iter().copied(), usable)?;
        let order = &self.order;
        self.bounds = refit(&mut self.nodes, |leaf| {
            let items = &order[leaf.items().start as usize..leaf.items().end as usize];
            items.iter().fold(SimdBox::EMPTY, |all, &item| all.union(checked_box(SimdBox::raw(&boxes[item as usize]))))
        });
        self.update_cost();
        Ok(())
    }

    /// Recomputes the SAH cost from the current nodes.
    pub(crate) fn update_cost(&mut self) {
        self.stats.sah_cost = sah_cost(&self.nodes, self.stats.block);
    }

    /// Checks that `count` items with the given usable boxes match the tree, which contains
    /// `items`.
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

/// The box as the builder stores it; empty if the builder would leave it out.
pub(crate) fn checked_box(bounds: SimdBox) -> SimdBox {
    Item::new(bounds, 0).map_or(SimdBox::EMPTY, |item| item.bounds())
}

/// Recomputes the boxes of all nodes bottom-up from those of the leaves; returns the bounds of the
/// root.
pub(crate) fn refit(nodes: &mut [Node], leaf: impl Fn(Child) -> SimdBox + Sync) -> Aabb {
    nodes.par_iter_mut().with_min_len(CHUNK).for_each(|node| {
        for slot in 0..node.count as usize {
            let child = node.children[slot];
            if child.is_leaf() {
                let bounds = leaf(child).aabb();
                node.set_bounds(slot, bounds.min.to_array(), bounds.max.to_array());
            }
        }
    });
    // Children are stored after their parents.
    for number in (0..nodes.len()).rev() {
        let (before, behind) = nodes.split_at_mut(number + 1);
        let node = &mut before[number];
        for slot in 0..node.count as usize {
            let child = node.children[slot];
            if !child.is_leaf() {
                let (low, high) = union_of_boxes(&behind[child.0 as usize - number - 1]);
                node.set_bounds(slot, low, high);
            }
        }
    }
    let (low, high) = nodes.first().map_or(([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]), union_of_boxes);
    Aabb { min: low.into(), max: high.into() }
}

/// Union of a node's boxes.
fn union_of_boxes(node: &Node) -> ([f32; 3], [f32; 3]) {
    let low = |axis: usize| node.bounds[axis][0].iter().fold(f32::INFINITY, |a, &b| a.min(b));
    let high = |axis: usize| node.bounds[axis][1].iter().fold(f32::NEG_INFINITY, |a, &b| a.max(b));
    (std::array::from_fn(low), std::array::from_fn(high))
}

/// SAH cost of a random ray that intersects the root's bounds: nodes and leaf blocks of `block`
/// items, each at cost 1.
pub(super) fn sah_cost(nodes: &[Node], block: usize) -> f64 {
    let cost = |node: &Node| -> f64 {
        let blocks = |child: Child| if child.is_leaf() { child.items().len().div_ceil(block) } else { 1 };
        (0..node.count as usize).map(|slot| half_area(node, slot) * blocks(node.children[slot]) as f64).sum()
    };
    let chunks: Vec<f64> = nodes.par_chunks(CHUNK).map(|nodes| nodes.iter().map(cost).sum()).collect();
    let root = nodes.first().map_or(0.0, |root| {
        let (low, high) = union_of_boxes(root);
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
