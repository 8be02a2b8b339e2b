//! Top-down construction with spatial splits (Stich, Friedrich, Dietrich 2009, "Spatial Splits in Bounding Volume
//! Hierarchies"): where the boxes of both sides of a cut overlap, space may be cut instead. Items across the plane are
//! then referred to from both sides, each time with the box of the part on that side.
//!
//! Deviations: planes are looked for where the overlap is large beside the node, not beside the root, and taken only
//! where they are much cheaper; the references that may be added are bounded, and each subtree is given its share
//! beforehand; which items are better not divided is decided by the boxes of the bins, not one after the other. So the
//! tree is the same on any number of threads.

use super::MAX_ITEMS;
use super::binary::{BinaryNode, Subtree};
use super::binned::{self, CHUNK, Settings, TASK, Task};
use super::bins::{Cut, Mapping};
use super::item::{Around, Extent, Item, Items};
use super::planes::{Plane, Planes, half_area};
use super::reinsert::relist;
use crate::pages::Pages;
use rayon::prelude::*;

/// At most one reference is added for so many items.
const SHARE: usize = 4;
/// Planes are looked for where the overlap of the boxes of both sides has more than this share of the area of both
/// together.
const OVERLAP: f64 = 0.5;
/// A plane must cost less than this share of the best cut. What the heuristic gains by less is lost again: subtrees
/// with parts of items find no better places later (`reinsert.rs`).
const GAIN: f32 = 0.8;

/// Items of which parts have boxes too.
pub(crate) trait Divide: Sync {
    /// The boxes of the parts of an item below and above the plane across `axis` at `at`, as far as they lie in
    /// `bounds`; empty where there is no part.
    fn divide(&self, item: u32, bounds: Extent, axis: usize, at: f32) -> [Extent; 2];
}

/// The binary tree, empty when there are no items, and the numbers of the items in leaf order, some more than once.
pub(super) fn build(mut items: Items, settings: &Settings, divide: &impl Divide) -> (Pages<BinaryNode>, Vec<u32>) {
    let around = items.around;
    let items = items.list().to_vec();
    if items.is_empty() {
        return (Pages::zeroed(0), Vec::new());
    }
    let spare = (items.len() / SHARE).min(MAX_ITEMS - items.len());
    let mut order = vec![0; items.len() + spare];
    let builder = Builder { settings, divide };
    let set = Set { items, spare, order: &mut order, first: 0, around, depth: 0 };
    let nodes = builder.subtree(set).into_nodes();
    // Closes the gaps where subtrees needed fewer references than they might have had.
    let (nodes, order, _) = relist(&nodes, &order);
    (nodes, order)
}

/// References on their way into a subtree: how many may be added, a place in leaf order for each that there may be, the
/// position of the first place, and how deep the set lies.
struct Set<'a> {
    items: Vec<Item>,
    spare: usize,
    order: &'a mut [u32],
    first: usize,
    around: Around,
    depth: usize,
}

impl<'a> Set<'a> {
    fn leaf(&self) -> BinaryNode {
        BinaryNode::new(self.around.bounds, self.first, self.items.len())
    }

    /// Both sides; the references that may still be added go to them by their area.
    fn sides(order: &'a mut [u32], first: usize, depth: usize, sides: [Side; 2]) -> [Self; 2] {
        let [left, right] = sides;
        let spare = order.len() - left.items.len() - right.items.len();
        let [a, b] = [&left, &right].map(|side| half_area(side.around.bounds));
        let left_spare = ((spare as f64 * (a / (a + b))) as usize).min(spare);
        let (places, others) = order.split_at_mut(left.items.len() + left_spare);
        let second = first + places.len();
        [
            Self { items: left.items, spare: left_spare, order: places, first, around: left.around, depth },
            Self {
                items: right.items,
                spare: spare - left_spare,
                order: others,
                first: second,
                around: right.around,
                depth,
            },
        ]
    }
}

/// The references on one side of a split, and what is around them.
struct Side {
    items: Vec<Item>,
    around: Around,
}

impl Side {
    const EMPTY: Self = Self { items: Vec::new(), around: Around::EMPTY };

