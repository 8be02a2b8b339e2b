//! Hierarchies with linear motion blur: each node stores its boxes at shutter open and close, and
//! the traversal interpolates them (Glassner 1988, "Spacetime Ray Tracing for Animation"; as in
//! Embree).

use crate::build::{SimdBox, checked_box, refit};
use crate::lanes::Lanes;
use crate::node::{Bounds, Child, Node, WIDTH, intersect_boxes};
use crate::pages::Pages;
use crate::single::{TraversalMemory, any_below, closest_below};
use crate::slabs::Slabs;
use crate::stack::Stack;
use crate::{BuildOptions, BuildStats, Bvh, Leaf, Quality, SimdLevel};
use bytemuck::{Pod, Zeroable};
use fearless_simd::{dispatch, f32x8};
use juggler_math::{Aabb, BuildControl, Cancelled, Ray, Vec3};
use rayon::prelude::*;

/// Boxes of a node's children at shutter open and close.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(64))]
struct NodeMotion {
    ends: [Bounds; 2],
}

impl NodeMotion {
    /// Boxes at a normalized time, 0 (open) to 1 (close). Every step is monotonic in the bounds, so
    /// a box that contains another at both ends contains it at every time, including rounding.
    #[inline(always)]
    fn at(&self, time: f32) -> Bounds {
        let mut bounds = [[[0.0; WIDTH]; 2]; 3];
        for (axis, sides) in bounds.iter_mut().enumerate() {
            for (side, values) in sides.iter_mut().enumerate() {
                let (open, close) = (&self.ends[0][axis][side], &self.ends[1][axis][side]);
                for slot in 0..WIDTH {
                    values[slot] = lerp(open[slot], close[slot], time);
                }
            }
        }
        bounds
    }
}

/// Interpolates a coordinate of a box or a vertex. All motion uses this function, so that
/// containment at both ends implies containment at every time.
#[inline(always)]
pub(crate) fn lerp(open: f32, close: f32, time: f32) -> f32 {
    open * (1.0 - time) + close * time
}

/// An eight-wide hierarchy over linearly moving boxes. It offers the single-ray queries of [`Bvh`],
/// with the boxes at the ray's time.
#[derive(Clone, Debug)]
pub struct MovingBvh {
    /// Hierarchy over the bounds of the whole shutter interval.
    pub(crate) bvh: Bvh,
    motion: Pages<NodeMotion>,
    shutter: f32,
}

impl MovingBvh {
    /// Builds a hierarchy over linearly moving boxes: item `i` has the box `boxes[i][0]` at shutter
    /// open (time 0) and `boxes[i][1]` at shutter close (time `shutter`, in the unit of
    /// [`Ray::time`]). At a time in between, the interpolated box must contain the item. Ray times
    /// are clamped to the shutter interval. The topology is that of a build over the bounds of the
    /// whole interval. Items whose box is empty or has a NaN at one end are left out. Otherwise as
    /// [`Bvh::build`].
    pub fn build(boxes: &[[Aabb; 2]], shutter: f32, quality: Quality) -> Self {
        Self::build_with(boxes, shutter, &quality.into())
    }

    /// [`MovingBvh::build`] with explicit [`BuildOptions`].
    pub fn build_with(boxes: &[[Aabb; 2]], shutter: f32, options: &BuildOptions) -> Self {
        let bvh = Bvh::build_with(boxes.par_iter().map(swept_bounds).collect::<Vec<_>>(), options);
        Self::with_topology(bvh, boxes, shutter)
    }

    /// [`MovingBvh::build_with`], which ends early if `control` is cancelled, and reports its
    /// progress to it.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] if `control` is cancelled.
    pub fn build_with_control(
        boxes: &[[Aabb; 2]],
        shutter: f32,
        options: &BuildOptions,
        control: &BuildControl,
    ) -> Result<Self, Cancelled> {
        let swept: Vec<Aabb> = boxes.par_iter().map(swept_bounds).collect();
        let bvh = Bvh::build_with_control(swept, options, control)?;
        Ok(Self::with_topology(bvh, boxes, shutter))
    }

    fn with_topology(bvh: Bvh, boxes: &[[Aabb; 2]], shutter: f32) -> Self {
        let ends = [0, 1].map(|end| nodes_with(&bvh, |item| padded(boxes[item][end])));
        let mut motion: Pages<NodeMotion> = Pages::zeroed(bvh.nodes.len());
        motion.par_iter_mut().enumerate().for_each(|(i, motion)| {
            motion.ends = [bounds_of(&ends[0][i]), bounds_of(&ends[1][i])];
        });
        Self { bvh, motion, shutter }
    }

    /// [`Bvh::closest`] with the boxes at the ray's time.
    pub fn closest(&self, ray: &mut Ray, leaf: &mut impl Leaf) {
        dispatch!(self.bvh.level, simd => self.closest_one(simd, ray, leaf));
    }

