//! Principled material: the metallic-roughness model of glTF 2.0 with its extensions.
//!
//! ```json
//! {"principled": {"base_color": [0.8, 0.1, 0.1], "roughness": 0.4, "clearcoat": 1}}
//! ```
//!
//! Fields are those of glTF and `KHR_materials_*`, with factor and texture in one: clearcoat,
//! transmission, volume, ior, specular, sheen, anisotropy, iridescence, diffuse_transmission,
//! emissive_strength. [`juggler_bsdf::principled`] states the deviations.

use super::emissive::{CompiledEmissive, EmissionCoat, Sides};
use super::error::in_range;
use super::input::{check_color, check_emission, check_number, check_unit_color, is_one, is_zero};
use super::mask::CompiledMask;
use super::normal_map::MAX_STRENGTH;
use super::roughness::rotation_slot;
use super::{CompiledMaterial, IneffectiveSetting, Material, MaterialError, MaterialResolver, SurfaceSides};
use crate::medium::{Interior, MAX_DISPERSION, Medium};
use compiled::{CoatNormals, CompiledPrincipled, Slots};
use juggler_bsdf::Principled as PrincipledLobes;
use juggler_math::{MAX_LIGHT, Rgb};
use juggler_texture::{Input, Slot, TextureLookup, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

mod compiled;

/// Metallic-roughness model of glTF 2.0 with its extensions: a mixture of metal, glass and plastic
/// under optional thin film, sheen and clearcoat. It suits most surfaces.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Principled {
    /// Base color, 0 to 1 per channel: the reflectance of metal at normal incidence, the diffuse
    /// albedo of plastic, and the tint of light that glass transmits.
    pub base_color: Input<Rgb>,
    /// Share of metal, 0 to 1. The rest is plastic or glass.
    pub metallic: Input<f32>,
    /// Roughness, 0 (mirror) to 1. The alpha of GGX is its square.
    pub roughness: Input<f32>,
    /// Index of refraction of plastic and glass, 1 to 10, or 0: then `specular_color` is the whole
    /// reflectance at normal incidence, and light enters glass without refraction, as with
    /// `KHR_materials_ior`.
    #[schemars(range(min = 0, max = 10))]
    pub ior: f32,
    /// Dispersion of the light that glass refracts: 20 divided by the Abbe number, 0 to 20. The
    /// default, 0, refracts all wavelengths alike. Only the integrator `path` shows dispersion, and
    /// spheres of dispersive glass cast no caustics of `point`, `spot` and `directional` lights.
    #[serde(skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0, max = 20))]
    pub dispersion: f32,
    /// Weight of the specular reflection of plastic and glass, 0 to 1.
    pub specular: Input<f32>,
    /// Color of the specular reflection of plastic and glass at normal incidence, 0 or more per
    /// channel. The reflectance itself is limited to 1.
    pub specular_color: Input<Rgb>,
    /// Anisotropy of the roughness, 0 to 1. Larger values elongate highlights along the surface's
    /// u.
    pub anisotropy: Input<f32>,
    /// Rotation of the anisotropy from u towards v, in full turns, -1000 to 1000.
    #[schemars(extend("x-unit" = "turns"))]
    pub anisotropy_rotation: Input<f32>,
    /// Coverage of the surface by the clearcoat, 0 (none) to 1 (complete).
    pub clearcoat: Input<f32>,
    /// Roughness of the clearcoat, 0 (mirror) to 1.
    pub clearcoat_roughness: Input<f32>,
    /// Index of refraction of the clearcoat.
    #[schemars(range(min = 1, max = 10))]
    pub clearcoat_ior: f32,
    /// Normals of the clearcoat, encoded as those of `normal_map`. They ignore normal and bump maps
    /// around this material: (0.5, 0.5, 1) makes the coat smooth over a mapped base. `null` gives
    /// the coat the normals of its base.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearcoat_normal: Option<Input<Rgb>>,
    /// Factor on the tangential components of `clearcoat_normal`, 0 to 1000. The default
    /// is 1.
    #[serde(skip_serializing_if = "is_one")]
    #[schemars(range(min = 0, max = 1000))]
    pub clearcoat_normal_scale: f32,
    /// Color of the sheen of fibers, 0 to 1 per channel. Black disables the sheen.
    pub sheen_color: Input<Rgb>,
    /// Roughness of the sheen, 0 to 1. Small values confine the sheen to grazing angles.
    pub sheen_roughness: Input<f32>,
    /// Coverage by a thin film that shows interference colors, 0 to 1.
    pub iridescence: Input<f32>,
    /// Index of refraction of the thin film.
    #[schemars(range(min = 1, max = 10))]
    pub iridescence_ior: f32,
    /// Thickness of the thin film in nanometers, 0 to 1e6.
    #[schemars(extend("x-unit" = "nm"))]
    pub iridescence_thickness: Input<f32>,
    /// Share of glass in the part that is not metal, 0 to 1. The rest is plastic.
    pub transmission: Input<f32>,
    /// Share of the diffuse light that is transmitted to the other side, 0 to 1.
    pub diffuse_transmission: Input<f32>,
    /// Color of the diffusely transmitted light, 0 to 1 per channel.
    pub diffuse_transmission_color: Input<Rgb>,
    /// Makes the surface a thin sheet: light passes straight through, and there is no interior.
    /// glTF expresses this by a thickness of 0.
    pub thin: bool,
    /// Medium inside the solid, if light can enter it. `color` and `distance` are the attenuation
    /// of glTF.
    pub medium: Medium,
    /// Priority where solids overlap: the solid of the highest priority fills the overlap (Schmidt
    /// and Budge 2002), among equals the one whose material comes first.
    pub priority: i32,
    /// Emitted radiance on all `sides`, 0 to 1e30 per channel, also after multiplication by
    /// `emissive_strength`. Black emits nothing. A clearcoat reflects some of it back.
    #[schemars(extend("x-unit" = "W/(scene unit² sr)"))]
    pub emissive: Input<Rgb>,
    /// Factor on `emissive`.
    #[schemars(range(min = 0, max = 1e30))]
    pub emissive_strength: f32,
    /// Opacity, 0 to 1: share of the light that interacts with the surface. The rest passes
    /// straight through.
    pub opacity: Input<f32>,
    /// Threshold that makes opacity binary: smaller opacities count as 0, all others as 1.
    /// Corresponds to the alpha mode `MASK` of glTF.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1))]
    pub alpha_cutoff: Option<f32>,
    /// Sides of the surface on which the material is present and emits: `both`, `front` (absent from
    /// behind) or `black_behind`. Has no effect with `transmission` or `diffuse_transmission`.
    #[serde(skip_serializing_if = "SurfaceSides::is_default")]
    pub sides: SurfaceSides,
    /// Adds the energy that single scattering between microfacets loses (Kulla and Conty 2017; on
    /// anisotropic metal within the highlight, Turquin 2019). Set it to `false` to match renderers
    /// with single scattering only, where rough metal and glass are darker.
    pub energy_compensation: bool,
}

