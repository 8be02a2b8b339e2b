//! Top-down construction by the surface-area heuristic with bins (Wald 2007, "On fast Construction of
//! SAH-based Bounding Volume Hierarchies"): a ray that meets a box meets a box inside it with a probability
//! of the ratio of their areas, so the best split is the one with the least `area × cost` on both sides.

use super::{BinaryNode, BuildOptions, Item, Quality, half_area};
use juggler_math::Aabb;

const MAX_BINS: usize = 32;
/// Deeper than this, sets are halved, so that 72 levels are never exceeded whatever the boxes are.
const SAH_DEPTH: usize = 44;
/// [`Quality::Best`] looks at every split of sets up to this size.
const SWEEP_SIZE: usize = 64;
/// A node's test in units of one leaf block's test. Below 1: a node of the binary tree is a seventh to a half
/// of an eight-wide one.
const NODE_COST: f64 = 0.5;

/// Builds the binary tree and brings the items into leaf order. Empty when there are no items.
pub(super) fn build(items: &mut [Item], options: &BuildOptions) -> Vec<BinaryNode> {
    let mut builder = Builder { items, options, nodes: Vec::new() };
    if !builder.items.is_empty() {
        builder.nodes.push(BinaryNode { bounds: Aabb::EMPTY, first: 0, count: builder.items.len() });
        builder.subdivide(0, 0);
    }
    builder.nodes
}

struct Builder<'a> {
    items: &'a mut [Item],
    options: &'a BuildOptions,
    nodes: Vec<BinaryNode>,
}

impl Builder<'_> {
    /// Turns a leaf of all its items into a subtree, where that pays.
    fn subdivide(&mut self, node: usize, depth: usize) {
        let (first, count) = (self.nodes[node].first, self.nodes[node].count);
        let items = &mut self.items[first..first + count];
        let bounds = bounds_of(items);
        self.nodes[node].bounds = bounds;
        let Some(left) = split(items, &bounds, depth, self.options) else { return };
        let child = self.nodes.len();
        self.nodes[node].first = child;
        self.nodes[node].count = 0;
        self.nodes.push(BinaryNode { bounds: Aabb::EMPTY, first, count: left });
        self.nodes.push(BinaryNode { bounds: Aabb::EMPTY, first: first + left, count: count - left });
        self.subdivide(child, depth + 1);
        self.subdivide(child + 1, depth + 1);
    }
}

fn bounds_of(items: &[Item]) -> Aabb {
    items.iter().fold(Aabb::EMPTY, |all, item| all.union(item.bounds))
}

/// Where to cut, and what the two sides cost (area × blocks).
#[derive(Clone, Copy)]
struct Cut {
    axis: usize,
    /// First bin, or first item in sorted order, of the right side.
    at: usize,
    cost: f64,
}

/// Brings the items of the left side to the front and says how many they are; `None` for a leaf.
fn split(items: &mut [Item], bounds: &Aabb, depth: usize, options: &BuildOptions) -> Option<usize> {
    let count = items.len();
    if count <= 1 {
        return None;
    }
    if depth >= SAH_DEPTH {
        return (count > options.leaf_size).then(|| halve(items));
    }
    let centers = Centers::of(items);
    let sweep = options.quality == Quality::Best && count <= SWEEP_SIZE;
    let cut = if sweep { best_sweep(items, options.block) } else { best_bins(items, &centers, options) };
    let Some(cut) = cut else {
        return (count > options.leaf_size).then(|| halve(items));
    };
    let area = half_area(bounds);
    if count <= options.leaf_size && area * blocks(count, options.block) <= NODE_COST * area + cut.cost {
        return None;
    }
    let left = if sweep {
        sort_along(items, cut.axis);
        cut.at
    } else {
        let bins = centers.bins(cut.axis, bin_count(options.quality));
        partition(items, |item| bins.of(item.center(cut.axis)) < cut.at)
    };
    Some(if left == 0 || left == count { halve(items) } else { left })
}

fn blocks(count: usize, block: usize) -> f64 {
    count.div_ceil(block) as f64
}

fn bin_count(quality: Quality) -> usize {
    match quality {
        Quality::Fast => 8,
        Quality::Balanced => 16,
        Quality::Best => MAX_BINS,
    }
}

/// Splits into two halves by the centers along the longest axis, equal centers by index.
fn halve(items: &mut [Item]) -> usize {
    let axis = Centers::of(items).longest();
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| a.center(axis).total_cmp(&b.center(axis)).then(a.index.cmp(&b.index)));
    middle
}

fn sort_along(items: &mut [Item], axis: usize) {
    items.sort_unstable_by(|a, b| a.center(axis).total_cmp(&b.center(axis)).then(a.index.cmp(&b.index)));
}

