//! Mixture of two materials.
//!
//! ```json
//! {"mix": {"amount": "rust map", "a": "steel", "b": "rust"}}
//! ```

use super::input::{check_number, unit_number};
use super::{CompiledMaterial, Material, MaterialError, MaterialId, MaterialRef, MaterialResolver, ShadingView};
use juggler_texture::{Input, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Mixture of two materials: each sample chooses one of them at random.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
#[schemars(rename = "MixMaterial")]
pub struct Mix {
    /// Weight of `b`, 0 to 1; the weight of `a` is 1 - `amount`.
    pub amount: Input<f32>,
    /// Material that an `amount` of 0 shows alone.
    pub a: MaterialRef,
    /// Material that an `amount` of 1 shows alone.
    pub b: MaterialRef,
}

impl Mix {
    /// Creates a blend of two materials; 0 for `amount` shows `a`, 1 shows `b`.
    pub fn new(a: impl Into<MaterialRef>, b: impl Into<MaterialRef>, amount: impl Into<Input<f32>>) -> Self {
        Self { amount: amount.into(), a: a.into(), b: b.into() }
    }
}

impl Default for Mix {
    fn default() -> Self {
        Self { amount: 0.5.into(), a: MaterialRef::default(), b: MaterialRef::default() }
    }
}

/// A [`Mix`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledMix {
    amount: Slot<f32>,
    a: MaterialId,
    b: MaterialId,
}

impl Material for Mix {
    fn compile(&self, resolver: &mut dyn MaterialResolver) -> Result<CompiledMaterial, MaterialError> {
        check_number("amount", &self.amount, 0.0, 1.0)?;
        let amount = resolver.textures().resolve("amount", &self.amount)?;
        let (a, b) = (resolver.material("a", &self.a)?, resolver.material("b", &self.b)?);
        Ok(CompiledMaterial::Mix(CompiledMix { amount, a, b }))
    }

    fn nested_materials(&self) -> Vec<(&'static str, &MaterialRef)> {
        vec![("a", &self.a), ("b", &self.b)]
    }

    fn scale_distances(&mut self, factor: f32) {
        self.a.scale_distances(factor);
        self.b.scale_distances(factor);
    }
}

impl CompiledMix {
    /// Material that `view.u_choice` chooses, and that number rescaled to [0, 1) for further
    /// choices.
    pub fn pick(&self, textures: &TextureTable, view: &ShadingView) -> (MaterialId, f32) {
        let amount = self.amount(textures, view);
        let below_one = |u: f32| u.min(1f32.next_down());
        if view.u_choice < amount {
            (self.b, below_one(view.u_choice / amount))
        } else {
            (self.a, below_one((view.u_choice - amount) / (1.0 - amount)))
        }
    }

    /// Weight of `b` at a point.
    pub fn amount(&self, textures: &TextureTable, view: &ShadingView) -> f32 {
        match &self.amount {
            Slot::Value(amount) => *amount,
            slot => unit_number(textures, slot, &view.lookup()),
        }
    }

    /// Both materials.
    pub fn choices(&self) -> [MaterialId; 2] {
        [self.a, self.b]
    }
}

#[cfg(any(test, feature = "testing"))]
impl Mix {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default(), Self { amount: Input::Texture("tiles".into()), ..Self::default() }]
    }
}
