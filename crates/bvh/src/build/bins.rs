//! Binning (Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies"): up to 32
//! bins along each axis collect the items by their centers. Splits between bins are evaluated by
//! the surface-area heuristic (MacDonald and Booth 1990): a ray that intersects a box intersects a
//! box inside it with a probability equal to the ratio of their areas.

use super::item::{Item, SimdBox};
use bytemuck::cast;
use wide::{f32x4, i32x4};

pub(super) const MAX_BINS: usize = 32;

/// Number of items from which two sets of bins are filled alternately.
const ONE_SET: usize = 512;

/// Mapping from centers to bin indices, for three axes in SIMD lanes.
#[derive(Clone, Copy)]
pub(super) struct Mapping {
    low: f32x4,
    scale: f32x4,
    last: f32x4,
    count: usize,
}

impl Mapping {
    /// Constructs the mapping; the number of bins grows with that of the items. `None` if all
    /// centers coincide.
    pub fn new(centers: SimdBox, items: usize) -> Option<Self> {
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

/// A split between bins: items in bins below `at` along `axis` go to the left side.
#[derive(Clone, Copy, Debug)]
pub(super) struct ObjectSplit {
    axis: usize,
    at: usize,
    /// SAH cost of both sides, relative to the area of the parent: area times leaf blocks.
    pub cost: f32,
}

/// Decides on which side of a split an item lies.
#[derive(Clone, Copy)]
pub(super) struct SideTest {
    mapping: Mapping,
    at: f32x4,
    lane: u32,
}

impl SideTest {
    pub fn new(mapping: &Mapping, split: &ObjectSplit) -> Self {
        Self { mapping: *mapping, at: f32x4::splat(split.at as f32), lane: 1 << split.axis }
    }

    /// Whether an item lies to the left. Compares without truncation, which gives the same result
    /// for an integer `at`.
    #[inline(always)]
    pub fn is_left(&self, item: &Item) -> bool {
        self.mapping.position(item).simd_lt(self.at).to_bitmask() & self.lane != 0
    }
}

/// Base of the item count in lane 3 of a bin. As a float, the base plus any count is smaller than
/// lane 3 of every item and never subnormal, which would be slow.
const NONE: u32 = 0x2000_0000;

/// Bounds of a bin's items, with [`NONE`] plus their number as an integer in lane 3 of the low
/// corner.
#[derive(Clone, Copy)]
struct Bin(SimdBox);

impl Bin {
    const EMPTY: Self = {
        let (inf, low) = (f32::INFINITY, f32::NEG_INFINITY);
        Self(SimdBox { low: f32x4::new([inf, inf, inf, f32::from_bits(NONE)]), high: f32x4::new([low; 4]) })
    };

    /// Adds an item. Lane 3 of an item, as a float, exceeds any count, so the count survives the
    /// minimum.
    #[inline(always)]
    fn add(&mut self, item: &Item) {
        let SimdBox { low, high } = self.0.union(item.bounds());
        self.0 = SimdBox { low: cast(cast::<_, i32x4>(low) + i32x4::new([0, 0, 0, 1])), high };
    }

    fn merge(&mut self, other: &Self) {
        let count = self.count() + other.count();
        let union = self.0.union(other.0);
        let [x, y, z, _] = union.low.to_array();
        self.0 = SimdBox { low: f32x4::new([x, y, z, f32::from_bits(NONE + count)]), high: union.high };
    }

    #[inline(always)]
    fn count(&self) -> u32 {
        self.0.low.as_array()[3].to_bits() - NONE
    }
}

/// Bins along three axes.
#[derive(Clone)]
pub(super) struct Bins([[Bin; MAX_BINS]; 3]);

impl Bins {
    pub const EMPTY: Self = Self([[Bin::EMPTY; MAX_BINS]; 3]);

    pub fn fill(&mut self, mapping: &Mapping, items: &[Item]) {
        self.0.iter_mut().for_each(|bins| bins[..mapping.count].fill(Bin::EMPTY));
        if items.len() < ONE_SET {
            items.iter().for_each(|item| self.add(mapping, item));
            return;
        }
        // Neighbors often share a bin: two sets of bins break the dependency chain.
        let mut other = Self::EMPTY;
        let (first, second) = items.split_at(items.len() / 2);
        for (a, b) in first.iter().zip(second) {
            self.add(mapping, a);
            other.add(mapping, b);
        }
        second[first.len()..].iter().for_each(|item| self.add(mapping, item));
        self.merge(&other, mapping);
    }

    #[inline(always)]
    fn add(&mut self, mapping: &Mapping, item: &Item) {
        let [x, y, z, _] = mapping.bins(item).to_array();
        for (bins, bin) in self.0.iter_mut().zip([x, y, z]) {
            bins[bin as usize % MAX_BINS].add(item);
        }
    }

    /// Adds the contents of bins with the same mapping.
    pub fn merge(&mut self, other: &Self, mapping: &Mapping) {
        for (bins, others) in self.0.iter_mut().zip(&other.0) {
            bins[..mapping.count].iter_mut().zip(others).for_each(|(bin, other)| bin.merge(other));
        }
    }

    /// Bins at one index along the three axes.
    #[inline(always)]
    fn at(&self, position: usize) -> [&Bin; 3] {
        let [x, y, z] = &self.0;
        [&x[position], &y[position], &z[position]]
    }

    /// Bounds of the items on both sides of the split.
    pub fn sides(&self, mapping: &Mapping, split: &ObjectSplit) -> [SimdBox; 2] {
        let boxes = |bins: &[Bin]| bins.iter().fold(SimdBox::EMPTY, |all, bin| all.union(bin.0));
        let (left, right) = self.0[split.axis][..mapping.count].split_at(split.at);
        [boxes(left), boxes(right)]
    }

    /// Finds the split of the lowest SAH cost with items on both sides. Areas are relative to the
    /// size of `bounds`; `block` is the number of items per leaf block.
    pub fn best(&self, mapping: &Mapping, bounds: SimdBox, block: BlockShift) -> Option<ObjectSplit> {
        let inverse = f32x4::splat(bounds.inverse_size());
        let mut right_costs = [f32x4::ZERO; MAX_BINS];
        let mut side = Side::EMPTY;
        for at in (1..mapping.count).rev() {
            side.add(self.at(at));
            right_costs[at] = side.cost(inverse, block);
        }
        let (mut least, mut best) = (f32x4::splat(f32::INFINITY), f32x4::ZERO);
        let mut side = Side::EMPTY;
        for (at, right_cost) in right_costs.iter().enumerate().take(mapping.count).skip(1) {
            side.add(self.at(at - 1));
            // The cost is NaN where a side is empty, and the comparison false.
            let cost = side.cost(inverse, block) + *right_cost;
            let better = cost.simd_lt(least);
            least = better.bitselect(cost, least);
            best = better.bitselect(f32x4::splat(at as f32), best);
        }
        let (least, best) = (least.to_array(), best.to_array());
        let axis = (1..3).fold(0, |a, b| if least[b] < least[a] { b } else { a });
        let area = area([bounds; 3], inverse).to_array()[0];
        (least[axis] < f32::INFINITY).then(|| ObjectSplit { axis, at: best[axis] as usize, cost: least[axis] / area })
    }
}

/// Number of items in a leaf block, which is tested at once, as a power of two: 0 to 3 for 1, 2, 4
/// or 8.
#[derive(Clone, Copy, Debug)]
pub(super) struct BlockShift(pub i32);

impl BlockShift {
    #[inline(always)]
    pub fn block_count(self, counts: i32x4) -> f32x4 {
        ((counts + i32x4::splat((1 << self.0) - 1)) >> self.0).round_float()
    }
}

/// Accumulated bounds and counts of bins, for three axes.
struct Side {
    boxes: [SimdBox; 3],
    counts: i32x4,
}

impl Side {
    const EMPTY: Self = Self { boxes: [SimdBox::EMPTY; 3], counts: i32x4::new([0; 4]) };

    #[inline(always)]
    fn add(&mut self, bins: [&Bin; 3]) {
        for (all, bin) in self.boxes.iter_mut().zip(bins) {
            *all = all.union(bin.0);
        }
        let [x, y, z] = bins.map(|bin| bin.0.low);
        let [.., counts] = f32x4::transpose([x, y, z, z]);
        self.counts += cast::<_, i32x4>(counts) - i32x4::splat(NONE as i32);
    }

    #[inline(always)]
    fn cost(&self, inverse: f32x4, block: BlockShift) -> f32x4 {
        area(self.boxes, inverse) * block.block_count(self.counts)
    }
}

/// Half surface areas of three boxes; infinite for empty ones.
#[inline(always)]
fn area(boxes: [SimdBox; 3], inverse: f32x4) -> f32x4 {
    let half = f32x4::splat(0.5);
    let sides = boxes.map(|b| (b.high * half - b.low * half) * inverse);
    let [x, y, z, _] = f32x4::transpose([sides[0], sides[1], sides[2], sides[2]]);
    x * y + y * z + z * x
}
