//! Coordinates as colours, to see how they run: the fractions of x, y and z as red, green and blue.
//!
//! ```json
//! {"uv": {"scale": 10}}
//! ```

use super::CompiledTexture;
use super::mapping::Map;
use super::{Compiled, InvalidTexture, Lookup, Mapping, Resolver, Space, Texture, TextureError, TextureTable};
use juggler_math::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Coordinates as colours, to see how they run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Uv {
    #[serde(flatten)]
    /// Where the pattern lies.
    pub mapping: Mapping,
}

impl Texture for Uv {
    fn check(&self) -> Result<(), InvalidTexture> {
        self.mapping.check()
    }

    fn compile(&self, _: &mut Resolver<'_>) -> Result<Compiled, TextureError> {
        Ok(Arc::new(CompiledUv { map: self.mapping.compile(Space::Uv) }))
    }
}

/// A [`Uv`] ready to be asked.
#[derive(Clone, Debug)]
pub struct CompiledUv {
    map: Map,
}

impl CompiledTexture for CompiledUv {
    fn eval(&self, _textures: &TextureTable, at: &Lookup) -> Rgb {
        let p = self.map.place(at).point;
        (p - p.floor()).to_array().into()
    }
}

#[cfg(any(test, feature = "testing"))]
impl Uv {
    /// For the contract tests.
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
    fn fractions_are_colours() {
        let at = Lookup { uv: Vec2::new(0.25, -0.25), ..Lookup::default() };
        assert_eq!(reader(r#"{"uv": {}}"#)(&at), Rgb::new(0.25, 0.75, 0.0));
        assert_eq!(reader(r#"{"uv": {"scale": 6}}"#)(&at), Rgb::new(0.5, 0.5, 0.0));
    }
}
