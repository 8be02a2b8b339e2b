//! Trees over things that move while the shutter is open: each node keeps its boxes at shutter open and close,
//! and the boxes between are interpolated (Glassner 1988, "Spacetime Ray Tracing for Animation"; as in Embree).

use crate::build::{Extent, extent, refit};
use crate::lanes::Lanes;
use crate::node::{Bounds, Child, Node, WIDTH, meet};
use crate::pages::Pages;
use crate::single::{Boxes, any_below, closest_below};
use crate::slabs::Slabs;
use crate::stack::Stack;
use crate::{BuildOptions, BuildStats, Bvh, Leaf, Quality, SimdLevel};
use bytemuck::{Pod, Zeroable};
use fearless_simd::{dispatch, f32x8};
use juggler_math::{Aabb, Ray, Vec3};
use rayon::prelude::*;

/// The boxes of a node's children at shutter open and close.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(64))]
struct Motion {
    ends: [Bounds; 2],
}

impl Motion {
    /// The boxes at a time between 0 (open) and 1 (close). Every step is monotonic in the bounds, so that a
    /// box that contains another at both ends contains it at every time, with all rounding.
    #[inline(always)]
    fn at(&self, time: f32) -> Bounds {
        let mut bounds = [[[0.0; WIDTH]; 2]; 3];
        for (axis, sides) in bounds.iter_mut().enumerate() {
            for (side, values) in sides.iter_mut().enumerate() {
                let (open, close) = (&self.ends[0][axis][side], &self.ends[1][axis][side]);
                for slot in 0..WIDTH {
                    values[slot] = between(open[slot], close[slot], time);
                }
            }
        }
        bounds
    }
}

/// What all that moves goes by, so that what encloses something at both ends does so at every time.
#[inline(always)]
pub(crate) fn between(open: f32, close: f32, time: f32) -> f32 {
    open * (1.0 - time) + close * time
}

/// A tree of boxes that move linearly while the shutter is open, eight wide. The calls are those of [`Bvh`] for one ray,
/// with the boxes at the ray's time; a still tree has no part in it.
#[derive(Clone, Debug)]
pub struct MovingBvh {
    /// Its boxes are those of all the time.
    pub(crate) bvh: Bvh,
    motion: Pages<Motion>,
    shutter: f32,
}

impl MovingBvh {
    /// Builds a tree over boxes that move linearly: item `i` has box `boxes[i][0]` when the shutter opens and
    /// `boxes[i][1]` when it closes, `shutter` seconds later; what it holds at a time between lies in the box between.
    /// Rays of other times see what is there at the nearer end. The shape of the tree is that over the boxes of the
    /// whole time. An item that is empty or has a NaN at one end is left out. Otherwise as [`Bvh::build`].
    pub fn build(boxes: &[[Aabb; 2]], shutter: f32, quality: Quality) -> Self {
        Self::build_with(boxes, shutter, &quality.into())
    }

    /// [`MovingBvh::build`] with the leaf's size and cost chosen.
    pub fn build_with(boxes: &[[Aabb; 2]], shutter: f32, options: &BuildOptions) -> Self {
        let bvh = Bvh::build_with(&boxes.par_iter().map(whole).collect::<Vec<_>>(), options);
        let ends = [0, 1].map(|end| nodes_with(&bvh, |item| wide(boxes[item][end])));
        let mut motion: Pages<Motion> = Pages::zeroed(bvh.nodes.len());
        motion.par_iter_mut().enumerate().for_each(|(i, motion)| {
            motion.ends = [bounds_of(&ends[0][i]), bounds_of(&ends[1][i])];
        });
        Self { bvh, motion, shutter }
    }

    /// [`Bvh::closest`] among the boxes at the ray's time.
    pub fn closest(&self, ray: &mut Ray, leaf: &mut impl Leaf) {
        dispatch!(self.bvh.level, simd => self.closest_one(simd, ray, leaf));
    }

    /// [`Bvh::any`] among the boxes at the ray's time.
    pub fn any(&self, ray: &Ray, leaf: &mut impl Leaf) -> bool {
        dispatch!(self.bvh.level, simd => self.any_one(simd, ray, leaf))
    }

