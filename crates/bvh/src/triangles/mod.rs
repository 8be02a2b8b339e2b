//! Triangles in a tree of their own, packed by leaf: up to eight side by side, tested together.

mod build;
mod clip;
mod common_origin;
mod filter;
mod in_flight;
mod many;
mod meet;
mod moving;
mod one;
mod query;

use crate::lanes::{Lanes, prefetch};
use crate::node::{Bounds, Child, Node};
use crate::pages::Pages;
use crate::single::Boxes;
use crate::slabs::Slabs;
use crate::triangle::{Shear, TriangleTest};
use crate::{BuildStats, Bvh, RefitError};
use bytemuck::{Pod, Zeroable};
use fearless_simd::prelude::*;
use fearless_simd::{dispatch, f32x8};
use filter::{All, Where};
use juggler_math::{Aabb, Ray, Vec3};
use meet::Corner;
pub use moving::MovingTriangleBvh;
use one::One;
pub use query::Filtered;
use query::Query;
use std::fmt;

const LANES: usize = 8;
/// Batches in trees of up to as many bytes are traced ray by ray: they stay near enough (measured).
const IN_CACHE: usize = 8 << 20;
/// Children in trees of up to as many bytes are not asked for ahead: they lie in the second-level
/// cache of any processor of today, where asking costs more than it saves.
const NEAR: usize = 256 << 10;
const GROWTH: f32 = 8.0 * f32::EPSILON;

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// Distance in units of the ray's direction.
    pub t: f32,
    /// Barycentric weight of the second vertex.
    pub u: f32,
    /// Barycentric weight of the third vertex.
    pub v: f32,
    /// Number of the triangle in the list that the tree was built from.
    pub index: u32,
}

impl TriangleHit {
    /// Nearer, or as near and on a triangle with a smaller number.
    #[inline(always)]
    fn is_before(&self, other: &Option<Self>) -> bool {
        match other {
            Some(other) => self.t < other.t || self.t == other.t && self.index < other.index,
            None => true,
        }
    }
}

/// Why triangles were refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TriangleError {
    /// A triangle names a vertex that does not exist.
    NoSuchVertex {
        /// Number of the triangle.
        triangle: usize,
        /// The vertex it names.
        vertex: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// More triangles than [`MAX_ITEMS`](crate::MAX_ITEMS).
    TooMany {
        /// How many there are.
        triangles: usize,
    },
    /// They are not those that the tree was built over.
    Refit(RefitError),
}

impl From<RefitError> for TriangleError {
    fn from(error: RefitError) -> Self {
        Self::Refit(error)
    }
}

impl fmt::Display for TriangleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSuchVertex { triangle, vertex, vertices } => {
                write!(f, "triangle {triangle} names vertex {vertex}, but there are {vertices} vertices")
            }
            Self::Refit(error) => error.fmt(f),
            Self::TooMany { triangles } => {
                write!(f, "{triangles} triangles are more than the {} that a tree can hold", crate::MAX_ITEMS)
            }
        }
    }
}

impl std::error::Error for TriangleError {}

/// A tree over triangles. Rays hit both faces; no ray passes between triangles that share an edge.
#[derive(Clone, Debug)]
pub struct TriangleBvh {
    /// Its leaves name one block each: `items.start` is the block, `items.len()` the triangles in it.
    bvh: Bvh,
    blocks: Pages<Block>,
    /// Whether rays wait for memory so long that several under way at once pay.
    in_flight: bool,
    /// Whether rays wait for memory so long that asking for all children that they meet pays.
    prefetches: bool,
    test: TriangleTest,
}

impl TriangleBvh {
    /// The closest hit; of hits at equal distance that on the triangle with the smallest number.
    pub fn closest(&self, ray: &Ray) -> Option<TriangleHit> {
        self.all().closest(ray)
    }

    /// Whether any triangle is hit.
    pub fn any(&self, ray: &Ray) -> bool {
        self.all().any(ray)
    }

