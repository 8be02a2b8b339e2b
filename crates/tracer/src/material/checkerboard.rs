//! Two whole materials in alternating cells of the object's xz plane.

use super::{Compiled, Material, MaterialError, MaterialId, MaterialRef, Resolver};
use crate::surface::Surface;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Two whole materials in alternating cells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Checkerboard {
    /// Edge of one cell.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub size: f32,
    /// Material of the cell at the origin.
    pub even: MaterialRef,
    /// Material of its neighbours.
    pub odd: MaterialRef,
}

/// A [`Checkerboard`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledCheckerboard {
    size: f32,
    even: MaterialId,
    odd: MaterialId,
}

impl Material for Checkerboard {
    fn compile(&self, resolver: &mut dyn Resolver) -> Result<Compiled, MaterialError> {
        let even = resolver.material("even", &self.even)?;
        let odd = resolver.material("odd", &self.odd)?;
        Ok(Compiled::Checkerboard(CompiledCheckerboard { size: self.size, even, odd }))
    }
}

impl CompiledCheckerboard {
    /// Which of the two stands at this point.
    pub fn pick(&self, surface: &Surface) -> MaterialId {
        let cell = |x: f32| (x / self.size).floor();
        let sum = cell(surface.local.x) + cell(surface.local.z);
        if sum.rem_euclid(2.0) < 1.0 { self.even } else { self.odd }
    }
}

#[cfg(test)]
impl Checkerboard {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self { size: 1.0, even: MaterialRef::default(), odd: MaterialRef::default() }]
    }
}
