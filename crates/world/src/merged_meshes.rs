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
/// Number of consecutive triangles whose owners are looked up from the same place.
const RUN: usize = 16;

/// Merged meshes of a geometry, all of them with the identity transform.
#[derive(Clone)]
pub struct MergedMeshes {
    bvh: Arc<TriangleBvh>,
    /// First triangle in `bvh` and shape index of each mesh.
    owners: Vec<(u32, u32)>,
    /// Index of the owner of the first triangle of each run of [`RUN`] triangles.
    first_owners: Vec<u32>,
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
        let first_owners = first_owners(&owners, triangles.len());
        Some(Self { bvh: Arc::new(bvh), owners, first_owners })
    }

    /// Sets the SIMD instruction set of the hierarchy.
    pub fn with_simd_level(&self, level: SimdLevel) -> Self {
        let bvh = Arc::new(TriangleBvh::clone(&self.bvh).with_simd_level(level));
        Self { bvh, ..self.clone() }
    }

    /// Memory of the hierarchy and of the table of owners, in bytes.
    pub fn bytes(&self) -> usize {
        self.bvh.bytes() + size_of_val(&*self.first_owners)
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
        let owners = &self.owners[self.first_owners[hit.index as usize / RUN] as usize..];
        let behind = owners.iter().skip(1).take_while(|(first, _)| *first <= hit.index).count();
        let (start, shape_index) = owners[behind];
        (Hit { t: hit.t, uv: Vec2::new(hit.u, hit.v), primitive: hit.index - start }, shape_index)
    }

    /// Marks the rays that a mesh occludes.
    pub fn occludes_rays(&self, rays: &[Ray], coherence: RayCoherence, occluded: &mut [bool]) {
        // Most rays can be traced as they are.
        let as_traced =
            |ray: &Ray, occluded: bool| if occluded { ray.with_t_max(-1.0) } else { clamp_to_f32_range(ray) };
        if rays.iter().zip(&*occluded).all(|(ray, occluded)| as_traced(ray, *occluded).t_max == ray.t_max) {
            return self.any(rays, coherence, occluded);
        }
        // Disable the rays that are occluded already.
        let local: Vec<Ray> = rays.iter().zip(&*occluded).map(|(ray, occluded)| as_traced(ray, *occluded)).collect();
        let mut found = vec![false; rays.len()];
        self.any(&local, coherence, &mut found);
        for (occluded, found) in occluded.iter_mut().zip(found) {
            *occluded |= found;
        }
    }

    fn any(&self, rays: &[Ray], coherence: RayCoherence, occluded: &mut [bool]) {
        match coherence {
            RayCoherence::Coherent => self.bvh.any_packet(rays, occluded),
            RayCoherence::Incoherent => self.bvh.any_batch(rays, occluded),
        }
    }
}

/// Index of the owner of every [`RUN`]th of `count` triangles.
fn first_owners(owners: &[(u32, u32)], count: usize) -> Vec<u32> {
    let mut owner = 0;
    let mut owner_of = |triangle: usize| {
        while owners.get(owner + 1).is_some_and(|(first, _)| *first as usize <= triangle) {
            owner += 1;
        }
        owner as u32
    };
    (0..count).step_by(RUN).map(&mut owner_of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn owners_are_found_from_the_table() {
        // Meshes of many and of few triangles, and of none.
        let sizes = [0, 1, 40, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 3, 0, 100, 2, 0];
        let mut count = 0;
        let owners = sizes.iter().zip(7..).map(|(size, shape_index)| {
            count += size;
            (count - size, shape_index)
        });
        let owners: Vec<(u32, u32)> = owners.collect();
        let table = first_owners(&owners, count as usize);
        assert_eq!(table.len(), (count as usize).div_ceil(RUN));
        let bvh = Arc::new(TriangleBvh::build(&[], &[], Quality::Balanced).unwrap());
        let merged = MergedMeshes { bvh, owners, first_owners: table };
        for index in 0..count {
            let (hit, shape_index) = merged.owned(&TriangleHit { t: 1.0, u: 0.0, v: 0.0, index });
            let mesh = (shape_index - 7) as usize;
            let first: u32 = sizes[..mesh].iter().sum();
            assert!(hit.primitive < sizes[mesh] && first + hit.primitive == index, "{index}: mesh {mesh}");
        }
    }
}
