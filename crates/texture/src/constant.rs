//! The same colour everywhere: a name for a colour that several textures and materials share.
//!
//! ```json
//! {"constant": {"color": "#c0a060"}}
//! ```

use super::CompiledTexture;
use super::{Compiled, Input, InvalidTexture, Lookup, Resolver, Slot, Texture, TextureError, TextureTable, check};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The same colour everywhere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Constant {
    /// The colour.
    pub color: Input<Rgb>,
}

impl Default for Constant {
    fn default() -> Self {
        Self { color: Rgb::splat(0.5).into() }
    }
}

impl Texture for Constant {
    fn check(&self) -> Result<(), InvalidTexture> {
        check::color("color", &self.color)
    }

    fn compile(&self, resolver: &mut Resolver<'_>) -> Result<Compiled, TextureError> {
        Ok(Arc::new(CompiledConstant(resolver.color("color", &self.color)?)))
    }
}

/// A [`Constant`] with its name looked up.
#[derive(Clone, Debug)]
pub struct CompiledConstant(pub Slot<Rgb>);

impl CompiledTexture for CompiledConstant {
    fn eval(&self, textures: &TextureTable, at: &Lookup) -> Rgb {
        textures.color(&self.0, at)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Constant {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default()]
    }
}
