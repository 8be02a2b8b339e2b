//! Triangle hierarchies with linear motion blur.

use super::build::{TriangleList, number_leaves, padded_bounds};
use super::simd_test::RayFrames;
use super::{Block, LANES, TriangleError, TriangleHit};
use crate::lanes::{Bits, Lanes};
use crate::moving::lerp;
use crate::pages::Pages;
use crate::slabs::Slabs;
use crate::triangle::{Shear, has_area};
use crate::{BuildOptions, BuildStats, Leaf, MAX_ITEMS, MovingBvh, Quality, SimdLevel};
use fearless_simd::dispatch;
use juggler_math::{Aabb, BuildControl, Ray, Vec3};
use rayon::prelude::*;
use std::ops::Range;

/// A hierarchy over triangles whose vertices move linearly while the shutter is open. Like
/// [`TriangleBvh`](super::TriangleBvh), it is watertight at every time.
#[derive(Clone, Debug)]
pub struct MovingTriangleBvh {
    /// Hierarchy whose leaves refer to one pair of blocks each, as in
    /// [`TriangleBvh`](super::TriangleBvh).
    tree: MovingBvh,
    /// Triangles at shutter open and at shutter close.
    blocks: Pages<[Block; 2]>,
}

impl MovingTriangleBvh {
    /// Builds a hierarchy over triangles, each given by three vertex indices. Vertices are at
    /// `open` at shutter open (time 0) and at `close` at shutter close (time `shutter`, in the unit
    /// of [`Ray::time`]); see [`MovingBvh::build`]. Triangles with a vertex that is not finite at
    /// one end are never hit, and none is hit at a time when it is degenerate.
    pub fn build(
        open: &[Vec3],
        close: &[Vec3],
        triangles: &[[u32; 3]],
        shutter: f32,
        quality: Quality,
    ) -> Result<Self, TriangleError> {
        Self::build_with_control([open, close], triangles, shutter, quality, &BuildControl::default())
    }

    /// [`MovingTriangleBvh::build`], which ends early if `control` is cancelled, and reports its
    /// progress to it. `ends` are the vertices at shutter open and at shutter close.
    pub fn build_with_control(
        ends: [&[Vec3]; 2],
        triangles: &[[u32; 3]],
        shutter: f32,
        quality: Quality,
        control: &BuildControl,
    ) -> Result<Self, TriangleError> {
        control.check()?;
        if triangles.len() > MAX_ITEMS {
            return Err(TriangleError::TooMany { triangles: triangles.len() });
        }
        let ends = ends.map(|positions| TriangleList { positions, triangles });
        let boxes = |triangle| Ok([bounds_of(ends[0].corners(triangle)?), bounds_of(ends[1].corners(triangle)?)]);
        let boxes: Vec<Result<_, TriangleError>> = (0..triangles.len()).into_par_iter().map(boxes).collect();
        let boxes = boxes.into_iter().collect::<Result<Vec<_>, _>>()?;
        let options = BuildOptions { block: LANES, ..quality.into() };
        let mut tree = MovingBvh::build_with_control(&boxes, shutter, &options, control)?;
        let leaves = number_leaves(&mut tree.bvh.nodes);
        let order = std::mem::take(&mut tree.bvh.order);
        let mut blocks: Pages<[Block; 2]> = Pages::zeroed(leaves.len());
        blocks.par_iter_mut().zip(&leaves).try_for_each(|(blocks, leaf)| {
            let items = &order[leaf.items().start as usize..leaf.items().end as usize];
            for (block, end) in blocks.iter_mut().zip(ends) {
                *block = end.block(items)?;
            }
            Ok::<_, TriangleError>(())
        })?;
        Ok(Self { tree, blocks })
    }

    /// Returns the closest hit at the ray's time; among hits at equal distance the one with the
    /// smallest triangle index.
    pub fn closest(&self, ray: &Ray) -> Option<TriangleHit> {
        self.closest_behind(ray, None)
    }

    /// [`MovingTriangleBvh::closest`] for the hits that follow the distance and triangle `after`:
    /// hits before the distance do not count, nor those at it of triangles up to that index.
    pub fn closest_after(&self, ray: &Ray, after: (f32, Option<u32>)) -> Option<TriangleHit> {
        self.closest_behind(ray, Some(after))
    }

    fn closest_behind(&self, ray: &Ray, after: Option<(f32, Option<u32>)>) -> Option<TriangleHit> {
        dispatch!(self.tree.bvh.level, simd => {
            let mut leaf = MovingVisitor { after, ..MovingVisitor::new(simd, self, ray) };
            self.tree.closest_one(simd, &mut { *ray }, &mut leaf);
            leaf.hit
        })
    }

