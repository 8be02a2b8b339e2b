//! Camera rays that pass straight through surfaces, for AOVs and for integrators that show one
//! surface property.

use super::{PathHistory, PathState, VertexOutput, path};
use juggler_math::Ray;
use juggler_world::{Cluster, Member, Vertex, World};

impl PathState {
    /// Whether the path is still a camera ray: it has passed straight through all surfaces so far.
    #[inline]
    pub(crate) fn is_camera_ray(&self) -> bool {
        let PathHistory { events, pass_throughs, .. } = &self.history;
        // The classic integrator counts these surfaces in the depth, and no events.
        self.depth == 0 || (events.is_none() && self.depth == u32::from(*pass_throughs))
    }
}

impl VertexOutput<'_> {
    /// Skips surfaces of opacity 0. Of the other surfaces at the place of `vertex`, returns the one
    /// that a path meets first: a surface that bounds no solid before a face of a solid, and a face
    /// that the ray enters before a face that it leaves. Without such a surface, the camera ray
    /// continues behind the place.
    pub(crate) fn skip_cut_outs(&mut self, world: &World, ray: &Ray, vertex: &Vertex) -> Option<Member> {
        let first = Member { vertex: *vertex, t: ray.t_max };
        let is_cut_out = |path: &PathState, vertex: &Vertex| {
            world.is_cut_out(vertex, -ray.direction, || path.sampler.skipped(0).next_1d())
        };
        if world.interior(vertex).is_none() && !is_cut_out(self.path, vertex) {
            return Some(first);
        }
        let mut cluster = Cluster::new(world, ray, vertex);
        let (mut path, mut member, mut face) = (*self.path, first, None::<Member>);
        loop {
            if !is_cut_out(&path, &member.vertex) {
                if world.interior(&member.vertex).is_none() {
                    return Some(member);
                }
                if face.is_none_or(|face| member.is_entered(ray) && !face.is_entered(ray)) {
                    face = Some(member);
                }
            }
            let Some(behind) = path::passed(world, ray, &path, &member.vertex, None) else { return face };
            path = behind;
            match cluster.next() {
                Some(next) => member = next,
                None if face.is_some() => return face,
                None => {
                    self.continue_straight(cluster.ray_behind(), &path);
                    return None;
                }
            }
        }
    }
}
