//! From boxes to a tree: binned surface-area heuristic to a binary tree, then collapsed to eight wide.

mod binary;
mod binned;
mod bins;
mod collapse;
mod item;
mod morton;
mod partition;
mod plan;
mod refit;
mod reinsert;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;

use crate::Bvh;
use crate::node::LEAF_MAX;
use crate::pages::Pages;
use binary::BinaryNode;
use binned::Settings;
use bins::Blocks;
pub(crate) use item::{Extent, Items};
use juggler_math::Aabb;
pub use refit::RefitError;
pub(crate) use refit::{extent, refit};
use std::convert::Infallible;

/// Most items that a tree can hold.
pub const MAX_ITEMS: usize = 1 << 28;

/// The test of a node of the binary tree in units of one leaf block's test. Below 1, because it is a seventh
/// to a half of an eight-wide one. Rays take the same time for anything from 0.2 to 1.2.
const NODE_COST: f32 = 0.5;

/// Of so many nodes one is tried to be moved, each time that the tree is made better.
const SHARE_BALANCED: usize = 128;
const SHARE_BEST: usize = 4;

/// How much work goes into a tree. The same boxes and quality always give the same tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// Leaves along a space-filling curve, bins above them: for trees that live for a frame.
    Fast,
    /// Up to 32 bins along each axis at every node; then the largest subtrees are moved to better places.
    #[default]
    Balanced,
    // Splitting large triangles beforehand (Karras, Aila 2013) was tried: with 25 % more references the cost fell
    // by 5 % for hair, rose by 3 to 13 % elsewhere.
    /// As balanced, and many more subtrees are tried: for trees that live for minutes.
    Best,
}

impl Quality {
    /// All of them, from quick to thorough.
    pub const ALL: [Self; 3] = [Self::Fast, Self::Balanced, Self::Best];
}

/// What decides the shape of a tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuildOptions {
    /// How thoroughly to look for splits.
    pub quality: Quality,
    /// Most items in a leaf, 1 to 8.
    pub leaf_size: usize,
    /// How many items the leaf visitor tests for the price of one, 1 to 8.
    pub block: usize,
}

impl From<Quality> for BuildOptions {
    /// Leaves of up to 8 items that are tested one by one.
    fn from(quality: Quality) -> Self {
        Self { quality, leaf_size: 8, block: 1 }
    }
}

/// What came out of a build.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BuildStats {
    /// Boxes in the tree.
    pub items: usize,
    /// Boxes left out because no ray can meet them: empty ones and those with a NaN.
    pub left_out: usize,
    /// Nodes of 256 bytes.
    pub nodes: usize,
    /// Nodes on the longest way from the root to a leaf.
    pub depth: usize,
    /// `leaf_sizes[n]` leaves hold `n` items.
    pub leaf_sizes: [usize; 9],
    /// Expected cost of a random ray: nodes and leaf blocks tested, each counted as one (MacDonald, Booth 1990).
    pub sah_cost: f64,
    /// Entries that a traversal's stack may need.
    pub(crate) stack: usize,
    /// How many items are tested for the price of one.
    pub(crate) block: usize,
}

impl Bvh {
    /// Builds a tree over the boxes; item `i` has box `i`. Runs on the threads of the current rayon pool;
    /// the tree does not depend on their number.
    ///
    /// Empty boxes and boxes with a NaN hold nothing that a ray could meet and are left out of
    /// [`Bvh::order`]. Infinite bounds are cut to the largest finite float. At most [`MAX_ITEMS`] boxes are
    /// taken; a caller with more must refuse them before.
    pub fn build(boxes: &[Aabb], quality: Quality) -> Self {
        Self::build_with(boxes, &quality.into())
    }

    /// [`Bvh::build`] with the leaf's size and cost chosen.
    pub fn build_with(boxes: &[Aabb], options: &BuildOptions) -> Self {
        let boxes = &boxes[..boxes.len().min(MAX_ITEMS)];
        let Ok(items) = Items::new(boxes.len(), |i| Ok::<_, Infallible>(boxes[i]));
        Self::over(items, options)
    }

    pub(crate) fn over(items: Items, options: &BuildOptions) -> Self {
        let block = options.block.clamp(1, LEAF_MAX).next_power_of_two();
        let leaf_size = options.leaf_size.clamp(1, LEAF_MAX);
        let block_bits = Blocks(block.trailing_zeros() as i32);
        let settings = Settings { leaf_size, block: block_bits, node_cost: NODE_COST, careless: 0 };
        let left_out = items.left_out;
        let (binary, order) = match options.quality {
            Quality::Fast => morton::build(items, leaf_size),
            Quality::Balanced => reinsert::optimize(binned::build(items, &settings), SHARE_BALANCED),
            Quality::Best => reinsert::optimize(binned::build(items, &settings), SHARE_BEST),
        };
        let (nodes, mut stats) = collapse::collapse(&binary, leaf_size, block);
        stats.items = order.len();
        stats.left_out = left_out;
        let bounds = binary.first().map_or(Aabb::EMPTY, BinaryNode::aabb);
        Self { nodes, motion: Pages::zeroed(0), order, bounds, stats, level: fearless_simd::Level::new() }
    }
}
