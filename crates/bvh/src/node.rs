//! The eight-wide node: eight child boxes in SoA layout and eight child words.
//!
//! A node has 256 bytes in four cache lines: for each of three axes eight minima and eight maxima,
//! then eight child words. All eight boxes are tested together.

use crate::lanes::{Lanes, bits};
use crate::slabs::{Bundle, MARGIN, Slabs};
use bytemuck::{Pod, Zeroable};
use fearless_simd::f32x8;
use fearless_simd::prelude::*;
use std::ops::Range;

/// Number of children of a node.
pub(crate) const WIDTH: usize = 8;
/// Maximum number of items in a leaf.
pub(crate) const LEAF_MAX: usize = 8;

const LEAF_BIT: u32 = 1 << 31;
const COUNT_SHIFT: u32 = 28;
const FIRST_MASK: u32 = (1 << COUNT_SHIFT) - 1;

/// Reference to a child: a node index, or a leaf with the leaf bit, the count minus one (3 bits)
/// and the first position.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(transparent)]
pub(crate) struct Child(pub u32);

impl Child {
    /// The root node.
    pub const ROOT: Self = Self(0);

    pub fn node(index: usize) -> Self {
        Self(index as u32 & !LEAF_BIT)
    }

    /// A leaf of 1 to [`LEAF_MAX`] items.
    pub fn leaf(first: usize, count: usize) -> Self {
        debug_assert!((1..=LEAF_MAX).contains(&count) && first <= FIRST_MASK as usize);
        Self(LEAF_BIT | (count as u32 - 1) << COUNT_SHIFT | first as u32 & FIRST_MASK)
    }

    #[inline(always)]
    pub fn is_leaf(self) -> bool {
        self.0 & LEAF_BIT != 0
    }

    /// Node index, or position of the leaf's first item.
    #[inline(always)]
    pub fn place(self) -> usize {
        (self.0 & FIRST_MASK) as usize
    }

    /// Range of positions of a leaf's items.
    #[inline(always)]
    pub fn items(self) -> Range<u32> {
        let first = self.0 & FIRST_MASK;
        first..first + (self.0 >> COUNT_SHIFT & 7) + 1
    }
}

/// Boxes of a node's children: `bounds[axis][0]` are the minima, `bounds[axis][1]` the maxima. A
/// free slot holds an empty box, which no ray intersects.
pub(crate) type Bounds = [[[f32; WIDTH]; 2]; 3];

/// A node with up to eight children.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(64))]
pub(crate) struct Node {
    pub bounds: Bounds,
    pub children: [Child; WIDTH],
    /// Number of slots in use.
    pub count: u32,
    unused: [u32; 7],
}

impl Node {
    pub const EMPTY: Self = Self {
        bounds: [[[f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]]; 3],
        children: [Child::ROOT; WIDTH],
        count: 0,
        unused: [0; 7],
    };

    /// Appends a child.
    pub fn add(&mut self, low: [f32; 3], high: [f32; 3], child: Child) {
        let slot = self.count as usize;
        self.set_bounds(slot, low, high);
        self.children[slot] = child;
        self.count += 1;
    }

    pub fn set_bounds(&mut self, slot: usize, low: [f32; 3], high: [f32; 3]) {
        for axis in 0..3 {
            self.bounds[axis][0][slot] = low[axis];
            self.bounds[axis][1][slot] = high[axis];
        }
    }

    /// [`intersect_boxes`] with the boxes of this node.
    #[inline(always)]
    pub fn test<S: Lanes>(&self, simd: S, slabs: &Slabs) -> (u32, f32x8<S>) {
        intersect_boxes(simd, &self.bounds, slabs)
    }

    /// [`intersect_bundle`] with the boxes of this node.
    #[inline(always)]
    pub fn test_bundle<S: Lanes>(&self, simd: S, bundle: &Bundle) -> (u32, f32x8<S>) {
        intersect_bundle(simd, &self.bounds, bundle)
    }
}

