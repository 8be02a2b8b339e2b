//! Binning (Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies"): the items are
//! counted in up to 32 bins along each axis by their centers, and the cuts between bins are priced by the
//! surface-area heuristic (MacDonald and Booth 1990): a ray that meets a box meets a box inside it with a
//! probability of the ratio of their areas.

use super::item::{Extent, Item};
use wide::{f32x4, i32x4};

pub(super) const MAX_BINS: usize = 32;

/// Fewer items are counted in one set of bins, not in two.
const ONE_SET: usize = 512;

/// The map from centers to bins, three axes side by side.
#[derive(Clone, Copy)]
pub(super) struct Mapping {
    low: f32x4,
    scale: f32x4,
    last: f32x4,
    count: usize,
}

impl Mapping {
    /// Few items need few bins. `None` when all centers coincide.
    pub fn new(centers: Extent, items: usize) -> Option<Self> {
        let count = (4 + items / 16).min(MAX_BINS);
        let sides = (centers.high - centers.low).to_array();
        let scale = |axis: usize| Some(count as f32 / sides[axis]).filter(|s| s.is_finite()).unwrap_or(0.0);
        let scale = [scale(0), scale(1), scale(2), 0.0];
        let last = f32x4::splat((count - 1) as f32);
        (scale != [0.0; 4]).then(|| Self { low: centers.low, scale: f32x4::new(scale), last, count })
    }

    #[inline(always)]
    fn position(&self, item: &Item) -> f32x4 {
        (item.center() - self.low) * self.scale
    }

    #[inline(always)]
    fn bins(&self, item: &Item) -> i32x4 {
        self.position(item).fast_min(self.last).fast_trunc_int()
    }
}

/// Where to cut: items in bins below `at` along `axis` go left.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    axis: usize,
    at: usize,
    /// Area times blocks of both sides, as a share of the area of the whole.
    pub cost: f32,
}

/// Tells on which side of a cut an item lies.
#[derive(Clone, Copy)]
pub(super) struct Rule {
    mapping: Mapping,
    at: f32x4,
    lane: u32,
}

impl Rule {
    pub fn new(mapping: &Mapping, cut: &Cut) -> Self {
        Self { mapping: *mapping, at: f32x4::splat(cut.at as f32), lane: 1 << cut.axis }
    }

    /// A position before rounding down is below a whole number when it is so afterwards.
    #[inline(always)]
    pub fn is_left(&self, item: &Item) -> bool {
        self.mapping.position(item).simd_lt(self.at).to_bitmask() & self.lane != 0
    }
}

/// Boxes and counts of the bins along three axes.
#[derive(Clone)]
pub(super) struct Bins {
    boxes: [[Extent; 3]; MAX_BINS],
    counts: [[i32; 4]; MAX_BINS],
}

impl Bins {
    pub const EMPTY: Self = Self { boxes: [[Extent::EMPTY; 3]; MAX_BINS], counts: [[0; 4]; MAX_BINS] };

    pub fn fill(&mut self, mapping: &Mapping, items: &[Item]) {
        self.boxes[..mapping.count].fill([Extent::EMPTY; 3]);
        self.counts[..mapping.count].fill([0; 4]);
        if items.len() < ONE_SET {
            items.iter().for_each(|item| self.add(mapping, item));
            return;
        }
        // Neighbours often share a bin and would wait for each other.
        let mut other = Self::EMPTY;
        let (first, second) = items.split_at(items.len() / 2);
        for (a, b) in first.iter().zip(second) {
            self.add(mapping, a);
            other.add(mapping, b);
        }
        second[first.len()..].iter().for_each(|item| self.add(mapping, item));
        self.merge(&other);
    }

    #[inline(always)]
    fn add(&mut self, mapping: &Mapping, item: &Item) {
        let bins = mapping.bins(item).to_array();
        for (axis, &bin) in bins[..3].iter().enumerate() {
            let bin = bin as usize % MAX_BINS;
            self.boxes[bin][axis] = self.boxes[bin][axis].union(item.extent());
            self.counts[bin][axis] += 1;
        }
    }

