//! Top-down construction by the surface-area heuristic with bins. Large sets are binned and parted by
//! several threads, small ones are tasks of their own; which is which depends on the counts alone, so the
//! tree is the same on any number of threads.

use super::binary::{BinaryNode, Subtree};
use super::bins::{Bins, Blocks, Cut, Mapping, Rule};
use super::item::{Around, Item, Items};
use super::partition;
use crate::pages::Pages;
use rayon::prelude::*;

/// Deeper than this, sets are halved, so that 72 levels are never exceeded whatever the boxes are.
pub(super) const SAH_DEPTH: usize = 44;
/// Sets up to this size are built by one thread.
pub(super) const TASK: usize = 1 << 14;
/// Larger sets are cut into pieces of this size for several threads.
pub(super) const CHUNK: usize = 1 << 13;

/// What decides the shape of the tree.
#[derive(Clone, Copy)]
pub(super) struct Settings {
    pub leaf_size: usize,
    pub block: Blocks,
    /// A node's test in units of one leaf block's test.
    pub node_cost: f32,
    /// Sets up to this size are halved as they lie: they will mostly be one wide node.
    pub careless: usize,
}

impl Settings {
    /// Whether a cut is cheaper than a leaf. Boxes without area have a cost of NaN and become leaves too.
    pub fn pays(&self, count: usize, cost: f32) -> bool {
        let blocks = self.block.of(wide::i32x4::splat(count as i32)).to_array()[0];
        self.node_cost + cost < blocks
    }
}

/// The binary tree, empty when there are no items, and the numbers of the items in leaf order.
pub(super) fn build(mut items: Items, settings: &Settings) -> (Pages<BinaryNode>, Vec<u32>) {
    let around = items.around;
    let items = items.list();
    if items.is_empty() {
        return (Pages::zeroed(0), Vec::new());
    }
    let mut room = Pages::zeroed(if items.len() > TASK { items.len() } else { 0 });
    let mut order = vec![0; items.len()];
    let set = Set { items, room: &mut room, order: &mut order, first: 0, around, depth: 0 };
    (subtree(set, settings).into_nodes(), order)
}

/// A set of items on its way into a subtree: the items, as much room for them to be moved to, where their
/// numbers go in leaf order, the position of the first in the order of all, and how deep the set lies.
pub(super) struct Set<'a> {
    pub items: &'a mut [Item],
    pub room: &'a mut [Item],
    pub order: &'a mut [u32],
    pub first: usize,
    pub around: Around,
    pub depth: usize,
}

impl<'a> Set<'a> {
    /// The items have been moved into the room.
    fn halves(self, left: usize, around: [Around; 2]) -> [Self; 2] {
        let (items, room) = (self.room.split_at_mut(left), self.items.split_at_mut(left));
        let order = self.order.split_at_mut(left);
        let (depth, [a, b]) = (self.depth + 1, around);
        [
            Set { items: items.0, room: room.0, order: order.0, first: self.first, around: a, depth },
            Set { items: items.1, room: room.1, order: order.1, first: self.first + left, around: b, depth },
        ]
    }
}

/// The subtree over a set of at least one item.
pub(super) fn subtree(set: Set<'_>, settings: &Settings) -> Subtree {
    if set.items.len() <= TASK {
        return build_alone(set, settings);
    }
    let bounds = set.around.bounds;
    let (left, around) = split_large(&mut *set.items, &mut *set.room, &set.around, set.depth, settings);
    let [left, right] = set.halves(left, around);
    let (left, right) = rayon::join(|| subtree(left, settings), || subtree(right, settings));
    Subtree::join(bounds, left, right)
}

/// Moves the items into the room, left before right; returns how many are left and what is around both.
fn split_large(
    items: &mut [Item],
    room: &mut [Item],
    around: &Around,
    depth: usize,
    settings: &Settings,
) -> (usize, [Around; 2]) {
    let mapping = Mapping::new(around.centers, items.len()).filter(|_| depth < SAH_DEPTH);
    let cut = mapping.and_then(|mapping| {
        let bins = |items| {
            let mut bins = Bins::EMPTY;
            bins.fill(&mapping, items);
            bins
        };
        let chunks: Vec<Bins> = items.par_chunks(CHUNK).map(bins).collect();
        let mut all = Bins::EMPTY;
        chunks.iter().for_each(|bins| all.merge(bins, &mapping));
        let cut = all.best(&mapping, around.bounds, settings.block)?;
        let lefts: Vec<usize> = chunks.iter().map(|bins| bins.left_count(&cut)).collect();
        let (left, [a, b]) = all.sides(&mapping, &cut);
        let [c, d] = partition::into(items, room, CHUNK, &lefts, &Rule::new(&mapping, &cut));
        Some((left, [Around { bounds: a, centers: c }, Around { bounds: b, centers: d }]))
    });
    cut.unwrap_or_else(|| {
        let halves = halve(items, around);
        room.copy_from_slice(items);
        halves
    })
}

