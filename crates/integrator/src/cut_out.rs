//! Camera rays that pass straight through surfaces, for AOVs and for integrators that show one
//! surface property.

use super::{PathHistory, PathState, VertexOutput, path};
use juggler_math::Ray;
use juggler_world::{Vertex, World};

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
    /// Continues the camera ray behind a surface of opacity 0. Returns `false` at any other surface.
    pub(crate) fn pass_cut_out(&mut self, world: &World, ray: &Ray, vertex: &Vertex) -> bool {
        let is_cut_out = world.is_cut_out(vertex, -ray.direction, || self.path.sampler.skipped(0).next_1d());
        if is_cut_out {
            // Keep the origin of the first ray, from which depth is measured.
            let history = self.path.history;
            let from = if history.pass_throughs == 0 { ray.origin } else { history.from };
            let path = PathState { history: PathHistory { from, ..history }, ..*self.path };
            path::pass_through(world, ray, &path, vertex, self);
        }
        is_cut_out
    }
}
