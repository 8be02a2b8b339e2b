//! The diffuse colour of what is seen, unlit.
//!
//! ```json
//! {"albedo": {}}
//! ```

use super::{Emit, Integrator, Path};
use crate::world::{Vertex, World};
use juggler_math::Ray;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The diffuse colour of what is seen, unlit; black where nothing is.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Albedo {}

impl Integrator for Albedo {
    fn vertex(&self, world: &World, _ray: &Ray, _path: &Path, vertex: &Vertex, emit: &mut Emit) {
        emit.add(world.phong(vertex).diffuse);
    }
}

#[cfg(test)]
impl Albedo {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self {}]
    }
}