    fn push(&mut self, item: Item) {
        self.around = self.around.with(&item);
        self.items.push(item);
    }

    fn append(&mut self, mut other: Self) {
        self.items.append(&mut other.items);
        self.around = self.around.union(other.around);
    }
}

struct Builder<'a, D> {
    settings: &'a Settings,
    divide: &'a D,
}

impl<D: Divide> Builder<'_, D> {
    /// The subtree over a set of at least one reference.
    fn subtree(&self, set: Set<'_>) -> Subtree {
        let mut task = Task::new(self.settings);
        if set.items.len() <= TASK {
            let root = self.grow(set, &mut task);
            return Subtree::new(root, task.nodes);
        }
        if set.spare == 0 {
            let Set { mut items, order, first, around, depth, .. } = set;
            let mut room = Pages::zeroed(items.len());
            let set = binned::Set { items: &mut items, room: &mut room, order, first, around, depth };
            return binned::subtree(set, self.settings);
        }
        let (bounds, leaf) = (set.around.bounds, set.leaf());
        match self.split(set, &mut task) {
            None => Subtree::new(leaf, Vec::new()),
            Some([left, right]) => {
                let (left, right) = rayon::join(|| self.subtree(left), || self.subtree(right));
                Subtree::join(bounds, left, right)
            }
        }
    }

    /// Returns the root, appends what is below it to the task's nodes.
    fn grow(&self, mut set: Set<'_>, task: &mut Task) -> BinaryNode {
        if set.spare == 0 {
            let root = task.grow(&mut set.items, set.first, &set.around, set.depth);
            binned::number(set.order, &set.items);
            return root;
        }
        let (bounds, leaf) = (set.around.bounds, set.leaf());
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

    /// `None` for a leaf.
    fn split<'s>(&self, mut set: Set<'s>, task: &mut Task) -> Option<[Set<'s>; 2]> {
        let count = set.items.len();
        let found = task.cut(&set.items, &set.around, set.depth);
        let pays = || found.as_ref().is_some_and(|(_, cut)| self.settings.pays(count, cut.cost));
        if count <= self.settings.leaf_size && (count == 1 || !pays()) {
            binned::number(set.order, &set.items);
            return None;
        }
        let plane = self.plane(&set, found.as_ref(), task);
        let sides = plane.and_then(|plane| self.part(&set.items, &plane, set.order.len())).unwrap_or_else(|| {
            let (left, [a, b]) = task.part(&mut set.items, &set.around, found);
            let right = set.items.split_off(left);
            [Side { items: set.items, around: a }, Side { items: right, around: b }]
        });
        Some(Set::sides(set.order, set.first, set.depth + 1, sides))
    }

    /// Where to cut space, if that is much cheaper than the cut that was found.
    fn plane(&self, set: &Set, found: Option<&(Mapping, Cut)>, task: &Task) -> Option<Plane> {
        if set.items.len() <= self.settings.leaf_size {
            return None;
        }
        let (mapping, cut) = found?;
        let (_, [left, right]) = task.bins.sides(mapping, cut);
        if half_area(left.intersection(right)) <= half_area(set.around.bounds) * OVERLAP {
            return None;
        }
        let planes = set.items.par_chunks(CHUNK).map(|items| {
            let mut planes = Planes::new(set.around.bounds, set.items.len());
            items.iter().for_each(|item| planes.add(item, self.divide));
            planes
        });
        let best = planes.reduce_with(|a, b| a.merged(&b))?.best(set.order.len(), self.settings.block)?;
        (best.cost < cut.cost * GAIN).then_some(best)
    }

    /// The references on both sides of a plane; `None` when one side has none, or when they are more than allowed:
    /// bins and planes are rounded differently.
    fn part(&self, items: &[Item], plane: &Plane, most: usize) -> Option<[Side; 2]> {
        let parts = |items: &[Item]| {
            let mut sides = [Side::EMPTY, Side::EMPTY];
            for item in items {
                for (side, part) in sides.iter_mut().zip(plane.parts(item, self.divide)) {
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
