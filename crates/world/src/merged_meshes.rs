//! Many small meshes merged into one hierarchy of triangles beside that of the objects, so that
//! overlapping bounding boxes cost nothing. The hits are the same: ties go to the lower shape
//! index, and within a mesh to the lower triangle.

use super::closest_after::HitKey;
use super::large_mesh::RayCoherence;
use super::{Object, WorldHit};
use juggler_bvh::{Quality, SimdLevel, TriangleBvh, TriangleHit};
use juggler_math::{BuildControl, Ray, Vec2, Vec3};
use juggler_shape::{Hit, Mesh, Shape, clamp_to_f32_range};
use std::sync::Arc;

/// Maximum number of triangles of a mesh that is merged.
const MAX_MESH_TRIANGLES: usize = 1 << 14;
/// Maximum number of merged triangles, which are stored both here and in their meshes.
const MAX_TRIANGLES: usize = 1 << 20;

/// Merged meshes of a geometry, all of them with the identity transform.
#[derive(Clone)]
pub struct MergedMeshes {
    bvh: Arc<TriangleBvh>,
    /// First triangle in `bvh` and shape index of each mesh.
    owners: Vec<(u32, u32)>,
}

impl std::fmt::Debug for MergedMeshes {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} meshes merged", self.owners.len())
    }
}

/// Indices of the meshes to merge, without those in `separate`; empty unless there are several.
pub fn indices(objects: &[Object], separate: &[u32]) -> Vec<u32> {
    let mut sum = 0;
    let mut fits = |object: &Object| {
        let Some(mesh) = mesh(object).filter(|mesh| mesh.triangles() <= MAX_MESH_TRIANGLES) else { return false };
        sum += mesh.triangles();
        sum <= MAX_TRIANGLES
    };
    let indices: Vec<u32> = (0..)
        .zip(objects)
        .filter(|(object_index, object)| !separate.contains(object_index) && fits(object))
        .map(|(object_index, _)| object_index)
        .collect();
    if indices.len() > 1 { indices } else { Vec::new() }
}

/// Mesh of an object that neither moves nor has a transform.
fn mesh(object: &Object) -> Option<&Mesh> {
    let is_static = object.motion.is_identity() && object.is_bounded();
    object.content.as_shape().filter(|_| is_static)?.mesh().filter(|mesh| !mesh.moves())
}

impl MergedMeshes {
    /// Merges the meshes of the objects at `indices`; `shape_index` maps them to shape indices.
    /// `None` if there is none, or if `control` is cancelled.
    pub fn new(
        objects: &[Object],
        indices: &[u32],
        shape_index: impl Fn(u32) -> u32,
        control: &BuildControl,
    ) -> Option<Self> {
        let (mut positions, mut triangles, mut owners) = (Vec::<Vec3>::new(), Vec::new(), Vec::new());
        for object_index in indices {
            let data = mesh(objects.get(*object_index as usize)?)?.data()?;
            owners.push((triangles.len() as u32, shape_index(*object_index)));
            let first = positions.len() as u32;
            triangles.extend(data.triangles.iter().map(|corners| corners.map(|corner| corner + first)));
            positions.extend_from_slice(&data.positions);
        }
        let bvh = TriangleBvh::build_with_control(&positions, &triangles, Quality::Balanced, control);
        let bvh = bvh.ok().filter(|_| !indices.is_empty())?;
        Some(Self { bvh: Arc::new(bvh), owners })
    }

    /// Sets the SIMD instruction set of the hierarchy.
    pub fn with_simd_level(&self, level: SimdLevel) -> Self {
        let bvh = Arc::new(TriangleBvh::clone(&self.bvh).with_simd_level(level));
        Self { bvh, ..self.clone() }
    }

    /// Memory of the hierarchy, in bytes.
    pub fn bytes(&self) -> usize {
        self.bvh.bytes()
    }

    /// Replaces `hits` by nearer ones.
    pub fn intersect_rays(&self, rays: &mut [Ray], coherence: RayCoherence, hits: &mut [WorldHit]) {
        let mut found: Vec<Option<TriangleHit>> = vec![None; rays.len()];
        rays.iter_mut().for_each(|ray| *ray = clamp_to_f32_range(ray));
        match coherence {
            RayCoherence::Coherent => self.bvh.closest_packet(rays, &mut found),
            RayCoherence::Incoherent => self.bvh.closest_batch(rays, &mut found),
        }
        for ((ray, best), hit) in rays.iter_mut().zip(hits).zip(found) {
            if let Some(hit) = hit {
                let (hit, shape_index) = self.owned(&hit);
                best.keep_nearer(hit, shape_index, ray);
            }
        }
    }

    /// Nearest hit behind `key`, with the index of its shape.
    pub fn closest_after(&self, ray: &Ray, key: &HitKey) -> Option<(Hit, u32)> {
        let accepts = |_: usize, hit: &TriangleHit| {
            let (hit, shape) = self.owned(hit);
            HitKey { t: hit.t, shape, primitive: hit.primitive } > *key
        };
        let hit = self.bvh.filtered(accepts).closest(&clamp_to_f32_range(ray))?;
        Some(self.owned(&hit))
    }

    /// Hit of a mesh, with the index of its shape, for a hit of the merged hierarchy.
    fn owned(&self, hit: &TriangleHit) -> (Hit, u32) {
        let owner = self.owners.partition_point(|(first, _)| *first <= hit.index) - 1;
        let (start, shape_index) = self.owners[owner];
        (Hit { t: hit.t, uv: Vec2::new(hit.u, hit.v), primitive: hit.index - start }, shape_index)
    }

    /// Marks the rays that a mesh occludes.
    pub fn occludes_rays(&self, rays: &[Ray], coherence: RayCoherence, occluded: &mut [bool]) {
        // Disable the rays that are occluded already.
        let unoccluded =
            |(ray, occluded): (&Ray, &bool)| if *occluded { ray.with_t_max(-1.0) } else { clamp_to_f32_range(ray) };
        let local: Vec<Ray> = rays.iter().zip(&*occluded).map(unoccluded).collect();
        let mut found = vec![false; rays.len()];
        match coherence {
            RayCoherence::Coherent => self.bvh.any_packet(&local, &mut found),
            RayCoherence::Incoherent => self.bvh.any_batch(&local, &mut found),
        }
        for (occluded, found) in occluded.iter_mut().zip(found) {
            *occluded |= found;
        }
    }
}
