//! Cloth with a sheen at grazing angles (Estevez and Kulla 2017) over a diffuse base.
//!
//! ```json
//! {"velvet": {"sheen_color": [0.9, 0.3, 0.4], "sheen_roughness": 0.4,
//! "reflectance": [0.2, 0.02, 0.05]}}
//! ```

use super::input::{check_number, check_unit_color, unit_color, unit_number};
use super::{
    CompiledMaterial, Material, MaterialError, MaterialResolver, ScatteringMaterial, ShadingView, SurfaceSides,
};
use juggler_bsdf::{Bsdf, Sheen};
use juggler_math::{Frame, Rgb};
use juggler_texture::{Input, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Cloth: a sheen of upright fibers over a diffuse base. Use it for velvet and other fabrics.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Velvet {
    /// Color of the sheen, 0 to 1 per channel.
    pub sheen_color: Input<Rgb>,
    /// Roughness of the sheen, 0 to 1. Small values confine the sheen to grazing angles, large
    /// values spread it over the surface.
    pub sheen_roughness: Input<f32>,
    /// Reflectance of the diffuse base, 0 to 1 per channel. Black leaves the sheen alone.
    pub reflectance: Input<Rgb>,
    /// Roughness of the diffuse base, 0 (Lambert's law) to 1 (energy-preserving Oren-Nayar model),
    /// as in the material `diffuse`.
    pub roughness: Input<f32>,
    /// Sides of the surface on which the material is present: `both`, `front` (absent from behind) or
    /// `black_behind`.
    #[serde(skip_serializing_if = "SurfaceSides::is_default")]
    pub sides: SurfaceSides,
}

impl Velvet {
    /// Creates velvet of a sheen color over a black base.
    pub fn new(sheen_color: impl Into<Input<Rgb>>) -> Self {
        Self { sheen_color: sheen_color.into(), ..Self::default() }
    }
}

impl Default for Velvet {
    fn default() -> Self {
        Self {
            sheen_color: Rgb::splat(0.8).into(),
            sheen_roughness: 0.5.into(),
            reflectance: Rgb::BLACK.into(),
            roughness: 0.0.into(),
            sides: SurfaceSides::Both,
        }
    }
}

/// A [`Velvet`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledVelvet {
    sheen_color: Slot<Rgb>,
    sheen_roughness: Slot<f32>,
    reflectance: Slot<Rgb>,
    roughness: Slot<f32>,
}

impl Material for Velvet {
    fn compile(&self, resolver: &mut dyn MaterialResolver) -> Result<CompiledMaterial, MaterialError> {
        check_unit_color("sheen_color", &self.sheen_color)?;
        check_number("sheen_roughness", &self.sheen_roughness, 0.0, 1.0)?;
        check_unit_color("reflectance", &self.reflectance)?;
        check_number("roughness", &self.roughness, 0.0, 1.0)?;
        let textures = resolver.textures();
        let compiled = CompiledMaterial::scattering(CompiledVelvet {
            sheen_color: textures.resolve("sheen_color", &self.sheen_color)?,
            sheen_roughness: textures.resolve("sheen_roughness", &self.sheen_roughness)?,
            reflectance: textures.resolve("reflectance", &self.reflectance)?,
            roughness: textures.resolve("roughness", &self.roughness)?,
        });
        Ok(self.sides.restrict(compiled, resolver))
    }
}

impl ScatteringMaterial for CompiledVelvet {
    fn add_lobes(&self, textures: &TextureTable, view: &ShadingView, _frame: &Frame, bsdf: &mut Bsdf) {
        let at = view.lookup();
        let roughness = unit_number(textures, &self.sheen_roughness, &at);
        let ground = unit_color(textures, &self.reflectance, &at);
        bsdf.push_layer(Sheen::new(unit_color(textures, &self.sheen_color, &at), roughness * roughness), 1.0);
        if !ground.is_black() {
            bsdf.push_diffuse(ground, unit_number(textures, &self.roughness, &at), 1.0);
        }
    }

    fn is_textured(&self) -> bool {
        let colors = self.sheen_color.is_texture() || self.reflectance.is_texture();
        colors || self.sheen_roughness.is_texture() || self.roughness.is_texture()
    }
}

#[cfg(any(test, feature = "testing"))]
impl Velvet {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let red = Self { reflectance: Rgb::new(0.3, 0.02, 0.02).into(), roughness: 0.8.into(), ..Self::default() };
        let woven = Self { sheen_color: Input::Texture("tiles".into()), sheen_roughness: 0.2.into(), ..red.clone() };
        let front = Self { sides: SurfaceSides::Front, ..red.clone() };
        vec![Self::default(), red, woven, front]
    }
}
