//! Triangle hierarchies: the triangles of a leaf are packed in a block of up to eight and tested
//! together.

mod build;
mod clip;
mod common_origin;
mod filter;
mod in_flight;
mod moving;
mod packet_visitor;
mod query;
mod ray_visitor;
mod simd_test;

use crate::lanes::{Lanes, prefetch};
use crate::node::{Bounds, Child, Node};
use crate::pages::Pages;
use crate::single::TraversalMemory;
use crate::slabs::Slabs;
use crate::triangle::{Shear, TriangleTest};
use crate::{BuildStats, Bvh, RefitError};
use bytemuck::{Pod, Zeroable};
use fearless_simd::prelude::*;
use fearless_simd::{dispatch, f32x8};
use filter::{All, FilterFn};
use juggler_math::{Aabb, Cancelled, Ray, Vec3};
pub use moving::MovingTriangleBvh;
pub use query::Filtered;
use query::Query;
use ray_visitor::RayVisitor;
use simd_test::Corner;
use std::fmt;

const LANES: usize = 8;
/// Tree size in bytes up to which batches are traced ray by ray: such trees stay in the cache
/// (measured).
const IN_FLIGHT_BYTES: usize = 8 << 20;
/// Tree size in bytes up to which children are not prefetched: such trees stay in the L2 cache of
/// current processors, where a prefetch costs more than it saves.
const PREFETCH_BYTES: usize = 256 << 10;
const GROWTH: f32 = 8.0 * f32::EPSILON;

/// A hit of a ray on a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// Distance in units of the direction's length.
    pub t: f32,
    /// Barycentric weight of the second vertex.
    pub u: f32,
    /// Barycentric weight of the third vertex.
    pub v: f32,
    /// Index of the triangle in the list that the tree was built from.
    pub index: u32,
}

impl TriangleHit {
    /// Whether this hit is closer, or equally close with a smaller index.
    #[inline(always)]
    fn is_before(&self, other: &Option<Self>) -> bool {
        match other {
            Some(other) => self.t < other.t || self.t == other.t && self.index < other.index,
            None => true,
        }
    }

    /// Whether this hit follows a distance and triangle: it is behind the distance, or at it and its
    /// index is above the triangle's, if there is one.
    #[inline(always)]
    pub fn is_after(&self, (t, triangle): (f32, Option<u32>)) -> bool {
        self.t > t || self.t == t && triangle.is_none_or(|triangle| self.index > triangle)
    }
}

/// Reason why a build or refit was rejected.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TriangleError {
    /// A triangle refers to a vertex that does not exist.
    NoSuchVertex {
        /// Index of the triangle.
        triangle: usize,
        /// Index of the vertex.
        vertex: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// More triangles than [`MAX_ITEMS`](crate::MAX_ITEMS).
    TooMany {
        /// Number of triangles.
        triangles: usize,
    },
    /// The triangles do not match those of the build.
    Refit(RefitError),
    /// The build was cancelled.
    Cancelled,
}

impl From<Cancelled> for TriangleError {
    fn from(Cancelled: Cancelled) -> Self {
        Self::Cancelled
    }
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
            Self::Cancelled => Cancelled.fmt(f),
            Self::TooMany { triangles } => {
                write!(f, "{triangles} triangles are more than the {} that a tree can hold", crate::MAX_ITEMS)
            }
        }
    }
}

impl std::error::Error for TriangleError {}

/// A bounding volume hierarchy over two-sided triangles. No ray passes between triangles that share
/// an edge.
#[derive(Clone, Debug)]
pub struct TriangleBvh {
    /// Hierarchy whose leaves refer to one block each: `items.start` is the block, `items.len()`
    /// its number of triangles.
    bvh: Bvh,
    blocks: Pages<Block>,
    /// Whether the tree is so large that batches interleave several rays.
    in_flight: bool,
    /// Whether the tree is so large that traversal prefetches all intersected children.
    prefetches: bool,
    test: TriangleTest,
}

impl TriangleBvh {
    /// Returns the closest hit; among hits at equal distance the one with the smallest triangle
    /// index.
    pub fn closest(&self, ray: &Ray) -> Option<TriangleHit> {
        self.all().closest(ray)
    }

    /// Whether the ray hits any triangle.
    pub fn any(&self, ray: &Ray) -> bool {
        self.all().any(ray)
    }

    /// [`TriangleBvh::closest`] for coherent rays, see [`Bvh::closest_packet`]. Overwrites `hits`
    /// and shortens each ray to its hit. If `hits` is shorter than `rays`, the remaining rays are
    /// not traced.
    pub fn closest_packet(&self, rays: &mut [Ray], hits: &mut [Option<TriangleHit>]) {
        self.all().closest_packet(rays, hits);
    }

    /// [`TriangleBvh::any`] for coherent rays, see [`Bvh::any_packet`].
    pub fn any_packet(&self, rays: &[Ray], occluded: &mut [bool]) {
        self.all().any_packet(rays, occluded);
    }

    /// [`TriangleBvh::closest`] for any number of incoherent rays, see [`Bvh::closest_batch`].
    /// Overwrites `hits` and shortens each ray to its hit. If `hits` is shorter than `rays`, the
    /// remaining rays are not traced.
    pub fn closest_batch(&self, rays: &mut [Ray], hits: &mut [Option<TriangleHit>]) {
        self.all().closest_batch(rays, hits);
    }

