//! Light that comes straight from lights, and no other: what a path tracer sees in two stretches.
//!
//! ```json
//! {"direct": {}}
//! ```

use super::{Emit, Integrator, Path, PathState};
use juggler_math::Ray;
use juggler_world::{Shadows, Vertex, World};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What lights light, with soft shadows, and nothing that other things reflect.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Direct {}

impl Integrator for Direct {
    fn vertex(&self, world: &World, ray: &Ray, path: &PathState, vertex: &Vertex, emit: &mut Emit) {
        Path::DIRECT.vertex(world, ray, path, vertex, emit);
    }

    fn escape(&self, world: &World, ray: &Ray, path: &PathState, emit: &mut Emit) {
        Path::DIRECT.escape(world, ray, path, emit);
    }

    fn fades_patterns(&self) -> bool {
        true
    }

    fn shadows(&self) -> Shadows {
        Shadows::Physical
    }
}

#[cfg(any(test, feature = "testing"))]
impl Direct {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self {}]
    }
}
