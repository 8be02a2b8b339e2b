//! The material that glTF 2.0 describes: metal or not, by roughness, with its extensions.
//!
//! ```json
//! {"principled": {"base_color": [0.8, 0.1, 0.1], "roughness": 0.4, "clearcoat": 1}}
//! ```
//!
//! Fields are those of glTF and of `KHR_materials_*`, factor and texture in one: clearcoat, transmission, volume, ior,
//! specular, sheen, anisotropy, iridescence, diffuse_transmission, emissive_strength. What differs is told in
//! [`juggler_bsdf::principled`].

use super::emissive::{CompiledEmissive, Sides};
use super::error::in_range;
use super::input::{check_color, check_light, check_number, check_share, fraction, light, share};
use super::mask::CompiledMask;
use super::roughness::{rotation_slot, turns};
use super::{Compiled, Material, MaterialError, Resolver, ScatteringMaterial, View};
use crate::medium::{Interior, Medium};
use juggler_bsdf::{Bsdf, Principled as PrincipledLobes};
use juggler_math::{MAX_LIGHT, Rgb};
use juggler_texture::{Input, Lookup, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What most surfaces are, by a few numbers and colours: glTF's metallic-roughness model and its extensions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Principled {
    /// Colour of metal head on, of plastic's body, and of light that goes through glass.
    pub base_color: Input<Rgb>,
    /// Share of metal, 0 to 1.
    pub metallic: Input<f32>,
    /// 0 for a mirror, 1 for the roughest; the width of GGX is its square.
    pub roughness: Input<f32>,
    /// Index of refraction of what is not metal.
    #[schemars(range(min = 1, max = 10))]
    pub ior: f32,
    /// Weight of what is mirrored by what is not metal.
    pub specular: Input<f32>,
    /// Its colour head on.
    pub specular_color: Input<Rgb>,
    /// Stretches highlights along the surface's u, 0 to 1.
    pub anisotropy: Input<f32>,
    /// Turns that direction from u towards v, in whole turns.
    pub anisotropy_rotation: Input<f32>,
    /// Share that a clear coat covers, 0 to 1.
    pub clearcoat: Input<f32>,
    /// Roughness of the coat.
    pub clearcoat_roughness: Input<f32>,
    /// Index of refraction of the coat.
    #[schemars(range(min = 1, max = 10))]
    pub clearcoat_ior: f32,
    /// Colour of fibres on top: black for none.
    pub sheen_color: Input<Rgb>,
    /// Roughness of the fibres.
    pub sheen_roughness: Input<f32>,
    /// Share that a thin film covers, 0 to 1.
    pub iridescence: Input<f32>,
    /// Index of refraction of the film.
    #[schemars(range(min = 1, max = 10))]
    pub iridescence_ior: f32,
    /// Thickness of the film in nanometres.
    pub iridescence_thickness: Input<f32>,
    /// Share of glass in what is not metal, 0 to 1.
    pub transmission: Input<f32>,
    /// Share of the body's light that comes out on the other side, 0 to 1.
    pub diffuse_transmission: Input<f32>,
    /// Colour of that light.
    pub diffuse_transmission_color: Input<Rgb>,
    /// A sheet, whose two sides are one surface: light goes straight through, and there is no inside. glTF means that
    /// with a thickness of 0.
    pub thin: bool,
    /// What is inside, where light comes there: `color` and `distance` are glTF's attenuation.
    pub medium: Medium,
    /// Where solids overlap, the one with the highest priority is there.
    pub priority: i32,
    /// Radiance given off to both sides.
    pub emissive: Input<Rgb>,
    /// Factor on that.
    #[schemars(range(min = 0, max = 1e30))]
    pub emissive_strength: f32,
    /// Share of light that meets the surface, 0 to 1; the rest passes as if nothing were there.
    pub opacity: Input<f32>,
    /// What is less opaque is not there at all, and what is as opaque or more is there wholly: glTF's alpha mode `MASK`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1))]
    pub alpha_cutoff: Option<f32>,
    /// Gives back what light loses between the grooves of a rough surface. Off, as most renderers have it, rough metal and
    /// glass are darker.
    pub energy_compensation: bool,
}

