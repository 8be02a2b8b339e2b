//! Constant color: a name for a color that several textures and materials share.
//!
//! ```json
//! {"constant": {"color": "#c0a060"}}
//! ```

use super::CompiledTexture;
use super::{
    Input, InvalidTexture, SharedTexture, Slot, Texture, TextureError, TextureLookup, TextureResolver, TextureTable,
    check,
};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Constant color, which several textures and materials can share by name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Constant {
    /// The color.
    pub color: Input<Rgb>,
}

impl Constant {
    /// Creates a texture of one color.
    pub fn new(color: impl Into<Input<Rgb>>) -> Self {
        Self { color: color.into() }
    }
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

    fn compile(&self, resolver: &mut TextureResolver<'_>) -> Result<SharedTexture, TextureError> {
        Ok(Arc::new(CompiledConstant(resolver.color("color", &self.color)?)))
    }
}

/// A [`Constant`] with its name resolved.
#[derive(Clone, Debug)]
pub struct CompiledConstant(pub Slot<Rgb>);

impl CompiledTexture for CompiledConstant {
    fn eval(&self, textures: &TextureTable, at: &TextureLookup) -> Rgb {
        textures.color(&self.0, at)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Constant {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default()]
    }
}
