//! Direct lighting only: path tracing limited to two segments.
//!
//! ```json
//! {"direct": {}}
//! ```

use super::{Integrator, Path, PathState, VertexOutput};
use juggler_math::Ray;
use juggler_world::{ShadowMode, Vertex, World};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Direct lighting only: emission and one bounce from lights, with soft shadows. Faster than
/// `path`, for previews of lighting.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Direct {}

impl Integrator for Direct {
    fn vertex(&self, world: &World, ray: &Ray, path: &PathState, vertex: &Vertex, output: &mut VertexOutput) {
        Path::DIRECT.vertex(world, ray, path, vertex, output);
    }

    fn escape(&self, world: &World, ray: &Ray, path: &PathState, output: &mut VertexOutput) {
        Path::DIRECT.escape(world, ray, path, output);
    }

    fn filters_textures(&self) -> bool {
        true
    }

    fn shadows(&self) -> ShadowMode {
        ShadowMode::Physical
    }
}

#[cfg(any(test, feature = "testing"))]
impl Direct {
    /// Example values for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self {}]
    }
}
