//! Construction of triangle hierarchies: bounding boxes, tree, triangle blocks of the leaves.

use super::{Block, IN_FLIGHT_BYTES, LANES, PREFETCH_BYTES, TriangleBvh, TriangleError};
use crate::build::{Items, SimdBox, checked_box, refit};
use crate::node::{Child, Node};
use crate::pages::Pages;
use crate::triangle::TriangleTest;
use crate::triangle::has_area;
use crate::{BuildOptions, Bvh, MAX_ITEMS, Quality};
use bytemuck::cast;
use juggler_math::{Aabb, BuildControl, Vec3};
use rayon::prelude::*;
use wide::{f32x4, i32x4};

/// Number of nodes or blocks per parallel task.
const CHUNK: usize = 1 << 8;

impl TriangleBvh {
    /// Builds a hierarchy over triangles, each given by three indices into `positions`. Degenerate
    /// triangles and those with a vertex that is not finite are never hit. Uses the threads of the
    /// current rayon pool; the result does not depend on their number.
    pub fn build(positions: &[Vec3], triangles: &[[u32; 3]], quality: Quality) -> Result<Self, TriangleError> {
        Self::build_with_control(positions, triangles, quality, &BuildControl::default())
    }

    /// [`TriangleBvh::build`], which ends early if `control` is cancelled, and reports its progress
    /// to it.
    pub fn build_with_control(
        positions: &[Vec3],
        triangles: &[[u32; 3]],
        quality: Quality,
        control: &BuildControl,
    ) -> Result<Self, TriangleError> {
        control.check()?;
        if triangles.len() > MAX_ITEMS {
            return Err(TriangleError::TooMany { triangles: triangles.len() });
        }
        let mesh = TriangleList { positions, triangles };
        let mut bvh = mesh.tree(quality, control)?;
        let leaves = number_leaves(&mut bvh.nodes);
        control.check()?;
        // The blocks hold the triangles' indices, so the tree no longer needs the order.
        let order = std::mem::take(&mut bvh.order);
        let mut blocks = Pages::zeroed(leaves.len());
        blocks.par_iter_mut().zip(&leaves).with_min_len(CHUNK).try_for_each(|(block, leaf)| {
            control.check()?;
            *block = mesh.block(&order[leaf.items().start as usize..leaf.items().end as usize])?;
            Ok::<_, TriangleError>(())
        })?;
        let bytes = bvh.bytes() + blocks.bytes();
        let (in_flight, prefetches) = (bytes > IN_FLIGHT_BYTES, bytes > PREFETCH_BYTES);
        Ok(Self { bvh, blocks, in_flight, prefetches, test: TriangleTest::default() })
    }

    /// Assigns new vertex positions, for as many triangles as in the build and in the same order.
    /// The topology does not change, see [`Bvh::refit`]. Where [spatial splits](Quality::Best) put
    /// a triangle into several leaves, each leaf gets the box of the whole triangle, so that
    /// refitting slows traversal down even with unchanged vertices. After an error the tree is
    /// unchanged.
    pub fn refit(&mut self, positions: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), TriangleError> {
        let mesh = TriangleList { positions, triangles };
        let numbers = (0..triangles.len()).into_par_iter().with_min_len(CHUNK);
        if let Some(error) = numbers.find_map_first(|triangle| mesh.corners(triangle).err()) {
            return Err(error);
        }
        let usable = |triangle| mesh.corners(triangle).is_ok_and(has_area);
        let lanes = self.blocks.iter().flat_map(|block| block.index).filter(|&triangle| triangle != u32::MAX);
        self.bvh.check_refit(triangles.len(), lanes, usable)?;
        let boxes: Vec<SimdBox> =
            self.blocks.par_iter_mut().with_min_len(CHUNK).map(|block| mesh.refill(block)).collect();
        self.bvh.bounds = refit(&mut self.bvh.nodes, |leaf| boxes[leaf.items().start as usize]);
        self.bvh.update_cost();
        Ok(())
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;

#[cfg(test)]
impl TriangleBvh {
    pub(crate) fn same_bits(&self, other: &Self) -> bool {
        *self.bvh.nodes == *other.bvh.nodes && *self.blocks == *other.blocks && self.bvh.stats == other.bvh.stats
    }
}

/// Replaces the first position of each leaf by the leaf's number; returns the previous leaves.
pub(super) fn number_leaves(nodes: &mut [Node]) -> Vec<Child> {
    let leaves = |node: &Node| node.children[..node.count as usize].iter().filter(|child| child.is_leaf()).count();
    let counts: Vec<usize> = nodes.par_chunks(CHUNK).map(|nodes| nodes.iter().map(leaves).sum()).collect();
    let mut old = vec![Child::ROOT; counts.iter().sum()];
    let (mut rest, mut start) = (&mut old[..], 0);
    let mut jobs = Vec::with_capacity(counts.len());
    for (nodes, count) in nodes.chunks_mut(CHUNK).zip(counts) {
        let (list, after) = rest.split_at_mut(count);
        rest = after;
        jobs.push((nodes, list, start));
        start += count;
    }
    jobs.into_par_iter().for_each(|(nodes, list, start)| {
        let children = nodes.iter_mut().flat_map(|node| &mut node.children[..node.count as usize]);
        for ((child, old), number) in children.filter(|child| child.is_leaf()).zip(list).zip(start..) {
            *old = *child;
            *child = Child::leaf(number, child.items().len());
        }
    });
    old
}

#[derive(Clone, Copy)]
pub(super) struct TriangleList<'a> {
    pub positions: &'a [Vec3],
    pub triangles: &'a [[u32; 3]],
}

impl TriangleList<'_> {
    fn items(&self, control: &BuildControl) -> Result<Items, TriangleError> {
        Items::new(self.triangles.len(), |triangle| {
            if triangle.is_multiple_of(CHUNK) {
                control.check()?;
            }
            self.corners(triangle).map(bounds_of)
        })
    }

