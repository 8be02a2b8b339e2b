//! Top-down construction with spatial splits (Stich, Friedrich, Dietrich 2009, "Spatial Splits in
//! Bounding Volume Hierarchies"): where the boxes of both sides of an object split overlap, a plane
//! may split space instead. Both sides then refer to the items that cross the plane, each with the
//! box of the clipped item.
//!
//! Deviations: spatial splits are tried where the overlap is large relative to the node, not to the
//! root, and taken only where they are much cheaper. The number of added references is bounded, and
//! each subtree gets its budget beforehand. Reference unsplitting uses the bounds of the bins and
//! not those of the references so far. So the tree is the same for any number of threads.

use super::MAX_ITEMS;
use super::binary::{BinaryNode, Subtree};
use super::binned::{self, CHUNK, Settings, TASK, Task};
use super::bins::{Mapping, ObjectSplit};
use super::item::{Item, Items, SetBounds, SimdBox};
use super::reinsert::relist;
use super::spatial_bins::{SpatialBins, SpatialSplit, half_area};
use crate::pages::Pages;
use juggler_math::Cancelled;
use rayon::prelude::*;

/// At most one reference is added per this many items.
const SHARE: usize = 4;
/// Spatial splits are tried where the overlap of both sides exceeds this fraction of the node's
/// area.
const OVERLAP: f64 = 0.5;
/// A spatial split must cost less than this fraction of the best object split. Smaller gains are
/// lost again, since subtrees with split references gain less from reinsertion (`reinsert.rs`).
const GAIN: f32 = 0.8;

/// Clipping of items at planes.
pub(crate) trait ItemSplitter: Sync {
    /// Boxes of the parts of an item below and above the plane at coordinate `at` of `axis`,
    /// clipped to `bounds`; empty where there is no part.
    fn split(&self, item: u32, bounds: SimdBox, axis: usize, at: f32) -> [SimdBox; 2];
}

/// Builds the binary tree, empty without items, and the item indices in leaf order, some more than
/// once.
pub(super) fn build(
    mut items: Items,
    settings: &Settings,
    splitter: &impl ItemSplitter,
) -> Result<(Pages<BinaryNode>, Vec<u32>), Cancelled> {
    let extents = items.extents;
    let items = items.list().to_vec();
    if items.is_empty() {
        return Ok((Pages::zeroed(0), Vec::new()));
    }
    let budget = (items.len() / SHARE).min(MAX_ITEMS - items.len());
    let mut order = vec![0; items.len() + budget];
    let builder = Builder { settings, splitter };
    let set = Set { items, budget, order: &mut order, first: 0, extents, depth: 0 };
    let nodes = builder.subtree(set)?.into_nodes();
    // Close the gaps where subtrees used fewer references than their budget.
    relist(&nodes, &order, settings.control)
}

/// References to build a subtree over: `budget` is the number that may be added, `order` the output
/// in leaf order with room for these, `first` the position of its first entry.
struct Set<'a> {
    items: Vec<Item>,
    budget: usize,
    order: &'a mut [u32],
    first: usize,
    extents: SetBounds,
    depth: usize,
}

impl<'a> Set<'a> {
    fn leaf(&self) -> BinaryNode {
        BinaryNode::new(self.extents.bounds, self.first, self.items.len())
    }

    /// Splits the set; the remaining budget is divided in proportion to the areas.
    fn sides(order: &'a mut [u32], first: usize, depth: usize, sides: [Side; 2]) -> [Self; 2] {
        let [left, right] = sides;
        let budget = order.len() - left.items.len() - right.items.len();
        let [a, b] = [&left, &right].map(|side| half_area(side.extents.bounds));
        let left_budget = ((budget as f64 * (a / (a + b))) as usize).min(budget);
        let (places, others) = order.split_at_mut(left.items.len() + left_budget);
        let second = first + places.len();
        [
            Self { items: left.items, budget: left_budget, order: places, first, extents: left.extents, depth },
            Self {
                items: right.items,
                budget: budget - left_budget,
                order: others,
                first: second,
                extents: right.extents,
                depth,
            },
        ]
    }
}

/// References on one side of a split, with their bounds.
struct Side {
    items: Vec<Item>,
    extents: SetBounds,
}

impl Side {
    const EMPTY: Self = Self { items: Vec::new(), extents: SetBounds::EMPTY };

    fn push(&mut self, item: Item) {
        self.extents = self.extents.with(&item);
        self.items.push(item);
    }

    fn append(&mut self, mut other: Self) {
        self.items.append(&mut other.items);
        self.extents = self.extents.union(other.extents);
    }
}

struct Builder<'a, D> {
    settings: &'a Settings<'a>,
    splitter: &'a D,
}

