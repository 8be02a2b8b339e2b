//! Meshes whose corners move while the shutter is open, linearly between keyframes.

use super::MeshData;
use crate::triangle_geometry::TriangleGeometry;
use crate::{InvalidShape, check::invalid};
use juggler_bvh::{MovingTriangleBvh, Quality, SimdLevel, TriangleHit};
use juggler_math::motion::{key_interval, lerp, without_redundant_keys};
use juggler_math::{Aabb, BuildControl, Ray, Vec2, Vec3};

/// Largest distance of a corner from its path where keyframes are left out, relative to the mesh's
/// size.
const TOLERANCE: f32 = 2e-4;

/// One hierarchy for each interval of time, and the corners at its ends.
pub struct MovingMesh {
    /// The mesh at uniform times from opening to closing of the shutter: at least two, with the
    /// same triangles.
    keys: Vec<MeshData>,
    intervals: Vec<MovingTriangleBvh>,
    bounds: Aabb,
}

impl MovingMesh {
    /// Hierarchies of meshes with the same triangles at uniform times, each already validated.
    /// Keyframes are left out where corners move linearly.
    pub fn new(keys: Vec<MeshData>, control: &BuildControl) -> Result<Self, InvalidShape> {
        let points = keys.iter().flat_map(|key| key.positions.iter().copied());
        let bounds = Aabb::from_points(points);
        let tolerance = TOLERANCE * bounds.extent().length();
        let keys = without_redundant_keys(keys, |at, before, after| is_between(at, before, after, tolerance));
        let tree = |pair: &[MeshData]| match pair {
            [from, to] => {
                let ends = [&from.positions[..], &to.positions[..]];
                MovingTriangleBvh::build_with_control(ends, &from.triangles, 1.0, Quality::Balanced, control)
                    .map_err(|error| invalid("triangles", error.to_string()))
            }
            _ => Err(invalid("triangles", "a moving mesh needs at least two keyframes")),
        };
        let intervals = keys.windows(2).map(tree).collect::<Result<Vec<_>, _>>()?;
        // Rounding may put an interpolated corner an ulp beyond both ends.
        let bounds = bounds.grown(4.0 * f32::EPSILON * bounds.min.abs().max(bounds.max.abs()).max_element());
        Ok(Self { keys, intervals, bounds })
    }

    /// Hierarchy of the interval that contains the ray's time, and the ray with its fraction of
    /// that interval as its time.
    fn at(&self, ray: &Ray) -> Option<(&MovingTriangleBvh, Ray)> {
        let (key, fraction) = key_interval(self.keys.len(), ray.time);
        Some((self.intervals.get(key)?, Ray { time: fraction, ..*ray }))
    }

    /// The nearest hit at the ray's time.
    pub fn closest(&self, ray: &Ray) -> Option<TriangleHit> {
        let (tree, ray) = self.at(ray)?;
        tree.closest(&ray)
    }

    /// The nearest hit at the ray's time that follows the distance and triangle `after`.
    pub fn closest_after(&self, ray: &Ray, after: (f32, Option<u32>)) -> Option<TriangleHit> {
        let (tree, ray) = self.at(ray)?;
        tree.closest_after(&ray, after)
    }

    /// Whether the ray hits anything at its time.
    pub fn any(&self, ray: &Ray) -> bool {
        self.at(ray).is_some_and(|(tree, ray)| tree.any(&ray))
    }

    /// Triangle at a time.
    pub fn triangle_geometry(&self, triangle: usize, time: f32) -> Option<TriangleGeometry> {
        let (key, fraction) = key_interval(self.keys.len(), time);
        let (from, to) =
            (self.keys.get(key)?.triangle_geometry(triangle)?, self.keys.get(key + 1)?.triangle_geometry(triangle)?);
        let lerp_corners = |from: [Vec3; 3], to: [Vec3; 3]| [0, 1, 2].map(|i: usize| lerp(from[i], to[i], fraction));
        let normals = from.normals.zip(to.normals).map(|(from, to)| lerp_corners(from, to));
        Some(TriangleGeometry { corners: lerp_corners(from.corners, to.corners), normals, uvs: from.uvs })
    }

    /// Mean area of a triangle over the keyframes and the midpoints between them, so that a triangle
    /// counts even if it has no area at some keyframes.
    pub fn mean_area(&self, triangle: usize) -> Option<f64> {
        let last = 2 * self.intervals.len();
        let area = |step: usize| Some(self.triangle_geometry(triangle, step as f32 / last as f32)?.area());
        Some((0..=last).map(area).sum::<Option<f64>>()? / (last + 1) as f64)
    }

    /// Tangent at a time, as [`MeshData::tangent`].
    pub fn tangent(&self, triangle: usize, at: Vec2, time: f32) -> Option<(Vec3, f32)> {
        let (key, fraction) = key_interval(self.keys.len(), time);
        let [from, to] = [self.keys.get(key)?, self.keys.get(key + 1)?].map(|key| key.tangent(triangle, at));
        let ((from, sign), (to, _)) = from.zip(to)?;
        Some((lerp(from, to, fraction), sign))
    }

    /// Bounding box of all triangles at all times.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Bytes of the hierarchies.
    pub fn bvh_bytes(&self) -> usize {
        self.intervals.iter().map(MovingTriangleBvh::bytes).sum()
    }

    /// Meshes at the ends of the intervals.
    pub fn keys(&self) -> &[MeshData] {
        &self.keys
    }

    /// The same hierarchies for another SIMD level.
    pub fn with_simd_level(&self, level: SimdLevel) -> Self {
        let intervals = self.intervals.iter().map(|tree| tree.clone().with_simd_level(level)).collect();
        Self { keys: self.keys.clone(), intervals, bounds: self.bounds }
    }
}

/// Whether all corners are within `tolerance` of the midpoints between the keyframes before and
/// after.
fn is_between(at: &MeshData, before: &MeshData, after: &MeshData, tolerance: f32) -> bool {
    let ends = before.positions.iter().zip(&after.positions);
    ends.zip(&at.positions).all(|((a, b), at)| lerp(*a, *b, 0.5).distance(*at) <= tolerance)
}
