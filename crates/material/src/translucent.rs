//! Thin sheets that light seeps through: paper, leaves, lampshades.
//!
//! ```json
//! {"translucent": {"reflectance": [0.2, 0.5, 0.1], "transmittance": [0.2, 0.4, 0.05]}}
//! ```

use super::input::{check_share, share};
use super::{Compiled, Material, MaterialError, Resolver, ScatteringMaterial, View};
use juggler_bsdf::{Bsdf, DiffuseTransmission};
use juggler_math::Rgb;
use juggler_texture::{Input, Lookup, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A matte sheet that some of the light comes through, spread as evenly as what is given back; the same from both sides.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Translucent {
    /// Share of light that it gives back, per channel, 0 to 1.
    pub reflectance: Input<Rgb>,
    /// Share of light that comes out on the other side. Both together are 1 at most; what textures give beyond is
    /// taken from both alike.
    pub transmittance: Input<Rgb>,
}

impl Default for Translucent {
    fn default() -> Self {
        Self { reflectance: Rgb::splat(0.4).into(), transmittance: Rgb::splat(0.4).into() }
    }
}

/// A [`Translucent`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledTranslucent {
    reflectance: Slot<Rgb>,
    transmittance: Slot<Rgb>,
}

impl Material for Translucent {
    fn compile(&self, resolver: &mut dyn Resolver) -> Result<Compiled, MaterialError> {
        check_share("reflectance", &self.reflectance)?;
        check_share("transmittance", &self.transmittance)?;
        if let (Input::Value(back), Input::Value(through)) = (&self.reflectance, &self.transmittance) {
            let most = (*back + *through).max_channel();
            // Numbers such as 0.7 and 0.3 may come to a rounding more.
            if most > 1.0 + 1e-6 {
                let message = format!("`reflectance` and `transmittance` together must be 1 or less, they are {most}");
                return Err(MaterialError::Invalid { field: "transmittance", message });
            }
        }
        let textures = resolver.textures();
        let reflectance = textures.resolve("reflectance", &self.reflectance)?;
        let transmittance = textures.resolve("transmittance", &self.transmittance)?;
        Ok(Compiled::scattering(CompiledTranslucent { reflectance, transmittance }))
    }
}

impl ScatteringMaterial for CompiledTranslucent {
    fn add_lobes(&self, textures: &TextureTable, view: &View, bsdf: &mut Bsdf) {
        let at = if self.is_textured() { view.lookup() } else { Lookup::default() };
        let (back, through) = (share(textures, &self.reflectance, &at), share(textures, &self.transmittance, &at));
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
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        let leaf = Self { transmittance: Input::Texture("tiles".into()), reflectance: Rgb::splat(0.9).into() };
        vec![Self::default(), leaf]
    }
}