fn partition(items: &mut [Item], is_left: impl Fn(&Item) -> bool) -> usize {
    let mut left = 0;
    for i in 0..items.len() {
        if is_left(&items[i]) {
            items.swap(i, left);
            left += 1;
        }
    }
    left
}

/// The box of the items' centers.
struct Centers(Aabb);

impl Centers {
    fn of(items: &[Item]) -> Self {
        Self(items.iter().fold(Aabb::EMPTY, |all, item| all.with_point(item.bounds.center())))
    }

    fn longest(&self) -> usize {
        let side = self.0.max * 0.5 - self.0.min * 0.5;
        if side.x >= side.y && side.x >= side.z {
            0
        } else if side.y >= side.z {
            1
        } else {
            2
        }
    }

    fn bins(&self, axis: usize, count: usize) -> Bins {
        let (low, high) = (self.0.min[axis], self.0.max[axis]);
        Bins { low: low * 0.5, scale: count as f32 / (high * 0.5 - low * 0.5), last: count - 1 }
    }
}

/// The map from centers to bins along one axis.
struct Bins {
    low: f32,
    scale: f32,
    last: usize,
}

impl Bins {
    /// Halved, so that no difference overflows; the cast takes NaN to 0 and infinity to the last bin.
    #[inline(always)]
    fn of(&self, center: f32) -> usize {
        (((center * 0.5 - self.low) * self.scale) as usize).min(self.last)
    }
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Aabb,
    count: usize,
}

impl Bin {
    const EMPTY: Self = Self { bounds: Aabb::EMPTY, count: 0 };

    fn join(self, other: Self) -> Self {
        Self { bounds: self.bounds.union(other.bounds), count: self.count + other.count }
    }

    fn cost(&self, block: usize) -> f64 {
        half_area(&self.bounds) * blocks(self.count, block)
    }
}

/// The cheapest cut between bins; `None` when the centers coincide.
#[inline(never)]
fn best_bins(items: &[Item], centers: &Centers, options: &BuildOptions) -> Option<Cut> {
    let count = bin_count(options.quality);
    let axes = if options.quality == Quality::Fast { centers.longest()..centers.longest() + 1 } else { 0..3 };
    let mut best: Option<Cut> = None;
    for axis in axes.filter(|&axis| centers.0.max[axis] > centers.0.min[axis]) {
        let map = centers.bins(axis, count);
        let mut bins = [Bin::EMPTY; MAX_BINS];
        for item in items {
            let bin = &mut bins[map.of(item.center(axis)) % MAX_BINS];
            bin.bounds = bin.bounds.union(item.bounds);
            bin.count += 1;
        }
        best = cheaper(best, cheapest_cut(&bins[..count], axis, options.block));
    }
    best
}

/// The cheapest cut between any two items along any axis (the full sweep of MacDonald and Booth 1990).
#[inline(never)]
fn best_sweep(items: &[Item], block: usize) -> Option<Cut> {
    let mut sorted = [Item { bounds: Aabb::EMPTY, index: 0 }; SWEEP_SIZE];
    let sorted = &mut sorted[..items.len().min(SWEEP_SIZE)];
    sorted.copy_from_slice(items);
    let mut best: Option<Cut> = None;
    for axis in 0..3 {
        sort_along(sorted, axis);
        let mut bins = [Bin::EMPTY; SWEEP_SIZE];
        for (bin, item) in bins.iter_mut().zip(sorted.iter()) {
            *bin = Bin { bounds: item.bounds, count: 1 };
        }
        best = cheaper(best, cheapest_cut(&bins[..sorted.len()], axis, block));
    }
    best
}

fn cheaper(a: Option<Cut>, b: Option<Cut>) -> Option<Cut> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b.cost < a.cost { b } else { a }),
        (a, b) => a.or(b),
    }
}

fn cheapest_cut(bins: &[Bin], axis: usize, block: usize) -> Option<Cut> {
    let mut right_cost = [0.0; SWEEP_SIZE];
    let mut right = Bin::EMPTY;
    for (i, bin) in bins.iter().enumerate().skip(1).rev() {
        right = right.join(*bin);
        right_cost[i] = right.cost(block);
    }
    let mut best: Option<Cut> = None;
    let mut left = Bin::EMPTY;
    let total = right.count + bins.first()?.count;
    for at in 1..bins.len() {
        left = left.join(bins[at - 1]);
        if left.count > 0 && left.count < total {
            best = cheaper(best, Some(Cut { axis, at, cost: left.cost(block) + right_cost[at] }));
        }
    }
    best
}
