//! Triangles in a tree of their own, packed by leaf: up to eight side by side, tested together.

mod build;

use crate::lanes::{less, max, min};
use crate::pages::Pages;
use crate::triangle::Shear;
use crate::{BuildStats, Bvh, Leaf, PACKET, RefitError};
use bytemuck::{Pod, Zeroable};
use juggler_math::{Aabb, Ray, Vec3};
use std::fmt;
use std::ops::Range;

const LANES: usize = 8;

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
}

impl TriangleBvh {
    /// The closest hit; of hits at equal distance that on the triangle with the smallest number.
    pub fn closest(&self, ray: &Ray) -> Option<TriangleHit> {
        let mut one = One { blocks: &self.blocks, shear: Shear::of(ray), hit: None };
        self.bvh.closest(&mut { *ray }, &mut one);
        one.hit
    }

    /// Whether any triangle is hit.
    pub fn any(&self, ray: &Ray) -> bool {
        self.bvh.any(ray, &mut One { blocks: &self.blocks, shear: Shear::of(ray), hit: None })
    }

    /// [`TriangleBvh::closest`] for coherent rays, see [`Bvh::closest_packet`]. The answers replace what
    /// `hits` held; rays without a place in it are not traced. Each ray ends at its hit.
    pub fn closest_packet(&self, rays: &mut [Ray], hits: &mut [Option<TriangleHit>]) {
        for (rays, hits) in rays.chunks_mut(PACKET).zip(hits.chunks_mut(PACKET)) {
            let count = rays.len().min(hits.len());
            hits.fill(None);
            let mut many = Many { blocks: &self.blocks, shears: [None; PACKET], hits };
            self.bvh.closest_packet(&mut rays[..count], &mut many);
        }
    }

    /// [`TriangleBvh::any`] for coherent rays, see [`Bvh::any_packet`].
    pub fn any_packet(&self, rays: &[Ray], occluded: &mut [bool]) {
        for (rays, occluded) in rays.chunks(PACKET).zip(occluded.chunks_mut(PACKET)) {
            let mut many = Many { blocks: &self.blocks, shears: [None; PACKET], hits: &mut [] };
            self.bvh.any_packet(rays, occluded, &mut many);
        }
    }

    /// [`TriangleBvh::closest`] for any number of unrelated rays, see [`Bvh::closest_batch`]. The answers
    /// replace what `hits` held; rays without a place in it are not traced. Each ray ends at its hit.
    pub fn closest_batch(&self, rays: &mut [Ray], hits: &mut [Option<TriangleHit>]) {
        for (ray, hit) in rays.iter_mut().zip(hits) {
            *hit = self.closest(ray);
            if let Some(hit) = hit {
                ray.t_max = hit.t;
            }
        }
    }

    /// [`TriangleBvh::any`] for any number of unrelated rays, see [`Bvh::any_batch`].
    pub fn any_batch(&self, rays: &[Ray], occluded: &mut [bool]) {
        for (ray, occluded) in rays.iter().zip(occluded) {
            *occluded = self.any(ray);
        }
    }

