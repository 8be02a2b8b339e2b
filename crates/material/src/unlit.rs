//! Surface that shows a color without lighting: labels, backdrops, and colors that are baked.
//!
//! ```json
//! {"unlit": {"color": "poster"}}
//! ```

use super::input::{check_color, check_number, emitted_color};
use super::mask::CompiledMask;
use super::{CompiledMaterial, Material, MaterialError, MaterialId, MaterialResolver, MaterialTable, ShadingView};
use juggler_math::{MAX_LIGHT, Rgb};
use juggler_texture::{Input, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Color without lighting, as `KHR_materials_unlit`: camera rays see it, directly, in mirrors and
/// through glass. For all other rays the surface is absent: it casts no shadow, and its color does
/// not light other surfaces. Use it for labels and backdrops; use `emissive` for area lights.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Unlit {
    /// Radiance of the surface, the same in all directions and on both sides, 0 to 1e30 per channel.
    #[schemars(extend("x-unit" = "W/(scene unit² sr)"))]
    pub color: Input<Rgb>,
    /// Opacity, 0 (absent) to 1 (present).
    pub opacity: Input<f32>,
}

impl Unlit {
    /// Creates an opaque material that shows a color and neither reflects nor casts light.
    pub fn new(color: impl Into<Input<Rgb>>) -> Self {
        Self { color: color.into(), ..Self::default() }
    }
}

impl Default for Unlit {
    fn default() -> Self {
        Self { color: Rgb::WHITE.into(), opacity: 1.0.into() }
    }
}

/// An [`Unlit`] with its names resolved, without opacity.
#[derive(Clone, Debug)]
pub struct CompiledUnlit {
    color: Slot<Rgb>,
}

impl Material for Unlit {
    fn compile(&self, resolver: &mut dyn MaterialResolver) -> Result<CompiledMaterial, MaterialError> {
        check_color("color", &self.color, MAX_LIGHT)?;
        check_number("opacity", &self.opacity, 0.0, 1.0)?;
        let color = resolver.textures().resolve("color", &self.color)?;
        let opacity = resolver.textures().resolve("opacity", &self.opacity)?;
        let compiled = CompiledMaterial::Unlit(CompiledUnlit { color });
        if self.opacity == Input::Value(1.0) {
            return Ok(compiled);
        }
        let inner = resolver.add_nested(compiled);
        Ok(CompiledMaterial::Mask(CompiledMask::new(opacity, None, inner)))
    }
}

impl CompiledUnlit {
    /// Radiance that the surface shows.
    pub fn color(&self, textures: &TextureTable, view: &ShadingView) -> Rgb {
        match &self.color {
            Slot::Value(color) => *color,
            slot => emitted_color(textures, slot, &view.lookup()),
        }
    }

    /// Whether the color varies over the surface.
    pub fn is_textured(&self) -> bool {
        self.color.is_texture()
    }
}

impl MaterialTable {
    /// Whether material `id`, or one inside it, shows its color without light.
    pub fn shows_unlit(&self, id: MaterialId) -> bool {
        let Some(compiled) = self.compiled(id) else { return false };
        // The recursion ends, since nested materials have smaller ids.
        matches!(compiled, CompiledMaterial::Unlit(_))
            || compiled.nested_materials().into_iter().any(|inner| self.shows_unlit(inner))
    }
}

#[cfg(any(test, feature = "testing"))]
impl Unlit {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let poster = Self { color: Input::Texture("tiles".into()), opacity: 0.4.into() };
        vec![Self::default(), poster]
    }
}
