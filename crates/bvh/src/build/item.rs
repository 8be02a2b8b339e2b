//! Boxes of the builder: four SIMD lanes, of which the fourth carries the item's index.

use crate::pages::Pages;
use bytemuck::{Pod, Zeroable};
use juggler_math::{Aabb, Vec3};
use rayon::prelude::*;
use wide::f32x4;

/// A box as two vectors; lane 3 is unused. Contains neither NaN nor negative zero, so that the
/// union of boxes has the same bits in every order.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct SimdBox {
    pub low: f32x4,
    pub high: f32x4,
}

impl SimdBox {
    pub const EMPTY: Self = Self { low: f32x4::new([f32::INFINITY; 4]), high: f32x4::new([f32::NEG_INFINITY; 4]) };

    #[inline(always)]
    pub fn union(self, other: Self) -> Self {
        Self { low: self.low.fast_min(other.low), high: self.high.fast_max(other.high) }
    }

    #[inline(always)]
    pub fn with(self, point: f32x4) -> Self {
        Self { low: self.low.fast_min(point), high: self.high.fast_max(point) }
    }

    /// Intersection of two boxes, which may be [empty](Self::is_empty).
    #[inline]
    pub fn intersection(self, other: Self) -> Self {
        Self { low: self.low.fast_max(other.low), high: self.high.fast_min(other.high) }
    }

    #[inline]
    pub fn is_empty(self) -> bool {
        self.low.simd_gt(self.high).to_bitmask() & 7 != 0
    }

    /// Half edge lengths; the full lengths of the largest boxes would overflow.
    #[inline(always)]
    fn half_sides(self) -> [f32; 3] {
        let [x, y, z, _] = (self.high * f32x4::splat(0.5) - self.low * f32x4::splat(0.5)).to_array();
        [x, y, z]
    }

    /// Converts a box without checks. The builder only accepts boxes checked by [`Item::new`].
    #[inline(always)]
    pub fn raw(bounds: &Aabb) -> Self {
        let corner = |v: Vec3| f32x4::new([v.x, v.y, v.z, 0.0]);
        Self { low: corner(bounds.min), high: corner(bounds.max) }
    }

    pub fn aabb(self) -> Aabb {
        let point = |v: f32x4| Vec3::from_slice(&v.to_array()[..3]);
        Aabb { min: point(self.low), max: point(self.high) }
    }

    /// Axis along which the box is longest.
    pub fn longest_axis(self) -> usize {
        let [x, y, z] = self.half_sides();
        if x >= y && x >= z { 0 } else { 2 - usize::from(y >= z) }
    }

    /// Scale factor that makes half the longest edge 1, so that areas neither overflow nor
    /// underflow. Zero for a point.
    pub fn inverse_size(self) -> f32 {
        let inverse = 1.0 / self.half_sides().into_iter().fold(0.0, f32::max);
        if inverse.is_finite() { inverse } else { 0.0 }
    }
}

/// A build primitive: its box, with the item index in lane 3 of the low corner.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Item(SimdBox);

/// Bit pattern that makes an index of up to 28 bits a normal float, so that arithmetic on lane 3 is
/// harmless.
const NUMBER: u32 = 0x4000_0000;

impl Item {
    /// Constructs an item; `None` for a box that no ray can intersect, which is empty or has a NaN.
    /// Infinite bounds are clamped to the largest finite numbers.
    #[inline(always)]
    pub fn new(bounds: SimdBox, number: u32) -> Option<Self> {
        let usable = bounds.low.simd_le(bounds.high).to_bitmask() & 7 == 7;
        let largest = f32x4::splat(f32::MAX);
        // Adding zero turns -0 into +0.
        let clamp = |v: f32x4| v.fast_max(-largest).fast_min(largest) + f32x4::ZERO;
        let lanes = f32x4::new([u32::MAX, u32::MAX, u32::MAX, 0].map(f32::from_bits));
        let low = lanes.bitselect(clamp(bounds.low), f32x4::splat(f32::from_bits(NUMBER | number)));
        usable.then(|| Self(SimdBox { low, high: clamp(bounds.high) & lanes }))
    }

    /// The item, or a reference to a part of it, with another box.
    pub fn with_bounds(&self, bounds: SimdBox) -> Self {
        let ([a, b, c, _], number) = (bounds.low.to_array(), self.0.low.as_array()[3]);
        Self(SimdBox { low: f32x4::new([a, b, c, number]), high: bounds.high })
    }

    pub fn number(&self) -> u32 {
        self.0.low.as_array()[3].to_bits() & !NUMBER
    }

    #[inline(always)]
    pub fn bounds(&self) -> SimdBox {
        self.0
    }

    /// Half the center of the box: a difference of two of these never overflows.
    #[inline(always)]
    pub fn center(&self) -> f32x4 {
        self.0.low * f32x4::splat(0.25) + self.0.high * f32x4::splat(0.25)
    }
}

/// Bounds of a set of items: the box of the items and the box of their [centers](Item::center).
#[derive(Clone, Copy, Debug)]
pub(crate) struct SetBounds {
    pub bounds: SimdBox,
    pub centers: SimdBox,
}

impl SetBounds {
    pub const EMPTY: Self = Self { bounds: SimdBox::EMPTY, centers: SimdBox::EMPTY };

    #[inline(always)]
    pub fn with(self, item: &Item) -> Self {
        Self { bounds: self.bounds.union(item.bounds()), centers: self.centers.with(item.center()) }
    }

    pub fn union(self, other: Self) -> Self {
        Self { bounds: self.bounds.union(other.bounds), centers: self.centers.union(other.centers) }
    }

    pub fn from_items(items: &[Item]) -> Self {
        items.iter().fold(Self::EMPTY, Self::with)
    }
}

/// Items to build a tree over.
pub(crate) struct Items {
    list: Pages<Item>,
    /// Number of items in use at the front of the list.
    pub count: usize,
    pub extents: SetBounds,
    pub left_out: usize,
}

/// Number of boxes per parallel task.
const CHUNK: usize = 1 << 13;

impl Items {
    /// Collects the items; item `i` has the box `bounds(i)`. Returns the error of the smallest `i`.
    pub fn new<E: Send>(count: usize, bounds: impl Fn(usize) -> Result<SimdBox, E> + Sync) -> Result<Self, E> {
        let mut list = Pages::zeroed(count);
        let take = |(chunk, items): (usize, &mut [Item])| {
            let (mut extents, mut used) = (SetBounds::EMPTY, 0);
            for i in 0..items.len() {
                let number = chunk * CHUNK + i;
                if let Some(item) = Item::new(bounds(number)?, number as u32) {
                    extents = extents.with(&item);
                    items[used] = item;
                    used += 1;
                }
            }
            Ok((extents, used))
        };
        let chunks: Vec<Result<(SetBounds, usize), E>> = list.par_chunks_mut(CHUNK).enumerate().map(take).collect();
        let mut items = Self { list, count: 0, extents: SetBounds::EMPTY, left_out: 0 };
        for (chunk, result) in chunks.into_iter().enumerate() {
            let (extents, used) = result?;
            if items.count < chunk * CHUNK {
                items.list.copy_within(chunk * CHUNK..chunk * CHUNK + used, items.count);
            }
            items.count += used;
            items.extents = items.extents.union(extents);
        }
        items.left_out = count - items.count;
        Ok(items)
    }

    pub fn list(&mut self) -> &mut [Item] {
        &mut self.list[..self.count]
    }
}
