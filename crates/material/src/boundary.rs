//! No surface at all, only what is behind it: fog, smoke, a cloud in the form of any solid.
//!
//! ```json
//! {"boundary": {"medium": {"scattering": 0.3, "anisotropy": 0.5}}}
//! ```

use super::{Compiled, Material, MaterialError, Resolver};
use crate::medium::{Interior, Medium};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// No surface, only what is behind it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Boundary {
    /// What fills the solid.
    pub medium: Medium,
    /// Where solids overlap, the one with the highest priority is there.
    pub priority: i32,
}

impl Material for Boundary {
    fn compile(&self, _resolver: &mut dyn Resolver) -> Result<Compiled, MaterialError> {
        let medium = checked(&self.medium)?;
        Ok(Compiled::Boundary(Interior { ior: 1.0, priority: self.priority, medium }))
    }
}

/// A medium ready to be asked.
pub(super) fn checked(medium: &Medium) -> Result<Medium, MaterialError> {
    match medium.check() {
        Ok(()) => Ok(medium.resolved()),
        Err((field, message)) => Err(MaterialError::Invalid { field, message }.within("medium")),
    }
}

#[cfg(any(test, feature = "testing"))]
impl Boundary {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        let fog = Medium { scattering: juggler_math::Rgb::splat(0.3), anisotropy: 0.6, ..Medium::default() };
        vec![Self::default(), Self { medium: fog, priority: 1 }]
    }
}
