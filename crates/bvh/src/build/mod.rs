//! From boxes to a tree: binned surface-area heuristic to a binary tree, then collapsed to eight wide.

mod binned;
mod collapse;

use crate::Bvh;
use fearless_simd::Level;
use crate::node::Child;
use juggler_math::{Aabb, Vec3};
use std::ops::Range;

/// Most items that a tree can hold.
pub const MAX_ITEMS: usize = 1 << 28;

/// How much work goes into a tree. The same boxes and quality always give the same tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// Eight bins along the longest axis: for trees that live for a frame.
    Fast,
    /// Sixteen bins along each axis.
    #[default]
    Balanced,
    /// Thirty-two bins, and every split of small sets looked at.
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
}

/// An item on its way into the tree.
#[derive(Clone, Copy)]
struct Item {
    bounds: Aabb,
    index: u32,
}

impl Item {
    fn center(&self, axis: usize) -> f32 {
        self.bounds.min[axis] * 0.5 + self.bounds.max[axis] * 0.5
    }
}

/// A node of the binary tree: a leaf of `count` items from `first`, or (`count` zero) the parent of the
/// nodes `first` and `first + 1`.
struct BinaryNode {
    bounds: Aabb,
    first: usize,
    count: usize,
}

/// Half the surface area. In double precision, so that boxes of any finite size can be compared.
fn half_area(bounds: &Aabb) -> f64 {
    let side = |axis: usize| (f64::from(bounds.max[axis]) - f64::from(bounds.min[axis])).max(0.0);
    side(0) * side(1) + side(1) * side(2) + side(2) * side(0)
}

impl Bvh {
    /// Builds a tree over the boxes; item `i` has box `i`.
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
        let mut items = items_of(boxes);
        let options = BuildOptions {
            leaf_size: options.leaf_size.clamp(1, crate::node::LEAF_MAX),
            block: options.block.clamp(1, crate::node::LEAF_MAX),
            ..*options
        };
        let binary = binned::build(&mut items, &options);
        let (nodes, mut stats) = collapse::collapse(&binary, options.block);
        stats.items = items.len();
        stats.left_out = boxes.len() - items.len();
        let order = items.iter().map(|item| item.index).collect();
        let bounds = binary.first().map_or(Aabb::EMPTY, |root| root.bounds);
        Self { nodes, order, bounds, stats, level: if std::env::var("LV").is_ok() { Level::Avx2(Level::new().as_avx2().unwrap()) } else { Level::new() } }
    }

    /// The tree with each leaf's range starting at the number of the leaf instead of a position; beside it
    /// the ranges that the leaves had, and the order, which the tree has no more use for.
    pub(crate) fn with_numbered_leaves(mut self) -> (Self, Vec<Range<u32>>, Vec<u32>) {
        let mut leaves = Vec::new();
        for node in &mut self.nodes {
            for child in node.children[..node.count as usize].iter_mut().filter(|child| child.is_leaf()) {
                let items = child.items();
                *child = Child::leaf(leaves.len(), items.len());
                leaves.push(items);
            }
        }
        let order = std::mem::take(&mut self.order);
        (self, leaves, order)
    }
}

fn items_of(boxes: &[Aabb]) -> Vec<Item> {
    let largest = Vec3::splat(f32::MAX);
    let usable = |b: &Aabb| b.min.cmple(b.max).all();
    let cut = |b: &Aabb| Aabb { min: b.min.clamp(-largest, largest), max: b.max.clamp(-largest, largest) };
    let numbered = boxes.iter().zip(0u32..).filter(|(b, _)| usable(b));
    numbered.map(|(b, index)| Item { bounds: cut(b), index }).collect()
}
