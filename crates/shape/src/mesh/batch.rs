//! Intersection of many rays with a mesh's bounding volume hierarchy. The hits equal those of
//! queries with single rays.

use super::Mesh;
use crate::Hit;
use crate::arithmetic::clamp_to_f32_range;
use juggler_math::{Ray, Vec2};

impl Mesh {
    /// [`Shape::intersect`](crate::Shape::intersect) for the hits that follow the distance and
    /// triangle `after`: hits before the distance do not count, nor those at it of triangles up to
    /// that index.
    pub fn intersect_after(&self, ray: &Ray, after: (f32, Option<u32>)) -> Option<Hit> {
        let hit = self.prepared.as_ref()?.closest_after(&clamp_to_f32_range(ray), after)?;
        Some(Hit { t: hit.t, uv: Vec2::new(hit.u, hit.v), primitive: hit.index })
    }

    /// [`Shape::intersect`](crate::Shape::intersect) for many rays, in object space. Set `coherent`
    /// if neighboring rays have about the same origin and direction: they are then traced in
    /// packets. The rays are overwritten.
    pub fn intersect_rays(&self, rays: &mut [Ray], coherent: bool) -> Vec<Option<Hit>> {
        let Some(prepared) = &self.prepared else { return vec![None; rays.len()] };
        rays.iter_mut().for_each(|ray| *ray = clamp_to_f32_range(ray));
        let mut hits = vec![None; rays.len()];
        match (prepared.bvh(), coherent) {
            (Some(bvh), true) => bvh.closest_packet(rays, &mut hits),
            (Some(bvh), false) => bvh.closest_batch(rays, &mut hits),
            (None, _) => rays.iter().zip(&mut hits).for_each(|(ray, hit)| *hit = prepared.closest(ray)),
        }
        let hit = |hit: juggler_bvh::TriangleHit| Hit { t: hit.t, uv: Vec2::new(hit.u, hit.v), primitive: hit.index };
        hits.into_iter().map(|found| found.map(hit)).collect()
    }

    /// [`Shape::occludes`](crate::Shape::occludes) for many rays, in object space; see
    /// [`Mesh::intersect_rays`].
    pub fn occludes_rays(&self, rays: &mut [Ray], coherent: bool) -> Vec<bool> {
        let mut occluded = vec![false; rays.len()];
        let Some(prepared) = &self.prepared else { return occluded };
        rays.iter_mut().for_each(|ray| *ray = clamp_to_f32_range(ray));
        match (prepared.bvh(), coherent) {
            (Some(bvh), true) => bvh.any_packet(rays, &mut occluded),
            (Some(bvh), false) => bvh.any_batch(rays, &mut occluded),
            (None, _) => rays.iter().zip(&mut occluded).for_each(|(ray, found)| *found = prepared.any(ray)),
        }
        occluded
    }
}
