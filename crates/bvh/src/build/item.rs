//! The builder's boxes: four lanes, of which the fourth carries the number of the item.

use crate::pages::Pages;
use bytemuck::{Pod, Zeroable};
use juggler_math::{Aabb, Vec3};
use rayon::prelude::*;
use wide::f32x4;

/// A box as two vectors. Lane 3 means nothing. Never holds a NaN or a negative zero, so that the union of
/// boxes is the same bits in every order.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Extent {
    pub low: f32x4,
    pub high: f32x4,
}

impl Extent {
    pub const EMPTY: Self = Self { low: f32x4::new([f32::INFINITY; 4]), high: f32x4::new([f32::NEG_INFINITY; 4]) };

    #[inline(always)]
    pub fn union(self, other: Self) -> Self {
        Self { low: self.low.fast_min(other.low), high: self.high.fast_max(other.high) }
    }

    #[inline(always)]
    pub fn with(self, point: f32x4) -> Self {
        Self { low: self.low.fast_min(point), high: self.high.fast_max(point) }
    }

    /// What lies in both, maybe [nothing](Self::is_empty).
    #[inline]
    pub fn intersection(self, other: Self) -> Self {
        Self { low: self.low.fast_max(other.low), high: self.high.fast_min(other.high) }
    }

    #[inline]
    pub fn is_empty(self) -> bool {
        self.low.simd_gt(self.high).to_bitmask() & 7 != 0
    }

    /// Half the sides: those of the largest boxes do not fit.
    #[inline(always)]
    fn half_sides(self) -> [f32; 3] {
        let [x, y, z, _] = (self.high * f32x4::splat(0.5) - self.low * f32x4::splat(0.5)).to_array();
        [x, y, z]
    }

    /// The corners of a box in vectors. The builder takes boxes only as [`Item::new`] makes them of these.
    #[inline(always)]
    pub fn raw(bounds: &Aabb) -> Self {
        let corner = |v: Vec3| f32x4::new([v.x, v.y, v.z, 0.0]);
        Self { low: corner(bounds.min), high: corner(bounds.max) }
    }

    pub fn aabb(self) -> Aabb {
        let point = |v: f32x4| Vec3::from_slice(&v.to_array()[..3]);
        Aabb { min: point(self.low), max: point(self.high) }
    }

    /// The axis along which the box is longest.
    pub fn longest_axis(self) -> usize {
        let [x, y, z] = self.half_sides();
        if x >= y && x >= z { 0 } else { 2 - usize::from(y >= z) }
    }

    /// What to multiply lengths by, so that half the longest side of the box is 1 and areas neither
    /// overflow nor underflow. Zero for a point.
    pub fn inverse_size(self) -> f32 {
        let inverse = 1.0 / self.half_sides().into_iter().fold(0.0, f32::max);
        if inverse.is_finite() { inverse } else { 0.0 }
    }
}

/// An item on its way into the tree: its box, and its number in lane 3 of the low corner.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Item(Extent);

/// Makes a number of up to 28 bits an ordinary float, whatever is computed with that lane.
const NUMBER: u32 = 0x4000_0000;

impl Item {
    /// `None` for a box that no ray can meet: an empty one and one with a NaN. Infinite bounds become the
    /// largest finite numbers.
    #[inline(always)]
    pub fn new(bounds: Extent, number: u32) -> Option<Self> {
        let usable = bounds.low.simd_le(bounds.high).to_bitmask() & 7 == 7;
        let largest = f32x4::splat(f32::MAX);
        // The sum takes -0 to +0.
        let cut = |v: f32x4| v.fast_max(-largest).fast_min(largest) + f32x4::ZERO;
        let lanes = f32x4::new([u32::MAX, u32::MAX, u32::MAX, 0].map(f32::from_bits));
        let low = lanes.bitselect(cut(bounds.low), f32x4::splat(f32::from_bits(NUMBER | number)));
        usable.then(|| Self(Extent { low, high: cut(bounds.high) & lanes }))
    }

    /// The same item, or a part of it, with another box.
    pub fn with_extent(&self, extent: Extent) -> Self {
        let ([a, b, c, _], number) = (extent.low.to_array(), self.0.low.as_array()[3]);
        Self(Extent { low: f32x4::new([a, b, c, number]), high: extent.high })
    }

    pub fn number(&self) -> u32 {
        self.0.low.as_array()[3].to_bits() & !NUMBER
    }

    #[inline(always)]
    pub fn extent(&self) -> Extent {
        self.0
    }

    /// Half the center of the box: a difference of two of them never overflows.
    #[inline(always)]
    pub fn center(&self) -> f32x4 {
        self.0.low * f32x4::splat(0.25) + self.0.high * f32x4::splat(0.25)
    }
}

/// What is known of a set of items: the box around them and the box of their [centers](Item::center).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Around {
    pub bounds: Extent,
    pub centers: Extent,
}

impl Around {
    pub const EMPTY: Self = Self { bounds: Extent::EMPTY, centers: Extent::EMPTY };

    #[inline(always)]
    pub fn with(self, item: &Item) -> Self {
        Self { bounds: self.bounds.union(item.extent()), centers: self.centers.with(item.center()) }
    }

    pub fn union(self, other: Self) -> Self {
        Self { bounds: self.bounds.union(other.bounds), centers: self.centers.union(other.centers) }
    }

    pub fn of(items: &[Item]) -> Self {
        items.iter().fold(Self::EMPTY, Self::with)
    }
}

/// The items that a tree is built over.
pub(crate) struct Items {
    list: Pages<Item>,
    /// How many of the list are in use; the others lie behind.
    pub count: usize,
    pub around: Around,
    pub left_out: usize,
}

/// So many boxes are taken at once by a thread.
const CHUNK: usize = 1 << 13;

impl Items {
    /// Item `i` has the box `bounds(i)`. The error is that of the smallest `i`.
    pub fn new<E: Send>(count: usize, bounds: impl Fn(usize) -> Result<Extent, E> + Sync) -> Result<Self, E> {
        let mut list = Pages::zeroed(count);
        let take = |(chunk, items): (usize, &mut [Item])| {
            let (mut around, mut used) = (Around::EMPTY, 0);
            for i in 0..items.len() {
                let number = chunk * CHUNK + i;
                if let Some(item) = Item::new(bounds(number)?, number as u32) {
                    around = around.with(&item);
                    items[used] = item;
                    used += 1;
                }
            }
            Ok((around, used))
        };
        let chunks: Vec<Result<(Around, usize), E>> = list.par_chunks_mut(CHUNK).enumerate().map(take).collect();
        let mut items = Self { list, count: 0, around: Around::EMPTY, left_out: 0 };
        for (chunk, result) in chunks.into_iter().enumerate() {
            let (around, used) = result?;
            if items.count < chunk * CHUNK {
                items.list.copy_within(chunk * CHUNK..chunk * CHUNK + used, items.count);
            }
            items.count += used;
            items.around = items.around.union(around);
        }
        items.left_out = count - items.count;
        Ok(items)
    }

    pub fn list(&mut self) -> &mut [Item] {
        &mut self.list[..self.count]
    }
}
