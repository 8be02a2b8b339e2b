//! Spatial bins: candidates for spatial splits, and the partition of items at a plane.

use super::binary::BinaryNode;
use super::bins::BlockShift;
use super::item::{Item, SimdBox};
use super::spatial::ItemSplitter;

/// Maximum number of bins; fewer than for object splits, since each item is clipped at each plane
/// that it crosses.
const MAX_BINS: usize = 16;

/// A spatial bin between two planes: bounds of the clipped items, and numbers of items that begin
/// and end in it.
#[derive(Clone, Copy)]
struct Bin {
    bounds: SimdBox,
    begin: usize,
    end: usize,
}

impl Bin {
    const EMPTY: Self = Self { bounds: SimdBox::EMPTY, begin: 0, end: 0 };

    fn union(&self, other: &Self) -> Self {
        let bounds = self.bounds.union(other.bounds);
        Self { bounds, begin: self.begin + other.begin, end: self.end + other.end }
    }
}

/// Spatial bins along three axes.
pub(super) struct SpatialBins {
    bounds: SimdBox,
    count: usize,
    /// Bins per unit of length; zero along an axis that is not split.
    scale: [f32; 3],
    bins: [[Bin; MAX_BINS]; 3],
}

/// A candidate split plane, with bounds and reference counts of both sides.
pub(super) struct SpatialSplit {
    axis: usize,
    at: f32,
    boxes: [SimdBox; 2],
    counts: [usize; 2],
    /// SAH cost, as that of a [`ObjectSplit`](super::bins::ObjectSplit).
    pub cost: f32,
}

/// Half the surface area; zero for empty boxes.
pub(super) fn half_area(bounds: SimdBox) -> f64 {
    if bounds.is_empty() { 0.0 } else { BinaryNode::new(bounds, 0, 0).half_area() }
}

impl SpatialBins {
    /// Constructs empty bins; their number grows with that of the items.
    pub fn new(bounds: SimdBox, items: usize) -> Self {
        let count = (4 + items / 16).min(MAX_BINS);
        let (low, high) = (bounds.low.to_array(), bounds.high.to_array());
        let scale = [0, 1, 2].map(|axis| count as f32 / (high[axis] - low[axis]));
        let scale = scale.map(|scale| if scale.is_finite() { scale } else { 0.0 });
        Self { bounds, count, scale, bins: [[Bin::EMPTY; MAX_BINS]; 3] }
    }

    fn axes(&self) -> impl Iterator<Item = usize> + use<> {
        let scale = self.scale;
        (0..3).filter(move |&axis| scale[axis] > 0.0)
    }

    /// Coordinate of a bin's lower plane.
    fn plane(&self, axis: usize, bin: usize) -> f32 {
        self.bounds.low.as_array()[axis] + bin as f32 / self.scale[axis]
    }

    fn bin(&self, axis: usize, at: f32) -> usize {
        let bin = ((at - self.bounds.low.as_array()[axis]) * self.scale[axis]) as usize;
        bin.min(self.count - 1)
    }

    pub fn add(&mut self, item: &Item, splitter: &impl ItemSplitter) {
        let bounds = item.bounds();
        for axis in self.axes() {
            let [first, last] = [bounds.low, bounds.high].map(|corner| self.bin(axis, corner.as_array()[axis]));
            let (mut rest, mut begin, mut end) = (bounds, None, first);
            for bin in first..=last {
                let mut part = rest;
                if bin < last && !rest.is_empty() {
                    [part, rest] = splitter.split(item.number(), rest, axis, self.plane(axis, bin + 1));
                }
                if !part.is_empty() {
                    self.bins[axis][bin].bounds = self.bins[axis][bin].bounds.union(part);
                    (begin, end) = (begin.or(Some(bin)), bin);
                }
            }
            self.bins[axis][begin.unwrap_or(first)].begin += 1;
            self.bins[axis][end].end += 1;
        }
    }

    pub fn merged(mut self, other: &Self) -> Self {
        for (bin, other) in self.bins.as_flattened_mut().iter_mut().zip(other.bins.as_flattened()) {
            *bin = bin.union(other);
        }
        self
    }

    /// Finds the plane of the lowest cost with at most `most` references in total.
    pub fn best(&self, most: usize, block: BlockShift) -> Option<SpatialSplit> {
        let mut best: Option<SpatialSplit> = None;
        for axis in self.axes() {
            let bins = &self.bins[axis][..self.count];
            let mut above = [Bin::EMPTY; MAX_BINS];
            let mut all = Bin::EMPTY;
            for (bin, above) in bins.iter().zip(&mut above).rev() {
                all = all.union(bin);
                *above = all;
            }
            let mut below = Bin::EMPTY;
            for (number, bin) in bins.iter().enumerate() {
                let (boxes, counts) = ([below.bounds, above[number].bounds], [below.begin, above[number].end]);
                below = below.union(bin);
                if counts.contains(&0) || counts[0] + counts[1] > most {
                    continue;
                }
                let cost = self.cost(boxes, counts, block);
                if best.as_ref().is_none_or(|best| cost < best.cost) {
                    best = Some(SpatialSplit { axis, at: self.plane(axis, number), boxes, counts, cost });
                }
            }
        }
        best
    }

    /// SAH cost of both sides, relative to the area of the whole: area times leaf blocks.
    fn cost(&self, boxes: [SimdBox; 2], counts: [usize; 2], block: BlockShift) -> f32 {
        let blocks = block.block_count([counts[0] as i32, counts[1] as i32, 0, 0].into()).to_array();
        let costs = boxes.map(half_area);
        let cost = costs[0] * f64::from(blocks[0]) + costs[1] * f64::from(blocks[1]);
        (cost / half_area(self.bounds)) as f32
    }
}

impl SpatialSplit {
    /// References to an item on both sides. The item stays whole on one side where that is cheaper
    /// ("reference unsplitting").
    pub fn references(&self, item: &Item, splitter: &impl ItemSplitter) -> [Option<Item>; 2] {
        let bounds = item.bounds();
        let [below, above] = splitter.split(item.number(), bounds, self.axis, self.at);
        if above.is_empty() {
            return [Some(*item), None];
        }
        if below.is_empty() {
            return [None, Some(*item)];
        }
        let [left, right] = self.boxes.map(half_area);
        let [n, m] = self.counts.map(|count| count as f64);
        let [with_left, with_right] = self.boxes.map(|side| half_area(side.union(bounds)));
        let divided = left * n + right * m;
        let (to_left, to_right) = (with_left * n + right * (m - 1.0), left * (n - 1.0) + with_right * m);
        if to_left < divided && to_left <= to_right {
            [Some(*item), None]
        } else if to_right < divided {
            [None, Some(*item)]
        } else {
            [Some(item.with_bounds(below)), Some(item.with_bounds(above))]
        }
    }
}
