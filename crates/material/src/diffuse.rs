//! A matte surface.
//!
//! ```json
//! {"diffuse": {"reflectance": [0.8, 0.2, 0.1], "roughness": 0.3}}
//! ```

use super::input::{check_number, check_share, fraction, share};
use super::{Compiled, Material, MaterialError, Resolver, ScatteringMaterial, View};
use juggler_bsdf::{Bsdf, Lambert};
use juggler_math::Rgb;
use juggler_texture::{Input, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A matte surface, the same from both sides.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Diffuse {
    /// Share of light that it gives back, per channel, 0 to 1.
    pub reflectance: Input<Rgb>,
    /// 0 for Lambert's law, up to 1 for dust and plaster, which look flatter (Oren-Nayar, energy-preserving).
    pub roughness: Input<f32>,
}

impl Default for Diffuse {
    fn default() -> Self {
        Self { reflectance: Rgb::splat(0.8).into(), roughness: 0.0.into() }
    }
}

/// A [`Diffuse`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledDiffuse {
    reflectance: Slot<Rgb>,
    roughness: Slot<f32>,
}

impl Material for Diffuse {
    fn compile(&self, resolver: &mut dyn Resolver) -> Result<Compiled, MaterialError> {
        check_share("reflectance", &self.reflectance)?;
        check_number("roughness", &self.roughness, 0.0, 1.0)?;
        let textures = resolver.textures();
        let reflectance = textures.resolve("reflectance", &self.reflectance)?;
        let roughness = textures.resolve("roughness", &self.roughness)?;
        Ok(Compiled::scattering(CompiledDiffuse { reflectance, roughness }))
    }
}

impl ScatteringMaterial for CompiledDiffuse {
    fn add_lobes(&self, textures: &TextureTable, view: &View, bsdf: &mut Bsdf) {
        if let (Slot::Value(albedo), Slot::Value(0.0)) = (self.reflectance, self.roughness) {
            bsdf.push(Lambert { albedo });
            return;
        }
        let at = view.lookup();
        bsdf.push_diffuse(share(textures, &self.reflectance, &at), fraction(textures, &self.roughness, &at), 1.0);
    }

    fn is_textured(&self) -> bool {
        self.reflectance.is_texture() || self.roughness.is_texture()
    }
}

#[cfg(any(test, feature = "testing"))]
impl Diffuse {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        let rough = Self { roughness: 0.7.into(), reflectance: Input::Texture("tiles".into()) };
        vec![Self::default(), rough]
    }
}
