//! From boxes to a tree: binned surface-area heuristic to a binary tree, then collapsed to eight wide.

mod binary;
mod binned;
mod bins;
mod collapse;
mod item;
mod morton;
mod partition;
mod plan;
mod planes;
mod refit;
mod reinsert;
mod spatial;
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
pub(crate) use spatial::Divide;
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
    /// As balanced, and many more subtrees are tried; of triangles also a tree with spatial splits, where a triangle may
    /// stand in several leaves, and the cheaper of the two is kept. For trees that live for minutes.
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

impl BuildOptions {
    fn settings(&self) -> Settings {
        let block = self.block.clamp(1, LEAF_MAX).next_power_of_two();
        let leaf_size = self.leaf_size.clamp(1, LEAF_MAX);
        Settings { leaf_size, block: Blocks(block.trailing_zeros() as i32), node_cost: NODE_COST, careless: 0 }
    }
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
    /// Items in the tree.
    pub items: usize,
    /// Places in leaves: as many as items, or more where items stand in several leaves.
    pub references: usize,
    /// Items left out because no ray can meet their boxes: empty ones and those with a NaN.
    pub left_out: usize,
    /// Nodes of 256 bytes.
    pub nodes: usize,
    /// Nodes on the longest way from the root to a leaf.
    pub depth: usize,
    /// `leaf_sizes[n]` leaves hold `n` references.
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
        let Ok(items) = Items::new(boxes.len(), |i| Ok::<_, Infallible>(Extent::raw(&boxes[i])));
        Self::over(items, options)
    }

    pub(crate) fn over(items: Items, options: &BuildOptions) -> Self {
        let (settings, left_out) = (options.settings(), items.left_out);
        let built = match options.quality {
            Quality::Fast => morton::build(items, settings.leaf_size),
            Quality::Balanced => reinsert::optimize(binned::build(items, &settings), SHARE_BALANCED),
            Quality::Best => reinsert::optimize(binned::build(items, &settings), SHARE_BEST),
        };
        Self::of_binary(built, &settings, left_out)
    }

    /// [`Bvh::over`], in best quality whatever is asked for; items may stand in several leaves.
    pub(crate) fn divided(items: Items, options: &BuildOptions, divide: &impl Divide) -> Self {
        let (settings, left_out, count) = (options.settings(), items.left_out, items.count);
        let built = reinsert::optimize(spatial::build(items, &settings, divide), SHARE_BEST);
        let mut bvh = Self::of_binary(built, &settings, left_out);
        bvh.stats.items = count;
        bvh
    }

    fn of_binary((binary, order): (Pages<BinaryNode>, Vec<u32>), settings: &Settings, left_out: usize) -> Self {
        let (nodes, mut stats) = collapse::collapse(&binary, settings.leaf_size, 1 << settings.block.0);
        (stats.items, stats.references) = (order.len(), order.len());
        stats.left_out = left_out;
        let bounds = binary.first().map_or(Aabb::EMPTY, BinaryNode::aabb);
        Self { nodes, order, bounds, stats, level: fearless_simd::Level::new() }
    }
}
