//! All materials of a world, ready to be asked.

use super::shade::facing_normal;
use super::{Compiled, Glow, MaterialId, ScatteringMaterial, Shade, View, lookup, tangent};
use crate::medium::{Interior, InteriorId};
use juggler_bsdf::Phong as PhongLobe;
use juggler_math::{Frame, Rgb};
use juggler_shape::surface::Surface;
use juggler_texture::{Lookup, TextureTable};
use std::borrow::Cow;

/// All materials of a world by number, with the textures they use. Made by a
/// [`MaterialCompiler`](super::MaterialCompiler).
#[derive(Clone, Debug, Default)]
pub struct MaterialTable {
    /// A material refers only to earlier ones.
    materials: Vec<Compiled>,
    facts: Vec<Facts>,
    interiors: Vec<Interior>,
    textures: TextureTable,
}

/// What holds for a material wherever it is asked.
#[derive(Clone, Copy, Debug)]
struct Facts {
    /// The classic integrator's shadow rays may come through somewhere.
    transparent: bool,
    /// Light may pass as if nothing were there.
    holes: bool,
    /// It differs from place to place.
    textured: bool,
    /// It must know how the surface runs along its coordinates.
    tangents: bool,
    /// How it shines, if it does.
    glow: Option<Glow>,
    /// What is behind it.
    interior: Option<InteriorId>,
}

impl Facts {
    const NONE: Self =
        Self { transparent: false, holes: false, textured: false, tangents: false, glow: None, interior: None };
}

impl MaterialTable {
    pub(super) fn new(textures: TextureTable) -> Self {
        Self { textures, ..Self::default() }
    }

    pub(super) fn push(&mut self, compiled: Compiled) -> MaterialId {
        let parts = compiled.parts();
        let any = |fact: fn(&Facts) -> bool| parts.iter().any(|part| fact(&self.facts(*part)));
        let holes = match &compiled {
            Compiled::Mask(material) => !material.is_solid(),
            Compiled::Boundary(_) => true,
            _ => false,
        };
        let classic = matches!(&compiled, Compiled::Phong(material) if material.is_transparent());
        let holes = holes || any(|part| part.holes);
        let tangents = compiled.needs_tangents() || any(|part| part.tangents);
        let facts = Facts {
            transparent: holes || classic || any(|part| part.transparent),
            holes,
            // Tangents are found by the point in object space, which is left out where nothing differs.
            textured: tangents || compiled.is_textured() || any(|part| part.textured),
            tangents,
            // What shines has the same radiance everywhere only where it is there for sure.
            glow: self.glow_of(&compiled).map(|glow| if holes { glow.somewhere() } else { glow }),
            interior: None,
        };
        let interior = self.interior_of(&compiled, &parts);
        self.facts.push(Facts { interior, ..facts });
        self.materials.push(compiled);
        MaterialId(u32::try_from(self.materials.len() - 1).unwrap_or(u32::MAX))
    }

    /// The textures that its materials use.
    #[inline]
    pub fn textures(&self) -> &TextureTable {
        &self.textures
    }

    /// What a material has become; `None` for a number that is no material.
    pub(super) fn compiled(&self, id: MaterialId) -> Option<&Compiled> {
        self.materials.get(id.0 as usize)
    }

    fn facts(&self, id: MaterialId) -> Facts {
        self.facts.get(id.0 as usize).copied().unwrap_or(Facts::NONE)
    }

    /// What is behind a material: of several, what the first has.
    fn interior_of(&mut self, compiled: &Compiled, parts: &[MaterialId]) -> Option<InteriorId> {
        if let Some(interior) = compiled.interior() {
            let id = InteriorId::new(self.interiors.len())?;
            self.interiors.push(interior);
            return Some(id);
        }
        parts.iter().find_map(|part| self.facts(*part).interior)
    }

    /// What is behind material `id`, if light comes there.
    #[inline]
    pub fn interior(&self, id: MaterialId) -> Option<InteriorId> {
        self.facts(id).interior
    }

    /// All that is behind materials.
    #[inline]
    pub fn interiors(&self) -> &[Interior] {
        &self.interiors
    }

    fn glow_of(&self, compiled: &Compiled) -> Option<Glow> {
        let glows = || compiled.parts().into_iter().filter_map(|part| self.facts(part).glow);
        match compiled {
            Compiled::Phong(phong) => phong.glow(),
            Compiled::Scattering(_) | Compiled::Boundary(_) => None,
            Compiled::Emissive(emissive) => match glows().next() {
                None => Some(emissive.glow()).filter(|glow| glow.radiance.is_none_or(|light| !light.is_black())),
                Some(other) => Some(emissive.glow().and(other).somewhere()),
            },
            Compiled::NormalMap(_) | Compiled::BumpMap(_) => glows().next(),
            Compiled::Checkerboard(_) | Compiled::Mix(_) | Compiled::Mask(_) => {
                glows().reduce(Glow::and).map(Glow::somewhere)
            }
        }
    }

    /// How material `id` shines, if it does anywhere.
    pub fn glow(&self, id: MaterialId) -> Option<Glow> {
        self.facts(id).glow
    }

