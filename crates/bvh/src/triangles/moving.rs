//! Triangles whose corners move while the shutter is open.

use super::build::{Mesh, around, number_leaves};
use super::meet::Lines;
use super::{Block, LANES, TriangleError, TriangleHit};
use crate::lanes::{Bits, Lanes};
use crate::moving::between;
use crate::pages::Pages;
use crate::slabs::Slabs;
use crate::triangle::{Shear, has_area};
use crate::{BuildOptions, BuildStats, Leaf, MAX_ITEMS, MovingBvh, Quality, SimdLevel};
use fearless_simd::dispatch;
use juggler_math::{Aabb, Ray, Vec3};
use rayon::prelude::*;
use std::ops::Range;

/// A tree over triangles whose corners move linearly while the shutter is open. As [`TriangleBvh`](super::TriangleBvh)
/// watertight, at every time.
#[derive(Clone, Debug)]
pub struct MovingTriangleBvh {
    /// Its leaves name one pair of blocks each, as in [`TriangleBvh`](super::TriangleBvh).
    tree: MovingBvh,
    /// When the shutter opens and when it closes.
    blocks: Pages<[Block; 2]>,
}

impl MovingTriangleBvh {
    /// Builds the tree. A triangle is three numbers of vertices, which lie at `open` when the shutter opens and at `close`
    /// when it closes, `shutter` seconds later; see [`MovingBvh::build`]. A triangle with a vertex that is not finite at
    /// one end is never hit, and none is at times when it has no area.
    pub fn build(
        open: &[Vec3],
        close: &[Vec3],
        triangles: &[[u32; 3]],
        shutter: f32,
        quality: Quality,
    ) -> Result<Self, TriangleError> {
        if triangles.len() > MAX_ITEMS {
            return Err(TriangleError::TooMany { triangles: triangles.len() });
        }
        let ends = [open, close].map(|positions| Mesh { positions, triangles });
        let boxes = |triangle| Ok([bounds_of(ends[0].corners(triangle)?), bounds_of(ends[1].corners(triangle)?)]);
        let boxes: Vec<Result<_, TriangleError>> = (0..triangles.len()).into_par_iter().map(boxes).collect();
        let boxes = boxes.into_iter().collect::<Result<Vec<_>, _>>()?;
        let mut tree = MovingBvh::build_with(&boxes, shutter, &BuildOptions { block: LANES, ..quality.into() });
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

    /// The closest hit at the ray's time; of hits at equal distance that on the triangle with the smallest number.
    pub fn closest(&self, ray: &Ray) -> Option<TriangleHit> {
        dispatch!(self.tree.bvh.level, simd => {
            let mut leaf = MovingOne::new(simd, self, ray);
            self.tree.closest_one(simd, &mut { *ray }, &mut leaf);
            leaf.hit
        })
    }

    /// Whether any triangle is hit at the ray's time.
    pub fn any(&self, ray: &Ray) -> bool {
        dispatch!(self.tree.bvh.level, simd => self.tree.any_one(simd, ray, &mut MovingOne::new(simd, self, ray)))
    }

    /// A box around all triangles over all the time; empty when there are none.
    pub fn bounds(&self) -> Aabb {
        self.tree.bounds()
    }

    /// What the build made.
    pub fn stats(&self) -> &BuildStats {
        self.tree.stats()
    }

    /// Bytes of memory that the tree and its triangles hold.
    pub fn bytes(&self) -> usize {
        self.tree.bytes() + self.blocks.bytes()
    }

    /// [`Bvh::with_simd_level`](crate::Bvh::with_simd_level).
    pub fn with_simd_level(mut self, level: SimdLevel) -> Self {
        self.tree = self.tree.with_simd_level(level);
        self
    }
}

/// Empty only where a corner is not finite: what has no area at one end may have one between.
fn bounds_of(corners: [Vec3; 3]) -> Aabb {
    if corners.iter().all(|corner| corner.is_finite()) { around(corners).aabb() } else { Aabb::EMPTY }
}

/// Visitor for one ray.
struct MovingOne<'a, S> {
    simd: S,
    blocks: &'a [[Block; 2]],
    /// The ray's time as a share of the shutter's.
    time: f32,
    shear: Shear,
    hit: Option<TriangleHit>,
}

impl<'a, S: Lanes> MovingOne<'a, S> {
    #[inline(always)]
    fn new(simd: S, bvh: &'a MovingTriangleBvh, ray: &Ray) -> Self {
        let slabs = Slabs::of_ray(simd, ray);
        let shear = Shear::of(ray, slabs.exact_inverse, slabs.signs);
        Self { simd, blocks: &bvh.blocks, time: bvh.tree.share(ray), shear, hit: None }
    }

    /// The block at the ray's time and the lanes that the ray may hit.
    #[inline(always)]
    fn candidates(&self, ray: &Ray, items: &Range<u32>) -> (Block, u32) {
        let block = Block::between(&self.blocks[items.start as usize], self.time);
        let lines = Lines::of_one(self.simd, &self.shear, ray.t_min, ray.t_max);
        let (mask, _) = lines.candidates(self.simd, &block.corners(self.simd, self.shear.axes), (1 << items.len()) - 1);
        (block, mask)
    }

    /// A hit on a triangle that has an area at this time.
    #[inline(always)]
    fn meet(&self, ray: &Ray, block: &Block, lane: usize) -> Option<TriangleHit> {
        let hit = block.hit(&self.shear, ray, lane)?;
        has_area(block.permuted(lane, [0, 1, 2]).map(Vec3::from)).then_some(hit)
    }
}

impl<S: Lanes> Leaf for MovingOne<'_, S> {
    #[inline(always)]
    fn closest(&mut self, _lane: usize, ray: &mut Ray, items: Range<u32>) {
        let (block, candidates) = self.candidates(ray, &items);
        for lane in Bits(candidates) {
            if let Some(hit) = self.meet(ray, &block, lane)
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
            |lane| self.meet(ray, &block, lane).is_some(),
        )
    }
}

impl Block {
    /// The triangles of both blocks at a time between 0 and 1.
    #[inline(always)]
    fn between([open, close]: &[Self; 2], time: f32) -> Self {
        let mut block = *open;
        for (corner, end) in block.vertices.iter_mut().zip(&close.vertices) {
            for (axis, end) in corner.iter_mut().zip(end) {
                for (coordinate, end) in axis.iter_mut().zip(end) {
                    *coordinate = between(*coordinate, *end, time);
                }
            }
        }
        block
    }
}