impl Default for Principled {
    fn default() -> Self {
        Self {
            base_color: Rgb::splat(0.8).into(),
            metallic: 0.0.into(),
            roughness: 0.5.into(),
            ior: 1.5,
            specular: 1.0.into(),
            specular_color: Rgb::WHITE.into(),
            anisotropy: 0.0.into(),
            anisotropy_rotation: 0.0.into(),
            clearcoat: 0.0.into(),
            clearcoat_roughness: 0.0.into(),
            clearcoat_ior: 1.5,
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
            energy_compensation: true,
        }
    }
}

/// Whether a share is anything but 0 everywhere.
fn may(input: &Input<f32>) -> bool {
    *input != Input::Value(0.0)
}

/// The thickest film, nanometres.
const THICKEST_FILM: f32 = 1e6;

/// A [`Principled`] with its names looked up, but for what it gives off and its holes.
#[derive(Clone, Debug)]
pub struct CompiledPrincipled {
    slots: Slots,
    rotation: Slot<f32>,
    /// What is the same everywhere.
    fixed: PrincipledLobes,
    /// What is inside; nothing where light does not come there.
    pub interior: Option<Interior>,
}

/// What may be a texture.
#[derive(Clone, Debug)]
struct Slots {
    colors: [Slot<Rgb>; 3],
    specular_color: Slot<Rgb>,
    numbers: [Slot<f32>; 10],
    film: Slot<f32>,
}

impl Material for Principled {
    fn compile(&self, resolver: &mut dyn Resolver) -> Result<Compiled, MaterialError> {
        self.check()?;
        let medium = super::boundary::checked(&self.medium)?;
        let textures = resolver.textures();
        let compiled = self.surface(textures, medium)?;
        let emissive = textures.resolve("emissive", &self.emissive)?;
        let opacity = textures.resolve("opacity", &self.opacity)?;
        let mut compiled = Compiled::scattering(compiled);
        if self.is_emitter() {
            let inner = resolver.within(compiled);
            compiled = Compiled::Emissive(CompiledEmissive::new(emissive, self.emissive_strength, Sides::Both, inner));
        }
        if self.opacity != Input::Value(1.0) {
            let inner = resolver.within(compiled);
            compiled = Compiled::Mask(CompiledMask::new(opacity, self.alpha_cutoff, inner));
        }
        Ok(compiled)
    }

    fn is_emitter(&self) -> bool {
        self.emissive_strength > 0.0 && !matches!(&self.emissive, Input::Value(color) if color.is_black())
    }
}

impl Principled {
    fn check(&self) -> Result<(), MaterialError> {
        for (field, input) in self.colors() {
            check_share(field, input)?;
        }
        for (field, input) in self.numbers() {
            check_number(field, input, 0.0, 1.0)?;
        }
        check_color("specular_color", &self.specular_color, MAX_LIGHT)?;
        check_number("iridescence_thickness", &self.iridescence_thickness, 0.0, THICKEST_FILM)?;
        check_number("opacity", &self.opacity, 0.0, 1.0)?;
        check_light("emissive", &self.emissive, "emissive_strength", self.emissive_strength)?;
        in_range("alpha_cutoff", self.alpha_cutoff.unwrap_or_default(), 0.0, 1.0)?;
        in_range("ior", self.ior, 1.0, 10.0)?;
        in_range("clearcoat_ior", self.clearcoat_ior, 1.0, 10.0)?;
        in_range("iridescence_ior", self.iridescence_ior, 1.0, 10.0)
    }

