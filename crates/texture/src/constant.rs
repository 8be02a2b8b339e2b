//! The same colour everywhere: a name for a colour that several textures and materials share.
//!
//! ```json
//! {"constant": {"color": "#c0a060"}}
//! ```

use super::{Compiled, Input, InvalidTexture, Resolver, Texture, TextureError, check};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
        Ok(Compiled::Constant(resolver.color("color", &self.color)?))
    }
}

#[cfg(any(test, feature = "testing"))]
impl Constant {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default()]
    }
}
