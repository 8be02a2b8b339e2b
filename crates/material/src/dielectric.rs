//! Dielectrics: glass, water, gems.
//!
//! ```json
//! {"dielectric": {"ior": 1.5, "roughness": 0.1,
//! "medium": {"color": [0.5, 0.9, 0.6], "distance": 2}}}
//! ```

use super::error::in_range;
use super::input::{check_unit_color, is_zero, unit_color};
use super::roughness::Roughness;
use super::{
    CompiledMaterial, IneffectiveSetting, Material, MaterialError, MaterialResolver, ScatteringMaterial, ShadingView,
};
use crate::medium::{Interior, MAX_DISPERSION, Medium};
use juggler_bsdf::{Bsdf, Dielectric as DielectricLobe, ThinDielectric};
use juggler_math::{Frame, Rgb};
use juggler_texture::{Input, Slot, TextureLookup, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Dielectric interface, smooth or rough (GGX microfacets), with a medium inside. Use it for glass,
/// water and gems.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Dielectric {
    /// Index of refraction inside: 1.33 for water, 1.5 for glass, 2.42 for diamond.
    #[schemars(range(min = 0.1, max = 10))]
    pub ior: f32,
    /// Dispersion: 20 divided by the Abbe number of the glass, 0 to 20; 0.34 for crown glass, 0.36
    /// for diamond, 0.7 for flint glass. The default, 0, refracts all wavelengths alike. Only the
    /// integrator `path` shows dispersion. Paths do not sample lights through spheres of dispersive
    /// glass, so such spheres cast caustics of emissive objects and environments, but none of
    /// `point`, `spot` and `directional` lights.
    #[serde(skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0, max = 20))]
    pub dispersion: f32,
    /// Roughness, 0 (clear) to 1 (frosted). The alpha of GGX is its square.
    pub roughness: Input<f32>,
    /// Anisotropy of the roughness, -1 to 1: positive values elongate highlights along the
    /// surface's u, negative values along v.
    pub anisotropy: Input<f32>,
    /// Rotation of the anisotropy from u towards v, in full turns, -1000 to 1000.
    #[schemars(extend("x-unit" = "turns"))]
    pub anisotropy_rotation: Input<f32>,
    /// Tint of reflected light, 0 to 1 per channel. White is physical.
    pub reflection_tint: Input<Rgb>,
    /// Tint of transmitted light, 0 to 1 per channel. White is physical; use the `medium` for
    /// colored glass.
    pub transmission_tint: Input<Rgb>,
    /// Makes the surface a thin pane or bubble: light passes straight through, and there is no
    /// interior, so `medium` and `priority` have no effect.
    pub thin: bool,
    /// Medium inside the solid.
    pub medium: Medium,
    /// Priority where solids overlap: the solid of the highest priority fills the overlap (Schmidt
    /// and Budge 2002), among equals the one whose material comes first. Let a drink reach slightly
    /// into its glass, and give the glass the higher priority.
    pub priority: i32,
    /// Adds the energy that single scattering between microfacets loses. Set it to `false` to match
    /// renderers with single scattering only, where rough glass is darker.
    pub energy_compensation: bool,
}

impl Dielectric {
    /// Creates smooth, clear glass or liquid of an index of refraction.
    pub fn new(ior: f32) -> Self {
        Self { ior, ..Self::default() }
    }
}

impl Default for Dielectric {
    fn default() -> Self {
        Self {
            ior: 1.5,
            dispersion: 0.0,
            roughness: 0.0.into(),
            anisotropy: 0.0.into(),
            anisotropy_rotation: 0.0.into(),
            reflection_tint: Rgb::WHITE.into(),
            transmission_tint: Rgb::WHITE.into(),
            thin: false,
            medium: Medium::default(),
            priority: 0,
            energy_compensation: true,
        }
    }
}

/// A [`Dielectric`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledDielectric {
    ior: f32,
    /// Roughness of the surface.
    pub roughness: Roughness,
    reflection: Slot<Rgb>,
    transmission: Slot<Rgb>,
    compensated: bool,
    /// Interior of the solid; `None` for a thin surface.
    pub interior: Option<Interior>,
}

impl Material for Dielectric {
    fn compile(&self, resolver: &mut dyn MaterialResolver) -> Result<CompiledMaterial, MaterialError> {
        in_range("ior", self.ior, 0.1, 10.0)?;
        in_range("dispersion", self.dispersion, 0.0, MAX_DISPERSION)?;
        check_unit_color("reflection_tint", &self.reflection_tint)?;
        check_unit_color("transmission_tint", &self.transmission_tint)?;
        let medium = super::boundary::compile_medium(&self.medium)?;
        let textures = resolver.textures();
        let Self { ior, dispersion, priority, .. } = *self;
        let roughness = [&self.roughness, &self.anisotropy, &self.anisotropy_rotation];
        Ok(CompiledMaterial::scattering(CompiledDielectric {
            ior,
            roughness: Roughness::new(textures, roughness)?,
            reflection: textures.resolve("reflection_tint", &self.reflection_tint)?,
            transmission: textures.resolve("transmission_tint", &self.transmission_tint)?,
            compensated: self.energy_compensation,
            interior: (!self.thin).then_some(Interior { ior, dispersion, priority, medium }),
        }))
    }

    fn ineffective_settings(&self) -> Vec<IneffectiveSetting> {
        let is_ineffective = self.thin && self.dispersion > 0.0;
        is_ineffective.then_some(IneffectiveSetting { field: "dispersion", replaced_by: "thin" }).into_iter().collect()
    }

    fn scale_distances(&mut self, factor: f32) {
        self.medium.scale_distances(factor);
    }
}

impl ScatteringMaterial for CompiledDielectric {
    #[inline]
    fn add_lobes(&self, textures: &TextureTable, view: &ShadingView, _frame: &Frame, bsdf: &mut Bsdf) {
        let at = if self.is_textured() { view.lookup() } else { TextureLookup::default() };
        let alpha = self.roughness.alpha(textures, &at);
        let (reflection, transmission) =
            (unit_color(textures, &self.reflection, &at), unit_color(textures, &self.transmission, &at));
        if self.interior.is_none() {
            let thin = if self.compensated { ThinDielectric::compensated } else { ThinDielectric::new };
            bsdf.push(thin(self.ior, alpha).tinted(reflection, transmission));
            return;
        }
        let interface = if self.compensated { DielectricLobe::compensated } else { DielectricLobe::new };
        bsdf.push(interface(self.ior / view.outside_ior, alpha).tinted(reflection, transmission));
    }

    fn is_textured(&self) -> bool {
        let colors = self.reflection.is_texture() || self.transmission.is_texture();
        colors || self.roughness.is_textured()
    }

    fn rotation_turns(&self, textures: &TextureTable, view: &ShadingView) -> Option<f32> {
        self.roughness.rotation_turns(textures, view)
    }

    fn is_anisotropic(&self) -> bool {
        self.roughness.is_anisotropic()
    }

    fn is_transmissive(&self) -> bool {
        true
    }

    fn interior(&self) -> Option<Interior> {
        self.interior
    }
}

#[cfg(any(test, feature = "testing"))]
impl Dielectric {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let medium = Medium { color: Rgb::new(0.3, 0.9, 0.5), ..Medium::default() };
        let frosted = Self { roughness: 0.5.into(), medium, priority: 3, ..Self::default() };
        let flint = Self { ior: 1.7, dispersion: 0.7, ..Self::default() };
        vec![Self::default(), frosted, flint, Self { thin: true, ior: 1.33, ..Self::default() }]
    }
}
