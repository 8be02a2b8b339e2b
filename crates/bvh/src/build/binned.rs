//! Top-down construction by the binned surface-area heuristic. Large sets are binned and
//! partitioned by several threads, small sets are independent tasks. The choice depends on counts
//! only, so the tree is the same for any number of threads.

use super::binary::{BinaryNode, Subtree};
use super::bins::{Bins, BlockShift, Mapping, ObjectSplit, SideTest};
use super::item::{Item, Items, SetBounds};
use super::partition;
use crate::pages::Pages;
use juggler_math::{BuildControl, Cancelled};
use rayon::prelude::*;

/// Depth from which sets are split at the median, so that no tree exceeds 72 levels.
pub(super) const SAH_DEPTH: usize = 44;
/// Maximum size of a set that one thread builds.
pub(super) const TASK: usize = 1 << 14;
/// Chunk size for parallel loops over larger sets.
pub(super) const CHUNK: usize = 1 << 13;

/// Parameters of the surface-area heuristic.
#[derive(Clone, Copy)]
pub(super) struct Settings<'c> {
    pub leaf_size: usize,
    pub block: BlockShift,
    /// Cost of a node test in units of the cost of one leaf block test.
    pub node_cost: f32,
    /// Sets up to this size are halved in their present order: the collapse mostly merges them into
    /// one wide node.
    pub split_in_order_size: usize,
    /// Ends the build between subtrees.
    pub control: &'c BuildControl,
}

impl<'c> Settings<'c> {
    /// Settings of a tree over clusters, in whose leaves single clusters lie.
    pub fn of_clusters(control: &'c BuildControl) -> Self {
        Self { leaf_size: 1, block: BlockShift(0), node_cost: 0.0, split_in_order_size: 4, control }
    }

    /// Whether a split is cheaper than a leaf. Boxes without area have a cost of NaN and become
    /// leaves.
    pub fn pays(&self, count: usize, cost: f32) -> bool {
        let blocks = self.block.block_count(wide::i32x4::splat(count as i32)).to_array()[0];
        self.node_cost + cost < blocks
    }
}

/// Builds the binary tree, empty without items, and the item indices in leaf order.
pub(super) fn build(mut items: Items, settings: &Settings) -> Result<(Pages<BinaryNode>, Vec<u32>), Cancelled> {
    let extents = items.extents;
    if items.count == 0 {
        return Ok((Pages::zeroed(0), Vec::new()));
    }
    let mut order = vec![0; items.count];
    let set = Set { items: items.list(), order: &mut order, first: 0, extents, depth: 0 };
    let tree = subtree(set, settings)?;
    Ok((tree.into_nodes(), order))
}

/// A set of items to build a subtree over: the items, the output for item indices in leaf order, the
/// position of the first item in leaf order, bounds, and depth.
pub(super) struct Set<'a> {
    pub items: &'a mut [Item],
    pub order: &'a mut [u32],
    pub first: usize,
    pub extents: SetBounds,
    pub depth: usize,
}

impl<'a> Set<'a> {
    /// Splits the set after the items were partitioned.
    fn halves(self, left: usize, extents: [SetBounds; 2]) -> [Self; 2] {
        let (items, order) = (self.items.split_at_mut(left), self.order.split_at_mut(left));
        let (depth, [a, b]) = (self.depth + 1, extents);
        [
            Set { items: items.0, order: order.0, first: self.first, extents: a, depth },
            Set { items: items.1, order: order.1, first: self.first + left, extents: b, depth },
        ]
    }
}

/// Builds the subtree over a set of at least one item.
pub(super) fn subtree<'a>(set: Set<'a>, settings: &Settings) -> Result<Subtree<'a>, Cancelled> {
    settings.control.check()?;
    if set.items.len() <= TASK {
        settings.control.advance(set.items.len());
        return Ok(build_sequentially(set, settings));
    }
    let bounds = set.extents.bounds;
    let (left, extents) = split_large(&mut *set.items, &set.extents, set.depth, settings)?;
    let [left, right] = set.halves(left, extents);
    let (left, right) = rayon::join(|| subtree(left, settings), || subtree(right, settings));
    Ok(Subtree::join(bounds, left?, right?))
}

/// Partitions the items, left side first. Returns the size of the left side and the bounds of both
/// sides.
fn split_large(
    items: &mut [Item],
    extents: &SetBounds,
    depth: usize,
    settings: &Settings,
) -> Result<(usize, [SetBounds; 2]), Cancelled> {
    let mapping = Mapping::new(extents.centers, items.len()).filter(|_| depth < SAH_DEPTH);
    let found = mapping.map(|mapping| {
        let all = bins_of_large(items, &mapping, settings)?;
        Ok(all.best(&mapping, extents.bounds, settings.block).map(|split| (mapping, all, split)))
    });
    let Some((mapping, bins, split)) = found.transpose()?.flatten() else { return Ok(split_at_median(items, extents)) };
    let [a, b] = bins.sides(&mapping, &split);
    let (left, [c, d]) = partition::in_place_parallel(items, CHUNK, &SideTest::new(&mapping, &split));
    Ok((left, [SetBounds { bounds: a, centers: c }, SetBounds { bounds: b, centers: d }]))
}

