//! Emissive surface: an area light of any shape for the path tracer.
//!
//! ```json
//! {"emissive": {"radiance": [17, 12, 4], "sides": "front"}}
//! ```

use super::input::{check_emission, emitted_color, unit_number};
use super::{CompiledMaterial, Material, MaterialError, MaterialId, MaterialRef, MaterialResolver, ShadingView};
use juggler_bsdf::fresnel::dielectric_reflectance;
use juggler_math::{MAX_LIGHT, Rgb};
use juggler_texture::{Input, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Emissive surface: the same radiance in all directions, optionally over another material that
/// scatters light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Emissive {
    /// Emitted radiance, 0 to 1e30 per channel, also after multiplication by `scale`.
    #[schemars(extend("x-unit" = "W/(scene unit² sr)"))]
    pub radiance: Input<Rgb>,
    /// Factor on the radiance.
    #[schemars(range(min = 0, max = 1e30))]
    pub scale: f32,
    /// Sides of the surface that emit light.
    pub sides: Sides,
    /// Material that scatters light. Without it, the surface is black.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub material: Option<MaterialRef>,
}

impl Emissive {
    /// Creates a material whose front emits a radiance.
    pub fn new(radiance: impl Into<Input<Rgb>>) -> Self {
        Self { radiance: radiance.into(), ..Self::default() }
    }
}

/// Sides of a surface that emit light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Sides {
    /// The side of the surface normals: the outside of a solid, the upper side of a rectangle.
    #[default]
    Front,
    /// Both sides.
    Both,
}

impl Default for Emissive {
    fn default() -> Self {
        Self { radiance: Rgb::WHITE.into(), scale: 1.0, sides: Sides::Front, material: None }
    }
}

/// An [`Emissive`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledEmissive {
    radiance: Slot<Rgb>,
    scale: f32,
    sides: Sides,
    coat: Option<EmissionCoat>,
    /// Material that scatters light.
    pub material: MaterialId,
}

/// Clear coat over an emissive surface, which reflects some of the emission back.
#[derive(Clone, Debug)]
pub struct EmissionCoat {
    /// Coverage by the coat, 0 to 1.
    pub coverage: Slot<f32>,
    /// Index of refraction of the coat.
    pub ior: f32,
}

impl EmissionCoat {
    /// Fraction of the emission that leaves through the coat towards the viewer:
    /// 1 - coverage · Fresnel reflectance (`KHR_materials_clearcoat`, "Emission").
    fn transmittance(&self, textures: &TextureTable, view: &ShadingView) -> f32 {
        let cos = view.surface.shading_normal.dot(view.wo).abs();
        1.0 - unit_number(textures, &self.coverage, &view.lookup()) * dielectric_reflectance(cos, self.ior)
    }
}

impl Material for Emissive {
    fn compile(&self, resolver: &mut dyn MaterialResolver) -> Result<CompiledMaterial, MaterialError> {
        check_emission("radiance", &self.radiance, "scale", self.scale)?;
        let radiance = resolver.textures().resolve("radiance", &self.radiance)?;
        let material = match &self.material {
            Some(material) => resolver.material("material", material)?,
            None => MaterialId::NONE,
        };
        Ok(CompiledMaterial::Emissive(CompiledEmissive::new(radiance, self.scale, self.sides, material)))
    }

    fn nested_materials(&self) -> Vec<(&'static str, &MaterialRef)> {
        self.material.iter().map(|material| ("material", material)).collect()
    }

    fn scale_distances(&mut self, factor: f32) {
        self.material.iter_mut().for_each(|material| material.scale_distances(factor));
    }

    fn is_area_light(&self) -> bool {
        true
    }
}

impl CompiledEmissive {
    /// Emission of checked values over a material.
    pub fn new(radiance: Slot<Rgb>, scale: f32, sides: Sides, material: MaterialId) -> Self {
        Self { radiance, scale, sides, coat: None, material }
    }

    /// The same emission under a clear coat, if there is one.
    #[must_use]
    pub fn under_coat(self, coat: Option<EmissionCoat>) -> Self {
        Self { coat, ..self }
    }

    /// Radiance emitted towards the viewer.
    pub fn emission(&self, textures: &TextureTable, view: &ShadingView) -> Rgb {
        if self.sides == Sides::Front && !view.is_outside() {
            return Rgb::BLACK;
        }
        let radiance = match &self.radiance {
            Slot::Value(radiance) => *radiance,
            slot => emitted_color(textures, slot, &view.lookup()),
        };
        let scale = self.coat.as_ref().map_or(self.scale, |coat| self.scale * coat.transmittance(textures, view));
        (radiance * scale).map(|channel| channel.min(MAX_LIGHT))
    }

    /// Emission of the whole surface.
    pub fn surface_emission(&self) -> SurfaceEmission {
        let radiance = match &self.radiance {
            Slot::Value(radiance) => Some(*radiance * self.scale).filter(|_| self.coat.is_none()),
            Slot::Texture(_) | Slot::Product(_) => None,
        };
        SurfaceEmission { radiance, sides: self.sides }
    }

    /// Whether emission varies over the surface.
    pub fn is_textured(&self) -> bool {
        self.radiance.is_texture() || self.coat.as_ref().is_some_and(|coat| coat.coverage.is_texture())
    }
}

/// Emission of a whole surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceEmission {
    /// Radiance, if it is constant over the surface.
    pub radiance: Option<Rgb>,
    /// Sides that emit light.
    pub sides: Sides,
}

impl SurfaceEmission {
    /// Emission of a surface that has both emissions at different points.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        let sides = if self.sides == other.sides { self.sides } else { Sides::Both };
        Self { radiance: self.radiance.filter(|_| self.radiance == other.radiance), sides }
    }

    /// The same emission on the front only.
    #[must_use]
    pub fn on_front(self) -> Self {
        Self { sides: Sides::Front, ..self }
    }

    /// The same emission with a radiance that varies over the surface.
    #[must_use]
    pub fn with_varying_radiance(self) -> Self {
        Self { radiance: None, ..self }
    }
}

#[cfg(any(test, feature = "testing"))]
impl Emissive {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let screen = Self {
            radiance: Input::Texture("tiles".into()),
            scale: 3.0,
            sides: Sides::Both,
            material: Some(super::Phong::default().into()),
        };
        vec![Self::default(), screen]
    }
}
