//! Many rays at once through a mesh's own hierarchy. The same hits as one by one.

use super::Mesh;
use crate::Hit;
use crate::arithmetic::within_floats;
use juggler_math::{Ray, Vec2};

impl Mesh {
    /// [`Shape::intersect`](crate::Shape::intersect) for many rays, object space. `coherent` where they go much
    /// the same way as their neighbours. The rays are used up.
    pub fn intersect_many(&self, rays: &mut [Ray], coherent: bool) -> Vec<Option<Hit>> {
        let Some(prepared) = &self.prepared else { return vec![None; rays.len()] };
        rays.iter_mut().for_each(|ray| *ray = within_floats(ray));
        let mut hits = vec![None; rays.len()];
        match (prepared.bvh(), coherent) {
            (Some(bvh), true) => bvh.closest_packet(rays, &mut hits),
            (Some(bvh), false) => bvh.closest_batch(rays, &mut hits),
            (None, _) => rays.iter().zip(&mut hits).for_each(|(ray, hit)| *hit = prepared.closest(ray)),
        }
        let hit = |hit: juggler_bvh::TriangleHit| Hit { t: hit.t, uv: Vec2::new(hit.u, hit.v), part: hit.index };
        hits.into_iter().map(|found| found.map(hit)).collect()
    }

    /// [`Shape::occludes`](crate::Shape::occludes) for many rays, object space; see [`Mesh::intersect_many`].
    pub fn occludes_many(&self, rays: &mut [Ray], coherent: bool) -> Vec<bool> {
        let mut occluded = vec![false; rays.len()];
        let Some(prepared) = &self.prepared else { return occluded };
        rays.iter_mut().for_each(|ray| *ray = within_floats(ray));
        match (prepared.bvh(), coherent) {
            (Some(bvh), true) => bvh.any_packet(rays, &mut occluded),
            (Some(bvh), false) => bvh.any_batch(rays, &mut occluded),
            (None, _) => rays.iter().zip(&mut occluded).for_each(|(ray, found)| *found = prepared.any(ray)),
        }
        occluded
    }
}
