//! Expected emission and opacity over all random choices inside a material, for light sampling and
//! shadow rays.

use super::{CompiledMaterial, MaterialId, MaterialTable, ShadingView};
use juggler_math::Rgb;

/// Maximum depth of nested mixes that are averaged. In deeper mixes `ShadingView::u_choice`
/// chooses, since the time grows exponentially with the depth.
const MAX_AVERAGED_MIXES: u32 = 6;

/// Expected emission and opacity of a material at a point.
#[derive(Clone, Copy, Debug)]
struct MeanShading {
    /// Radiance towards the viewer, weighted by opacity.
    radiance: Rgb,
    /// Opacity, 0 to 1.
    opacity: f32,
}

impl MeanShading {
    const DARK: Self = Self { radiance: Rgb::BLACK, opacity: 1.0 };

    fn lerp(self, other: Self, amount: f32) -> Self {
        let opacity = self.opacity + (other.opacity - self.opacity) * amount;
        Self { radiance: self.radiance.lerp(other.radiance, amount), opacity }
    }
}

impl MaterialTable {
    /// Radiance that material `id` emits towards the viewer, averaged over its random choices.
    pub fn radiance(&self, id: MaterialId, view: &ShadingView) -> Rgb {
        self.average(id, view, MAX_AVERAGED_MIXES).radiance
    }

    /// Opacity of material `id`, averaged over its random choices.
    pub(super) fn opacity(&self, id: MaterialId, view: &ShadingView) -> f32 {
        self.average(id, view, MAX_AVERAGED_MIXES).opacity
    }

    /// Averages a material. The recursion ends, since nested materials have smaller ids.
    fn average(&self, id: MaterialId, view: &ShadingView, mixes: u32) -> MeanShading {
        let mean = |part: MaterialId| self.average(part, view, mixes);
        match self.compiled(id) {
            Some(CompiledMaterial::Phong(phong)) => {
                MeanShading { radiance: phong.eval(self.textures(), || view.lookup()).emission, ..MeanShading::DARK }
            }
            Some(CompiledMaterial::Scattering(_)) | None => MeanShading::DARK,
            // An unlit surface is absent for shadow rays, and no light.
            Some(CompiledMaterial::Boundary(_) | CompiledMaterial::Unlit(_)) => {
                MeanShading { opacity: 0.0, ..MeanShading::DARK }
            }
            Some(CompiledMaterial::Checkerboard(board)) => mean(board.pick(view.surface)),
            Some(CompiledMaterial::OneSided(one_sided)) => match (view.is_outside(), one_sided.is_absent_behind) {
                (true, _) => mean(one_sided.material),
                (false, true) => MeanShading { opacity: 0.0, ..MeanShading::DARK },
                (false, false) => MeanShading::DARK,
            },
            Some(CompiledMaterial::NormalMap(map)) => mean(map.material),
            Some(CompiledMaterial::BumpMap(map)) => mean(map.material),
            Some(CompiledMaterial::Mix(mix)) if mixes == 0 => mean(mix.pick(self.textures(), view).0),
            Some(CompiledMaterial::Mix(mix)) => {
                let [a, b] = mix.choices().map(|part| self.average(part, view, mixes - 1));
                a.lerp(b, mix.amount(self.textures(), view))
            }
            Some(CompiledMaterial::Mask(mask)) => {
                let opacity = mask.opacity(self.textures(), view);
                let inner = mean(mask.material);
                MeanShading { radiance: inner.radiance * opacity, opacity: inner.opacity * opacity }
            }
            Some(CompiledMaterial::Emissive(emissive)) => {
                let inner = mean(emissive.material);
                let own = emissive.emission(self.textures(), view) * inner.opacity;
                MeanShading { radiance: inner.radiance + own, ..inner }
            }
        }
    }
}
