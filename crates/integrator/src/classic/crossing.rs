//! Surfaces at one place in classic pictures. Surfaces that opacity removes are passed one by one,
//! an opaque surface ends the passage, and the surfaces of two transparent solids that touch act as
//! one.

use super::{Classic, Material};
use crate::{PathHistory, PathState, VertexOutput};
use juggler_math::{Ray, Vec2};
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
            let is_straight = match surface(world, ray, &path, member, &mut cluster) {
                Some((Member { vertex, t }, outside_ior)) => {
                    let mut phong = world.phong(&vertex);
                    if let Some(phong) = phong.as_mut().filter(|_| outside_ior != 1.0) {
                        phong.to_mut().ior /= outside_ior;
                    }
                    let material = Material::new(phong.as_deref(), outside_ior);
                    !self.interact(world, &ray.with_t_max(t), &path, &vertex, material, here)
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
/// refraction of the medium outside of it; `None` if the ray goes straight on, from one solid into
/// another of the same index.
fn surface(world: &World, ray: &Ray, path: &PathState, member: Member, cluster: &mut Cluster) -> Option<(Member, f32)> {
    if !is_transparent(world, &member.vertex) {
        return Some((member, 1.0));
    }
    let mut touching = None;
    for other in cluster {
        if !is_transparent(world, &other.vertex) {
            // The choice by which the surface itself decides.
            if world.is_open(&other.vertex, -ray.direction, true, || opacity_choice(path)) {
                continue;
            }
            return Some((grown(other, &member), 1.0));
        }
        if other.is_entered(ray) != member.is_entered(ray) {
            touching = touching.or(Some(other));
        }
    }
    let Some(other) = touching else { return Some((member, 1.0)) };
    let (entered, left) = if member.is_entered(ray) { (member, other) } else { (other, member) };
    let [inside, outside] = [&entered, &left].map(|member| ior(world, &member.vertex));
    (inside != outside).then(|| (grown(entered, &left), outside))
}

/// Numbers in [0, 1) that select among mixed materials and decide whether opacity lets a ray pass.
pub(super) fn opacity_choice(path: &PathState) -> Vec2 {
    path.sampler.skipped(0).next_2d()
}

/// Whether the ray may be refracted into the solid behind the surface.
fn is_transparent(world: &World, vertex: &Vertex) -> bool {
    world.interior(vertex).is_some() || world.phong(vertex).is_some_and(|phong| !phong.transparency.is_black())
}

/// Index of refraction of the solid behind the surface.
fn ior(world: &World, vertex: &Vertex) -> f32 {
    let interior = || world.interior(vertex).and_then(|id| world.interior_at(id)).map_or(1.0, |interior| interior.ior);
    world.phong(vertex).map_or_else(interior, |phong| phong.ior)
}

/// The surface with an error that reaches beyond another one at its place.
fn grown(member: Member, other: &Member) -> Member {
    let mut grown = member;
    grown.vertex.surface.grow_error(&member.vertex.surface, &other.vertex.surface);
    grown
}
