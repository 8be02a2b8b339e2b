//! Principled material with its names resolved.

use super::MAX_FILM_THICKNESS_NM;
use crate::input::{emitted_color, unit_color, unit_number};
use crate::medium::Interior;
use crate::normal_map::{UNCHANGED_NORMAL, mapped_normal};
use crate::roughness::rotation_turns;
use crate::shading::facing_normal;
use crate::{ScatteringMaterial, ShadingView};
use juggler_bsdf::{Bsdf, Principled as PrincipledLobes};
use juggler_math::{Frame, Rgb, Vec3};
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
    /// Normals of the clearcoat, if they are its own.
    pub coat_normals: Option<CoatNormals>,
    /// Interior of the solid; `None` if light cannot enter it.
    pub interior: Option<Interior>,
}

/// Normals of a clearcoat that ignores the normal maps of the layers below it.
#[derive(Clone, Debug)]
pub struct CoatNormals {
    /// Normals, encoded as in a normal map.
    pub texture: Slot<Rgb>,
    /// Factor on their tangential components.
    pub scale: f32,
}

impl CoatNormals {
    /// Whether the normals differ from those of the surface.
    fn is_mapped(&self) -> bool {
        !matches!(self.texture, Slot::Value(UNCHANGED_NORMAL))
    }

    /// Unit normal in world space, on the viewer's side.
    fn normal(&self, textures: &TextureTable, view: &ShadingView) -> Vec3 {
        let color = unit_color(textures, &self.texture, &view.lookup());
        facing_normal(view, mapped_normal(color, self.scale, view.surface.shading_normal, view))
    }
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
    fn add_lobes(&self, textures: &TextureTable, view: &ShadingView, frame: &Frame, bsdf: &mut Bsdf) {
        let relative_ior = self.fixed.glass_ior() / view.outside_ior;
        if !self.is_textured() {
            return self.fixed.add_lobes(relative_ior, bsdf);
        }
        let mut lobes = self.fixed;
        self.slots.fill(&mut lobes, textures, &view.lookup());
        if let Some(coat) = &self.coat_normals {
            let sign = if self.interior.is_some() && !view.is_outside() { -1.0 } else { 1.0 };
            lobes.clearcoat_normal = frame.to_local(coat.normal(textures, view)) * sign;
        }
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
        self.slots.any_texture() || self.coat_normals.is_some()
    }

    fn has_normal_map(&self) -> bool {
        self.coat_normals.as_ref().is_some_and(CoatNormals::is_mapped)
    }

    fn interior(&self) -> Option<Interior> {
        self.interior
    }
}
