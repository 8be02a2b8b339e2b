//! All materials of a world, compiled.

use super::properties::MaterialProperties;
use super::shading::facing_normal;
use super::{
    CompiledMaterial, MaterialId, ScatteringMaterial, Shading, ShadingView, SurfaceEmission, TexturedPoint, lookup,
    tangent,
};
use crate::medium::{Interior, InteriorId};
use juggler_bsdf::PhongParameters;
use juggler_math::{Frame, Rgb, Vec3};
use juggler_shape::surface::Surface;
use juggler_texture::{TextureLookup, TextureTable};
use std::borrow::Cow;

/// All materials of a world by id, with their textures. Built by a
/// [`MaterialCompiler`](super::MaterialCompiler).
#[derive(Clone, Debug, Default)]
pub struct MaterialTable {
    /// Materials by id. A material refers only to earlier ones.
    materials: Vec<CompiledMaterial>,
    properties: Vec<MaterialProperties>,
    interiors: Vec<Interior>,
    textures: TextureTable,
}

impl MaterialTable {
    pub(super) fn new(textures: TextureTable) -> Self {
        Self { textures, ..Self::default() }
    }

    pub(super) fn push(&mut self, compiled: CompiledMaterial) -> MaterialId {
        let nested = compiled.nested_materials();
        let any = |property: fn(&MaterialProperties) -> bool| nested.iter().any(|id| property(&self.properties(*id)));
        let absent = compiled.has_absence();
        let has_opacity = match &compiled {
            CompiledMaterial::Mask(material) => !material.is_opaque(),
            CompiledMaterial::Boundary(_) => true,
            _ => false,
        };
        let classic = matches!(&compiled, CompiledMaterial::Phong(material) if material.is_transparent());
        let is_unlit = matches!(&compiled, CompiledMaterial::Unlit(_));
        let passes_front = has_opacity || classic || is_unlit || any(|properties| properties.passes_front);
        let nested_opacity = any(|properties| properties.has_opacity);
        let has_opacity = has_opacity || absent || nested_opacity;
        // A material that is absent from behind is as opaque on the front as the one inside it.
        let emits_partly = has_opacity && (nested_opacity || !absent);
        let transmissive = matches!(&compiled, CompiledMaterial::Scattering(material) if material.is_transmissive());
        let tangents = compiled.needs_tangents() || any(|properties| properties.tangents);
        let properties = MaterialProperties {
            transparent: has_opacity || classic || any(|properties| properties.transparent),
            has_opacity,
            has_absence: absent || any(|properties| properties.has_absence),
            passes_front,
            transmits: transmissive || any(|properties| properties.transmits),
            // Tangents are computed from the point in object space, which untextured surfaces lack.
            textured: tangents || compiled.is_textured() || any(|properties| properties.textured),
            tangents,
            // Radiance is constant only where the material is fully opaque.
            emission: self
                .emission_of(&compiled)
                .map(|emission| if emits_partly { emission.with_varying_radiance() } else { emission }),
            interior: None,
        };
        let interior = self.interior_of(&compiled, &nested);
        self.properties.push(MaterialProperties { interior, ..properties });
        self.materials.push(compiled);
        MaterialId(u32::try_from(self.materials.len() - 1).unwrap_or(u32::MAX))
    }

    /// Textures of the materials.
    #[inline]
    pub fn textures(&self) -> &TextureTable {
        &self.textures
    }

    /// Compiled material; `None` for an unknown id.
    pub(super) fn compiled(&self, id: MaterialId) -> Option<&CompiledMaterial> {
        self.materials.get(id.0 as usize)
    }

    fn properties(&self, id: MaterialId) -> MaterialProperties {
        self.properties.get(id.0 as usize).copied().unwrap_or(MaterialProperties::NONE)
    }

    /// Interior of a material: its own, or the first of its nested materials.
    fn interior_of(&mut self, compiled: &CompiledMaterial, nested: &[MaterialId]) -> Option<InteriorId> {
        if let Some(interior) = compiled.interior() {
            let id = InteriorId::new(self.interiors.len())?;
            self.interiors.push(interior);
            return Some(id);
        }
        nested.iter().find_map(|id| self.properties(*id).interior)
    }

    /// Interior behind material `id`; `None` if light cannot enter it.
    #[inline]
    pub fn interior(&self, id: MaterialId) -> Option<InteriorId> {
        self.properties(id).interior
    }

