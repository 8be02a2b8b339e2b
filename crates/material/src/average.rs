//! What a material gives off and lets by on average, over all that is there by chance: what lights and shadows ask for.

use super::{Compiled, MaterialId, MaterialTable, View};
use juggler_math::Rgb;

/// Mixes in each other that are averaged; of those that lie deeper `View::pick` chooses, as there might be more than time
/// to look at them.
const MOST_MIXES: u32 = 6;

/// A material at a point on average.
#[derive(Clone, Copy, Debug)]
struct Average {
    /// Radiance towards the viewer, holes counted as dark.
    radiance: Rgb,
    /// Share of light that meets it.
    opacity: f32,
}

impl Average {
    const DARK: Self = Self { radiance: Rgb::BLACK, opacity: 1.0 };

    fn lerp(self, other: Self, amount: f32) -> Self {
        let opacity = self.opacity + (other.opacity - self.opacity) * amount;
        Self { radiance: self.radiance.lerp(other.radiance, amount), opacity }
    }
}

impl MaterialTable {
    /// Radiance that material `id` gives off towards the viewer, on average over what is there by chance.
    pub fn radiance(&self, id: MaterialId, view: &View) -> Rgb {
        self.average(id, view, MOST_MIXES).radiance
    }

    /// Share of light that meets material `id`, on average over what is there by chance.
    pub(super) fn opacity(&self, id: MaterialId, view: &View) -> f32 {
        self.average(id, view, MOST_MIXES).opacity
    }

    /// Every part is an earlier material, so this ends.
    fn average(&self, id: MaterialId, view: &View, mixes: u32) -> Average {
        let of = |part: MaterialId| self.average(part, view, mixes);
        match self.compiled(id) {
            Some(Compiled::Phong(phong)) => {
                Average { radiance: phong.eval(self.textures(), || view.lookup()).emission, ..Average::DARK }
            }
            Some(Compiled::Scattering(_)) | None => Average::DARK,
            Some(Compiled::Boundary(_)) => Average { opacity: 0.0, ..Average::DARK },
            Some(Compiled::Checkerboard(board)) => of(board.pick(view.surface)),
            Some(Compiled::NormalMap(map)) => of(map.material),
            Some(Compiled::BumpMap(map)) => of(map.material),
            Some(Compiled::Mix(mix)) if mixes == 0 => of(mix.pick(self.textures(), view).0),
            Some(Compiled::Mix(mix)) => {
                let [a, b] = mix.choices().map(|part| self.average(part, view, mixes - 1));
                a.lerp(b, mix.amount(self.textures(), view))
            }
            Some(Compiled::Mask(mask)) => {
                let opacity = mask.opacity(self.textures(), view);
                let inner = of(mask.material);
                Average { radiance: inner.radiance * opacity, opacity: inner.opacity * opacity }
            }
            Some(Compiled::Emissive(emissive)) => {
                let inner = of(emissive.material);
                let own = emissive.emission(self.textures(), view) * inner.opacity;
                Average { radiance: inner.radiance + own, ..inner }
            }
        }
    }
}
