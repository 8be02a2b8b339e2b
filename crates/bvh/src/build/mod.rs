//! Construction: the binned surface-area heuristic builds a binary tree, which is then collapsed to
//! eight children per node.

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
mod spatial;
mod spatial_bins;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;

use crate::Bvh;
use crate::node::{LEAF_MAX, Node};
use crate::pages::Pages;
use binary::BinaryNode;
use binned::Settings;
use bins::BlockShift;
pub(crate) use item::{Items, SimdBox};
use juggler_math::{Aabb, BuildControl, Cancelled};
pub use refit::RefitError;
pub(crate) use refit::{checked_box, refit};
pub(crate) use spatial::ItemSplitter;
use std::convert::Infallible;

/// Maximum number of items in a tree.
pub const MAX_ITEMS: usize = 1 << 28;

/// Cost of a node test of the binary tree, in units of one leaf block test. Below 1, since a binary
/// node becomes a seventh to a half of an eight-wide node. Traversal times are equal for values
/// from 0.2 to 1.2.
const NODE_COST: f32 = 0.5;

/// In each round of optimization, one of this many nodes is a candidate for reinsertion.
const SHARE_BALANCED: usize = 128;
const SHARE_BEST: usize = 4;

/// Build quality. The same boxes and quality always give the same tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// Leaves along a Morton curve with a binned SAH tree above them: for trees that live for one
    /// frame.
    Fast,
    /// Binned SAH with up to 32 bins per axis, then reinsertion of the largest subtrees.
    #[default]
    Balanced,
    // Splitting large triangles before the build (Karras, Aila 2013) was tried: with 25 % more
    // references the SAH cost fell by 5 % for hair and rose by 3 to 13 % elsewhere.
    /// As balanced with many more reinsertions. For triangles, a tree with spatial splits is built
    /// too, in which several leaves may refer to a triangle, and the cheaper tree is kept. For
    /// trees that live for minutes.
    Best,
}

impl Quality {
    /// All qualities, from fast to thorough.
    pub const ALL: [Self; 3] = [Self::Fast, Self::Balanced, Self::Best];
}

/// Parameters of a build.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuildOptions {
    /// Build quality.
    pub quality: Quality,
    /// Maximum number of items in a leaf, 1 to 8.
    pub leaf_size: usize,
    /// Number of items that the leaf visitor tests at the cost of one, 1 to 8, rounded up to a
    /// power of two.
    pub block: usize,
}

impl BuildOptions {
    fn settings<'c>(&self, control: &'c BuildControl) -> Settings<'c> {
        let block = self.block.clamp(1, LEAF_MAX).next_power_of_two();
        let leaf_size = self.leaf_size.clamp(1, LEAF_MAX);
        Settings {
            leaf_size,
            block: BlockShift(block.trailing_zeros() as i32),
            node_cost: NODE_COST,
            split_in_order_size: 0,
            control,
        }
    }
}

impl From<Quality> for BuildOptions {
    /// Leaves of up to 8 items that are tested one by one.
    fn from(quality: Quality) -> Self {
        Self { quality, leaf_size: 8, block: 1 }
    }
}

/// Statistics of a build.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BuildStats {
    /// Items in the tree.
    pub items: usize,
    /// Item references in leaves: as many as items, or more after spatial splits.
    pub references: usize,
    /// Items left out because no ray can intersect their boxes, which are empty or have a NaN.
    pub left_out: usize,
    /// Number of nodes, 256 bytes each.
    pub nodes: usize,
    /// Number of nodes on the longest path from the root to a leaf.
    pub depth: usize,
    /// Histogram: `leaf_sizes[n]` leaves hold `n` references.
    pub leaf_sizes: [usize; 9],
    /// SAH cost: expected number of node and leaf block tests of a random ray (MacDonald, Booth
    /// 1990).
    pub sah_cost: f64,
    /// Maximum number of entries on a traversal's stack.
    pub(crate) stack: usize,
    /// Number of items per leaf block.
    pub(crate) block: usize,
}

