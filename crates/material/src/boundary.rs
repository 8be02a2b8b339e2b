//! Interface without a BSDF, around a participating medium: fog, smoke or a cloud in the shape of
//! any solid.
//!
//! ```json
//! {"boundary": {"medium": {"scattering": 0.3, "anisotropy": 0.5}}}
//! ```

use super::{CompiledMaterial, Material, MaterialError, MaterialResolver};
use crate::medium::{Interior, Medium};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Interface without a BSDF: light enters the medium inside the solid without reflection or
/// refraction. Use it for fog, smoke and clouds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Boundary {
    /// Medium inside the solid.
    pub medium: Medium,
    /// Priority where solids overlap: the solid of the highest priority fills the overlap (Schmidt
    /// and Budge 2002), among equals the one whose material comes first.
    pub priority: i32,
}

impl Boundary {
    /// Creates the invisible boundary of a medium.
    pub fn new(medium: Medium) -> Self {
        Self { medium, ..Self::default() }
    }
}

impl Material for Boundary {
    fn compile(&self, _resolver: &mut dyn MaterialResolver) -> Result<CompiledMaterial, MaterialError> {
        let medium = compile_medium(&self.medium)?;
        Ok(CompiledMaterial::Boundary(Interior { ior: 1.0, dispersion: 0.0, priority: self.priority, medium }))
    }

    fn scale_distances(&mut self, factor: f32) {
        self.medium.scale_distances(factor);
    }
}

/// Checks a medium and converts its `color` to absorption.
pub(super) fn compile_medium(medium: &Medium) -> Result<Medium, MaterialError> {
    match medium.check() {
        Ok(()) => Ok(medium.resolved()),
        Err((field, message)) => Err(MaterialError::Invalid { field, message }.within("medium")),
    }
}

#[cfg(any(test, feature = "testing"))]
impl Boundary {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let fog = Medium { scattering: juggler_math::Rgb::splat(0.3), anisotropy: 0.6, ..Medium::default() };
        vec![Self::default(), Self { medium: fog, priority: 1 }]
    }
}
