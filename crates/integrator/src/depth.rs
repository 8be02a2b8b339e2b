//! Distance from the camera to the first surface along the ray. Cut-out surfaces do not count.
//!
//! ```json
//! {"depth": {"far": 10}}
//! ```

use super::{Integrator, PathState, VertexOutput};
use juggler_camera::aov::LightGroup;
use juggler_math::{Ray, Rgb};
use juggler_world::{Member, Vertex, World};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Distance from the camera to the first surface, along the ray, as a gray value; 0 where rays hit no
/// surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Depth {
    /// Distance that is shown as 1 (white), in scene units, above 0. Without it the value is the
    /// distance itself, for EXR and PFM files.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
    pub far: Option<f32>,
}

impl Integrator for Depth {
    fn vertex(&self, world: &World, ray: &Ray, _path: &PathState, vertex: &Vertex, output: &mut VertexOutput) {
        let Some(Member { vertex, t }) = output.skip_cut_outs(world, ray, vertex) else { return };
        let (ray, vertex) = (&ray.with_t_max(t), &vertex);
        output.record_surface(world, ray, vertex);
        output.add(Rgb::splat(ray.t_max / self.far.unwrap_or(1.0)), LightGroup::REST);
    }

    fn escape(&self, _world: &World, ray: &Ray, _path: &PathState, output: &mut VertexOutput) {
        output.record_miss(ray);
    }
}

#[cfg(any(test, feature = "testing"))]
impl Depth {
    /// Example values for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default(), Self { far: Some(10.0) }]
    }
}