impl<D: ItemSplitter> Builder<'_, D> {
    /// Builds the subtree over a set of at least one reference.
    fn subtree(&self, set: Set<'_>) -> Result<Subtree<'static>, Cancelled> {
        self.settings.control.check()?;
        let mut task = Task::new(self.settings);
        if set.items.len() <= TASK {
            let root = self.grow(set, &mut task);
            return Ok(Subtree::new(root, task.nodes));
        }
        if set.budget == 0 {
            let Set { mut items, order, first, extents, depth, .. } = set;
            let set = binned::Set { items: &mut items, order, first, extents, depth };
            return Ok(binned::subtree(set, self.settings)?.into_owned());
        }
        let (bounds, leaf) = (set.extents.bounds, set.leaf());
        match self.split(set, &mut task) {
            None => Ok(Subtree::new(leaf, Vec::new())),
            Some([left, right]) => {
                let (left, right) = rayon::join(|| self.subtree(left), || self.subtree(right));
                Ok(Subtree::join(bounds, left?, right?))
            }
        }
    }

    /// Builds a subtree. Returns its root and appends the nodes below it to the task.
    fn grow(&self, mut set: Set<'_>, task: &mut Task) -> BinaryNode {
        if set.budget == 0 {
            let root = task.grow(&mut set.items, set.first, &set.extents, set.depth);
            binned::write_order(set.order, &set.items);
            return root;
        }
        let (bounds, leaf) = (set.extents.bounds, set.leaf());
        match self.split(set, task) {
            None => leaf,
            Some([left, right]) => {
                let place = task.nodes.len();
                let root = BinaryNode::new(bounds, place, 0);
                task.nodes.extend([root; 2]);
                task.nodes[place] = self.grow(left, task);
                task.nodes[place + 1] = self.grow(right, task);
                root
            }
        }
    }

    /// Splits a set by an object or a spatial split; `None` for a leaf.
    fn split<'s>(&self, mut set: Set<'s>, task: &mut Task) -> Option<[Set<'s>; 2]> {
        let count = set.items.len();
        let found = task.find_object_split(&set.items, &set.extents, set.depth);
        let pays = || found.as_ref().is_some_and(|(_, split)| self.settings.pays(count, split.cost));
        if count <= self.settings.leaf_size && (count == 1 || !pays()) {
            binned::write_order(set.order, &set.items);
            return None;
        }
        let spatial = self.find_spatial_split(&set, found.as_ref(), task);
        let sides =
            spatial.and_then(|plane| self.partition(&set.items, &plane, set.order.len())).unwrap_or_else(|| {
                let (left, [a, b]) = task.partition(&mut set.items, &set.extents, found);
                let right = set.items.split_off(left);
                [Side { items: set.items, extents: a }, Side { items: right, extents: b }]
            });
        Some(Set::sides(set.order, set.first, set.depth + 1, sides))
    }

    /// Finds a spatial split that is much cheaper than the object split `found`.
    fn find_spatial_split(
        &self,
        set: &Set,
        found: Option<&(Mapping, ObjectSplit)>,
        task: &Task,
    ) -> Option<SpatialSplit> {
        if set.items.len() <= self.settings.leaf_size {
            return None;
        }
        let (mapping, split) = found?;
        let [left, right] = task.bins.sides(mapping, split);
        if half_area(left.intersection(right)) <= half_area(set.extents.bounds) * OVERLAP {
            return None;
        }
        let bins = set.items.par_chunks(CHUNK).map(|items| {
            let mut bins = SpatialBins::new(set.extents.bounds, set.items.len());
            items.iter().for_each(|item| bins.add(item, self.splitter));
            bins
        });
        let best = bins.reduce_with(|a, b| a.merged(&b))?.best(set.order.len(), self.settings.block)?;
        (best.cost < split.cost * GAIN).then_some(best)
    }

    /// Partitions the references at a plane; `None` if a side is empty or the budget is exceeded,
    /// which may happen since bins and planes are rounded differently.
    fn partition(&self, items: &[Item], plane: &SpatialSplit, most: usize) -> Option<[Side; 2]> {
        let parts = |items: &[Item]| {
            let mut sides = [Side::EMPTY, Side::EMPTY];
            for item in items {
                for (side, part) in sides.iter_mut().zip(plane.references(item, self.splitter)) {
                    part.into_iter().for_each(|part| side.push(part));
                }
            }
            sides
        };
        let chunks: Vec<[Side; 2]> = items.par_chunks(CHUNK).map(parts).collect();
        let mut sides = [Side::EMPTY, Side::EMPTY];
        for chunk in chunks {
            sides.iter_mut().zip(chunk).for_each(|(side, part)| side.append(part));
        }
        let [left, right] = [0, 1].map(|side: usize| sides[side].items.len());
        (left > 0 && right > 0 && left + right <= most).then_some(sides)
    }
}
