//! Shading normals as colors, (n + 1) / 2, in world space: those of the AOV `normal`.
//!
//! ```json
//! {"normals": {}}
//! ```

use super::{Integrator, PathState, VertexOutput};
use juggler_camera::aov::LightGroup;
use juggler_math::{Ray, Rgb};
use juggler_world::{Member, Vertex, World};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Shading normals in world space, after normal and bump mapping, as colors, (n + 1) / 2; black
/// where rays hit no surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Normals {}

impl Integrator for Normals {
    fn vertex(&self, world: &World, ray: &Ray, _path: &PathState, vertex: &Vertex, output: &mut VertexOutput) {
        let Some(Member { vertex, t }) = output.skip_cut_outs(world, ray, vertex) else { return };
        let (ray, vertex) = (&ray.with_t_max(t), &vertex);
        let shading = output.shade_surface(world, ray, vertex);
        output.record_shading(world, ray, vertex, &shading);
        let n = shading.frame.normal * 0.5 + 0.5;
        output.add(Rgb::new(n.x, n.y, n.z), LightGroup::REST);
    }

    fn escape(&self, _world: &World, ray: &Ray, _path: &PathState, output: &mut VertexOutput) {
        output.record_miss(ray);
    }
}

#[cfg(any(test, feature = "testing"))]
impl Normals {
    /// Example values for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self {}]
    }
}
