//! A matte body under a clear coat: plastic, varnished wood, glazed tiles.
//!
//! ```json
//! {"plastic": {"reflectance": [0.7, 0.1, 0.1], "roughness": 0.2, "ior": 1.5}}
//! ```

use super::error::in_range;
use super::input::{check_number, check_share, fraction, share};
use super::roughness::Roughness;
use super::{Compiled, Material, MaterialError, Resolver, ScatteringMaterial, View};
use juggler_bsdf::{Bsdf, Plastic as PlasticLobes};
use juggler_math::Rgb;
use juggler_texture::{Input, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A matte body under a clear coat, the same from both sides.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Plastic {
    /// Share of light that the body gives back, per channel, 0 to 1.
    pub reflectance: Input<Rgb>,
    /// Roughness of the body: as for `diffuse`.
    pub diffuse_roughness: Input<f32>,
    /// Index of refraction of the coat.
    #[schemars(range(min = 1, max = 10))]
    pub ior: f32,
    /// Roughness of the coat: 0 polished, 1 the roughest; the width of GGX is its square.
    pub roughness: Input<f32>,
    /// Stretches highlights: 0 for round ones, up to 1 along the surface's u, down to -1 across.
    pub anisotropy: Input<f32>,
    /// Turns that direction from u towards v, in whole turns.
    pub anisotropy_rotation: Input<f32>,
    /// Filter of what the coat mirrors: white in nature.
    pub reflection_tint: Input<Rgb>,
    /// Colours grow deeper, as light that the coat throws back into the body meets its colour again. Off, the body shows
    /// the colours that are written or painted.
    pub nonlinear: bool,
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
        }
    }
}

/// A [`Plastic`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledPlastic {
    reflectance: Slot<Rgb>,
    diffuse_roughness: Slot<f32>,
    ior: f32,
    /// Of the coat.
    pub roughness: Roughness,
    reflection: Slot<Rgb>,
    nonlinear: bool,
}

impl Material for Plastic {
    fn compile(&self, resolver: &mut dyn Resolver) -> Result<Compiled, MaterialError> {
        check_share("reflectance", &self.reflectance)?;
        check_number("diffuse_roughness", &self.diffuse_roughness, 0.0, 1.0)?;
        in_range("ior", self.ior, 1.0, 10.0)?;
        check_share("reflection_tint", &self.reflection_tint)?;
        let textures = resolver.textures();
        let roughness = [&self.roughness, &self.anisotropy, &self.anisotropy_rotation];
        Ok(Compiled::scattering(CompiledPlastic {
            reflectance: textures.resolve("reflectance", &self.reflectance)?,
            diffuse_roughness: textures.resolve("diffuse_roughness", &self.diffuse_roughness)?,
            ior: self.ior,
            roughness: Roughness::new(textures, roughness)?,
            reflection: textures.resolve("reflection_tint", &self.reflection_tint)?,
            nonlinear: self.nonlinear,
        }))
    }
}

impl ScatteringMaterial for CompiledPlastic {
    fn add_lobes(&self, textures: &TextureTable, view: &View, bsdf: &mut Bsdf) {
        let at = view.lookup();
        PlasticLobes {
            albedo: share(textures, &self.reflectance, &at),
            body_roughness: fraction(textures, &self.diffuse_roughness, &at),
            // In something denser than itself the coat is not seen.
            ior: (self.ior / view.around_ior).max(1.0),
            alpha: self.roughness.alpha(textures, &at),
            reflection: share(textures, &self.reflection, &at),
            nonlinear: self.nonlinear,
        }
        .add_lobes(bsdf);
    }

    fn is_textured(&self) -> bool {
        let colors = self.reflectance.is_texture() || self.reflection.is_texture();
        colors || self.diffuse_roughness.is_texture() || self.roughness.is_textured()
    }

    fn turns(&self, textures: &TextureTable, view: &View) -> Option<f32> {
        self.roughness.turns(textures, view)
    }

    fn is_stretched(&self) -> bool {
        self.roughness.is_stretched()
    }
}

#[cfg(any(test, feature = "testing"))]
impl Plastic {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        let glazed = Self { reflectance: Input::Texture("tiles".into()), nonlinear: true, ..Self::default() };
        let brushed = Self { roughness: 0.5.into(), anisotropy: 0.7.into(), ior: 1.8, ..Self::default() };
        let chalky =
            Self { diffuse_roughness: 1.0.into(), roughness: Input::Texture("tiles".into()), ..brushed.clone() };
        vec![Self::default(), glazed, brushed, chalky]
    }
}