/// Bit mask of the boxes that any ray of a bundle may intersect, and lower bounds of the entry
/// distances.
#[inline(always)]
pub(crate) fn intersect_bundle<S: Lanes>(simd: S, bounds: &Bounds, bundle: &Bundle) -> (u32, f32x8<S>) {
    let mut enter = simd.splat(bundle.t_min);
    let mut leave = simd.splat(bundle.t_max);
    for (axis, sides) in bounds.iter().enumerate() {
        let (near, far) = planes(simd, sides, bundle.side[axis]);
        let near = (near - bundle.near[axis]) * bundle.near_inverse[3 + axis];
        let far = (far - bundle.far[axis]).mul_add(simd.splat(bundle.far_inverse[3 + axis]), simd.splat(MARGIN));
        // Operand order matters: a NaN leaves the interval unchanged.
        enter = simd.most(near, enter);
        leave = simd.least(far, leave);
    }
    (bits(enter.simd_le(leave)), enter)
}

/// Bit mask of the boxes that a ray intersects, and the entry distances.
///
/// No distance is NaN, since offsets are finite and inverses neither zero nor infinite. So the
/// extremes may be reduced pairwise, with less latency than one after the other (3 % more rays per
/// second).
#[inline(always)]
pub(crate) fn intersect_boxes<S: Lanes>(simd: S, bounds: &Bounds, slabs: &Slabs) -> (u32, f32x8<S>) {
    let [(near_x, far_x), (near_y, far_y), (near_z, far_z)] =
        [distances(simd, bounds, slabs, 0), distances(simd, bounds, slabs, 1), distances(simd, bounds, slabs, 2)];
    let enter = simd.most(simd.most(near_x, near_y), simd.most(near_z, simd.splat(slabs.t_min)));
    let leave = simd.least(simd.least(far_x, far_y), simd.least(far_z, simd.splat(slabs.t_max)));
    (bits(enter.simd_le(leave)), enter)
}

/// Distances to the near and the far planes along an axis.
#[inline(always)]
fn distances<S: Lanes>(simd: S, bounds: &Bounds, slabs: &Slabs, axis: usize) -> (f32x8<S>, f32x8<S>) {
    let (near, far) = planes(simd, &bounds[axis], (slabs.signs >> axis) as usize);
    let near = near.mul_add(simd.splat(slabs.inverse[axis]), simd.splat(slabs.near_offset[axis]));
    let far = far.mul_add(simd.splat(slabs.far_inverse[axis]), simd.splat(slabs.far_offset[axis]));
    (near, far)
}

/// Near and far planes along an axis.
#[inline(always)]
fn planes<S: Lanes>(simd: S, sides: &[[f32; WIDTH]; 2], side: usize) -> (f32x8<S>, f32x8<S>) {
    (simd.load(&sides[side & 1]), simd.load(&sides[side & 1 ^ 1]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fearless_simd::dispatch;
    use juggler_math::{Ray, Vec3};

    #[test]
    fn a_node_takes_four_cache_lines() {
        assert_eq!((size_of::<Node>(), align_of::<Node>()), (256, 64));
    }

    #[test]
    fn child_encoding_round_trips() {
        for (first, count) in [(0, 1), (5, 8), (FIRST_MASK as usize, 3)] {
            let child = Child::leaf(first, count);
            assert!(child.is_leaf());
            assert_eq!(child.items(), first as u32..(first + count) as u32);
        }
        assert!(!Child::node(77).is_leaf());
    }

    #[test]
    fn free_slots_are_never_hit() {
        let mut node = Node::EMPTY;
        node.add([-1.0; 3], [1.0; 3], Child::leaf(0, 1));
        for direction in [Vec3::X, -Vec3::X, Vec3::new(-0.0, 1.0, 0.0), Vec3::ONE, Vec3::new(1e-40, 1.0, 0.0)] {
            for level in crate::simd_levels() {
                let ray = Ray::new(Vec3::ZERO, direction);
                let mask = dispatch!(level, simd => node.test(simd, &Slabs::of_ray(simd, &ray)).0);
                assert_eq!(mask, 1, "{direction} {level:?}");
            }
        }
    }
}