    pub fn merge(&mut self, other: &Self) {
        for bin in 0..MAX_BINS {
            for axis in 0..3 {
                self.boxes[bin][axis] = self.boxes[bin][axis].union(other.boxes[bin][axis]);
                self.counts[bin][axis] += other.counts[bin][axis];
            }
        }
    }

    /// How many items are left of the cut, and the box around them; and the box of the others.
    pub fn sides(&self, mapping: &Mapping, cut: &Cut) -> (usize, [Extent; 2]) {
        let boxes = |bins: &[[Extent; 3]]| bins.iter().fold(Extent::EMPTY, |all, bin| all.union(bin[cut.axis]));
        let (left, right) = self.boxes[..mapping.count].split_at(cut.at);
        (self.left_count(cut), [boxes(left), boxes(right)])
    }

    pub fn left_count(&self, cut: &Cut) -> usize {
        self.counts[..cut.at].iter().map(|counts| counts[cut.axis] as usize).sum()
    }

    /// The cheapest cut with items on both sides. `block` items cost as much as one, and areas are shares of
    /// that of `bounds`.
    pub fn best(&self, mapping: &Mapping, bounds: Extent, block: Blocks) -> Option<Cut> {
        let inverse = f32x4::splat(bounds.inverse_size());
        let mut right_costs = [f32x4::ZERO; MAX_BINS];
        let mut side = Side::EMPTY;
        for at in (1..mapping.count).rev() {
            side.add(&self.boxes[at], self.counts[at]);
            right_costs[at] = side.cost(inverse, block);
        }
        let (mut least, mut best) = (f32x4::splat(f32::INFINITY), f32x4::ZERO);
        let mut side = Side::EMPTY;
        for (at, right_cost) in right_costs.iter().enumerate().take(mapping.count).skip(1) {
            side.add(&self.boxes[at - 1], self.counts[at - 1]);
            // Where a side is empty this is a NaN, which is not less.
            let cost = side.cost(inverse, block) + *right_cost;
            let better = cost.simd_lt(least);
            least = better.bitselect(cost, least);
            best = better.bitselect(f32x4::splat(at as f32), best);
        }
        let (least, best) = (least.to_array(), best.to_array());
        let axis = (1..3).fold(0, |a, b| if least[b] < least[a] { b } else { a });
        let area = area([bounds; 3], inverse).to_array()[0];
        (least[axis] < f32::INFINITY).then(|| Cut { axis, at: best[axis] as usize, cost: least[axis] / area })
    }
}

/// How many items are tested for the price of one: blocks of 1, 2, 4 or 8 as a shift.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blocks(pub i32);

impl Blocks {
    #[inline(always)]
    pub fn of(self, counts: i32x4) -> f32x4 {
        ((counts + i32x4::splat((1 << self.0) - 1)) >> self.0).round_float()
    }
}

/// The union of some bins, for the three axes side by side.
struct Side {
    boxes: [Extent; 3],
    counts: i32x4,
}

impl Side {
    const EMPTY: Self = Self { boxes: [Extent::EMPTY; 3], counts: i32x4::new([0; 4]) };

    #[inline(always)]
    fn add(&mut self, boxes: &[Extent; 3], counts: [i32; 4]) {
        for (all, other) in self.boxes.iter_mut().zip(boxes) {
            *all = all.union(*other);
        }
        self.counts += i32x4::new(counts);
    }

    #[inline(always)]
    fn cost(&self, inverse: f32x4, block: Blocks) -> f32x4 {
        area(self.boxes, inverse) * block.of(self.counts)
    }
}

/// Half the surface areas of three boxes; infinite for empty ones.
#[inline(always)]
fn area(boxes: [Extent; 3], inverse: f32x4) -> f32x4 {
    let half = f32x4::splat(0.5);
    let sides = boxes.map(|b| (b.high * half - b.low * half) * inverse);
    let [x, y, z, _] = f32x4::transpose([sides[0], sides[1], sides[2], sides[2]]);
    x * y + y * z + z * x
}
