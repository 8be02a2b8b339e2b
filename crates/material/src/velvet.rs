//! Cloth: fibres that stand upright and shine along edges.
//!
//! ```json
//! {"velvet": {"sheen_color": [0.9, 0.3, 0.4], "sheen_roughness": 0.4, "reflectance": [0.2, 0.02, 0.05]}}
//! ```

use super::input::{check_number, check_share, fraction, share};
use super::{Compiled, Material, MaterialError, Resolver, ScatteringMaterial, View};
use juggler_bsdf::{Bsdf, Sheen};
use juggler_math::Rgb;
use juggler_texture::{Input, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Fibres over a matte ground, the same from both sides.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Velvet {
    /// Colour of the fibres, 0 to 1.
    pub sheen_color: Input<Rgb>,
    /// 0 for fibres that stand straight and shine at the very edge only, 1 for tousled ones.
    pub sheen_roughness: Input<f32>,
    /// Share of light that the ground gives back, per channel, 0 to 1; black for fibres alone.
    pub reflectance: Input<Rgb>,
    /// Roughness of the ground: as for `diffuse`.
    pub roughness: Input<f32>,
}

impl Default for Velvet {
    fn default() -> Self {
        Self {
            sheen_color: Rgb::splat(0.8).into(),
            sheen_roughness: 0.5.into(),
            reflectance: Rgb::BLACK.into(),
            roughness: 0.0.into(),
        }
    }
}

/// A [`Velvet`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledVelvet {
    sheen_color: Slot<Rgb>,
    sheen_roughness: Slot<f32>,
    reflectance: Slot<Rgb>,
    roughness: Slot<f32>,
}

impl Material for Velvet {
    fn compile(&self, resolver: &mut dyn Resolver) -> Result<Compiled, MaterialError> {
        check_share("sheen_color", &self.sheen_color)?;
        check_number("sheen_roughness", &self.sheen_roughness, 0.0, 1.0)?;
        check_share("reflectance", &self.reflectance)?;
        check_number("roughness", &self.roughness, 0.0, 1.0)?;
        let textures = resolver.textures();
        Ok(Compiled::scattering(CompiledVelvet {
            sheen_color: textures.resolve("sheen_color", &self.sheen_color)?,
            sheen_roughness: textures.resolve("sheen_roughness", &self.sheen_roughness)?,
            reflectance: textures.resolve("reflectance", &self.reflectance)?,
            roughness: textures.resolve("roughness", &self.roughness)?,
        }))
    }
}

impl ScatteringMaterial for CompiledVelvet {
    fn add_lobes(&self, textures: &TextureTable, view: &View, bsdf: &mut Bsdf) {
        let at = view.lookup();
        let roughness = fraction(textures, &self.sheen_roughness, &at);
        let ground = share(textures, &self.reflectance, &at);
        bsdf.push_layer(Sheen::new(share(textures, &self.sheen_color, &at), roughness * roughness), 1.0);
        if !ground.is_black() {
            bsdf.push_diffuse(ground, fraction(textures, &self.roughness, &at), 1.0);
        }
    }

    fn is_textured(&self) -> bool {
        let colors = self.sheen_color.is_texture() || self.reflectance.is_texture();
        colors || self.sheen_roughness.is_texture() || self.roughness.is_texture()
    }
}

#[cfg(any(test, feature = "testing"))]
impl Velvet {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        let red = Self { reflectance: Rgb::new(0.3, 0.02, 0.02).into(), roughness: 0.8.into(), ..Self::default() };
        let woven = Self { sheen_color: Input::Texture("tiles".into()), sheen_roughness: 0.2.into(), ..red.clone() };
        vec![Self::default(), red, woven]
    }
}
