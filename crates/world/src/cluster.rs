//! Surfaces at one place: those that a ray hits within the rounding errors of each other, such as a
//! glass block and the table that it stands on.

use super::closest_after::HitKey;
use super::{Vertex, World};
use arrayvec::ArrayVec;
use juggler_math::Ray;

/// Maximum number of surfaces at one place that are distinguished by shape and side.
const MAX_SIDES: usize = 16;
/// Maximum number of surfaces at one place; a ray passes the others together with the last one.
const MAX_MEMBERS: u32 = 64;
/// Number of hits at one place that make it crowded.
const CROWD: u32 = 32;
/// Number of hits of a vertex that is known to be alone, so that no other is sought.
const ALONE: u32 = MAX_MEMBERS + 1;
/// Smallest cosine between ray and normal by which errors along the normal become errors along the
/// ray.
const MIN_COSINE: f32 = 0.05;

/// A surface at the place of another one.
#[derive(Clone, Copy, Debug)]
pub struct Member {
    /// Surface at the hit.
    pub vertex: Vertex,
    /// Distance along the ray.
    pub t: f32,
}

impl Member {
    /// Whether a ray of this direction arrives at the front of the surface.
    #[inline]
    pub fn is_entered(&self, ray: &Ray) -> bool {
        self.vertex.surface.normal.dot(ray.direction) < 0.0
    }
}

/// Whether a ray starts at the place of a surface that it hits: on the surface's tangent plane, within
/// `error`, that of the surfaces at its place, and rounding. Such a ray left another surface there.
pub fn starts_at(ray: &Ray, vertex: &Vertex, error: f32) -> bool {
    let surface = &vertex.surface;
    let rounding = f32::EPSILON * surface.point.abs().max_element();
    surface.normal.dot(surface.point - ray.origin).abs() <= 16.0 * (error + rounding)
}

/// Distance along the ray, from the vertex that it hits at its `t_max`, up to which other surfaces are
/// at the same place.
#[inline]
fn reach(ray: &Ray, vertex: &Vertex) -> f32 {
    let surface = &vertex.surface;
    let cosine = surface.normal.dot(ray.direction).abs().max(MIN_COSINE);
    let rounding = f32::EPSILON * surface.point.abs().max_element().max(ray.t_max);
    4.0 * (surface.position_error + rounding) / cosine
}

impl World {
    /// Whether the vertex that `ray` hits at its `t_max` is known to be the only surface at its place.
    #[inline]
    pub fn is_alone(&self, ray: &Ray, vertex: &Vertex) -> bool {
        self.contacts.is_apart(vertex, reach(ray, vertex))
    }
}

/// Surfaces at the place of a vertex, in the order of their hits along the ray. Neighboring triangles
/// of a mesh that a ray hits at their common edge count as one.
#[derive(Clone)]
pub struct Cluster<'w> {
    world: &'w World,
    ray: Ray,
    /// Distance up to which surfaces are at the same place.
    end: f32,
    key: HitKey,
    /// Shape and side of each member so far.
    sides: ArrayVec<(u32, bool), MAX_SIDES>,
    /// Number of hits behind the first one so far; [`ALONE`] if no other surface can be near.
    visited: u32,
}

impl<'w> Cluster<'w> {
    /// Cluster of the vertex that `ray` hits at its `t_max`.
    pub fn new(world: &'w World, ray: &Ray, vertex: &Vertex) -> Self {
        let first = Member { vertex: *vertex, t: ray.t_max };
        let reach = reach(ray, vertex);
        let visited = if world.contacts.is_apart(vertex, reach) { ALONE } else { 0 };
        let mut sides = ArrayVec::new();
        sides.push((vertex.shape, first.is_entered(ray)));
        Self { world, ray: *ray, end: ray.t_max + reach, key: HitKey::new(first.t, vertex), sides, visited }
    }

    /// Whether the cluster has found many hits at its place so far. Hits of neighboring triangles
    /// count one by one.
    pub fn is_crowded(&self) -> bool {
        (CROWD..ALONE).contains(&self.visited)
    }

    /// The cluster without surfaces beyond the distance `t_max`.
    pub fn up_to(self, t_max: f32) -> Self {
        Self { end: self.end.min(t_max), ..self }
    }

    /// The ray behind all surfaces of the cluster, with the same origin.
    pub fn ray_behind(&self) -> Ray {
        Ray { t_min: self.end.next_up(), t_max: f32::INFINITY, ..self.ray }
    }
}

impl Iterator for Cluster<'_> {
    type Item = Member;

    /// The next surface at the place.
    fn next(&mut self) -> Option<Member> {
        while self.visited < MAX_MEMBERS {
            self.visited += 1;
            let mut ray = self.ray.with_t_max(self.end);
            let hit = self.world.closest_after(&mut ray, &self.key);
            if !hit.is_some() {
                return None;
            }
            self.key = hit.key();
            let ray = self.ray.with_t_max(hit.hit.t);
            let member = Member { vertex: self.world.vertex(&ray, &hit), t: hit.hit.t };
            let side = (member.vertex.shape, member.is_entered(&self.ray));
            if !self.sides.contains(&side) {
                _ = self.sides.try_push(side);
                return Some(member);
            }
        }
        None
    }
}