    /// [`Bvh::any`] with the boxes at the ray's time.
    pub fn any(&self, ray: &Ray, leaf: &mut impl Leaf) -> bool {
        dispatch!(self.bvh.level, simd => self.any_one(simd, ray, leaf))
    }

    #[inline(always)]
    pub(crate) fn closest_one<S: Lanes>(&self, simd: S, ray: &mut Ray, leaf: &mut impl Leaf) {
        let (memory, slabs) = (self.memory(ray), Slabs::of_ray(simd, ray));
        closest_below(simd, memory, Child::ROOT, Stack::new().view(), (0, ray), slabs, leaf);
    }

    #[inline(always)]
    pub(crate) fn any_one<S: Lanes>(&self, simd: S, ray: &Ray, leaf: &mut impl Leaf) -> bool {
        let (memory, slabs) = (self.memory(ray), Slabs::of_ray(simd, ray));
        any_below(simd, memory, Child::ROOT, Stack::new().view(), (0, ray), &slabs, leaf)
    }

    /// The ray's time normalized to the shutter interval and clamped to 0 to 1.
    #[inline(always)]
    pub(crate) fn shutter_fraction(&self, ray: &Ray) -> f32 {
        let fraction = ray.time / self.shutter;
        // NaN for a shutter interval of length zero.
        if fraction > 0.0 { fraction.min(1.0) } else { 0.0 }
    }

    #[inline(always)]
    fn memory(&self, ray: &Ray) -> MovingMemory<'_> {
        MovingMemory { nodes: &self.bvh.nodes, motion: &self.motion, time: self.shutter_fraction(ray) }
    }

    /// [`Bvh::order`].
    pub fn order(&self) -> &[u32] {
        self.bvh.order()
    }

    /// Bounds of all items over the shutter interval; empty for an empty hierarchy.
    pub fn bounds(&self) -> Aabb {
        self.bvh.bounds()
    }

    /// Statistics of the build; the SAH cost is that of the bounds over the shutter interval.
    pub fn stats(&self) -> &BuildStats {
        self.bvh.stats()
    }

    /// Memory of the hierarchy in bytes, without the items.
    pub fn bytes(&self) -> usize {
        self.bvh.bytes() + self.motion.bytes()
    }

    /// [`Bvh::with_simd_level`].
    pub fn with_simd_level(mut self, level: SimdLevel) -> Self {
        self.bvh = self.bvh.with_simd_level(level);
        self
    }
}

/// Boxes at one time.
#[derive(Clone, Copy)]
struct MovingMemory<'a> {
    nodes: &'a [Node],
    motion: &'a [NodeMotion],
    time: f32,
}

impl TraversalMemory for MovingMemory<'_> {
    #[inline(always)]
    fn node(&self, number: usize) -> &Node {
        &self.nodes[number]
    }

    #[inline(always)]
    fn test<S: Lanes>(&self, simd: S, number: usize, slabs: &Slabs) -> (u32, f32x8<S>) {
        intersect_boxes(simd, &self.motion[number].at(self.time), slabs)
    }
}

/// Copies the nodes and refits them to the items' boxes at one end.
fn nodes_with(bvh: &Bvh, bounds: impl Fn(usize) -> Aabb + Sync) -> Pages<Node> {
    let mut nodes = bvh.nodes.clone();
    refit(&mut nodes, |leaf| {
        let items = &bvh.order[leaf.items().start as usize..leaf.items().end as usize];
        items.iter().fold(SimdBox::EMPTY, |all, &item| all.union(checked_box(SimdBox::raw(&bounds(item as usize)))))
    });
    nodes
}

/// Bounds of a node with finite numbers in free slots, since infinity times zero is NaN.
fn bounds_of(node: &Node) -> Bounds {
    node.bounds.map(|sides| sides.map(|values| values.map(|value| value.clamp(-f32::MAX, f32::MAX))))
}

/// Bounds of an item over the shutter interval; empty if the box at one end is empty.
fn swept_bounds(ends: &[Aabb; 2]) -> Aabb {
    let usable = ends.iter().all(|bounds| bounds.min.cmple(bounds.max).all());
    if usable { padded(ends[0]).union(padded(ends[1])) } else { Aabb::EMPTY }
}

/// Enlarges a box so that interpolated boxes contain interpolated items despite rounding: an
/// interpolation is off by at most two ulps of the larger end.
fn padded(bounds: Aabb) -> Aabb {
    let margin = |v: Vec3| v.abs() * (4.0 * f32::EPSILON) + f32::MIN_POSITIVE;
    let margin = margin(bounds.min).max(margin(bounds.max));
    Aabb { min: bounds.min - margin, max: bounds.max + margin }
}

#[cfg(test)]
mod tests;
