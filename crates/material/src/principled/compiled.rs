//! Principled material with its names resolved.

use super::MAX_FILM_THICKNESS_NM;
use crate::input::{emitted_color, unit_color, unit_number};
use crate::medium::Interior;
use crate::roughness::rotation_turns;
use crate::{ScatteringMaterial, ShadingView};
use juggler_bsdf::{Bsdf, Principled as PrincipledLobes};
use juggler_math::Rgb;
use juggler_texture::{Slot, TextureLookup, TextureTable};

/// A [`Principled`] with its names resolved, without emission and opacity.
#[derive(Clone, Debug)]
pub struct CompiledPrincipled {
    /// Inputs that may be textures.
    pub slots: Slots,
    /// Rotation of the anisotropy in turns.
    pub rotation: Slot<f32>,
    /// Values that hold at all points; without textures, all values.
    pub fixed: PrincipledLobes,
    /// Interior of the solid; `None` if light cannot enter it.
    pub interior: Option<Interior>,
}

/// Inputs that may be textures.
#[derive(Clone, Debug)]
pub struct Slots {
    /// Colors from 0 to 1 per channel, in the order of [`Slots::fill`].
    pub colors: [Slot<Rgb>; 3],
    /// Color of the specular reflection.
    pub specular_color: Slot<Rgb>,
    /// Numbers from 0 to 1, in the order of [`Slots::fill`].
    pub numbers: [Slot<f32>; 10],
    /// Thickness of the thin film in nanometers.
    pub iridescence_thickness: Slot<f32>,
}

impl Slots {
    /// Whether any value is a texture.
    pub fn any_texture(&self) -> bool {
        let colors = self.colors.iter().any(Slot::is_texture) || self.specular_color.is_texture();
        colors || self.numbers.iter().any(Slot::is_texture) || self.iridescence_thickness.is_texture()
    }

    /// Writes the values at a point into the parameters of the lobes.
    pub fn fill(&self, lobes: &mut PrincipledLobes, textures: &TextureTable, at: &TextureLookup) {
        let number = |slot: &Slot<f32>| unit_number(textures, slot, at);
        let color = |slot: &Slot<Rgb>| unit_color(textures, slot, at);
        [lobes.base_color, lobes.sheen_color, lobes.diffuse_transmission_color] = self.colors.each_ref().map(color);
        lobes.specular_color = emitted_color(textures, &self.specular_color, at);
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
        ] = self.numbers.each_ref().map(number);
        lobes.iridescence_thickness_nm =
            textures.number(&self.iridescence_thickness, at).clamp(0.0, MAX_FILM_THICKNESS_NM);
    }
}

impl ScatteringMaterial for CompiledPrincipled {
    fn add_lobes(&self, textures: &TextureTable, view: &ShadingView, bsdf: &mut Bsdf) {
        let relative_ior = self.fixed.glass_ior() / view.outside_ior;
        if !self.is_textured() {
            return self.fixed.add_lobes(relative_ior, bsdf);
        }
        let mut lobes = self.fixed;
        self.slots.fill(&mut lobes, textures, &view.lookup());
        lobes.add_lobes(relative_ior, bsdf);
    }

    fn is_transmissive(&self) -> bool {
        let [.., transmission, diffuse_transmission] = &self.slots.numbers;
        [transmission, diffuse_transmission].iter().any(|slot| !matches!(slot, Slot::Value(0.0)))
    }

    fn is_anisotropic(&self) -> bool {
        let [_, _, _, anisotropy, ..] = &self.slots.numbers;
        !matches!(anisotropy, Slot::Value(0.0))
    }

    fn rotation_turns(&self, textures: &TextureTable, view: &ShadingView) -> Option<f32> {
        self.is_anisotropic().then(|| rotation_turns(textures, &self.rotation, view))
    }

    fn is_textured(&self) -> bool {
        self.slots.any_texture()
    }

    fn interior(&self) -> Option<Interior> {
        self.interior
    }
}