    /// The numbers of the classic material `id` at a point of a surface (world space, normals as the shape gives them), its
    /// patterns as sharp as they are;
    /// `None` for a material of another kind, black for a number that is no material.
    #[inline]
    pub fn phong(&self, id: MaterialId, surface: &Surface) -> Option<Cow<'_, PhongLobe>> {
        match self.leaf(id, surface) {
            Some(Compiled::Phong(phong)) => {
                Some(phong.eval(&self.textures, || Lookup { sharp: true, ..lookup(surface) }))
            }
            Some(_) => None,
            None => Some(Cow::Borrowed(&PhongLobe::BLACK)),
        }
    }

    /// Material `id` at a point; black for a number that is no material.
    #[inline(always)]
    pub fn shade(&self, id: MaterialId, view: &View) -> Shade {
        let mut shade = Shade::black();
        self.fill(id, view, &mut shade);
        shade
    }

    /// [`MaterialTable::shade`] into a black `shade`, which is too large to be handed on by value.
    #[inline]
    pub fn fill(&self, id: MaterialId, view: &View, shade: &mut Shade) {
        let (mut id, first, mut view) = (id, view, *view);
        // Every part is an earlier material, so this ends.
        while let Some(compiled) = self.materials.get(id.0 as usize) {
            id = match compiled {
                Compiled::Phong(phong) => {
                    Self::classic(&phong.eval(&self.textures, || view.lookup()), &view, shade);
                    return;
                }
                Compiled::Scattering(scattering) => {
                    self.fill_scattering(&**scattering, &view, shade);
                    return;
                }
                Compiled::NormalMap(map) => {
                    view.normal = map.turned(&self.textures, &view);
                    map.material
                }
                Compiled::BumpMap(map) => {
                    view.normal = map.turned(&self.textures, &view);
                    map.material
                }
                Compiled::Checkerboard(board) => board.pick(view.surface),
                Compiled::Mix(mix) => {
                    (id, view.pick) = mix.pick(&self.textures, &view);
                    continue;
                }
                Compiled::Mask(mask) => {
                    shade.opacity *= mask.opacity(&self.textures, &view);
                    mask.material
                }
                Compiled::Boundary(_) => {
                    shade.opacity = 0.0;
                    break;
                }
                Compiled::Emissive(emissive) => {
                    shade.emission += emissive.emission(&self.textures, &view);
                    emissive.material
                }
            };
        }
        shade.frame = Frame::around(facing_normal(first, first.normal));
    }

    /// What is nothing but a scattering function, in its frame.
    fn fill_scattering(&self, material: &dyn ScatteringMaterial, view: &View, shade: &mut Shade) {
        let mut normal = facing_normal(view, view.normal);
        let is_mapped = view.normal != view.surface.shading_normal;
        if material.interior().is_some() {
            let outwards = if view.is_outside() { normal } else { -normal };
            normal = if is_mapped { outwards } else { view.normal };
        }
        shade.frame = tangent::frame(view, normal, material.turns(&self.textures, view));
        material.add_lobes(&self.textures, view, &mut shade.bsdf);
        shade.transmissive = material.is_transmissive();
        if is_mapped {
            shade.set_geometric_normal(view.surface.normal);
        }
    }

    /// The classic material as physics would have it.
    fn classic(lobe: &PhongLobe, view: &View, shade: &mut Shade) {
        shade.frame = Frame::around(facing_normal(view, view.normal));
        shade.emission += lobe.emission;
        lobe.add_lobes(view.is_outside(), &mut shade.bsdf);
        shade.lamp_scale = lobe.lamp_scale();
        if view.normal != view.surface.shading_normal {
            shade.set_geometric_normal(view.surface.normal);
        }
    }

    /// What a shadow ray of the classic integrator keeps when it crosses material `id` at this point: its
    /// transparency.
    #[inline]
    pub fn filter(&self, id: MaterialId, surface: &Surface) -> Rgb {
        match self.leaf(id, surface) {
            Some(Compiled::Phong(phong)) => phong.filter(&self.textures, || lookup(surface)),
            Some(Compiled::Mask(mask)) => {
                let opacity = mask.opacity(&self.textures, &View::of(surface));
                self.filter(mask.material, surface) * opacity + Rgb::splat(1.0 - opacity)
            }
            Some(Compiled::Boundary(_)) => Rgb::WHITE,
            Some(Compiled::Emissive(emissive)) => self.filter(emissive.material, surface),
            Some(Compiled::NormalMap(map)) => self.filter(map.material, surface),
            Some(Compiled::BumpMap(map)) => self.filter(map.material, surface),
            _ => Rgb::BLACK,
        }
    }

    /// Share of light that passes material `id` at this point as if nothing were there.
    #[inline]
    pub fn gap(&self, id: MaterialId, surface: &Surface) -> f32 {
        if !self.has_holes(id) {
            return 0.0;
        }
        1.0 - self.opacity(id, &View::of(surface))
    }

    /// Whether [`MaterialTable::filter`] is anything but black anywhere.
    #[inline]
    pub fn is_transparent(&self, id: MaterialId) -> bool {
        self.facts(id).transparent
    }

    /// Whether [`MaterialTable::gap`] is anything but 0 anywhere.
    #[inline]
    pub fn has_holes(&self, id: MaterialId) -> bool {
        self.facts(id).holes
    }

    /// Whether shading material `id` asks for [`View::tangents`]. Such a material is textured, too.
    #[inline]
    pub fn needs_tangents(&self, id: MaterialId) -> bool {
        self.facts(id).tangents
    }

    /// Whether material `id` is a surface of its own, not made of others.
    #[inline]
    pub fn is_simple(&self, id: MaterialId) -> bool {
        self.compiled(id).is_some_and(|compiled| matches!(compiled, Compiled::Phong(_) | Compiled::Scattering(_)))
    }

    /// Whether material `id` differs from place to place.
    #[inline]
    pub fn is_textured(&self, id: MaterialId) -> bool {
        self.facts(id).textured
    }

    /// The material that stands at this point once all checkerboards have chosen. Every choice is an
    /// earlier material, so this ends.
    #[inline]
    fn leaf(&self, mut id: MaterialId, surface: &Surface) -> Option<&Compiled> {
        loop {
            match self.materials.get(id.0 as usize)? {
                Compiled::Checkerboard(board) => id = board.pick(surface),
                other => return Some(other),
            }
        }
    }
}
