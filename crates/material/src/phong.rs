//! The classic material: ambient, diffuse and specular light (Phong 1975), mirrors and glass (Whitted 1980),
//! glossy and blurry ones (Cook, Porter and Carpenter 1984).
//!
//! ```json
//! {"phong": {"diffuse": "#c02020", "specular": 1, "shininess": 20, "reflection": 0.2}}
//! ```
//!
//! With n the normal, l the direction to a light of radiance L, v the direction to the viewer, r = l mirrored
//! at n, the light given off is
//!
//! emission + `ambient` · `diffuse` · ambient light
//! \+ Σ L (`diffuse_weight` · `diffuse` · (n · l) + `specular` · `highlight_color` · (r · v)^`shininess`)
//! \+ `reflection` · mirrored ray + `transparency` · ray that goes through.
//!
//! The Juggler's reflection weight and colour are one product here, as are the teaching engine's kR, kT (numbers
//! or colours per channel); its kD stands in `diffuse`, its kS in `highlight_color` with `specular` 1.

use super::error::in_range;
use super::{Compiled, Glow, Material, MaterialError, Resolver, Sides};
use juggler_bsdf::{Cone, Highlight, Phong as PhongLobe};
use juggler_math::{MAX_LIGHT, Rgb};
use juggler_texture::{Input, Lookup, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// The classic material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Phong {
    /// Light given off, whatever falls on it.
    pub emission: Input<Rgb>,
    /// Share of the ambient light; a factor on `diffuse`.
    pub ambient: Input<Rgb>,
    /// Share of the ambient light that nearby geometry takes away, where the integrator looks for it.
    #[schemars(range(min = 0, max = 1))]
    pub occlusion: f32,
    /// Colour of ambient and diffuse light.
    pub diffuse: Input<Rgb>,
    /// Weight of diffuse light.
    #[schemars(range(min = 0, max = 1e30))]
    pub diffuse_weight: f32,
    /// A further factor on diffuse light.
    pub diffuse_normalization: DiffuseNormalization,
    /// Weight of the highlight.
    pub specular: Input<f32>,
    /// Colour of the highlight.
    pub highlight_color: Input<Rgb>,
    /// Exponent of the highlight: the larger, the smaller.
    #[schemars(range(min = 0))]
    pub shininess: f32,
    /// How the highlight is weighted.
    pub highlight: Highlight,
    /// Share of mirrored light, per channel.
    pub reflection: Input<Rgb>,
    /// Spreads the mirrored ray.
    pub glossy: Spread,
    /// Share of light that goes through, per channel; shadows keep the same share.
    pub transparency: Input<Rgb>,
    /// Spreads the ray that goes through.
    pub blurry: Spread,
    /// Index of refraction inside over outside; 1 goes straight on, glass has 1.5.
    #[schemars(range(min = 0.01, max = 100))]
    pub ior: f32,
    /// Shares light between `reflection` and `transparency` by Fresnel's equations: at a flat angle a window
    /// is a mirror.
    pub fresnel: bool,
    /// Lit from either side, whoever looks: for paper-thin surfaces.
    pub both_sides: bool,
}

/// A further factor on diffuse light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DiffuseNormalization {
    /// None: light of radiance 1 that falls straight on a white surface makes it white.
    #[default]
    One,
    /// 1/π: light is measured as irradiance.
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

/// Spreads a ray into a bundle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Spread {
    /// Half of the cone's opening angle; 0 for a sharp image.
    #[schemars(range(min = 0, max = 90))]
    pub half_angle_degrees: f32,
    /// Rays per sample.
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

/// A [`Phong`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledPhong {
    /// All that does not change from point to point; without textures, everything.
    fixed: PhongLobe,
    /// What textures are part of; boxed, for most materials have none.
    textured: Option<Box<Slots>>,
}