impl Default for Principled {
    fn default() -> Self {
        Self {
            base_color: Rgb::splat(0.8).into(),
            metallic: 0.0.into(),
            roughness: 0.5.into(),
            ior: 1.5,
            dispersion: 0.0,
            specular: 1.0.into(),
            specular_color: Rgb::WHITE.into(),
            anisotropy: 0.0.into(),
            anisotropy_rotation: 0.0.into(),
            clearcoat: 0.0.into(),
            clearcoat_roughness: 0.0.into(),
            clearcoat_ior: 1.5,
            clearcoat_normal: None,
            clearcoat_normal_scale: 1.0,
            sheen_color: Rgb::BLACK.into(),
            sheen_roughness: 0.0.into(),
            iridescence: 0.0.into(),
            iridescence_ior: 1.3,
            iridescence_thickness: 400.0.into(),
            transmission: 0.0.into(),
            diffuse_transmission: 0.0.into(),
            diffuse_transmission_color: Rgb::WHITE.into(),
            thin: false,
            medium: Medium::default(),
            priority: 0,
            emissive: Rgb::BLACK.into(),
            emissive_strength: 1.0,
            opacity: 1.0.into(),
            alpha_cutoff: None,
            sides: SurfaceSides::Both,
            energy_compensation: true,
        }
    }
}