/// Bins of a large set, by several threads.
fn bins_of_large(items: &[Item], mapping: &Mapping, settings: &Settings) -> Result<Bins, Cancelled> {
    let bins = |items| {
        let mut bins = Bins::EMPTY;
        // The largest sets take long.
        if !settings.control.is_cancelled() {
            bins.fill(mapping, items);
        }
        bins
    };
    let chunks: Vec<Bins> = items.par_chunks(CHUNK).map(bins).collect();
    settings.control.check()?;
    let mut all = Bins::EMPTY;
    chunks.iter().for_each(|bins| all.merge(bins, mapping));
    Ok(all)
}

/// Splits at the median center along the longest axis; equal centers are ordered by item index.
fn split_at_median(items: &mut [Item], extents: &SetBounds) -> (usize, [SetBounds; 2]) {
    let axis = extents.centers.longest_axis();
    let middle = items.len() / 2;
    if extents.centers.low.as_array()[axis] < extents.centers.high.as_array()[axis] {
        let center = |item: &Item| item.center().to_array()[axis];
        let order = |a: &Item, b: &Item| center(a).total_cmp(&center(b)).then(a.number().cmp(&b.number()));
        items.select_nth_unstable_by(middle, order);
    }
    split_in_order(items)
}

/// Splits into two halves in the present order.
fn split_in_order(items: &[Item]) -> (usize, [SetBounds; 2]) {
    let (left, right) = items.split_at(items.len() / 2);
    (left.len(), [SetBounds::from_items(left), SetBounds::from_items(right)])
}

fn build_sequentially<'a>(set: Set<'a>, settings: &Settings) -> Subtree<'a> {
    let Set { items, order, first, extents, depth, .. } = set;
    let mut task = Task::new(settings);
    task.nodes.reserve(items.len() / 2);
    let root = task.grow(items, first, &extents, depth);
    write_order(order, items);
    // The items are no longer needed.
    Subtree::new(root, task.nodes).moved_to(bytemuck::cast_slice_mut(items))
}

/// Writes the item indices in leaf order.
pub(super) fn write_order(order: &mut [u32], items: &[Item]) {
    for (place, item) in order.iter_mut().zip(items) {
        *place = item.number();
    }
}

/// State of a sequential build.
pub(super) struct Task<'a> {
    settings: &'a Settings<'a>,
    /// Bins of the last call of [`Task::find_object_split`].
    pub bins: Bins,
    pub nodes: Vec<BinaryNode>,
}

impl<'a> Task<'a> {
    pub fn new(settings: &'a Settings<'a>) -> Self {
        Self { settings, bins: Bins::EMPTY, nodes: Vec::new() }
    }

    /// Builds a subtree. Returns its root and appends the nodes below it.
    pub fn grow(&mut self, items: &mut [Item], first: usize, extents: &SetBounds, depth: usize) -> BinaryNode {
        let Some((left, child_extents)) = self.split(items, extents, depth) else {
            return BinaryNode::new(extents.bounds, first, items.len());
        };
        let place = self.nodes.len();
        let root = BinaryNode::new(extents.bounds, place, 0);
        self.nodes.extend([root; 2]);
        let (left_items, right_items) = items.split_at_mut(left);
        self.nodes[place] = self.grow(left_items, first, &child_extents[0], depth + 1);
        self.nodes[place + 1] = self.grow(right_items, first + left, &child_extents[1], depth + 1);
        root
    }

    /// Partitions the items, left side first; `None` for a leaf.
    fn split(&mut self, items: &mut [Item], extents: &SetBounds, depth: usize) -> Option<(usize, [SetBounds; 2])> {
        let count = items.len();
        if count <= 1 {
            return None;
        }
        if count <= self.settings.split_in_order_size {
            return Some(split_in_order(items));
        }
        let found = self.find_object_split(items, extents, depth);
        if count <= self.settings.leaf_size {
            let (_, split) = found?;
            if !self.settings.pays(count, split.cost) {
                return None;
            }
        }
        Some(self.partition(items, extents, found))
    }

    /// Partitions the items at the split that [`Task::find_object_split`] found, left side first;
    /// at the median without a split.
    pub fn partition(
        &self,
        items: &mut [Item],
        extents: &SetBounds,
        found: Option<(Mapping, ObjectSplit)>,
    ) -> (usize, [SetBounds; 2]) {
        let Some((mapping, split)) = found else { return split_at_median(items, extents) };
        let [a, b] = self.bins.sides(&mapping, &split);
        let (left, [c, d]) = partition::in_place(items, &SideTest::new(&mapping, &split));
        (left, [SetBounds { bounds: a, centers: c }, SetBounds { bounds: b, centers: d }])
    }

    /// Finds the split of the lowest cost.
    pub fn find_object_split(
        &mut self,
        items: &[Item],
        extents: &SetBounds,
        depth: usize,
    ) -> Option<(Mapping, ObjectSplit)> {
        let mapping = Mapping::new(extents.centers, items.len()).filter(|_| depth < SAH_DEPTH)?;
        self.bins.fill(&mapping, items);
        let split = self.bins.best(&mapping, extents.bounds, self.settings.block)?;
        Some((mapping, split))
    }
}