/// Splits into two halves by the centers along the longest axis, equal centers by number.
fn halve(items: &mut [Item], around: &Around) -> (usize, [Around; 2]) {
    let axis = around.centers.longest_axis();
    let middle = items.len() / 2;
    if around.centers.low.as_array()[axis] < around.centers.high.as_array()[axis] {
        let center = |item: &Item| item.center().to_array()[axis];
        let order = |a: &Item, b: &Item| center(a).total_cmp(&center(b)).then(a.number().cmp(&b.number()));
        items.select_nth_unstable_by(middle, order);
    }
    parts(items)
}

/// The two halves as they lie.
fn parts(items: &[Item]) -> (usize, [Around; 2]) {
    let (left, right) = items.split_at(items.len() / 2);
    (left.len(), [Around::of(left), Around::of(right)])
}

fn build_alone(set: Set<'_>, settings: &Settings) -> Subtree {
    let Set { items, order, first, around, depth, .. } = set;
    let mut task = Task::new(settings);
    task.nodes.reserve(items.len() / 2);
    let root = task.grow(items, first, &around, depth);
    number(order, items);
    Subtree::new(root, task.nodes)
}

/// The numbers of the items, in leaf order.
pub(super) fn number(order: &mut [u32], items: &[Item]) {
    for (place, item) in order.iter_mut().zip(items) {
        *place = item.number();
    }
}

/// What one thread builds.
pub(super) struct Task<'a> {
    settings: &'a Settings,
    /// Of the last cut.
    pub bins: Bins,
    pub nodes: Vec<BinaryNode>,
}

impl<'a> Task<'a> {
    pub fn new(settings: &'a Settings) -> Self {
        Self { settings, bins: Bins::EMPTY, nodes: Vec::new() }
    }

    /// Returns the root, appends what is below it.
    pub fn grow(&mut self, items: &mut [Item], first: usize, around: &Around, depth: usize) -> BinaryNode {
        let Some((left, around_both)) = self.split(items, around, depth) else {
            return BinaryNode::new(around.bounds, first, items.len());
        };
        let place = self.nodes.len();
        let root = BinaryNode::new(around.bounds, place, 0);
        self.nodes.extend([root; 2]);
        let (left_items, right_items) = items.split_at_mut(left);
        self.nodes[place] = self.grow(left_items, first, &around_both[0], depth + 1);
        self.nodes[place + 1] = self.grow(right_items, first + left, &around_both[1], depth + 1);
        root
    }

    /// Brings the items of the left side to the front; `None` for a leaf.
    fn split(&mut self, items: &mut [Item], around: &Around, depth: usize) -> Option<(usize, [Around; 2])> {
        let count = items.len();
        if count <= 1 {
            return None;
        }
        if count <= self.settings.careless {
            return Some(parts(items));
        }
        let found = self.cut(items, around, depth);
        if count <= self.settings.leaf_size {
            let (_, cut) = found?;
            if !self.settings.pays(count, cut.cost) {
                return None;
            }
        }
        Some(self.part(items, around, found))
    }

    /// Brings the items of the left side of the cut that was found last to the front; halves them where there is none.
    pub fn part(&self, items: &mut [Item], around: &Around, found: Option<(Mapping, Cut)>) -> (usize, [Around; 2]) {
        let Some((mapping, cut)) = found else { return halve(items, around) };
        let (left, [a, b]) = self.bins.sides(&mapping, &cut);
        let [c, d] = partition::in_place(items, &Rule::new(&mapping, &cut));
        (left, [Around { bounds: a, centers: c }, Around { bounds: b, centers: d }])
    }

    /// The cheapest cut.
    pub fn cut(&mut self, items: &[Item], around: &Around, depth: usize) -> Option<(Mapping, Cut)> {
        let mapping = Mapping::new(around.centers, items.len()).filter(|_| depth < SAH_DEPTH)?;
        self.bins.fill(&mapping, items);
        let cut = self.bins.best(&mapping, around.bounds, self.settings.block)?;
        Some((mapping, cut))
    }
}
