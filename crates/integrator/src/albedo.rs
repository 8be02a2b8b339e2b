//! Albedo of the first surface, without lighting.
//!
//! ```json
//! {"albedo": {}}
//! ```

use super::{Integrator, PathState, VertexOutput};
use juggler_camera::aov::LightGroup;
use juggler_math::Ray;
use juggler_world::{Member, Vertex, World};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Albedo of the first surface, without lighting; black where rays hit no surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Albedo {}

impl Integrator for Albedo {
    fn vertex(&self, world: &World, ray: &Ray, path: &PathState, vertex: &Vertex, output: &mut VertexOutput) {
        let Some(Member { vertex, t }) = output.skip_cut_outs(world, ray, vertex) else { return };
        let (ray, vertex) = (&ray.with_t_max(t), &vertex);
        output.record_surface(world, ray, vertex);
        let diffuse = world.phong(vertex).map(|phong| phong.diffuse);
        let albedo = diffuse.unwrap_or_else(|| {
            let shading = world.shade(vertex, -ray.direction, 1.0, path.sampler.skipped(0).next_1d());
            shading.albedo(-ray.direction)
        });
        output.add(albedo, LightGroup::REST);
    }

    fn escape(&self, _world: &World, ray: &Ray, _path: &PathState, output: &mut VertexOutput) {
        output.record_miss(ray);
    }
}

#[cfg(any(test, feature = "testing"))]
impl Albedo {
    /// Example values for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self {}]
    }
}
