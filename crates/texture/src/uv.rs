//! Coordinates as colors, to check mappings: the fractional parts of x, y and z are red, green and
//! blue.
//!
//! ```json
//! {"uv": {"scale": 10}}
//! ```

use super::CompiledTexture;
use super::mapping::CompiledMapping;
use super::{
    InvalidTexture, Mapping, SharedTexture, Space, Texture, TextureError, TextureLookup, TextureResolver, TextureTable,
};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Coordinates as colors, to check mappings: the fractional parts of x, y and z are red, green and
/// blue.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Uv {
    #[serde(flatten)]
    /// Placement of the pattern: coordinate space, scale, rotation and offset.
    pub mapping: Mapping,
}

impl Texture for Uv {
    fn check(&self) -> Result<(), InvalidTexture> {
        self.mapping.check()
    }

    fn compile(&self, _: &mut TextureResolver<'_>) -> Result<SharedTexture, TextureError> {
        Ok(Arc::new(CompiledUv { map: self.mapping.compile(Space::Uv) }))
    }

    fn space(&self) -> Option<Space> {
        Some(self.mapping.space_or(Space::Uv))
    }
}

/// A compiled [`Uv`].
#[derive(Clone, Debug)]
pub struct CompiledUv {
    map: CompiledMapping,
}

impl CompiledTexture for CompiledUv {
    fn eval(&self, _textures: &TextureTable, at: &TextureLookup) -> Rgb {
        let p = self.map.pattern_point(at).point;
        (p - p.floor()).to_array().into()
    }
}

#[cfg(any(test, feature = "testing"))]
impl Uv {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::reader;
    use juggler_math::Vec2;

    #[test]
    fn fractional_uvs_are_colors() {
        let at = TextureLookup { uv: Vec2::new(0.25, -0.25), ..TextureLookup::default() };
        assert_eq!(reader(r#"{"uv": {}}"#)(&at), Rgb::new(0.25, 0.75, 0.0));
        assert_eq!(reader(r#"{"uv": {"scale": 6}}"#)(&at), Rgb::new(0.5, 0.5, 0.0));
    }
}
