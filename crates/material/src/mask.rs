//! Opacity of another material, from a texture: leaves, fences, lace.
//!
//! ```json
//! {"mask": {"opacity": "leaf outline", "material": "leaf"}}
//! ```

use super::error::in_range;
use super::input::{check_number, unit_number};
use super::{CompiledMaterial, Material, MaterialError, MaterialId, MaterialRef, MaterialResolver, ShadingView};
use juggler_texture::{Input, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Opacity of another material: light passes straight through where the opacity is 0, and with
/// probability 1 - opacity elsewhere. Use it to cut leaves out of a rectangle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Mask {
    /// Opacity, 0 (absent) to 1 (present).
    pub opacity: Input<f32>,
    /// Threshold that makes opacity binary: smaller opacities count as 0, all others as 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1))]
    pub cutoff: Option<f32>,
    /// Material that has this opacity.
    pub material: MaterialRef,
}

impl Default for Mask {
    fn default() -> Self {
        Self { opacity: 1.0.into(), cutoff: None, material: MaterialRef::default() }
    }
}

/// A [`Mask`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledMask {
    opacity: Slot<f32>,
    cutoff: Option<f32>,
    /// Material that has this opacity.
    pub material: MaterialId,
}

impl Material for Mask {
    fn compile(&self, resolver: &mut dyn MaterialResolver) -> Result<CompiledMaterial, MaterialError> {
        check_number("opacity", &self.opacity, 0.0, 1.0)?;
        in_range("cutoff", self.cutoff.unwrap_or_default(), 0.0, 1.0)?;
        let opacity = resolver.textures().resolve("opacity", &self.opacity)?;
        let material = resolver.material("material", &self.material)?;
        Ok(CompiledMaterial::Mask(CompiledMask::new(opacity, self.cutoff, material)))
    }

    fn nested_materials(&self) -> Vec<(&'static str, &MaterialRef)> {
        vec![("material", &self.material)]
    }
}

impl CompiledMask {
    /// Opacity of a material, from checked values.
    pub fn new(opacity: Slot<f32>, cutoff: Option<f32>, material: MaterialId) -> Self {
        let cut_off = |opacity: f32| cutoff.map_or(opacity, |cutoff| f32::from(opacity >= cutoff));
        let opacity = match opacity {
            Slot::Value(opacity) => Slot::Value(cut_off(opacity)),
            texture => texture,
        };
        Self { opacity, cutoff, material }
    }

    /// Opacity at a point, 0 to 1.
    pub fn opacity(&self, textures: &TextureTable, view: &ShadingView) -> f32 {
        match &self.opacity {
            Slot::Value(opacity) => *opacity,
            slot => {
                let opacity = unit_number(textures, slot, &view.lookup());
                self.cutoff.map_or(opacity, |cutoff| f32::from(opacity >= cutoff))
            }
        }
    }

    /// Whether the material is fully opaque everywhere.
    pub fn is_opaque(&self) -> bool {
        matches!(self.opacity, Slot::Value(1.0))
    }

    /// Whether opacity varies over the surface.
    pub fn is_textured(&self) -> bool {
        self.opacity.is_texture()
    }
}

#[cfg(any(test, feature = "testing"))]
impl Mask {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let leaf = Self { opacity: Input::Texture("tiles".into()), ..Self::default() };
        vec![Self::default(), Self { cutoff: Some(0.3), ..leaf.clone() }, leaf]
    }
}
