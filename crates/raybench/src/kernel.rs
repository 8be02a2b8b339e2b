//! The ways in which a tree of triangles can be built and asked: what is measured.

use crate::Mesh;
use crate::measure::Sums;
use crate::rays::Query;
use juggler_bvh::{Quality, TriangleBvh, TriangleError, TriangleHit, TriangleTest};
use juggler_math::Ray;

/// Rays of one call that coherent kernels are given: a tile of pixels.
const TILE: usize = 64;

/// A triangle test. A new one is one more line in [`TESTS`].
#[derive(Clone, Copy, Debug)]
pub struct Test {
    /// What it is called.
    pub name: &'static str,
    /// Whether no ray slips between triangles that share an edge; decides what it is compared with.
    pub watertight: bool,
    test: TriangleTest,
}

/// All triangle tests.
pub const TESTS: [Test; 2] = [
    Test { name: "watertight", watertight: true, test: TriangleTest::Watertight },
    Test { name: "fast", watertight: false, test: TriangleTest::Fast },
];

/// Builds the tree of a mesh.
pub fn build(mesh: &Mesh, quality: Quality) -> Result<TriangleBvh, TriangleError> {
    TriangleBvh::build(&mesh.positions, &mesh.triangles, quality)
}

/// The tree with each of the triangle tests: a copy each, because they are traced in turns.
pub fn with_tests(tree: TriangleBvh) -> [(Test, TriangleBvh); 2] {
    let ([first, second], copy) = (TESTS, tree.clone());
    [(first, tree.with_test(first.test)), (second, copy.with_test(second.test))]
}

/// A way to ask.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernel {
    /// One ray a call.
    Single,
    /// Thousands of unrelated rays a call.
    Batch,
    /// Eight neighbours together.
    Packet,
}

/// Memory of one thread that a kernel uses again and again.
#[derive(Debug, Default)]
pub struct Scratch {
    rays: Vec<Ray>,
    hits: Vec<Option<TriangleHit>>,
    occluded: Vec<bool>,
}

impl Scratch {
    /// Rays that a kernel may shorten, and room for their hits.
    fn closest(&mut self, rays: &[Ray]) -> (&mut [Ray], &mut [Option<TriangleHit>]) {
        self.rays.clear();
        self.rays.extend_from_slice(rays);
        self.hits.resize(rays.len(), None);
        (&mut self.rays, &mut self.hits[..rays.len()])
    }

    fn any(&mut self, rays: &[Ray]) -> &mut [bool] {
        self.occluded.resize(rays.len(), false);
        &mut self.occluded[..rays.len()]
    }
}

impl Kernel {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Single, Self::Batch, Self::Packet];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Single => "single",
            Self::Batch => "batch",
            Self::Packet => "packet",
        }
    }

    /// Traces the rays and adds up what they hit.
    pub fn trace(self, bvh: &TriangleBvh, query: Query, rays: &[Ray], scratch: &mut Scratch) -> Sums {
        match (self, query) {
            (Self::Single, Query::Closest) => Sums::of_hits(rays.iter().map(|ray| bvh.closest(ray))),
            (Self::Single, Query::Any) => Sums::of_occluded(rays.iter().map(|ray| bvh.any(ray))),
            (Self::Batch, Query::Closest) => {
                let (rays, hits) = scratch.closest(rays);
                bvh.closest_batch(rays, hits);
                Sums::of_hits(hits.iter().copied())
            }
            (Self::Batch, Query::Any) => {
                let occluded = scratch.any(rays);
                bvh.any_batch(rays, occluded);
                Sums::of_occluded(occluded.iter().copied())
            }
            (Self::Packet, Query::Closest) => rays.chunks(TILE).map(|tile| packet(bvh, tile)).sum(),
            (Self::Packet, Query::Any) => rays.chunks(TILE).map(|tile| packet_any(bvh, tile)).sum(),
        }
    }
}

fn packet(bvh: &TriangleBvh, tile: &[Ray]) -> Sums {
    let (mut rays, mut hits) = ([NO_RAY; TILE], [None; TILE]);
    let (rays, hits) = (&mut rays[..tile.len()], &mut hits[..tile.len()]);
    rays.copy_from_slice(tile);
    bvh.closest_packet(rays, hits);
    Sums::of_hits(hits.iter().copied())
}

fn packet_any(bvh: &TriangleBvh, tile: &[Ray]) -> Sums {
    let mut occluded = [false; TILE];
    let occluded = &mut occluded[..tile.len()];
    bvh.any_packet(tile, occluded);
    Sums::of_occluded(occluded.iter().copied())
}

/// Fills what is not yet a ray.
const NO_RAY: Ray =
    Ray { origin: juggler_math::Vec3::ZERO, direction: juggler_math::Vec3::Z, t_min: 0.0, t_max: 0.0, time: 0.0 };