/// The inputs that may be textures.
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
    fn compile(&self, resolver: &mut dyn Resolver) -> Result<Compiled, MaterialError> {
        self.check()?;
        let textures = resolver.textures();
        let slots = self.slots(textures)?;
        let mut fixed = PhongLobe {
            albedo_scale: 1.0 / self.diffuse_normalization.factor(),
            occlusion: self.occlusion,
            shininess: self.shininess,
            highlight: self.highlight,
            both_sides: self.both_sides,
            glossy: self.glossy.cone(),
            blurry: self.blurry.cone(),
            ior: self.ior,
            fresnel: self.fresnel,
            ..PhongLobe::BLACK
        };
        slots.fill(&mut fixed, textures, &Lookup::default());
        let textured = slots.any_texture().then(|| Box::new(slots));
        Ok(Compiled::Phong(CompiledPhong { fixed, textured }))
    }

    fn has_emission(&self) -> bool {
        !matches!(&self.emission, Input::Value(color) if color.is_black())
    }

    fn is_classic(&self) -> bool {
        true
    }

    fn glossy_rays(&self) -> u64 {
        u64::from(self.glossy.rays) + u64::from(self.blurry.rays)
    }
}

impl Phong {
    fn check(&self) -> Result<(), MaterialError> {
        in_range("occlusion", self.occlusion, 0.0, 1.0)?;
        in_range("diffuse_weight", self.diffuse_weight, 0.0, MAX_LIGHT)?;
        in_range("shininess", self.shininess, 0.0, f32::MAX)?;
        in_range("ior", self.ior, 0.01, 100.0)?;
        in_range("glossy.half_angle_degrees", self.glossy.half_angle_degrees, 0.0, 90.0)?;
        in_range("glossy.rays", self.glossy.rays as f32, 1.0, 10_000.0)?;
        in_range("blurry.half_angle_degrees", self.blurry.half_angle_degrees, 0.0, 90.0)?;
        in_range("blurry.rays", self.blurry.rays as f32, 1.0, 10_000.0)?;
        if let Input::Value(specular) = self.specular {
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
            if let Input::Value(color) = input {
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
    fn cone(self) -> Cone {
        Cone { half_angle_radians: self.half_angle_degrees.to_radians(), rays: self.rays }
    }
}

impl Slots {
    fn fill(&self, lobe: &mut PhongLobe, textures: &TextureTable, at: &Lookup) {
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
    /// Takes all light and gives none back.
    pub const BLACK: Self = Self { fixed: PhongLobe::BLACK, textured: None };

    /// The numbers at a point.
    #[inline]
    pub fn eval(&self, textures: &TextureTable, at: impl FnOnce() -> Lookup) -> Cow<'_, PhongLobe> {
        let Some(slots) = &self.textured else { return Cow::Borrowed(&self.fixed) };
        let mut lobe = self.fixed;
        slots.fill(&mut lobe, textures, &at());
        Cow::Owned(lobe)
    }

    /// What a shadow ray keeps at a point.
    pub fn filter(&self, textures: &TextureTable, at: impl FnOnce() -> Lookup) -> Rgb {
        match &self.textured {
            Some(slots) => textures.color(&slots.transparency, &at()),
            None => self.fixed.transparency,
        }
    }

    /// How it shines, if it does: to both sides.
    pub fn glow(&self) -> Option<Glow> {
        let radiance = match self.textured.as_ref().map(|slots| &slots.emission) {
            Some(Slot::Texture(_)) => None,
            _ if self.fixed.emission.is_black() => return None,
            _ => Some(self.fixed.emission),
        };
        Some(Glow { radiance, sides: Sides::Both })
    }

    /// Whether it differs from place to place.
    pub fn is_textured(&self) -> bool {
        self.textured.is_some()
    }

    /// Whether light gets through anywhere.
    pub fn is_transparent(&self) -> bool {
        let by_texture = self.textured.as_ref().is_some_and(|slots| slots.transparency.is_texture());
        by_texture || !self.fixed.transparency.is_black()
    }
}

#[cfg(any(test, feature = "testing"))]
impl Phong {
    /// For the contract tests.
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