    /// Interiors of all materials.
    #[inline]
    pub fn interiors(&self) -> &[Interior] {
        &self.interiors
    }

    fn emission_of(&self, compiled: &CompiledMaterial) -> Option<SurfaceEmission> {
        let emissions = || compiled.nested_materials().into_iter().filter_map(|id| self.properties(id).emission);
        match compiled {
            CompiledMaterial::Phong(phong) => phong.surface_emission(),
            CompiledMaterial::Scattering(_) | CompiledMaterial::Unlit(_) | CompiledMaterial::Boundary(_) => None,
            CompiledMaterial::Emissive(emissive) => match emissions().next() {
                None => Some(emissive.surface_emission())
                    .filter(|emission| emission.radiance.is_none_or(|light| !light.is_black())),
                Some(other) => Some(emissive.surface_emission().union(other).with_varying_radiance()),
            },
            CompiledMaterial::NormalMap(_) | CompiledMaterial::BumpMap(_) => emissions().next(),
            CompiledMaterial::OneSided(_) => emissions().next().map(SurfaceEmission::on_front),
            CompiledMaterial::Checkerboard(_) | CompiledMaterial::Mix(_) | CompiledMaterial::Mask(_) => {
                emissions().reduce(SurfaceEmission::union).map(SurfaceEmission::with_varying_radiance)
            }
        }
    }

    /// Emission of material `id`, if it emits anywhere.
    pub fn emission(&self, id: MaterialId) -> Option<SurfaceEmission> {
        self.properties(id).emission
    }