    /// What the search for the closest hit looks at.
    pub fn visits(&self, ray: &Ray) -> crate::Visits {
        let mut one = One { blocks: &self.blocks, shear: Shear::of(ray), hit: None };
        self.bvh.closest_counted(&mut { *ray }, &mut one)
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

    fn corners(&self, lane: usize) -> [Vec3; 3] {
        std::array::from_fn(|corner| Vec3::from(self.vertices[corner].map(|values| values[lane])))
    }

    /// Corner by corner and lane by lane, x and y in the frame of the shear.
    #[inline(always)]
    fn project(&self, shear: &Shear, corner: usize) -> [[f32; LANES]; 2] {
        let [x, y, z] = shear.axes;
        let mut projected = [[0.0; LANES]; 2];
        let values = &self.vertices[corner];
        for lane in 0..LANES {
            let depth = values[z][lane] - shear.origin[z];
            projected[0][lane] = (values[x][lane] - shear.origin[x]) - shear.factors[0] * depth;
            projected[1][lane] = (values[y][lane] - shear.origin[y]) - shear.factors[1] * depth;
        }
        projected
    }

    /// Lanes whose triangle the ray may hit (bit per lane): those where no two edges say otherwise. The same
    /// sums as in [`Shear::intersect`], which has the last word.
    #[inline(always)]
    fn candidates(&self, shear: &Shear) -> u32 {
        let [a, b, c] = [self.project(shear, 0), self.project(shear, 1), self.project(shear, 2)];
        let (mut least, mut most) = ([0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            let u = c[0][lane] * b[1][lane] - c[1][lane] * b[0][lane];
            let v = a[0][lane] * c[1][lane] - a[1][lane] * c[0][lane];
            let w = b[0][lane] * a[1][lane] - b[1][lane] * a[0][lane];
            least[lane] = min(u, min(v, w));
            most[lane] = max(u, max(v, w));
        }
        !(less(&least, &[0.0; LANES]) & less(&[0.0; LANES], &most))
    }

    /// Candidates among the first `count` lanes.
    #[inline(always)]
    fn candidates_among(&self, count: usize, shear: &Shear) -> Lanes {
        Lanes(self.candidates(shear) & ((1 << count) - 1))
    }

    /// Improves on `hit`, and shortens the ray to it.
    #[inline(always)]
    fn closest(&self, count: usize, shear: &Shear, ray: &mut Ray, hit: &mut Option<TriangleHit>) {
        for lane in self.candidates_among(count, shear) {
            let Some((t, u, v)) = shear.intersect(ray, self.corners(lane)) else { continue };
            let index = self.index[lane];
            if hit.is_none_or(|best| t < best.t || index < best.index) {
                ray.t_max = t;
                *hit = Some(TriangleHit { t, u, v, index });
            }
        }
    }

    #[inline(always)]
    fn any(&self, count: usize, shear: &Shear, ray: &Ray) -> bool {
        self.candidates_among(count, shear).any(|lane| shear.intersect(ray, self.corners(lane)).is_some())
    }
}

/// The lanes of a mask's bits, lowest first.
struct Lanes(u32);

impl Iterator for Lanes {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        let lane = self.0.trailing_zeros() as usize;
        self.0 &= self.0.wrapping_sub(1);
        (lane < LANES).then_some(lane)
    }
}

/// Visitor for one ray.
struct One<'a> {
    blocks: &'a [Block],
    shear: Shear,
    hit: Option<TriangleHit>,
}

impl Leaf for One<'_> {
    #[inline(always)]
    fn closest(&mut self, _lane: usize, ray: &mut Ray, items: Range<u32>) {
        self.blocks[items.start as usize].closest(items.len(), &self.shear, ray, &mut self.hit);
    }

    #[inline(always)]
    fn any(&mut self, _lane: usize, ray: &Ray, items: Range<u32>) -> bool {
        self.blocks[items.start as usize].any(items.len(), &self.shear, ray)
    }
}

/// Visitor for a packet; a shear is made when its ray first reaches a leaf.
struct Many<'a> {
    blocks: &'a [Block],
    shears: [Option<Shear>; PACKET],
    hits: &'a mut [Option<TriangleHit>],
}

impl Many<'_> {
    #[inline(always)]
    fn shear(&mut self, lane: usize, ray: &Ray) -> Shear {
        *self.shears[lane].get_or_insert_with(|| Shear::of(ray))
    }
}

impl Leaf for Many<'_> {
    #[inline(always)]
    fn closest(&mut self, lane: usize, ray: &mut Ray, items: Range<u32>) {
        let shear = self.shear(lane, ray);
        self.blocks[items.start as usize].closest(items.len(), &shear, ray, &mut self.hits[lane]);
    }

    #[inline(always)]
    fn any(&mut self, lane: usize, ray: &Ray, items: Range<u32>) -> bool {
        let shear = self.shear(lane, ray);
        self.blocks[items.start as usize].any(items.len(), &shear, ray)
    }
}