    /// [`TriangleBvh::any`] for any number of incoherent rays, see [`Bvh::any_batch`].
    pub fn any_batch(&self, rays: &[Ray], occluded: &mut [bool]) {
        self.all().any_batch(rays, occluded);
    }

    #[inline(always)]
    fn memory(&self) -> TriangleMemory<'_> {
        TriangleMemory { nodes: &self.bvh.nodes, blocks: &self.blocks, prefetches: self.prefetches }
    }

    fn all(&self) -> Query<'_, All> {
        Query { tree: self, filter: All }
    }

    /// Queries that only count the hits that `accepts` returns `true` for, for example for opacity
    /// and masks. `accepts` receives the ray's index in the slice (0 for a single ray) and the hit.
    /// It may be called for hits that are not the closest, more than once for the same hit (several
    /// leaves may refer to a triangle) and in any order, and must be a pure function.
    pub fn filtered<F: Fn(usize, &TriangleHit) -> bool + Copy>(&self, accepts: F) -> Filtered<'_, F> {
        Filtered { query: Query { tree: self, filter: FilterFn(accepts) } }
    }

    /// Selects the triangle test in place of the watertight one.
    pub fn with_test(mut self, test: TriangleTest) -> Self {
        self.test = test;
        self
    }

    /// [`Bvh::with_simd_level`].
    pub fn with_simd_level(mut self, level: crate::SimdLevel) -> Self {
        self.bvh = self.bvh.with_simd_level(level);
        self
    }

    /// Makes batches interleave several rays, or not, whatever the tree's size; for tests and
    /// benchmarks.
    pub fn with_rays_in_flight(mut self, in_flight: bool) -> Self {
        self.in_flight = in_flight;
        self
    }

    /// Counts the nodes, leaves and triangles that a closest-hit query visits.
    pub fn visits(&self, ray: &Ray) -> crate::Visits {
        let simd = fearless_simd::Level::baseline();
        dispatch!(simd, simd => self.bvh.closest_counted(&mut { *ray }, &mut RayVisitor::new(simd, self.all(), ray, &Slabs::of_ray(simd, ray))))
    }

    /// Bounds of all triangles, enlarged by at most a few millionths; empty without triangles.
    pub fn bounds(&self) -> Aabb {
        self.bvh.bounds()
    }

    /// Statistics of the build.
    pub fn stats(&self) -> &BuildStats {
        self.bvh.stats()
    }

    /// Memory of the tree and its triangles in bytes.
    pub fn bytes(&self) -> usize {
        self.bvh.bytes() + self.blocks.bytes()
    }
}

/// Memory that a traversal reads.
#[derive(Clone, Copy)]
struct TriangleMemory<'a> {
    nodes: &'a [Node],
    blocks: &'a [Block],
    prefetches: bool,
}

impl TraversalMemory for TriangleMemory<'_> {
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
        // Select instead of branching: leaf or node is unpredictable.
        let (start, size) = if child.is_leaf() {
            (self.blocks.as_ptr().cast::<u8>(), size_of::<Block>())
        } else {
            (self.nodes.as_ptr().cast(), size_of::<Node>())
        };
        prefetch(start.wrapping_add(child.place() * size));
    }
}

/// Triangles of a leaf in SoA layout.
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

    /// Watertight intersection of the shear's ray with the triangle in a lane.
    #[inline(always)]
    fn hit(&self, shear: &Shear, ray: &Ray, lane: usize) -> Option<TriangleHit> {
        let (t, u, v) = shear.intersect(ray, self.permuted(lane, shear.axes))?;
        Some(TriangleHit { t, u, v, index: self.index[lane & 7] })
    }

    /// One vertex of all lanes, axes in the order of the shear.
    #[inline(always)]
    fn corner<S: Lanes>(&self, simd: S, corner: usize, [x, y, z]: [usize; 3]) -> Corner<S> {
        let axes = &self.vertices[corner];
        [simd.load(&axes[x]), simd.load(&axes[y]), simd.load(&axes[z])]
    }

    /// Boxes of the triangles, at least as large as those that the tree was built from.
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
            // At least the margin of a single triangle's box: relative to the largest edge along
            // each axis.
            let margin = (size + low[axis].abs() + high[axis].abs()) * GROWTH;
            boxes[axis] = [(low[axis] - margin).into(), (high[axis] + margin).into()];
        }
        boxes
    }

    /// Vertices of one lane, axes in the order of the shear.
    #[inline(always)]
    fn permuted(&self, lane: usize, axes: [usize; 3]) -> [[f32; 3]; 3] {
        let [x, y, z] = axes;
        let corner = |c: &[[f32; LANES]; 3]| [c[x][lane & 7], c[y][lane & 7], c[z][lane & 7]];
        [corner(&self.vertices[0]), corner(&self.vertices[1]), corner(&self.vertices[2])]
    }

    /// All vertices of all lanes, axes in the order of the shear.
    #[inline(always)]
    fn corners<S: Lanes>(&self, simd: S, axes: [usize; 3]) -> [Corner<S>; 3] {
        [self.corner(simd, 0, axes), self.corner(simd, 1, axes), self.corner(simd, 2, axes)]
    }
}