    /// Builds the tree; for the best quality the cheaper of two, with and without spatial splits.
    fn tree(&self, quality: Quality, control: &BuildControl) -> Result<Bvh, TriangleError> {
        let options = BuildOptions { block: LANES, ..quality.into() };
        let whole = Bvh::from_items(self.items(control)?, &options, control)?;
        if quality != Quality::Best {
            return Ok(whole);
        }
        let with_splits = Bvh::with_spatial_splits(self.items(control)?, &options, self, control)?;
        Ok(if with_splits.stats.sah_cost < whole.stats.sah_cost { with_splits } else { whole })
    }

    pub fn corners(&self, triangle: usize) -> Result<[Vec3; 3], TriangleError> {
        let mut corners = [Vec3::ZERO; 3];
        for (corner, &vertex) in corners.iter_mut().zip(&self.triangles[triangle]) {
            let vertices = self.positions.len();
            let missing = || TriangleError::NoSuchVertex { triangle, vertex, vertices };
            *corner = *self.positions.get(vertex as usize).ok_or_else(missing)?;
        }
        Ok(corners)
    }

    /// Block of a leaf with these triangles.
    pub fn block(&self, triangles: &[u32]) -> Result<Block, TriangleError> {
        let mut block = Block::EMPTY;
        for (lane, &triangle) in triangles.iter().enumerate() {
            block.set(lane, triangle, self.corners(triangle as usize)?);
        }
        Ok(block)
    }

    /// Updates the vertices of a block's triangles; returns their bounds.
    fn refill(&self, block: &mut Block) -> SimdBox {
        let mut bounds = SimdBox::EMPTY;
        let lanes = block.index.into_iter().enumerate().filter(|&(_, triangle)| triangle != u32::MAX);
        for (lane, triangle) in lanes {
            let corners = self.corners(triangle as usize).ok().filter(|&corners| has_area(corners));
            // A triangle that became degenerate collapses to a point, which no ray hits.
            block.set(lane, triangle, corners.unwrap_or_default());
            bounds = bounds.union(corners.map_or(SimdBox::EMPTY, |corners| checked_box(bounds_of(corners))));
        }
        bounds
    }
}

/// Bounds of a triangle; empty if it can never be hit.
#[inline(always)]
fn bounds_of(corners: [Vec3; 3]) -> SimdBox {
    if has_area(corners) { padded_bounds(corners) } else { SimdBox::EMPTY }
}

/// Enlarged bounds of three finite vertices. The triangle test rounds the vertices in the ray's
/// frame by up to 4 half ulps of the triangle's size more than the box test allows for, and a ray
/// that hits the triangle must not miss its box.
#[inline(always)]
pub(super) fn padded_bounds(corners: [Vec3; 3]) -> SimdBox {
    let [a, b, c] = corners.map(|v| f32x4::new([v.x, v.y, v.z, 0.0]));
    let (low, high) = (a.fast_min(b).fast_min(c), a.fast_max(b).fast_max(c));
    let [x, y, z, _] = (high - low).to_array();
    let margin = f32x4::splat(x.max(y).max(z) * MARGIN);
    SimdBox { low: -next_up(-(low - margin)), high: next_up(high + margin) }
}

/// Next larger number in each lane, or infinity; undefined for negative infinity and NaN.
#[inline(always)]
fn next_up(numbers: f32x4) -> f32x4 {
    // Adding zero turns -0 into +0.
    let bits: i32x4 = cast(numbers.fast_min(f32x4::splat(f32::MAX)) + f32x4::ZERO);
    let step: i32x4 = (bits >> 31) | i32x4::ONE;
    cast(bits + step)
}

/// Margin of a triangle's box relative to its longest edge.
const MARGIN: f32 = 4.0 * f32::EPSILON;

/// Absolute margin of a triangle's box, on each side.
pub(super) fn margin_of(corners: [Vec3; 3]) -> f32 {
    Aabb::from_points(corners).extent().max_element() * MARGIN
}