    /// Whether the ray hits any triangle at its time.
    pub fn any(&self, ray: &Ray) -> bool {
        dispatch!(self.tree.bvh.level, simd => self.tree.any_one(simd, ray, &mut MovingVisitor::new(simd, self, ray)))
    }

    /// Bounds of all triangles over the shutter interval; empty without triangles.
    pub fn bounds(&self) -> Aabb {
        self.tree.bounds()
    }

    /// Statistics of the build.
    pub fn stats(&self) -> &BuildStats {
        self.tree.stats()
    }

    /// Memory of the tree and its triangles in bytes.
    pub fn bytes(&self) -> usize {
        self.tree.bytes() + self.blocks.bytes()
    }

    /// [`Bvh::with_simd_level`](crate::Bvh::with_simd_level).
    pub fn with_simd_level(mut self, level: SimdLevel) -> Self {
        self.tree = self.tree.with_simd_level(level);
        self
    }
}

/// Bounds of a triangle; empty only if a vertex is not finite, since a triangle that is degenerate
/// at one end may have an area in between.
fn bounds_of(corners: [Vec3; 3]) -> Aabb {
    if corners.iter().all(|corner| corner.is_finite()) { padded_bounds(corners).aabb() } else { Aabb::EMPTY }
}

/// Leaf visitor for one ray.
struct MovingVisitor<'a, S> {
    simd: S,
    blocks: &'a [[Block; 2]],
    /// Normalized shutter time of the ray, 0 to 1.
    time: f32,
    shear: Shear,
    /// Distance and triangle up to which hits do not count.
    after: Option<(f32, Option<u32>)>,
    hit: Option<TriangleHit>,
}

impl<'a, S: Lanes> MovingVisitor<'a, S> {
    #[inline(always)]
    fn new(simd: S, bvh: &'a MovingTriangleBvh, ray: &Ray) -> Self {
        let slabs = Slabs::of_ray(simd, ray);
        let shear = Shear::new(ray, slabs.exact_inverse, slabs.signs);
        Self { simd, blocks: &bvh.blocks, time: bvh.tree.shutter_fraction(ray), shear, after: None, hit: None }
    }

    /// Interpolates the block to the ray's time. Returns it with a bit mask of the lanes that the
    /// ray may hit.
    #[inline(always)]
    fn candidates(&self, ray: &Ray, items: &Range<u32>) -> (Block, u32) {
        let block = Block::lerp(&self.blocks[items.start as usize], self.time);
        let frames = RayFrames::broadcast(self.simd, &self.shear, ray.t_min, ray.t_max);
        let (mask, _) =
            frames.candidates(self.simd, &block.corners(self.simd, self.shear.axes), (1 << items.len()) - 1);
        (block, mask)
    }

    /// Intersects the triangle in a lane, unless it is degenerate at this time.
    #[inline(always)]
    fn intersect(&self, ray: &Ray, block: &Block, lane: usize) -> Option<TriangleHit> {
        let hit = block.hit(&self.shear, ray, lane)?;
        let counts = self.after.is_none_or(|after| hit.is_after(after));
        (counts && has_area(block.permuted(lane, [0, 1, 2]).map(Vec3::from))).then_some(hit)
    }
}

impl<S: Lanes> Leaf for MovingVisitor<'_, S> {
    #[inline(always)]
    fn closest(&mut self, _lane: usize, ray: &mut Ray, items: Range<u32>) {
        let (block, candidates) = self.candidates(ray, &items);
        for lane in Bits(candidates) {
            if let Some(hit) = self.intersect(ray, &block, lane)
                && hit.is_before(&self.hit)
            {
                self.hit = Some(hit);
                ray.t_max = hit.t;
            }
        }
    }

    #[inline(always)]
    fn any(&mut self, _lane: usize, ray: &Ray, items: Range<u32>) -> bool {
        let (block, candidates) = self.candidates(ray, &items);
        Bits(candidates).any(
            #[inline(always)]
            |lane| self.intersect(ray, &block, lane).is_some(),
        )
    }
}

impl Block {
    /// Interpolates the triangles between two blocks at a normalized time, 0 to 1.
    #[inline(always)]
    fn lerp([open, close]: &[Self; 2], time: f32) -> Self {
        let mut block = *open;
        for (corner, end) in block.vertices.iter_mut().zip(&close.vertices) {
            for (axis, end) in corner.iter_mut().zip(end) {
                for (coordinate, end) in axis.iter_mut().zip(end) {
                    *coordinate = lerp(*coordinate, *end, time);
                }
            }
        }
        block
    }
}