    /// [`TriangleBvh::closest`] for coherent rays, see [`Bvh::closest_packet`]. The answers replace what
    /// `hits` held; rays without a place in it are not traced. Each ray ends at its hit.
    pub fn closest_packet(&self, rays: &mut [Ray], hits: &mut [Option<TriangleHit>]) {
        self.all().closest_packet(rays, hits);
    }

    /// [`TriangleBvh::any`] for coherent rays, see [`Bvh::any_packet`].
    pub fn any_packet(&self, rays: &[Ray], occluded: &mut [bool]) {
        self.all().any_packet(rays, occluded);
    }

    /// [`TriangleBvh::closest`] for any number of unrelated rays, see [`Bvh::closest_batch`]. The answers
    /// replace what `hits` held; rays without a place in it are not traced. Each ray ends at its hit.
    pub fn closest_batch(&self, rays: &mut [Ray], hits: &mut [Option<TriangleHit>]) {
        self.all().closest_batch(rays, hits);
    }

    /// [`TriangleBvh::any`] for any number of unrelated rays, see [`Bvh::any_batch`].
    pub fn any_batch(&self, rays: &[Ray], occluded: &mut [bool]) {
        self.all().any_batch(rays, occluded);
    }

    #[inline(always)]
    fn memory(&self) -> Memory<'_> {
        Memory { nodes: &self.bvh.nodes, blocks: &self.blocks, prefetches: self.prefetches }
    }

    fn all(&self) -> Query<'_, All> {
        Query { tree: self, filter: All }
    }

    /// The same tree, of whose hits only those count that `accepts` lets pass, given the number of the ray in
    /// the slice (0 for one ray) and the hit: for cut-outs and masks. It may be asked about hits that turn out not
    /// to be the closest, about the same hit more than once (a triangle may stand in several leaves), in any order, and
    /// must always answer the same.
    pub fn filtered<F: Fn(usize, &TriangleHit) -> bool + Copy>(&self, accepts: F) -> Filtered<'_, F> {
        Filtered { query: Query { tree: self, filter: Where(accepts) } }
    }

    /// The same tree with another test of triangles than the watertight one.
    pub fn with_test(mut self, test: TriangleTest) -> Self {
        self.test = test;
        self
    }

    /// [`Bvh::with_simd_level`].
    pub fn with_simd_level(mut self, level: crate::SimdLevel) -> Self {
        self.bvh = self.bvh.with_simd_level(level);
        self
    }

    /// The same tree, whose batches keep several rays under way at once, or do not, whatever its size: for tests and
    /// measurements.
    pub fn with_rays_in_flight(mut self, in_flight: bool) -> Self {
        self.in_flight = in_flight;
        self
    }

    /// What the search for the closest hit looks at.
    pub fn visits(&self, ray: &Ray) -> crate::Visits {
        let simd = fearless_simd::Level::baseline();
        dispatch!(simd, simd => self.bvh.closest_counted(&mut { *ray }, &mut One::new(simd, self.all(), ray, &Slabs::of_ray(simd, ray))))
    }

    /// A box around all triangles, at most a few millionths larger than needed; empty when there are none.
    pub fn bounds(&self) -> Aabb {
        self.bvh.bounds()
    }

    /// What the build made.
    pub fn stats(&self) -> &BuildStats {
        self.bvh.stats()
    }

    /// Bytes of memory that the tree and its triangles hold.
    pub fn bytes(&self) -> usize {
        self.bvh.bytes() + self.blocks.bytes()
    }
}

/// The memory of a tree.
#[derive(Clone, Copy)]
struct Memory<'a> {
    nodes: &'a [Node],
    blocks: &'a [Block],
    prefetches: bool,
}