    /// Colours whose channels are shares, in the order of [`Slots::fill`].
    fn colors(&self) -> [(&'static str, &Input<Rgb>); 3] {
        [
            ("base_color", &self.base_color),
            ("sheen_color", &self.sheen_color),
            ("diffuse_transmission_color", &self.diffuse_transmission_color),
        ]
    }

    /// Numbers that are shares, in the order of [`Slots::fill`].
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

    /// Whether light may come in: by refraction, or to be scattered or coloured inside.
    fn has_inside(&self, medium: &Medium) -> bool {
        !self.thin && (may(&self.transmission) || (may(&self.diffuse_transmission) && !medium.is_clear()))
    }

    fn surface(&self, textures: &TextureTable, medium: Medium) -> Result<CompiledPrincipled, MaterialError> {
        let slots = self.slots(textures)?;
        let mut fixed = PrincipledLobes {
            ior: self.ior,
            clearcoat_ior: self.clearcoat_ior,
            iridescence_ior: self.iridescence_ior,
            thin_walled: self.thin,
            is_open: [&self.transmission, &self.diffuse_transmission].into_iter().any(may),
            is_refracting: may(&self.transmission),
            single_scattering: !self.energy_compensation,
            ..PrincipledLobes::default()
        };
        if !slots.any_texture() {
            slots.fill(&mut fixed, textures, &Lookup::default());
        }
        let inside = Interior { ior: self.ior, priority: self.priority, medium };
        let interior = self.has_inside(&medium).then_some(inside);
        let rotation = rotation_slot(textures, &self.anisotropy_rotation)?;
        Ok(CompiledPrincipled { slots, rotation, fixed, interior })
    }

    fn slots(&self, textures: &TextureTable) -> Result<Slots, MaterialError> {
        let mut slots = Slots {
            colors: [Slot::Value(Rgb::BLACK); 3],
            specular_color: textures.resolve("specular_color", &self.specular_color)?,
            numbers: [Slot::Value(0.0); 10],
            film: textures.resolve("iridescence_thickness", &self.iridescence_thickness)?,
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

impl Slots {
    fn any_texture(&self) -> bool {
        let colors = self.colors.iter().any(Slot::is_texture) || self.specular_color.is_texture();
        colors || self.numbers.iter().any(Slot::is_texture) || self.film.is_texture()
    }

    fn fill(&self, lobes: &mut PrincipledLobes, textures: &TextureTable, at: &Lookup) {
        let number = |slot: Slot<f32>| fraction(textures, &slot, at);
        let color = |slot: Slot<Rgb>| share(textures, &slot, at);
        [lobes.base_color, lobes.sheen_color, lobes.diffuse_transmission_color] = self.colors.map(color);
        lobes.specular_color = light(textures, &self.specular_color, at);
        [
            lobes.metallic,
            lobes.roughness,
            lobes.specular,
            lobes.anisotropy,
            lobes.clearcoat,
            lobes.clearcoat_roughness,
            lobes.sheen_roughness,
            lobes.iridescence,
            lobes.transmission,
            lobes.diffuse_transmission,
        ] = self.numbers.map(number);
        lobes.iridescence_thickness_nm = textures.number(&self.film, at).clamp(0.0, THICKEST_FILM);
    }
}

impl ScatteringMaterial for CompiledPrincipled {
    fn add_lobes(&self, textures: &TextureTable, view: &View, bsdf: &mut Bsdf) {
        let relative_ior = self.fixed.ior / view.around_ior;
        if !self.is_textured() {
            return self.fixed.add_lobes(relative_ior, bsdf);
        }
        let mut lobes = self.fixed;
        self.slots.fill(&mut lobes, textures, &view.lookup());
        lobes.add_lobes(relative_ior, bsdf);
    }

    fn is_transmissive(&self) -> bool {
        let [.., transmission, diffuse_transmission] = self.slots.numbers;
        [transmission, diffuse_transmission].iter().any(|slot| !matches!(slot, Slot::Value(0.0)))
    }

    fn is_stretched(&self) -> bool {
        let [_, _, _, anisotropy, ..] = self.slots.numbers;
        !matches!(anisotropy, Slot::Value(0.0))
    }

    fn turns(&self, textures: &TextureTable, view: &View) -> Option<f32> {
        self.is_stretched().then(|| turns(textures, &self.rotation, view))
    }

    fn is_textured(&self) -> bool {
        self.slots.any_texture()
    }

    fn interior(&self) -> Option<Interior> {
        self.interior
    }
}

#[cfg(any(test, feature = "testing"))]
impl Principled {
    /// For the contract tests.
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
            anisotropy: tiles(),
            transmission: tiles(),
            emissive: Input::Texture("tiles".into()),
            emissive_strength: 5.0,
            opacity: tiles(),
            alpha_cutoff: Some(0.1),
            ..Self::default()
        };
        let lamp = Self { emissive: Rgb::new(2.0, 1.0, 0.5).into(), ..gold.clone() };
        vec![Self::default(), gold, brushed, amber, pane, petal, wax, all, lamp]
    }
}
