//! Meshes whose corners move while the shutter is open, straight from moment to moment.

use super::MeshData;
use crate::facet::Facet;
use crate::{InvalidShape, check::invalid};
use juggler_bvh::{MovingTriangleBvh, Quality, SimdLevel, TriangleHit};
use juggler_math::motion::{between, stretch, thinned};
use juggler_math::{Aabb, Ray, Vec3};

/// How far a corner may be off its way where moments are left out, in sizes of the mesh.
const TOLERANCE: f32 = 2e-4;

/// A hierarchy for each stretch of time, and the corners at its ends.
pub struct Deforming {
    /// The mesh at even times from opening to closing of the shutter, with the same triangles; two at least.
    keys: Vec<MeshData>,
    stretches: Vec<MovingTriangleBvh>,
    bounds: Aabb,
}

impl Deforming {
    /// Of meshes with the same triangles at even times, each already checked; fewer of them where corners go straight.
    pub fn new(keys: Vec<MeshData>) -> Result<Self, InvalidShape> {
        let points = keys.iter().flat_map(|key| key.positions.iter().copied());
        let bounds = Aabb::from_points(points);
        let tolerance = TOLERANCE * bounds.extent().length();
        let keys = thinned(keys, |at, before, after| is_between(at, before, after, tolerance));
        let tree = |pair: &[MeshData]| match pair {
            [from, to] => {
                MovingTriangleBvh::build(&from.positions, &to.positions, &from.triangles, 1.0, Quality::Balanced)
                    .map_err(|error| invalid("triangles", error.to_string()))
            }
            _ => Err(invalid("triangles", "a mesh that moves needs two moments")),
        };
        let stretches = keys.windows(2).map(tree).collect::<Result<Vec<_>, _>>()?;
        // What lies between two places, rounded, may lie an ulp beyond both.
        let bounds = bounds.grown(4.0 * f32::EPSILON * bounds.min.abs().max(bounds.max.abs()).max_element());
        Ok(Self { keys, stretches, bounds })
    }

    /// The stretch of a ray's time, and the ray with its share of that stretch for its time.
    fn at(&self, ray: &Ray) -> Option<(&MovingTriangleBvh, Ray)> {
        let (key, share) = stretch(self.keys.len(), ray.time);
        Some((self.stretches.get(key)?, Ray { time: share, ..*ray }))
    }

    /// The nearest hit at the ray's time.
    pub fn closest(&self, ray: &Ray) -> Option<TriangleHit> {
        let (tree, ray) = self.at(ray)?;
        tree.closest(&ray)
    }

    /// Whether anything is hit at the ray's time.
    pub fn any(&self, ray: &Ray) -> bool {
        self.at(ray).is_some_and(|(tree, ray)| tree.any(&ray))
    }

    /// A triangle as it is at a time.
    pub fn facet(&self, triangle: usize, time: f32) -> Option<Facet> {
        let (key, share) = stretch(self.keys.len(), time);
        let (from, to) = (self.keys.get(key)?.facet(triangle)?, self.keys.get(key + 1)?.facet(triangle)?);
        let way = |from: [Vec3; 3], to: [Vec3; 3]| [0, 1, 2].map(|i: usize| between(from[i], to[i], share));
        let normals = from.normals.zip(to.normals).map(|(from, to)| way(from, to));
        Some(Facet { corners: way(from.corners, to.corners), normals, uvs: from.uvs })
    }

    /// A box around all triangles wherever they come.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Bytes of the hierarchies.
    pub fn bvh_bytes(&self) -> usize {
        self.stretches.iter().map(MovingTriangleBvh::bytes).sum()
    }

    /// The meshes at the ends of the stretches.
    pub fn keys(&self) -> &[MeshData] {
        &self.keys
    }

    /// The same for another vector unit.
    pub fn with_simd_level(&self, level: SimdLevel) -> Self {
        let stretches = self.stretches.iter().map(|tree| tree.clone().with_simd_level(level)).collect();
        Self { keys: self.keys.clone(), stretches, bounds: self.bounds }
    }
}

/// Whether all corners are near the straight ways from one moment to the next.
fn is_between(at: &MeshData, before: &MeshData, after: &MeshData, tolerance: f32) -> bool {
    let ends = before.positions.iter().zip(&after.positions);
    ends.zip(&at.positions).all(|((a, b), at)| between(*a, *b, 0.5).distance(*at) <= tolerance)
}