    /// Parameters of the classic material `id` at a point of a surface (world space, normals of the
    /// shape), without filtering of procedural textures. Returns `None` for a material of another
    /// kind, black for an unknown id.
    #[inline]
    pub fn phong<'a>(&self, id: MaterialId, at: impl Into<TexturedPoint<'a>>) -> Option<Cow<'_, PhongParameters>> {
        let at = at.into();
        match self.resolve_checkerboards(id, at.surface) {
            Some(CompiledMaterial::Phong(phong)) => {
                Some(phong.eval(&self.textures, || TextureLookup { unfiltered: true, ..lookup(at) }))
            }
            Some(_) => None,
            None => Some(Cow::Borrowed(&PhongParameters::BLACK)),
        }
    }

    /// Shading of material `id` at a point; black for an unknown id.
    #[inline(always)]
    pub fn shade(&self, id: MaterialId, view: &ShadingView) -> Shading {
        let mut shading = Shading::black();
        self.shade_into(id, view, &mut shading);
        shading
    }

    /// Writes [`MaterialTable::shade`] into a black `shading`, which is too large to return by
    /// value.
    #[inline]
    pub fn shade_into(&self, id: MaterialId, view: &ShadingView, shading: &mut Shading) {
        if !self.fill(id, view, shading) {
            self.fill_layered(id, *view, shading);
        }
    }

    /// Fills in the shading of a material that has a BSDF of its own; returns false for any other.
    #[inline(always)]
    fn fill(&self, id: MaterialId, view: &ShadingView, shading: &mut Shading) -> bool {
        match self.compiled(id) {
            Some(CompiledMaterial::Phong(phong)) => {
                Self::fill_classic(&phong.eval(&self.textures, || view.lookup()), view, shading);
            }
            Some(CompiledMaterial::Scattering(scattering)) => self.fill_scattering(&**scattering, view, shading),
            _ => return false,
        }
        true
    }

    /// Fills in the shading of a material around others.
    #[inline(never)]
    fn fill_layered(&self, mut id: MaterialId, mut view: ShadingView, shading: &mut Shading) {
        let first = view;
        // The loop ends, since nested materials have smaller ids.
        while let Some(layer) = self.compiled(id) {
            match self.apply_layer(layer, &mut view, shading) {
                Some(nested) if self.fill(nested, &view, shading) => return,
                Some(nested) => id = nested,
                None => break,
            }
        }
        shading.frame = Frame::around(facing_normal(&first, first.normal));
    }

    /// Applies a material without a BSDF of its own. Returns the material inside it, which comes
    /// next; `None` if there is none.
    #[inline(always)]
    fn apply_layer(
        &self,
        layer: &CompiledMaterial,
        view: &mut ShadingView,
        shading: &mut Shading,
    ) -> Option<MaterialId> {
        match layer {
            CompiledMaterial::NormalMap(map) => {
                view.normal = map.shading_normal(&self.textures, view);
                Some(map.material)
            }
            CompiledMaterial::BumpMap(map) => {
                view.normal = map.shading_normal(&self.textures, view);
                Some(map.material)
            }
            CompiledMaterial::Checkerboard(board) => Some(board.pick(view.surface)),
            CompiledMaterial::Mix(mix) => {
                let (id, u_choice) = mix.pick(&self.textures, view);
                view.u_choice = u_choice;
                Some(id)
            }
            CompiledMaterial::Mask(mask) => {
                shading.opacity *= mask.opacity(&self.textures, view);
                Some(mask.material)
            }
            CompiledMaterial::Emissive(emissive) => {
                shading.emission += emissive.emission(&self.textures, view);
                Some(emissive.material)
            }
            CompiledMaterial::OneSided(one_sided) if view.is_outside() => Some(one_sided.material),
            layer => {
                layer.end(&self.textures, view, shading);
                None
            }
        }
    }

    /// Fills in the BSDF of a scattering material, with its frame.
    fn fill_scattering(&self, material: &dyn ScatteringMaterial, view: &ShadingView, shading: &mut Shading) {
        let surface = view.surface;
        let mut normal = facing_normal(view, view.normal);
        shading.transmissive = material.is_transmissive();
        // Light inside of glass meets its surface many times, so what smooth normals lose would add up.
        let is_perturbed =
            view.normal != surface.shading_normal || (shading.transmissive && surface.shading_normal != surface.normal);
        if material.interior().is_some() {
            let outwards = if view.is_outside() { normal } else { -normal };
            normal = if is_perturbed { outwards } else { view.normal };
        }
        shading.frame = tangent::frame(view, normal, material.rotation_turns(&self.textures, view));
        material.add_lobes(&self.textures, view, &shading.frame, &mut shading.bsdf);
        if is_perturbed {
            shading.set_geometric_normal(surface.normal);
            if material.interior().is_none() {
                shading.tilt_diffuse(view);
            }
        }
    }

    /// Fills in the physically based approximation of the classic material.
    fn fill_classic(lobe: &PhongParameters, view: &ShadingView, shading: &mut Shading) {
        shading.frame = Frame::around(facing_normal(view, view.normal));
        shading.emission += lobe.emission;
        lobe.add_lobes(view.is_outside(), &mut shading.bsdf);
        shading.light_scale = lobe.light_scale();
        if view.normal != view.surface.shading_normal {
            shading.set_geometric_normal(view.surface.normal);
            shading.tilt_diffuse(view);
        }
    }

    /// Transmittance of material `id` at a point, seen from `wo`, for shadow rays of the classic
    /// integrator.
    #[inline]
    pub fn shadow_transmittance<'a>(&self, id: MaterialId, at: impl Into<TexturedPoint<'a>>, wo: Vec3) -> Rgb {
        let at = at.into();
        match self.resolve_checkerboards(id, at.surface) {
            Some(CompiledMaterial::Phong(phong)) => phong.shadow_transmittance(&self.textures, || lookup(at)),
            Some(CompiledMaterial::Mask(mask)) => {
                let opacity = mask.opacity(&self.textures, &ShadingView::along_normal(at));
                self.shadow_transmittance(mask.material, at, wo) * opacity + Rgb::splat(1.0 - opacity)
            }
            Some(CompiledMaterial::Boundary(_) | CompiledMaterial::Unlit(_)) => Rgb::WHITE,
            Some(CompiledMaterial::Emissive(emissive)) => self.shadow_transmittance(emissive.material, at, wo),
            Some(CompiledMaterial::NormalMap(map)) => self.shadow_transmittance(map.material, at, wo),
            Some(CompiledMaterial::BumpMap(map)) => self.shadow_transmittance(map.material, at, wo),
            Some(CompiledMaterial::OneSided(one_sided)) if at.surface.normal.dot(wo) >= 0.0 => {
                self.shadow_transmittance(one_sided.material, at, wo)
            }
            Some(CompiledMaterial::OneSided(one_sided)) => Rgb::splat(f32::from(one_sided.is_absent_behind)),
            Some(CompiledMaterial::Mix(mix)) if mix.choices().iter().any(|id| self.has_absence(*id)) => {
                let [a, b] = mix.choices().map(|id| self.straight_transmittance(id, at, wo));
                let amount = mix.amount(&self.textures, &ShadingView::along_normal(at));
                Rgb::splat(a + (b - a) * amount)
            }
            _ => Rgb::BLACK,
        }
    }

    /// Share of light that passes straight through material `id` at a point, seen from `wo`: 1 -
    /// opacity.
    #[inline]
    pub fn straight_transmittance<'a>(&self, id: MaterialId, at: impl Into<TexturedPoint<'a>>, wo: Vec3) -> f32 {
        if !self.has_opacity(id) {
            return 0.0;
        }
        1.0 - self.opacity(id, &ShadingView { wo, ..ShadingView::along_normal(at) })
    }

    /// Whether material `id` is absent at a point for shadow rays that come from the side of `wo`,
    /// as an unlit surface is, and a surface without a back from behind. Opacity does not count, nor
    /// do mixtures.
    pub fn is_absent(&self, mut id: MaterialId, surface: &Surface, wo: Vec3) -> bool {
        // The loop ends, since nested materials have smaller ids.
        while self.has_absence(id) {
            id = match self.compiled(id) {
                Some(CompiledMaterial::OneSided(one_sided)) if surface.normal.dot(wo) >= 0.0 => one_sided.material,
                Some(CompiledMaterial::OneSided(one_sided)) => return one_sided.is_absent_behind,
                Some(CompiledMaterial::Unlit(_)) => return true,
                Some(CompiledMaterial::Checkerboard(board)) => board.pick(surface),
                Some(CompiledMaterial::Mask(mask)) => mask.material,
                Some(CompiledMaterial::NormalMap(map)) => map.material,
                Some(CompiledMaterial::BumpMap(map)) => map.material,
                Some(CompiledMaterial::Emissive(emissive)) => emissive.material,
                _ => return false,
            };
        }
        false
    }

    /// Whether [`MaterialTable::is_absent`] holds for some rays.
    #[inline]
    pub fn has_absence(&self, id: MaterialId) -> bool {
        self.properties(id).has_absence
    }

    /// Whether light may pass straight through the front of material `id`. The back of a one-sided
    /// material may be absent all the same.
    #[inline]
    pub fn passes_front(&self, id: MaterialId) -> bool {
        self.properties(id).passes_front
    }

    /// Whether light may pass through a surface of material `id` that bounds no solid, such as a
    /// pane or a translucent sheet. Transparent classic materials bound solids of their own.
    #[inline]
    pub fn is_sheet(&self, id: MaterialId) -> bool {
        let MaterialProperties { transmits, interior, .. } = self.properties(id);
        transmits && interior.is_none()
    }

    /// Whether a ray ends at a surface of material `id` without light: the material neither emits nor
    /// transmits light, and is never absent.
    #[inline]
    pub fn blocks_sight(&self, id: MaterialId) -> bool {
        let MaterialProperties { has_opacity, has_absence, transmits, emission, interior, .. } = self.properties(id);
        !(has_opacity || has_absence || transmits) && emission.is_none() && interior.is_none()
    }

    /// Whether [`MaterialTable::shadow_transmittance`] is above 0 anywhere.
    #[inline]
    pub fn is_transparent(&self, id: MaterialId) -> bool {
        self.properties(id).transparent
    }

    /// Whether [`MaterialTable::straight_transmittance`] is above 0 anywhere.
    #[inline]
    pub fn has_opacity(&self, id: MaterialId) -> bool {
        self.properties(id).has_opacity
    }

    /// Whether shading material `id` needs [`ShadingView::tangents`]. Such a material also counts
    /// as textured.
    #[inline]
    pub fn needs_tangents(&self, id: MaterialId) -> bool {
        self.properties(id).tangents
    }

    /// Whether material `id` is a BSDF or a classic material, without nested materials.
    #[inline]
    pub fn is_simple(&self, id: MaterialId) -> bool {
        self.compiled(id)
            .is_some_and(|compiled| matches!(compiled, CompiledMaterial::Phong(_) | CompiledMaterial::Scattering(_)))
    }

    /// Whether shading material `id` varies over the surface.
    #[inline]
    pub fn is_textured(&self, id: MaterialId) -> bool {
        self.properties(id).textured
    }

    /// Material at a point, after all checkerboards have chosen. The loop ends, since nested
    /// materials have smaller ids.
    #[inline]
    fn resolve_checkerboards(&self, mut id: MaterialId, surface: &Surface) -> Option<&CompiledMaterial> {
        loop {
            match self.materials.get(id.0 as usize)? {
                CompiledMaterial::Checkerboard(board) => id = board.pick(surface),
                other => return Some(other),
            }
        }
    }
}
