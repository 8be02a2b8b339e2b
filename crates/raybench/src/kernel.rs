//! Kernels that the benchmark measures: construction and traversal of a bounding volume hierarchy
//! of triangles.

use crate::Mesh;
use crate::measure::HitSummary;
use crate::rays::QueryKind;
use juggler_bvh::{Quality, TriangleBvh, TriangleError, TriangleHit, TriangleTest};
use juggler_math::Ray;

/// Number of rays per call of a coherent kernel: a tile of pixels.
const TILE: usize = 64;

/// A ray-triangle intersection test. To measure another test, add a line to [`TESTS`].
#[derive(Clone, Copy, Debug)]
pub struct NamedTest {
    /// Name of the test.
    pub name: &'static str,
    /// Whether no ray passes between triangles that share an edge. Compare only tests with the same
    /// value.
    pub watertight: bool,
    test: TriangleTest,
}

/// All ray-triangle intersection tests.
pub const TESTS: [NamedTest; 2] = [
    NamedTest { name: "watertight", watertight: true, test: TriangleTest::Watertight },
    NamedTest { name: "fast", watertight: false, test: TriangleTest::Fast },
];

/// Builds the hierarchy of a mesh.
pub fn build(mesh: &Mesh, quality: Quality) -> Result<TriangleBvh, TriangleError> {
    TriangleBvh::build(&mesh.positions, &mesh.triangles, quality)
}

/// Copies of a hierarchy, one for each intersection test, because the benchmark traces them
/// alternately.
pub fn with_tests(tree: TriangleBvh) -> [(NamedTest, TriangleBvh); 2] {
    let ([first, second], copy) = (TESTS, tree.clone());
    [(first, tree.with_test(first.test)), (second, copy.with_test(second.test))]
}

/// A query kernel: how many rays a call traces, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernel {
    /// One ray per call.
    Single,
    /// Hundreds of incoherent rays per call.
    Batch,
    /// A tile of coherent rays per call, traced in packets of eight.
    Packet,
}

/// Buffers of one thread, reused between calls.
#[derive(Debug, Default)]
pub struct Scratch {
    rays: Vec<Ray>,
    hits: Vec<Option<TriangleHit>>,
    occluded: Vec<bool>,
}

impl Scratch {
    /// Copies of the rays, which a kernel may shorten, and space for their hits.
    fn closest(&mut self, rays: &[Ray]) -> (&mut [Ray], &mut [Option<TriangleHit>]) {
        self.rays.clear();
        self.rays.extend_from_slice(rays);
        self.hits.resize(rays.len(), None);
        (&mut self.rays, &mut self.hits[..rays.len()])
    }

    /// Space for whether each ray is occluded.
    fn any(&mut self, rays: &[Ray]) -> &mut [bool] {
        self.occluded.resize(rays.len(), false);
        &mut self.occluded[..rays.len()]
    }
}

impl Kernel {
    /// All kernels.
    pub const ALL: [Self; 3] = [Self::Single, Self::Batch, Self::Packet];

    /// Name of the kernel.
    pub fn name(self) -> &'static str {
        match self {
            Self::Single => "single",
            Self::Batch => "batch",
            Self::Packet => "packet",
        }
    }

    /// Traces the rays and sums up the hits.
    pub fn trace(self, bvh: &TriangleBvh, query: QueryKind, rays: &[Ray], scratch: &mut Scratch) -> HitSummary {
        match (self, query) {
            (Self::Single, QueryKind::Closest) => HitSummary::from_hits(rays.iter().map(|ray| bvh.closest(ray))),
            (Self::Single, QueryKind::Any) => HitSummary::from_occluded(rays.iter().map(|ray| bvh.any(ray))),
            (Self::Batch, QueryKind::Closest) => {
                let (rays, hits) = scratch.closest(rays);
                bvh.closest_batch(rays, hits);
                HitSummary::from_hits(hits.iter().copied())
            }
            (Self::Batch, QueryKind::Any) => {
                let occluded = scratch.any(rays);
                bvh.any_batch(rays, occluded);
                HitSummary::from_occluded(occluded.iter().copied())
            }
            (Self::Packet, QueryKind::Closest) => rays.chunks(TILE).map(|tile| packet(bvh, tile)).sum(),
            (Self::Packet, QueryKind::Any) => rays.chunks(TILE).map(|tile| packet_any(bvh, tile)).sum(),
        }
    }
}

fn packet(bvh: &TriangleBvh, tile: &[Ray]) -> HitSummary {
    let (mut rays, mut hits) = ([NO_RAY; TILE], [None; TILE]);
    let (rays, hits) = (&mut rays[..tile.len()], &mut hits[..tile.len()]);
    rays.copy_from_slice(tile);
    bvh.closest_packet(rays, hits);
    HitSummary::from_hits(hits.iter().copied())
}

fn packet_any(bvh: &TriangleBvh, tile: &[Ray]) -> HitSummary {
    let mut occluded = [false; TILE];
    let occluded = &mut occluded[..tile.len()];
    bvh.any_packet(tile, occluded);
    HitSummary::from_occluded(occluded.iter().copied())
}

/// Initial value of ray buffers.
const NO_RAY: Ray =
    Ray { origin: juggler_math::Vec3::ZERO, direction: juggler_math::Vec3::Z, t_min: 0.0, t_max: 0.0, time: 0.0 };