impl Bvh {
    /// Builds a hierarchy over boxes; item `i` has box `i`. Uses the threads of the current rayon
    /// pool; the result does not depend on their number.
    ///
    /// Empty boxes and boxes with a NaN are left out of [`Bvh::order`]. Infinite bounds are clamped
    /// to the largest finite number. Boxes beyond [`MAX_ITEMS`] are ignored; the caller must reject
    /// larger inputs. A list of boxes given by value is freed before the tree is built.
    pub fn build(boxes: impl AsRef<[Aabb]>, quality: Quality) -> Self {
        Self::build_with(boxes, &quality.into())
    }

    /// [`Bvh::build`] with explicit [`BuildOptions`].
    pub fn build_with(boxes: impl AsRef<[Aabb]>, options: &BuildOptions) -> Self {
        // Nothing cancels this control.
        Self::build_with_control(boxes, options, &BuildControl::default()).unwrap_or_else(|Cancelled| Self::empty())
    }

    /// [`Bvh::build_with`], which ends early if `control` is cancelled, and reports its progress to
    /// it.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] if `control` is cancelled.
    pub fn build_with_control(
        boxes: impl AsRef<[Aabb]>,
        options: &BuildOptions,
        control: &BuildControl,
    ) -> Result<Self, Cancelled> {
        control.check()?;
        let list = boxes.as_ref();
        let list = &list[..list.len().min(MAX_ITEMS)];
        let Ok(items) = Items::new(list.len(), |i| Ok::<_, Infallible>(SimdBox::raw(&list[i])));
        drop(boxes);
        Self::from_items(items, options, control)
    }

    /// Hierarchy over no items.
    fn empty() -> Self {
        let nodes = vec![Node::EMPTY].into();
        let stats = BuildStats { nodes: 1, depth: 1, block: 1, ..BuildStats::default() };
        Self { nodes, order: Vec::new(), bounds: Aabb::EMPTY, stats, level: fearless_simd::Level::new() }
    }

    pub(crate) fn from_items(items: Items, options: &BuildOptions, control: &BuildControl) -> Result<Self, Cancelled> {
        let (settings, left_out, count) = (options.settings(control), items.left_out, items.count);
        // The rest costs about as much as the binary tree.
        control.expect(2 * count);
        let built = match options.quality {
            Quality::Fast => morton::build(items, settings.leaf_size, control)?,
            Quality::Balanced => reinsert::optimize(binned::build(items, &settings)?, SHARE_BALANCED, control)?,
            Quality::Best => reinsert::optimize(binned::build(items, &settings)?, SHARE_BEST, control)?,
        };
        let bvh = Self::from_binary(built, &settings, left_out)?;
        control.advance(count);
        Ok(bvh)
    }

    /// [`Bvh::from_items`] with spatial splits and the best quality, whatever `options` says;
    /// several leaves may refer to an item.
    pub(crate) fn with_spatial_splits(
        items: Items,
        options: &BuildOptions,
        splitter: &impl ItemSplitter,
        control: &BuildControl,
    ) -> Result<Self, Cancelled> {
        let (settings, left_out, count) = (options.settings(control), items.left_out, items.count);
        let built = reinsert::optimize(spatial::build(items, &settings, splitter)?, SHARE_BEST, control)?;
        let mut bvh = Self::from_binary(built, &settings, left_out)?;
        bvh.stats.items = count;
        Ok(bvh)
    }

    fn from_binary(
        (binary, order): (Pages<BinaryNode>, Vec<u32>),
        settings: &Settings,
        left_out: usize,
    ) -> Result<Self, Cancelled> {
        let (nodes, mut stats) = collapse::collapse(&binary, settings)?;
        (stats.items, stats.references) = (order.len(), order.len());
        stats.left_out = left_out;
        let bounds = binary.first().map_or(Aabb::EMPTY, BinaryNode::aabb);
        Ok(Self { nodes, order, bounds, stats, level: fearless_simd::Level::new() })
    }
}
