//! Classic material: ambient, diffuse and specular reflection (Phong 1975), mirror reflection and
//! refraction (Whitted 1980), also over cones of rays (Cook, Porter and Carpenter 1984).
//!
//! ```json
//! {"phong": {"diffuse": "#c02020", "specular": 1, "shininess": 20, "reflection": 0.2}}
//! ```
//!
//! With n the normal, l the direction to a light of radiance L, v the direction to the viewer, and
//! r the reflection of l at n, the radiance towards the viewer is
//!
//! `emission` + `ambient` · `diffuse` · ambient light
//! \+ Σ L (`diffuse_weight` · `diffuse` · (n · l)
//! \+ `specular` · `highlight_color` · (r · v)^`shininess`)
//! \+ `reflection` · radiance of the reflected ray
//! \+ `transparency` · radiance of the refracted ray.
//!
//! `reflection` is the product of the Juggler's reflection weight and color, and of the teaching
//! engine's kR; `transparency` is its kT, `diffuse` its kD, `highlight_color` with `specular` 1 its
//! kS.

use super::error::in_range;
use super::{CompiledMaterial, Material, MaterialError, MaterialResolver, Sides, SurfaceEmission};
use juggler_bsdf::{ConeSampling, Highlight, PhongParameters};
use juggler_math::{MAX_LIGHT, Rgb};
use juggler_texture::{Input, Slot, TextureLookup, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Classic model of Phong and Whitted: ambient, diffuse and specular reflection, mirror reflection
/// and refraction. The integrator `classic` follows it exactly, path tracers approximate it by a
/// physically based BSDF.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Phong {
    /// Emitted radiance, 0 or more per channel.
    #[schemars(extend("x-unit" = "W/(scene unit² sr)"))]
    pub emission: Input<Rgb>,
    /// Weight of ambient light, 0 or more per channel; a factor on `diffuse`.
    pub ambient: Input<Rgb>,
    /// Share of the ambient light that nearby geometry may occlude. Takes effect if the integrator
    /// has an `occlusion_distance`.
    #[schemars(range(min = 0, max = 1))]
    pub occlusion: f32,
    /// Color of ambient and diffuse reflection, 0 or more per channel.
    pub diffuse: Input<Rgb>,
    /// Weight of diffuse reflection.
    #[schemars(range(min = 0, max = 1e30))]
    pub diffuse_weight: f32,
    /// Normalization of diffuse reflection.
    pub diffuse_normalization: DiffuseNormalization,
    /// Weight of the specular highlight, 0 or more.
    pub specular: Input<f32>,
    /// Color of the specular highlight, 0 or more per channel.
    pub highlight_color: Input<Rgb>,
    /// Exponent of the specular highlight. Larger values make it smaller.
    #[schemars(range(min = 0))]
    pub shininess: f32,
    /// Formula of the specular highlight.
    pub highlight: Highlight,
    /// Weight of mirror reflection, 0 or more per channel.
    pub reflection: Input<Rgb>,
    /// Cone of reflected rays, for glossy reflection.
    pub glossy: Spread,
    /// Weight of refraction, 0 or more per channel; also the transmittance for shadow rays.
    pub transparency: Input<Rgb>,
    /// Cone of refracted rays, for blurry refraction.
    pub blurry: Spread,
    /// Index of refraction inside over outside. 1 leaves rays straight, glass has 1.5.
    #[schemars(range(min = 0.01, max = 100))]
    pub ior: f32,
    /// Weights `reflection` and `transparency` by Fresnel's equations: at grazing angles,
    /// reflection dominates.
    pub fresnel: bool,
    /// Lights the surface from both sides, whichever side is seen. Use it for surfaces as thin as
    /// paper.
    pub both_sides: bool,
}

/// Normalization of diffuse reflection.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum DiffuseNormalization {
    /// Factor 1: a light of radiance 1 at normal incidence makes a white surface white.
    #[default]
    One,
    /// Factor 1/π: light is measured as irradiance.
    InversePi,
}

impl DiffuseNormalization {
    fn factor(self) -> f32 {
        match self {
            Self::One => 1.0,
            Self::InversePi => std::f32::consts::FRAC_1_PI,
        }
    }
}

/// Cone of rays around a reflected or refracted direction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Spread {
    /// Half of the cone's opening angle, in degrees. 0 gives sharp images, larger values blur more.
    #[schemars(range(min = 0, max = 90), extend("x-unit" = "degrees"))]
    pub half_angle_degrees: f32,
    /// Rays per sample in the integrator `classic`. More rays reduce noise.
    #[schemars(range(min = 1, max = 10_000))]
    pub rays: u32,
}

