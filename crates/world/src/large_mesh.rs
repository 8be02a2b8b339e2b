//! Large meshes beside the hierarchy, if there are few: all rays that hit a mesh's bounding box
//! traverse its hierarchy together, which is faster than one at a time. Ties do not depend on the
//! order of traversal, so the hits are the same.

use super::instance::Instance;
use super::{Content, Object, WorldHit};
use juggler_math::{Aabb, Ray};
use juggler_shape::{Mesh, Shape};

/// Minimum number of triangles of a large mesh.
const MIN_TRIANGLES: usize = 1024;
/// Maximum number of meshes beside the hierarchy. With more, front-to-back traversal of the
/// hierarchy saves more.
const MAX_LARGE_MESHES: usize = 4;
/// Below this number of rays a batch gains nothing.
const MIN_BATCH: usize = 4;

/// Coherence of the rays of a query.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayCoherence {
    /// Neighboring rays have similar origins and directions.
    Coherent,
    /// Rays have nothing in common.
    Incoherent,
}

/// A large mesh of a geometry.
#[derive(Clone, Debug)]
pub struct LargeMesh {
    /// Bounding box in the geometry's space.
    pub(super) bounds: Aabb,
    pub(super) object_index: u32,
    pub(super) shape_index: u32,
}

/// Indices of the bounded objects that are large meshes; empty if there are more than
/// `MAX_LARGE_MESHES`.
pub fn indices(objects: &[Object]) -> Vec<u32> {
    let has_many = |object: &Object| object.content.mesh().is_some_and(|mesh| mesh.triangles() >= MIN_TRIANGLES);
    let is_large = |object: &Object| has_many(object) && object.is_bounded();
    let indices: Vec<u32> =
        (0..).zip(objects).filter(|(_, object)| is_large(object)).map(|(object_index, _)| object_index).collect();
    if indices.len() <= MAX_LARGE_MESHES { indices } else { Vec::new() }
}

impl LargeMesh {
    /// Creates the entry of the object at index `object_index`, whose shape has the index
    /// `shape_index`.
    pub fn new(object: &Object, object_index: u32, shape_index: u32) -> Self {
        let bounds = object.bounds();
        // Pad the box: it must not reject a ray that the hierarchy's padded box test would accept.
        let bounds = bounds.grown(16.0 * f32::EPSILON * bounds.min.abs().max(bounds.max.abs()).max_element());
        Self { bounds, object_index, shape_index }
    }

    /// Replaces `hits` by nearer ones.
    pub fn intersect_rays(
        &self,
        objects: &[Instance],
        rays: &mut [Ray],
        coherence: RayCoherence,
        hits: &mut [WorldHit],
    ) {
        let instance = &objects[self.object_index as usize];
        let mesh = instance.content.mesh().filter(|_| rays.len() >= MIN_BATCH);
        let Some(mesh) = mesh else {
            for (ray, best) in rays.iter_mut().zip(hits).filter(|(ray, _)| self.bounds.clip(ray).is_some()) {
                instance.closest(ray, self.shape_index, best);
            }
            return;
        };
        let lanes: Vec<usize> = (0..rays.len()).filter(|lane| self.bounds.clip(&rays[*lane]).is_some()).collect();
        let mut local: Vec<Ray> = lanes.iter().map(|lane| instance.ray_to_object(&rays[*lane])).collect();
        for (lane, hit) in lanes.into_iter().zip(mesh.intersect_rays(&mut local, coherence == RayCoherence::Coherent)) {
            if let Some(hit) = hit {
                hits[lane].keep_nearer(hit, self.shape_index, &mut rays[lane]);
            }
        }
    }

    /// Marks the rays that the mesh occludes.
    pub fn occludes_rays(&self, objects: &[Instance], rays: &[Ray], coherence: RayCoherence, occluded: &mut [bool]) {
        let instance = &objects[self.object_index as usize];
        let mesh = instance.content.mesh().filter(|_| rays.len() >= MIN_BATCH);
        let Some(mesh) = mesh else {
            for (ray, occluded) in rays.iter().zip(occluded) {
                *occluded = *occluded || self.bounds.clip(ray).is_some() && instance.occludes(ray);
            }
            return;
        };
        let needs_test = |lane: &usize| !occluded[*lane] && self.bounds.clip(&rays[*lane]).is_some();
        let lanes: Vec<usize> = (0..rays.len()).filter(needs_test).collect();
        let mut local: Vec<Ray> = lanes.iter().map(|lane| instance.ray_to_object(&rays[*lane])).collect();
        for (lane, found) in lanes.into_iter().zip(mesh.occludes_rays(&mut local, coherence == RayCoherence::Coherent))
        {
            occluded[lane] = found;
        }
    }
}

impl Content {
    fn mesh(&self) -> Option<&Mesh> {
        self.as_shape()?.mesh()
    }
}