/// Whether an input differs from 0 anywhere.
fn may_be_nonzero(input: &Input<f32>) -> bool {
    input.constant() != Some(0.0)
}

/// Largest thickness of the thin film, in nanometers.
const MAX_FILM_THICKNESS_NM: f32 = 1e6;

impl Material for Principled {
    fn compile(&self, resolver: &mut dyn MaterialResolver) -> Result<CompiledMaterial, MaterialError> {
        self.check()?;
        let medium = super::boundary::compile_medium(&self.medium)?;
        let textures = resolver.textures();
        let compiled = self.surface(textures, medium)?;
        let emissive = textures.resolve("emissive", &self.emissive)?;
        let opacity = textures.resolve("opacity", &self.opacity)?;
        let coverage = textures.resolve("clearcoat", &self.clearcoat)?;
        let coat = may_be_nonzero(&self.clearcoat).then_some(EmissionCoat { coverage, ior: self.clearcoat_ior });
        let mut compiled = CompiledMaterial::scattering(compiled);
        if self.is_area_light() {
            let inner = resolver.add_nested(compiled);
            let emission = CompiledEmissive::new(emissive, self.emissive_strength, Sides::Both, inner);
            compiled = CompiledMaterial::Emissive(emission.under_coat(coat));
        }
        if self.opacity != Input::Value(1.0) {
            let inner = resolver.add_nested(compiled);
            compiled = CompiledMaterial::Mask(CompiledMask::new(opacity, self.alpha_cutoff, inner));
        }
        let sides = if self.transmission_field().is_some() { SurfaceSides::Both } else { self.sides };
        Ok(sides.restrict(compiled, resolver))
    }

    fn ineffective_settings(&self) -> Vec<IneffectiveSetting> {
        let replaced_by = self.transmission_field().filter(|_| self.sides != SurfaceSides::Both);
        let sides = replaced_by.map(|replaced_by| IneffectiveSetting { field: "sides", replaced_by });
        let is_achromatic = self.thin && self.dispersion > 0.0;
        let dispersion = is_achromatic.then_some(IneffectiveSetting { field: "dispersion", replaced_by: "thin" });
        sides.into_iter().chain(dispersion).collect()
    }

    fn is_area_light(&self) -> bool {
        self.emissive_strength > 0.0 && self.emissive.constant() != Some(Rgb::BLACK)
    }

    fn scale_distances(&mut self, factor: f32) {
        self.medium.scale_distances(factor);
    }
}

impl Principled {
    /// Creates a material of a base color: a plastic until other fields are set.
    pub fn new(base_color: impl Into<Input<Rgb>>) -> Self {
        Self { base_color: base_color.into(), ..Self::default() }
    }

    fn check(&self) -> Result<(), MaterialError> {
        for (field, input) in self.colors() {
            check_unit_color(field, input)?;
        }
        for (field, input) in self.numbers() {
            check_number(field, input, 0.0, 1.0)?;
        }
        check_color("specular_color", &self.specular_color, MAX_LIGHT)?;
        check_number("iridescence_thickness", &self.iridescence_thickness, 0.0, MAX_FILM_THICKNESS_NM)?;
        check_number("opacity", &self.opacity, 0.0, 1.0)?;
        check_emission("emissive", &self.emissive, "emissive_strength", self.emissive_strength)?;
        in_range("alpha_cutoff", self.alpha_cutoff.unwrap_or_default(), 0.0, 1.0)?;
        if self.ior != 0.0 {
            in_range("ior", self.ior, 1.0, 10.0)?;
        }
        in_range("dispersion", self.dispersion, 0.0, MAX_DISPERSION)?;
        if let Some(normal) = &self.clearcoat_normal {
            check_unit_color("clearcoat_normal", normal)?;
        }
        in_range("clearcoat_normal_scale", self.clearcoat_normal_scale, 0.0, MAX_STRENGTH)?;
        in_range("clearcoat_ior", self.clearcoat_ior, 1.0, 10.0)?;
        in_range("iridescence_ior", self.iridescence_ior, 1.0, 10.0)
    }