    #[inline(always)]
    pub(crate) fn closest_one<S: Lanes>(&self, simd: S, ray: &mut Ray, leaf: &mut impl Leaf) {
        let (boxes, slabs) = (self.boxes(ray), Slabs::of_ray(simd, ray));
        closest_below(simd, boxes, Child::ROOT, Stack::new().view(), (0, ray), slabs, leaf);
    }

    #[inline(always)]
    pub(crate) fn any_one<S: Lanes>(&self, simd: S, ray: &Ray, leaf: &mut impl Leaf) -> bool {
        let (boxes, slabs) = (self.boxes(ray), Slabs::of_ray(simd, ray));
        any_below(simd, boxes, Child::ROOT, Stack::new().view(), (0, ray), &slabs, leaf)
    }

    /// The ray's time as a share of the time that the shutter is open, 0 to 1.
    #[inline(always)]
    pub(crate) fn share(&self, ray: &Ray) -> f32 {
        let share = ray.time / self.shutter;
        // Not a number where the shutter opens for no time.
        if share > 0.0 { share.min(1.0) } else { 0.0 }
    }

    #[inline(always)]
    fn boxes(&self, ray: &Ray) -> MovingBoxes<'_> {
        MovingBoxes { nodes: &self.bvh.nodes, motion: &self.motion, time: self.share(ray) }
    }

    /// [`Bvh::order`].
    pub fn order(&self) -> &[u32] {
        self.bvh.order()
    }

    /// The box of everything in the tree over all the time; empty when nothing is.
    pub fn bounds(&self) -> Aabb {
        self.bvh.bounds()
    }

    /// What the build made; the cost is that of the boxes of all the time.
    pub fn stats(&self) -> &BuildStats {
        self.bvh.stats()
    }

    /// Bytes of memory that the tree holds, without the items.
    pub fn bytes(&self) -> usize {
        self.bvh.bytes() + self.motion.bytes()
    }

    /// [`Bvh::with_simd_level`].
    pub fn with_simd_level(mut self, level: SimdLevel) -> Self {
        self.bvh = self.bvh.with_simd_level(level);
        self
    }
}

/// The boxes at one time.
#[derive(Clone, Copy)]
struct MovingBoxes<'a> {
    nodes: &'a [Node],
    motion: &'a [Motion],
    time: f32,
}

impl Boxes for MovingBoxes<'_> {
    #[inline(always)]
    fn node(&self, number: usize) -> &Node {
        &self.nodes[number]
    }

    #[inline(always)]
    fn test<S: Lanes>(&self, simd: S, number: usize, slabs: &Slabs) -> (u32, f32x8<S>) {
        meet(simd, &self.motion[number].at(self.time), slabs)
    }
}

/// The nodes with the boxes that their items have at one end.
fn nodes_with(bvh: &Bvh, bounds: impl Fn(usize) -> Aabb + Sync) -> Pages<Node> {
    let mut nodes = bvh.nodes.clone();
    refit(&mut nodes, |leaf| {
        let items = &bvh.order[leaf.items().start as usize..leaf.items().end as usize];
        items.iter().fold(Extent::EMPTY, |all, &item| all.union(extent(Extent::raw(&bounds(item as usize)))))
    });
    nodes
}

/// The bounds of a node; those of free slots finite, for infinity times zero is not a number.
fn bounds_of(node: &Node) -> Bounds {
    node.bounds.map(|sides| sides.map(|values| values.map(|value| value.clamp(-f32::MAX, f32::MAX))))
}

/// The box of an item over all the time, empty when it is so at one end.
fn whole(ends: &[Aabb; 2]) -> Aabb {
    let usable = ends.iter().all(|bounds| bounds.min.cmple(bounds.max).all());
    if usable { wide(ends[0]).union(wide(ends[1])) } else { Aabb::EMPTY }
}

/// Large enough that the boxes between, rounded, contain what lies between, however that is rounded: an
/// interpolation is off by at most two ulp of the larger end.
fn wide(bounds: Aabb) -> Aabb {
    let margin = |v: Vec3| v.abs() * (4.0 * f32::EPSILON) + f32::MIN_POSITIVE;
    let margin = margin(bounds.min).max(margin(bounds.max));
    Aabb { min: bounds.min - margin, max: bounds.max + margin }
}

#[cfg(test)]
mod tests;
