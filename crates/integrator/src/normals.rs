//! The direction in which what is seen faces: (n + 1) / 2 as a colour, world space.
//!
//! ```json
//! {"normals": {}}
//! ```

use super::{Emit, Integrator, PathState};
use juggler_camera::layer::LightGroup;
use juggler_math::{Ray, Rgb};
use juggler_world::{Vertex, World};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Shading normals as colours; black where nothing is.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Normals {}

impl Integrator for Normals {
    fn vertex(&self, world: &World, ray: &Ray, _path: &PathState, vertex: &Vertex, emit: &mut Emit) {
        emit.see_unlit(world, ray, vertex);
        let n = vertex.surface.shading_normal * 0.5 + 0.5;
        emit.add(Rgb::new(n.x, n.y, n.z), LightGroup::REST);
    }

    fn escape(&self, _world: &World, ray: &Ray, _path: &PathState, emit: &mut Emit) {
        emit.miss(ray);
    }
}

#[cfg(any(test, feature = "testing"))]
impl Normals {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self {}]
    }
}