impl Boxes for Memory<'_> {
    #[inline(always)]
    fn node(&self, number: usize) -> &Node {
        &self.nodes[number]
    }

    #[inline(always)]
    fn test<S: Lanes>(&self, simd: S, number: usize, slabs: &Slabs) -> (u32, f32x8<S>) {
        self.nodes[number].test(simd, slabs)
    }

    #[inline(always)]
    fn prefetch(&self, child: Child) {
        if !self.prefetches {
            return;
        }
        // Selections, for the processor cannot guess what a child is.
        let (start, size) = if child.is_leaf() {
            (self.blocks.as_ptr().cast::<u8>(), size_of::<Block>())
        } else {
            (self.nodes.as_ptr().cast(), size_of::<Node>())
        };
        prefetch(start.wrapping_add(child.place() * size));
    }
}

/// The triangles of a leaf, coordinate by coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(64))]
struct Block {
    /// `vertices[corner][axis][lane]`.
    vertices: [[[f32; LANES]; 3]; 3],
    index: [u32; LANES],
}

impl Block {
    const EMPTY: Self = Self { vertices: [[[0.0; LANES]; 3]; 3], index: [u32::MAX; LANES] };

    fn set(&mut self, lane: usize, triangle: u32, corners: [Vec3; 3]) {
        for (corner, position) in corners.into_iter().enumerate() {
            for axis in 0..3 {
                self.vertices[corner][axis][lane] = position[axis];
            }
        }
        self.index[lane] = triangle;
    }

    /// Where the ray of the shear hits the triangle in a lane; watertight.
    #[inline(always)]
    fn hit(&self, shear: &Shear, ray: &Ray, lane: usize) -> Option<TriangleHit> {
        let (t, u, v) = shear.intersect(ray, self.permuted(lane, shear.axes))?;
        Some(TriangleHit { t, u, v, index: self.index[lane & 7] })
    }

    /// A corner, axes in the order of the shear.
    #[inline(always)]
    fn corner<S: Lanes>(&self, simd: S, corner: usize, [x, y, z]: [usize; 3]) -> Corner<S> {
        let axes = &self.vertices[corner];
        [simd.load(&axes[x]), simd.load(&axes[y]), simd.load(&axes[z])]
    }

    /// The boxes of the triangles, as large as those that the tree was built from, or larger.
    #[inline(always)]
    fn boxes<S: Lanes>(&self, simd: S) -> Bounds {
        let [a, b, c] = &self.vertices;
        let (mut low, mut high) = ([simd.splat(0.0); 3], [simd.splat(0.0); 3]);
        let mut size = simd.splat(0.0);
        for axis in 0..3 {
            let (a, b, c) = (simd.load(&a[axis]), simd.load(&b[axis]), simd.load(&c[axis]));
            (low[axis], high[axis]) = (simd.least(a, simd.least(b, c)), simd.most(a, simd.most(b, c)));
            size = simd.most(high[axis] - low[axis], size);
        }
        let mut boxes = [[[0.0; LANES]; 2]; 3];
        for axis in 0..3 {
            // As much as the boxes of single triangles are grown, and more: along each axis by the largest side.
            let room = (size + low[axis].abs() + high[axis].abs()) * GROWTH;
            boxes[axis] = [(low[axis] - room).into(), (high[axis] + room).into()];
        }
        boxes
    }

    /// The corners of one lane, axes in the order of the shear.
    #[inline(always)]
    fn permuted(&self, lane: usize, axes: [usize; 3]) -> [[f32; 3]; 3] {
        let [x, y, z] = axes;
        let corner = |c: &[[f32; LANES]; 3]| [c[x][lane & 7], c[y][lane & 7], c[z][lane & 7]];
        [corner(&self.vertices[0]), corner(&self.vertices[1]), corner(&self.vertices[2])]
    }

    /// All corners, axes in the order of the shear.
    #[inline(always)]
    fn corners<S: Lanes>(&self, simd: S, axes: [usize; 3]) -> [Corner<S>; 3] {
        [self.corner(simd, 0, axes), self.corner(simd, 1, axes), self.corner(simd, 2, axes)]
    }
}
