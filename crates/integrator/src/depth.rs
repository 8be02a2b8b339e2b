//! How far away what is seen is, in scene units along the ray.
//!
//! ```json
//! {"depth": {"far": 10}}
//! ```

use super::{Emit, Integrator, PathState};
use juggler_camera::layer::LightGroup;
use juggler_math::{Ray, Rgb};
use juggler_world::{Vertex, World};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Distance as a grey; 0 where nothing is.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Depth {
    /// The distance that is shown as 1. Without it the value is the distance itself, for EXR and PFM.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub far: Option<f32>,
}

impl Integrator for Depth {
    fn vertex(&self, world: &World, ray: &Ray, _path: &PathState, vertex: &Vertex, emit: &mut Emit) {
        emit.see_unlit(world, ray, vertex);
        emit.add(Rgb::splat(ray.t_max / self.far.unwrap_or(1.0)), LightGroup::REST);
    }

    fn escape(&self, _world: &World, ray: &Ray, _path: &PathState, emit: &mut Emit) {
        emit.miss(ray);
    }
}

#[cfg(any(test, feature = "testing"))]
impl Depth {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default(), Self { far: Some(10.0) }]
    }
}