    /// Colors from 0 to 1 per channel, in the order of [`Slots::fill`].
    fn colors(&self) -> [(&'static str, &Input<Rgb>); 3] {
        [
            ("base_color", &self.base_color),
            ("sheen_color", &self.sheen_color),
            ("diffuse_transmission_color", &self.diffuse_transmission_color),
        ]
    }

    /// Numbers from 0 to 1, in the order of [`Slots::fill`].
    fn numbers(&self) -> [(&'static str, &Input<f32>); 10] {
        [
            ("metallic", &self.metallic),
            ("roughness", &self.roughness),
            ("specular", &self.specular),
            ("anisotropy", &self.anisotropy),
            ("clearcoat", &self.clearcoat),
            ("clearcoat_roughness", &self.clearcoat_roughness),
            ("sheen_roughness", &self.sheen_roughness),
            ("iridescence", &self.iridescence),
            ("transmission", &self.transmission),
            ("diffuse_transmission", &self.diffuse_transmission),
        ]
    }

    /// Field by which light passes through the surface, if any.
    fn transmission_field(&self) -> Option<&'static str> {
        let fields = [("transmission", &self.transmission), ("diffuse_transmission", &self.diffuse_transmission)];
        fields.into_iter().find(|(_, input)| may_be_nonzero(input)).map(|(field, _)| field)
    }

    /// Whether light can enter the solid: by refraction, or by diffuse transmission into a medium.
    fn has_interior(&self, medium: &Medium) -> bool {
        !self.thin
            && (may_be_nonzero(&self.transmission)
                || (may_be_nonzero(&self.diffuse_transmission) && !medium.is_clear()))
    }

    fn surface(&self, textures: &TextureTable, medium: Medium) -> Result<CompiledPrincipled, MaterialError> {
        let slots = self.slots(textures)?;
        let mut fixed = PrincipledLobes {
            ior: self.ior,
            clearcoat_ior: self.clearcoat_ior,
            iridescence_ior: self.iridescence_ior,
            thin_walled: self.thin,
            is_open: [&self.transmission, &self.diffuse_transmission].into_iter().any(may_be_nonzero),
            is_refracting: may_be_nonzero(&self.transmission),
            single_scattering: !self.energy_compensation,
            ..PrincipledLobes::default()
        };
        if !slots.any_texture() {
            slots.fill(&mut fixed, textures, &TextureLookup::default());
        }
        let interior =
            Interior { ior: fixed.glass_ior(), dispersion: self.dispersion, priority: self.priority, medium };
        let interior = self.has_interior(&medium).then_some(interior);
        let rotation = rotation_slot(textures, &self.anisotropy_rotation)?;
        let coat_normals = self.coat_normals(textures)?;
        Ok(CompiledPrincipled { slots, rotation, fixed, coat_normals, interior })
    }

    fn coat_normals(&self, textures: &TextureTable) -> Result<Option<CoatNormals>, MaterialError> {
        let Some(normal) = &self.clearcoat_normal else { return Ok(None) };
        let texture = textures.resolve("clearcoat_normal", normal)?;
        let normals = CoatNormals { texture, scale: self.clearcoat_normal_scale };
        Ok(may_be_nonzero(&self.clearcoat).then_some(normals))
    }

    fn slots(&self, textures: &TextureTable) -> Result<Slots, MaterialError> {
        let mut slots = Slots {
            colors: [const { Slot::Value(Rgb::BLACK) }; 3],
            specular_color: textures.resolve("specular_color", &self.specular_color)?,
            numbers: [const { Slot::Value(0.0) }; 10],
            iridescence_thickness: textures.resolve("iridescence_thickness", &self.iridescence_thickness)?,
        };
        for (slot, (field, input)) in slots.colors.iter_mut().zip(self.colors()) {
            *slot = textures.resolve(field, input)?;
        }
        for (slot, (field, input)) in slots.numbers.iter_mut().zip(self.numbers()) {
            *slot = textures.resolve(field, input)?;
        }
        Ok(slots)
    }
}

#[cfg(any(test, feature = "testing"))]
impl Principled {
    /// Examples for the contract tests.
    pub fn examples() -> Vec<Self> {
        let tiles = || Input::Texture("tiles".into());
        let gold = Self { metallic: 1.0.into(), base_color: Rgb::new(1.0, 0.7, 0.3).into(), ..Self::default() };
        let brushed = Self { anisotropy: 0.6.into(), anisotropy_rotation: 0.1.into(), ..gold.clone() };
        let medium = Medium { color: Rgb::new(0.9, 0.4, 0.2), distance: 0.5, ..Medium::default() };
        let amber = Self { transmission: 1.0.into(), roughness: 0.1.into(), medium, priority: 2, ..Self::default() };
        let pane = Self { thin: true, iridescence: 0.5.into(), opacity: 0.5.into(), ..amber.clone() };
        let petal = Self { diffuse_transmission: 0.7.into(), sheen_color: Rgb::splat(0.3).into(), ..Self::default() };
        let wax = Self { diffuse_transmission: 1.0.into(), medium, ..Self::default() };
        let all = Self {
            base_color: Input::Texture("wild".into()),
            metallic: tiles(),
            roughness: Input::Texture("wild".into()),
            specular_color: Input::Texture("wild".into()),
            clearcoat: tiles(),
            clearcoat_normal: Some(Input::Texture("wild".into())),
            anisotropy: tiles(),
            transmission: tiles(),
            emissive: Input::Texture("tiles".into()),
            emissive_strength: 5.0,
            opacity: tiles(),
            alpha_cutoff: Some(0.1),
            ..Self::default()
        };
        let lacquer = Self {
            clearcoat: 1.0.into(),
            clearcoat_roughness: 0.2.into(),
            clearcoat_normal: Some(Rgb::new(0.56, 0.45, 0.98).into()),
            ..gold.clone()
        };
        let emitter = Self { emissive: Rgb::new(2.0, 1.0, 0.5).into(), ..gold.clone() };
        let mut all = vec![Self::default(), gold, brushed, amber, pane, petal, wax, all, lacquer];
        all.extend(emitter.surface_examples());
        all
    }

    /// This emitter, and materials with emission, opacity and other sides.
    fn surface_examples(self) -> [Self; 6] {
        let emitter = self;
        let coated = Self { clearcoat: 0.7.into(), clearcoat_ior: 1.8, ..emitter.clone() };
        let mirror = Self { ior: 0.0, specular_color: Rgb::new(0.9, 0.5, 0.1).into(), ..Self::default() };
        let products = Self {
            base_color: Input::product("wild", Rgb::new(1.0, 0.5, 0.0)),
            roughness: Input::product("wild", 0.5),
            transmission: Input::product("tiles", 0.0),
            emissive: Input::product("tiles", Rgb::splat(2.0)),
            opacity: Input::product("wild", 0.75),
            ..Self::default()
        };
        let [front, black_behind] = [SurfaceSides::Front, SurfaceSides::BlackBehind].map(|sides| Self {
            sides,
            opacity: 0.7.into(),
            ..emitter.clone()
        });
        [emitter, coated, mirror, products, front, black_behind]
    }
}
