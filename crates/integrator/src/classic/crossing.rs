//! Surfaces at one place in classic pictures. Surfaces that opacity removes are passed one by one,
//! an opaque surface ends the passage, and the surfaces of two transparent solids that touch act as
//! one.

use super::Classic;
use crate::{PathHistory, PathState, VertexOutput};
use juggler_math::Ray;
use juggler_world::{Cluster, Member, Vertex, World};

impl Classic {
    /// Follows a ray through all surfaces at the place of `vertex`.
    #[inline(never)]
    pub(super) fn cross_surfaces(
        &self,
        world: &World,
        ray: &Ray,
        path: &PathState,
        vertex: &Vertex,
        output: &mut VertexOutput,
    ) {
        let mut cluster = Cluster::new(world, ray, vertex);
        let (mut member, mut path) = (Member { vertex: *vertex, t: ray.t_max }, *path);
        loop {
            let here = &mut output.at(&path);
            let is_straight = match surface(world, ray, member, &mut cluster) {
                Some((Member { vertex, t }, ior)) => {
                    let mut phong = world.phong(&vertex);
                    if let (Some(phong), Some(ior)) = (&mut phong, ior) {
                        phong.to_mut().ior = ior;
                    }
                    !self.interact(world, &ray.with_t_max(t), &path, &vertex, phong, here)
                }
                None => true,
            };
            if !is_straight || path.depth >= self.max_depth {
                return;
            }
            let pass_throughs = path.history.pass_throughs.saturating_add(1);
            let history = PathHistory { pass_throughs, ..path.history };
            path = PathState { depth: path.depth + 1, sampler: path.sampler.branch(0), history, ..path };
            match cluster.next() {
                Some(next) => member = next,
                None => return output.continue_straight(cluster.ray_behind(), &path),
            }
        }
    }
}

/// Surface of all those at the place of `member` that the ray interacts with, and the index of
/// refraction relative to the other side if two solids touch; `None` if the ray goes straight on,
/// from one solid into another of the same index.
fn surface(world: &World, ray: &Ray, member: Member, cluster: &mut Cluster) -> Option<(Member, Option<f32>)> {
    if !is_transparent(world, &member.vertex) {
        return Some((member, None));
    }
    let mut touching = None;
    for other in cluster {
        if !is_transparent(world, &other.vertex) {
            if world.is_cut_out(&other.vertex, -ray.direction, || 0.0) {
                continue;
            }
            return Some((grown(other, &member), None));
        }
        if other.is_entered(ray) != member.is_entered(ray) {
            touching = touching.or(Some(other));
        }
    }
    let Some(other) = touching else { return Some((member, None)) };
    let (entered, left) = if member.is_entered(ray) { (member, other) } else { (other, member) };
    let ior = |vertex: &Vertex| world.phong(vertex).map_or(1.0, |phong| phong.ior);
    let (inside, outside) = (ior(&entered.vertex), ior(&left.vertex));
    (inside != outside).then(|| (grown(entered, &left), Some(inside / outside)))
}

/// Whether the ray may be refracted into the solid behind the surface.
fn is_transparent(world: &World, vertex: &Vertex) -> bool {
    world.phong(vertex).is_some_and(|phong| !phong.transparency.is_black())
}

/// The surface with an error that reaches beyond another one at its place.
fn grown(member: Member, other: &Member) -> Member {
    let mut grown = member;
    grown.vertex.surface.grow_error(&member.vertex.surface, &other.vertex.surface);
    grown
}
