//! The diffuse colour of what is seen, unlit.
//!
//! ```json
//! {"albedo": {}}
//! ```

use super::{Emit, Integrator, PathState};
use juggler_camera::layer::LightGroup;
use juggler_math::Ray;
use juggler_world::{Vertex, World};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The diffuse colour of what is seen, unlit; black where nothing is.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Albedo {}

impl Integrator for Albedo {
    fn vertex(&self, world: &World, ray: &Ray, path: &PathState, vertex: &Vertex, emit: &mut Emit) {
        emit.see_unlit(world, ray, vertex);
        let diffuse = world.phong(vertex).map(|phong| phong.diffuse);
        let albedo = diffuse.unwrap_or_else(|| {
            let shade = world.shade(vertex, -ray.direction, 1.0, path.sampler.at(0).next_1d());
            shade.albedo(-ray.direction)
        });
        emit.add(albedo, LightGroup::REST);
    }

    fn escape(&self, _world: &World, ray: &Ray, _path: &PathState, emit: &mut Emit) {
        emit.miss(ray);
    }
}

#[cfg(any(test, feature = "testing"))]
impl Albedo {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self {}]
    }
}
