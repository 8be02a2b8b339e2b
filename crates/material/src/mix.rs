//! Two materials in one place, each for its share of the light.
//!
//! ```json
//! {"mix": {"amount": "rust map", "a": "steel", "b": "rust"}}
//! ```

use super::input::{check_number, fraction};
use super::{Compiled, Material, MaterialError, MaterialId, MaterialRef, Resolver, View};
use juggler_texture::{Input, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Two materials in one place: a sample meets one of them by chance, so that their light is mixed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Mix {
    /// Share of `b`, 0 to 1; the rest is `a`.
    pub amount: Input<f32>,
    /// One material.
    pub a: MaterialRef,
    /// The other.
    pub b: MaterialRef,
}

impl Default for Mix {
    fn default() -> Self {
        Self { amount: 0.5.into(), a: MaterialRef::default(), b: MaterialRef::default() }
    }
}

/// A [`Mix`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledMix {
    amount: Slot<f32>,
    a: MaterialId,
    b: MaterialId,
}

impl Material for Mix {
    fn compile(&self, resolver: &mut dyn Resolver) -> Result<Compiled, MaterialError> {
        check_number("amount", &self.amount, 0.0, 1.0)?;
        let amount = resolver.textures().resolve("amount", &self.amount)?;
        let (a, b) = (resolver.material("a", &self.a)?, resolver.material("b", &self.b)?);
        Ok(Compiled::Mix(CompiledMix { amount, a, b }))
    }

    fn parts(&self) -> Vec<&MaterialRef> {
        vec![&self.a, &self.b]
    }
}

impl CompiledMix {
    /// The material that `view.pick` meets, and that number stretched to the unit interval again.
    pub fn pick(&self, textures: &TextureTable, view: &View) -> (MaterialId, f32) {
        let amount = self.amount(textures, view);
        let below_one = |u: f32| u.min(1f32.next_down());
        if view.pick < amount {
            (self.b, below_one(view.pick / amount))
        } else {
            (self.a, below_one((view.pick - amount) / (1.0 - amount)))
        }
    }

    /// Share of the second.
    pub fn amount(&self, textures: &TextureTable, view: &View) -> f32 {
        match &self.amount {
            Slot::Value(amount) => *amount,
            slot => fraction(textures, slot, &view.lookup()),
        }
    }

    /// Both materials.
    pub fn choices(&self) -> [MaterialId; 2] {
        [self.a, self.b]
    }
}

#[cfg(any(test, feature = "testing"))]
impl Mix {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default(), Self { amount: Input::Texture("tiles".into()), ..Self::default() }]
    }
}