impl Default for Spread {
    fn default() -> Self {
        Self { half_angle_degrees: 0.0, rays: 1 }
    }
}

impl Default for Phong {
    fn default() -> Self {
        Self {
            emission: Rgb::BLACK.into(),
            ambient: Rgb::WHITE.into(),
            occlusion: 1.0,
            diffuse: Rgb::splat(0.8).into(),
            diffuse_weight: 1.0,
            diffuse_normalization: DiffuseNormalization::One,
            specular: Input::Value(0.0),
            highlight_color: Rgb::WHITE.into(),
            shininess: 20.0,
            highlight: Highlight::Phong,
            reflection: Rgb::BLACK.into(),
            glossy: Spread::default(),
            transparency: Rgb::BLACK.into(),
            blurry: Spread::default(),
            ior: 1.0,
            fresnel: false,
            both_sides: false,
        }
    }
}

/// A [`Phong`] with its names resolved.
#[derive(Clone, Debug)]
pub struct CompiledPhong {
    /// Values that hold at all points; without textures, all values.
    fixed: PhongParameters,
    /// Inputs, if one of them is a texture; boxed, since most materials have none.
    textured: Option<Box<Slots>>,
}

/// Inputs that may be textures.
#[derive(Clone, Debug)]
struct Slots {
    emission: Slot<Rgb>,
    ambient: Slot<Rgb>,
    diffuse: Slot<Rgb>,
    diffuse_weight: f32,
    specular: Slot<f32>,
    highlight_color: Slot<Rgb>,
    reflection: Slot<Rgb>,
    transparency: Slot<Rgb>,
}

impl Material for Phong {
    fn compile(&self, resolver: &mut dyn MaterialResolver) -> Result<CompiledMaterial, MaterialError> {
        self.check()?;
        let textures = resolver.textures();
        let slots = self.slots(textures)?;
        let mut fixed = PhongParameters {
            albedo_scale: 1.0 / self.diffuse_normalization.factor(),
            occlusion: self.occlusion,
            shininess: self.shininess,
            highlight: self.highlight,
            both_sides: self.both_sides,
            glossy: self.glossy.cone(),
            blurry: self.blurry.cone(),
            ior: self.ior,
            fresnel: self.fresnel,
            ..PhongParameters::BLACK
        };
        slots.fill(&mut fixed, textures, &TextureLookup::default());
        let textured = slots.any_texture().then(|| Box::new(slots));
        Ok(CompiledMaterial::Phong(CompiledPhong { fixed, textured }))
    }

    fn has_emission(&self) -> bool {
        self.emission.constant() != Some(Rgb::BLACK)
    }

    fn is_classic(&self) -> bool {
        true
    }

    fn glossy_rays(&self) -> u64 {
        u64::from(self.glossy.rays) + u64::from(self.blurry.rays)
    }
}

impl Phong {
    /// Creates a classic material of a diffuse color, without a highlight.
    pub fn new(diffuse: impl Into<Input<Rgb>>) -> Self {
        Self { diffuse: diffuse.into(), ..Self::default() }
    }

    fn check(&self) -> Result<(), MaterialError> {
        in_range("occlusion", self.occlusion, 0.0, 1.0)?;
        in_range("diffuse_weight", self.diffuse_weight, 0.0, MAX_LIGHT)?;
        in_range("shininess", self.shininess, 0.0, f32::MAX)?;
        in_range("ior", self.ior, 0.01, 100.0)?;
        in_range("glossy.half_angle_degrees", self.glossy.half_angle_degrees, 0.0, 90.0)?;
        in_range("glossy.rays", self.glossy.rays as f32, 1.0, 10_000.0)?;
        in_range("blurry.half_angle_degrees", self.blurry.half_angle_degrees, 0.0, 90.0)?;
        in_range("blurry.rays", self.blurry.rays as f32, 1.0, 10_000.0)?;
        if let Some(specular) = self.specular.constant_factor() {
            in_range("specular", specular, 0.0, MAX_LIGHT)?;
        }
        let colors = [
            ("emission", &self.emission),
            ("ambient", &self.ambient),
            ("diffuse", &self.diffuse),
            ("highlight_color", &self.highlight_color),
            ("reflection", &self.reflection),
            ("transparency", &self.transparency),
        ];
        for (field, input) in colors {
            if let Some(color) = input.constant_factor() {
                color.to_array().iter().try_for_each(|v| in_range(field, *v, 0.0, MAX_LIGHT))?;
            }
        }
        Ok(())
    }

