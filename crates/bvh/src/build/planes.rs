//! Bins of space: where to cut it, and on which side of a plane items lie.

use super::binary::BinaryNode;
use super::bins::Blocks;
use super::item::{Extent, Item};
use super::spatial::Divide;

/// Fewer than for boxes that are not divided: each item is divided at each plane that it crosses.
const MAX_BINS: usize = 16;

/// What lies between neighbouring planes across an axis: the box of all parts of items, and how many items have their
/// first and their last part there.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Extent,
    begin: usize,
    end: usize,
}

impl Bin {
    const EMPTY: Self = Self { bounds: Extent::EMPTY, begin: 0, end: 0 };

    fn union(&self, other: &Self) -> Self {
        let bounds = self.bounds.union(other.bounds);
        Self { bounds, begin: self.begin + other.begin, end: self.end + other.end }
    }
}

/// Bins along three axes.
pub(super) struct Planes {
    bounds: Extent,
    count: usize,
    /// What to multiply the distance from the lower bound by to get the bin; zero for an axis that is not cut.
    scale: [f32; 3],
    bins: [[Bin; MAX_BINS]; 3],
}

/// A plane across an axis, and what the bins tell of both sides.
pub(super) struct Plane {
    axis: usize,
    at: f32,
    boxes: [Extent; 2],
    counts: [usize; 2],
    /// As that of a [`Cut`](super::bins::Cut).
    pub cost: f32,
}

/// Half the surface area; zero for empty boxes.
pub(super) fn half_area(bounds: Extent) -> f64 {
    if bounds.is_empty() { 0.0 } else { BinaryNode::new(bounds, 0, 0).half_area() }
}

impl Planes {
    /// Few items need few bins.
    pub fn new(bounds: Extent, items: usize) -> Self {
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

    /// The plane below a bin.
    fn plane(&self, axis: usize, bin: usize) -> f32 {
        self.bounds.low.as_array()[axis] + bin as f32 / self.scale[axis]
    }

    fn bin(&self, axis: usize, at: f32) -> usize {
        let bin = ((at - self.bounds.low.as_array()[axis]) * self.scale[axis]) as usize;
        bin.min(self.count - 1)
    }

    pub fn add(&mut self, item: &Item, divide: &impl Divide) {
        let bounds = item.extent();
        for axis in self.axes() {
            let [first, last] = [bounds.low, bounds.high].map(|corner| self.bin(axis, corner.as_array()[axis]));
            let (mut rest, mut begin, mut end) = (bounds, None, first);
            for bin in first..=last {
                let mut part = rest;
                if bin < last && !rest.is_empty() {
                    [part, rest] = divide.divide(item.number(), rest, axis, self.plane(axis, bin + 1));
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

    /// The cheapest plane that makes at most so many references of all items.
    pub fn best(&self, most: usize, block: Blocks) -> Option<Plane> {
        let mut best: Option<Plane> = None;
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
                    best = Some(Plane { axis, at: self.plane(axis, number), boxes, counts, cost });
                }
            }
        }
        best
    }

    /// Area times blocks of both sides, as a share of the area of the whole.
    fn cost(&self, boxes: [Extent; 2], counts: [usize; 2], block: Blocks) -> f32 {
        let blocks = block.of([counts[0] as i32, counts[1] as i32, 0, 0].into()).to_array();
        let costs = boxes.map(half_area);
        let cost = costs[0] * f64::from(blocks[0]) + costs[1] * f64::from(blocks[1]);
        (cost / half_area(self.bounds)) as f32
    }
}

impl Plane {
    /// The part of an item on each side. An item is left whole where that is cheaper ("reference unsplitting").
    pub fn parts(&self, item: &Item, divide: &impl Divide) -> [Option<Item>; 2] {
        let bounds = item.extent();
        let [below, above] = divide.divide(item.number(), bounds, self.axis, self.at);
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
            [Some(item.with_extent(below)), Some(item.with_extent(above))]
        }
    }
}
