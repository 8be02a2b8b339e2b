//! Diffuse base under a dielectric coating: plastic, varnished wood, glazed tiles.
//!
//! ```json
//! {"plastic": {"reflectance": [0.7, 0.1, 0.1], "roughness": 0.2, "ior": 1.5}}
//! ```

use super::error::in_range;
use super::input::{check_number, check_unit_color, unit_color, unit_number};
use super::roughness::Roughness;
use super::{
    CompiledMaterial, Material, MaterialError, MaterialResolver, ScatteringMaterial, ShadingView, SurfaceSides,
};
use juggler_bsdf::{Bsdf, Plastic as PlasticLobes};
use juggler_math::{Frame, Rgb};
use juggler_texture::{Input, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Diffuse base under a smooth or rough dielectric coating. Use it for plastic, varnished wood and
/// glazed tiles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Plastic {
    /// Reflectance of the diffuse base, 0 to 1 per channel.
    pub reflectance: Input<Rgb>,
    /// Roughness of the diffuse base, 0 (Lambert's law) to 1 (energy-preserving Oren-Nayar model),
    /// as in the material `diffuse`.
    pub diffuse_roughness: Input<f32>,
    /// Index of refraction of the coating.
    #[schemars(range(min = 1, max = 10))]
    pub ior: f32,
    /// Roughness of the coating, 0 (mirror) to 1. The alpha of GGX is its square.
    pub roughness: Input<f32>,
    /// Anisotropy of the roughness, -1 to 1: positive values elongate highlights along the
    /// surface's u, negative values along v.
    pub anisotropy: Input<f32>,
    /// Rotation of the anisotropy from u towards v, in full turns, -1000 to 1000.
    #[schemars(extend("x-unit" = "turns"))]
    pub anisotropy_rotation: Input<f32>,
    /// Tint of the coating's reflection, 0 to 1 per channel. White is physical.
    pub reflection_tint: Input<Rgb>,
    /// Simulates multiple reflections between base and coating, which make colors darker and more
    /// saturated. `false` keeps the colors as they are written or painted.
    pub nonlinear: bool,
    /// Sides of the surface on which the material is present: `both`, `front` (absent from behind) or
    /// `black_behind`.
    #[serde(skip_serializing_if = "SurfaceSides::is_default")]
    pub sides: SurfaceSides,
}

impl Plastic {
    /// Creates smooth plastic whose base under the coat has a diffuse reflectance.
    pub fn new(reflectance: impl Into<Input<Rgb>>) -> Self {
        Self { reflectance: reflectance.into(), ..Self::default() }
    }
}

impl Default for Plastic {
    fn default() -> Self {
        Self {
            reflectance: Rgb::splat(0.5).into(),
            diffuse_roughness: 0.0.into(),
            ior: 1.5,
            roughness: 0.0.into(),
            anisotropy: 0.0.into(),
            anisotropy_rotation: 0.0.into(),
            reflection_tint: Rgb::WHITE.into(),
            nonlinear: false,
            sides: SurfaceSides::Both,
        }
    }
}

/// A [`Plastic`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledPlastic {
    reflectance: Slot<Rgb>,
    diffuse_roughness: Slot<f32>,
    ior: f32,
    /// Roughness of the coating.
    pub roughness: Roughness,
    reflection: Slot<Rgb>,
    nonlinear: bool,
}

impl Material for Plastic {
    fn compile(&self, resolver: &mut dyn MaterialResolver) -> Result<CompiledMaterial, MaterialError> {
        check_unit_color("reflectance", &self.reflectance)?;
        check_number("diffuse_roughness", &self.diffuse_roughness, 0.0, 1.0)?;
        in_range("ior", self.ior, 1.0, 10.0)?;
        check_unit_color("reflection_tint", &self.reflection_tint)?;
        let textures = resolver.textures();
        let roughness = [&self.roughness, &self.anisotropy, &self.anisotropy_rotation];
        let compiled = CompiledMaterial::scattering(CompiledPlastic {
            reflectance: textures.resolve("reflectance", &self.reflectance)?,
            diffuse_roughness: textures.resolve("diffuse_roughness", &self.diffuse_roughness)?,
            ior: self.ior,
            roughness: Roughness::new(textures, roughness)?,
            reflection: textures.resolve("reflection_tint", &self.reflection_tint)?,
            nonlinear: self.nonlinear,
        });
        Ok(self.sides.restrict(compiled, resolver))
    }
}

impl ScatteringMaterial for CompiledPlastic {
    fn add_lobes(&self, textures: &TextureTable, view: &ShadingView, _frame: &Frame, bsdf: &mut Bsdf) {
        let at = view.lookup();
        PlasticLobes {
            albedo: unit_color(textures, &self.reflectance, &at),
            base_roughness: unit_number(textures, &self.diffuse_roughness, &at),
            // The coating is invisible in a denser medium.
            ior: (self.ior / view.outside_ior).max(1.0),
            alpha: self.roughness.alpha(textures, &at),
            reflection: unit_color(textures, &self.reflection, &at),
            nonlinear: self.nonlinear,
        }
        .add_lobes(bsdf);
    }

    fn is_textured(&self) -> bool {
        let colors = self.reflectance.is_texture() || self.reflection.is_texture();
        colors || self.diffuse_roughness.is_texture() || self.roughness.is_textured()
    }

    fn rotation_turns(&self, textures: &TextureTable, view: &ShadingView) -> Option<f32> {
        self.roughness.rotation_turns(textures, view)
    }

    fn is_anisotropic(&self) -> bool {
        self.roughness.is_anisotropic()
    }
}

#[cfg(any(test, feature = "testing"))]
impl Plastic {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let glazed = Self { reflectance: Input::Texture("tiles".into()), nonlinear: true, ..Self::default() };
        let brushed = Self { roughness: 0.5.into(), anisotropy: 0.7.into(), ior: 1.8, ..Self::default() };
        let chalky =
            Self { diffuse_roughness: 1.0.into(), roughness: Input::Texture("tiles".into()), ..brushed.clone() };
        vec![Self::default(), glazed, brushed, chalky]
    }
}
