//! Holes: where a texture says so, a material is not there.
//!
//! ```json
//! {"mask": {"opacity": "leaf outline", "material": "leaf"}}
//! ```

use super::error::in_range;
use super::input::{check_number, fraction};
use super::{Compiled, Material, MaterialError, MaterialId, MaterialRef, Resolver, View};
use juggler_texture::{Input, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A material with holes: light passes where the opacity is 0, and passes by chance where it is between 0 and 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Mask {
    /// 1 where the material is, 0 where it is not.
    pub opacity: Input<f32>,
    /// Makes edges sharp: what is less opaque is not there at all, and what is as opaque or more is there wholly.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1))]
    pub cutoff: Option<f32>,
    /// The material.
    pub material: MaterialRef,
}

impl Default for Mask {
    fn default() -> Self {
        Self { opacity: 1.0.into(), cutoff: None, material: MaterialRef::default() }
    }
}

/// A [`Mask`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledMask {
    opacity: Slot<f32>,
    cutoff: Option<f32>,
    /// The material.
    pub material: MaterialId,
}

impl Material for Mask {
    fn compile(&self, resolver: &mut dyn Resolver) -> Result<Compiled, MaterialError> {
        check_number("opacity", &self.opacity, 0.0, 1.0)?;
        in_range("cutoff", self.cutoff.unwrap_or_default(), 0.0, 1.0)?;
        let opacity = resolver.textures().resolve("opacity", &self.opacity)?;
        let material = resolver.material("material", &self.material)?;
        Ok(Compiled::Mask(CompiledMask::new(opacity, self.cutoff, material)))
    }

    fn parts(&self) -> Vec<&MaterialRef> {
        vec![&self.material]
    }
}

impl CompiledMask {
    /// Of numbers that have been checked.
    pub fn new(opacity: Slot<f32>, cutoff: Option<f32>, material: MaterialId) -> Self {
        let sharp = |opacity: f32| cutoff.map_or(opacity, |cutoff| f32::from(opacity >= cutoff));
        let opacity = match opacity {
            Slot::Value(opacity) => Slot::Value(sharp(opacity)),
            texture => texture,
        };
        Self { opacity, cutoff, material }
    }

    /// Share of light that meets the material.
    pub fn opacity(&self, textures: &TextureTable, view: &View) -> f32 {
        match &self.opacity {
            Slot::Value(opacity) => *opacity,
            slot => {
                let opacity = fraction(textures, slot, &view.lookup());
                self.cutoff.map_or(opacity, |cutoff| f32::from(opacity >= cutoff))
            }
        }
    }

    /// Whether it lets nothing by anywhere.
    pub fn is_solid(&self) -> bool {
        matches!(self.opacity, Slot::Value(1.0))
    }

    /// Whether it differs from place to place.
    pub fn is_textured(&self) -> bool {
        self.opacity.is_texture()
    }
}

#[cfg(any(test, feature = "testing"))]
impl Mask {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        let leaf = Self { opacity: Input::Texture("tiles".into()), ..Self::default() };
        vec![Self::default(), Self { cutoff: Some(0.3), ..leaf.clone() }, leaf]
    }
}