    fn slots(&self, textures: &TextureTable) -> Result<Slots, MaterialError> {
        Ok(Slots {
            emission: textures.resolve("emission", &self.emission)?,
            ambient: textures.resolve("ambient", &self.ambient)?,
            diffuse: textures.resolve("diffuse", &self.diffuse)?,
            diffuse_weight: self.diffuse_weight * self.diffuse_normalization.factor(),
            specular: textures.resolve("specular", &self.specular)?,
            highlight_color: textures.resolve("highlight_color", &self.highlight_color)?,
            reflection: textures.resolve("reflection", &self.reflection)?,
            transparency: textures.resolve("transparency", &self.transparency)?,
        })
    }
}

impl Spread {
    /// Creates a cone of a half angle, sampled by a number of rays.
    pub fn new(half_angle_degrees: f32, rays: u32) -> Self {
        Self { half_angle_degrees, rays }
    }

    fn cone(self) -> ConeSampling {
        ConeSampling { half_angle_radians: self.half_angle_degrees.to_radians(), rays: self.rays }
    }
}

impl Slots {
    fn fill(&self, lobe: &mut PhongParameters, textures: &TextureTable, at: &TextureLookup) {
        let diffuse = textures.color(&self.diffuse, at);
        lobe.emission = textures.color(&self.emission, at);
        lobe.ambient = textures.color(&self.ambient, at) * diffuse;
        lobe.diffuse = diffuse * self.diffuse_weight;
        lobe.specular = textures.color(&self.highlight_color, at) * textures.number(&self.specular, at);
        lobe.mirror = textures.color(&self.reflection, at);
        lobe.transparency = textures.color(&self.transparency, at);
    }

    fn any_texture(&self) -> bool {
        let colors =
            [&self.emission, &self.ambient, &self.diffuse, &self.highlight_color, &self.reflection, &self.transparency];
        self.specular.is_texture() || colors.iter().any(|slot| slot.is_texture())
    }
}

impl CompiledPhong {
    /// Absorbs all light.
    pub const BLACK: Self = Self { fixed: PhongParameters::BLACK, textured: None };

    /// Parameters at a point.
    #[inline]
    pub fn eval<'m>(
        &self,
        textures: &TextureTable,
        at: impl FnOnce() -> TextureLookup<'m>,
    ) -> Cow<'_, PhongParameters> {
        let Some(slots) = &self.textured else { return Cow::Borrowed(&self.fixed) };
        let mut lobe = self.fixed;
        slots.fill(&mut lobe, textures, &at());
        Cow::Owned(lobe)
    }

    /// Transmittance for shadow rays at a point.
    pub fn shadow_transmittance<'m>(&self, textures: &TextureTable, at: impl FnOnce() -> TextureLookup<'m>) -> Rgb {
        match &self.textured {
            Some(slots) => textures.color(&slots.transparency, &at()),
            None => self.fixed.transparency,
        }
    }

    /// Emission of the surface, on both sides; `None` if it is black.
    pub fn surface_emission(&self) -> Option<SurfaceEmission> {
        let radiance = match self.textured.as_ref().map(|slots| &slots.emission) {
            Some(Slot::Texture(_) | Slot::Product(_)) => None,
            _ if self.fixed.emission.is_black() => return None,
            _ => Some(self.fixed.emission),
        };
        Some(SurfaceEmission { radiance, sides: Sides::Both })
    }

    /// Whether the parameters vary over the surface.
    pub fn is_textured(&self) -> bool {
        self.textured.is_some()
    }

    /// Whether the surface transmits light anywhere.
    pub fn is_transparent(&self) -> bool {
        let by_texture = self.textured.as_ref().is_some_and(|slots| slots.transparency.is_texture());
        by_texture || !self.fixed.transparency.is_black()
    }
}

#[cfg(any(test, feature = "testing"))]
impl Phong {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let glass = Self {
            diffuse: Rgb::BLACK.into(),
            reflection: Rgb::WHITE.into(),
            transparency: Rgb::new(0.9, 1.0, 0.9).into(),
            ior: 1.5,
            fresnel: true,
            blurry: Spread { half_angle_degrees: 30.0, rays: 64 },
            ..Self::default()
        };
        let textured = Self { diffuse: Input::Texture("tiles".into()), specular: Input::Value(1.0), ..Self::default() };
        vec![Self::default(), glass, textured]
    }
}
