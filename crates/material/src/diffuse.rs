//! Diffuse surface, smooth or rough.
//!
//! ```json
//! {"diffuse": {"reflectance": [0.8, 0.2, 0.1], "roughness": 0.3}}
//! ```

use super::input::{check_number, check_unit_color, unit_color, unit_number};
use super::{
    CompiledMaterial, Material, MaterialError, MaterialResolver, ScatteringMaterial, ShadingView, SurfaceSides,
};
use juggler_bsdf::{Bsdf, Lambert};
use juggler_math::{Frame, Rgb};
use juggler_texture::{Input, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Diffuse surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Diffuse {
    /// Reflectance, 0 to 1 per channel. Roughness lowers it slightly, except for white.
    pub reflectance: Input<Rgb>,
    /// Roughness, 0 (Lambert's law) to 1 (energy-preserving Oren-Nayar model). Larger values
    /// flatten the shading, as on dust and plaster.
    pub roughness: Input<f32>,
    /// Sides of the surface on which the material is present: `both`, `front` (absent from behind) or
    /// `black_behind`.
    #[serde(skip_serializing_if = "SurfaceSides::is_default")]
    pub sides: SurfaceSides,
}

impl Diffuse {
    /// Creates a diffuse material of a reflectance.
    pub fn new(reflectance: impl Into<Input<Rgb>>) -> Self {
        Self { reflectance: reflectance.into(), ..Self::default() }
    }
}

impl Default for Diffuse {
    fn default() -> Self {
        Self { reflectance: Rgb::splat(0.8).into(), roughness: 0.0.into(), sides: SurfaceSides::Both }
    }
}

/// A [`Diffuse`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledDiffuse {
    reflectance: Slot<Rgb>,
    roughness: Slot<f32>,
}

impl Material for Diffuse {
    fn compile(&self, resolver: &mut dyn MaterialResolver) -> Result<CompiledMaterial, MaterialError> {
        check_unit_color("reflectance", &self.reflectance)?;
        check_number("roughness", &self.roughness, 0.0, 1.0)?;
        let textures = resolver.textures();
        let reflectance = textures.resolve("reflectance", &self.reflectance)?;
        let roughness = textures.resolve("roughness", &self.roughness)?;
        let compiled = CompiledMaterial::scattering(CompiledDiffuse { reflectance, roughness });
        Ok(self.sides.restrict(compiled, resolver))
    }
}

impl ScatteringMaterial for CompiledDiffuse {
    fn add_lobes(&self, textures: &TextureTable, view: &ShadingView, _frame: &Frame, bsdf: &mut Bsdf) {
        if let (Slot::Value(albedo), Slot::Value(0.0)) = (&self.reflectance, &self.roughness) {
            bsdf.push(Lambert { albedo: *albedo });
            return;
        }
        let at = view.lookup();
        bsdf.push_diffuse(
            unit_color(textures, &self.reflectance, &at),
            unit_number(textures, &self.roughness, &at),
            1.0,
        );
    }

    fn is_textured(&self) -> bool {
        self.reflectance.is_texture() || self.roughness.is_texture()
    }
}

#[cfg(any(test, feature = "testing"))]
impl Diffuse {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let rough =
            Self { roughness: 0.7.into(), reflectance: Input::Texture("tiles".into()), sides: SurfaceSides::Both };
        let front = Self { sides: SurfaceSides::Front, ..Self::default() };
        let black_behind = Self { sides: SurfaceSides::BlackBehind, ..rough.clone() };
        vec![Self::default(), rough, front, black_behind]
    }
}
