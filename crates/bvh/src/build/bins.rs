//! Binning (Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies"): the items are
//! counted in up to 32 bins along each axis by their centers, and the cuts between bins are priced by the
//! surface-area heuristic (MacDonald and Booth 1990): a ray that meets a box meets a box inside it with a
//! probability of the ratio of their areas.

use super::item::{Extent, Item};
use bytemuck::cast;
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

/// What stands for no item in lane 3 of a bin: with any count added, the bits of a float that is below those of items
/// and that no arithmetic turns into a subnormal number, which would be slow.
const NONE: u32 = 0x2000_0000;

/// The box around the items of a bin, with their number above [`NONE`] as an integer in lane 3 of the low corner.
#[derive(Clone, Copy)]
struct Bin(Extent);

impl Bin {
    const EMPTY: Self = {
        let (inf, low) = (f32::INFINITY, f32::NEG_INFINITY);
        Self(Extent { low: f32x4::new([inf, inf, inf, f32::from_bits(NONE)]), high: f32x4::new([low; 4]) })
    };

    /// An item's lane 3, as a float, is above any count, so that the count survives the union.
    #[inline(always)]
    fn add(&mut self, item: &Item) {
        let Extent { low, high } = self.0.union(item.extent());
        self.0 = Extent { low: cast(cast::<_, i32x4>(low) + i32x4::new([0, 0, 0, 1])), high };
    }

    fn merge(&mut self, other: &Self) {
        let count = self.count() + other.count();
        let extent = self.0.union(other.0);
        let [x, y, z, _] = extent.low.to_array();
        self.0 = Extent { low: f32x4::new([x, y, z, f32::from_bits(NONE + count)]), high: extent.high };
    }

    #[inline(always)]
    fn count(&self) -> u32 {
        self.0.low.as_array()[3].to_bits() - NONE
    }
}

/// The bins along three axes.
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
        // Neighbours often share a bin and would wait for each other.
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

    /// Adds the items of bins with the same mapping.
    pub fn merge(&mut self, other: &Self, mapping: &Mapping) {
        for (bins, others) in self.0.iter_mut().zip(&other.0) {
            bins[..mapping.count].iter_mut().zip(others).for_each(|(bin, other)| bin.merge(other));
        }
    }

    /// The bins at one position along the three axes.
    #[inline(always)]
    fn at(&self, position: usize) -> [&Bin; 3] {
        let [x, y, z] = &self.0;
        [&x[position], &y[position], &z[position]]
    }

    /// How many items are left of the cut, and the box around them; and the box of the others.
    pub fn sides(&self, mapping: &Mapping, cut: &Cut) -> (usize, [Extent; 2]) {
        let boxes = |bins: &[Bin]| bins.iter().fold(Extent::EMPTY, |all, bin| all.union(bin.0));
        let (left, right) = self.0[cut.axis][..mapping.count].split_at(cut.at);
        (self.left_count(cut), [boxes(left), boxes(right)])
    }

    pub fn left_count(&self, cut: &Cut) -> usize {
        self.0[cut.axis][..cut.at].iter().map(|bin| bin.count() as usize).sum()
    }

    /// The cheapest cut with items on both sides. `block` items cost as much as one, and areas are shares of
    /// that of `bounds`.
    pub fn best(&self, mapping: &Mapping, bounds: Extent, block: Blocks) -> Option<Cut> {
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
    fn add(&mut self, bins: [&Bin; 3]) {
        for (all, bin) in self.boxes.iter_mut().zip(bins) {
            *all = all.union(bin.0);
        }
        let [x, y, z] = bins.map(|bin| bin.0.low);
        let [.., counts] = f32x4::transpose([x, y, z, z]);
        self.counts += cast::<_, i32x4>(counts) - i32x4::splat(NONE as i32);
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
