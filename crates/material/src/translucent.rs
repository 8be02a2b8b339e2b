//! Thin sheets that transmit light diffusely: paper, leaves, lampshades.
//!
//! ```json
//! {"translucent": {"reflectance": [0.2, 0.5, 0.1], "transmittance": [0.2, 0.4, 0.05]}}
//! ```

use super::input::{check_unit_color, unit_color};
use super::{CompiledMaterial, Material, MaterialError, MaterialResolver, ScatteringMaterial, ShadingView};
use juggler_bsdf::{Bsdf, DiffuseTransmission};
use juggler_math::{Frame, Rgb};
use juggler_texture::{Input, Slot, TextureLookup, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Thin sheet that reflects and transmits light diffusely, the same from both sides. Use it for
/// paper, leaves and lampshades.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Translucent {
    /// Diffuse reflectance, 0 to 1 per channel.
    pub reflectance: Input<Rgb>,
    /// Diffuse transmittance, 0 to 1 per channel. The sum with `reflectance` is at most 1 per
    /// channel; larger sums of texture values are scaled to 1.
    pub transmittance: Input<Rgb>,
}

impl Translucent {
    /// Creates a thin material that reflects and transmits diffusely.
    pub fn new(reflectance: impl Into<Input<Rgb>>, transmittance: impl Into<Input<Rgb>>) -> Self {
        Self { reflectance: reflectance.into(), transmittance: transmittance.into() }
    }
}

impl Default for Translucent {
    fn default() -> Self {
        Self { reflectance: Rgb::splat(0.4).into(), transmittance: Rgb::splat(0.4).into() }
    }
}

/// A [`Translucent`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledTranslucent {
    reflectance: Slot<Rgb>,
    transmittance: Slot<Rgb>,
}

impl Material for Translucent {
    fn compile(&self, resolver: &mut dyn MaterialResolver) -> Result<CompiledMaterial, MaterialError> {
        check_unit_color("reflectance", &self.reflectance)?;
        check_unit_color("transmittance", &self.transmittance)?;
        if let (Some(back), Some(through)) = (self.reflectance.constant(), self.transmittance.constant()) {
            let most = (back + through).max_channel();
            // Rounding may lift the sum of numbers such as 0.7 and 0.3 slightly above 1.
            if most > 1.0 + 1e-6 {
                let message = format!("`reflectance` and `transmittance` together must be 1 or less, they are {most}");
                return Err(MaterialError::Invalid { field: "transmittance", message });
            }
        }
        let textures = resolver.textures();
        let reflectance = textures.resolve("reflectance", &self.reflectance)?;
        let transmittance = textures.resolve("transmittance", &self.transmittance)?;
        Ok(CompiledMaterial::scattering(CompiledTranslucent { reflectance, transmittance }))
    }
}

impl ScatteringMaterial for CompiledTranslucent {
    fn add_lobes(&self, textures: &TextureTable, view: &ShadingView, _frame: &Frame, bsdf: &mut Bsdf) {
        let at = if self.is_textured() { view.lookup() } else { TextureLookup::default() };
        let (back, through) =
            (unit_color(textures, &self.reflectance, &at), unit_color(textures, &self.transmittance, &at));
        let scale = (back + through).map(|both| 1.0 / both.max(1.0));
        bsdf.push(DiffuseTransmission { reflectance: back * scale, transmittance: through * scale, ior: 1.0 });
    }

    fn is_textured(&self) -> bool {
        self.reflectance.is_texture() || self.transmittance.is_texture()
    }

    fn is_transmissive(&self) -> bool {
        true
    }
}

#[cfg(any(test, feature = "testing"))]
impl Translucent {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let leaf = Self { transmittance: Input::Texture("tiles".into()), reflectance: Rgb::splat(0.9).into() };
        vec![Self::default(), leaf]
    }
}
