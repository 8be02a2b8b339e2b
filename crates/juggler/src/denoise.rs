//! Taking the noise out of a film's picture: its halves and what guides the filter, gathered tile by tile.

use crate::{Error, LayerSet, check_name};
use juggler_camera::film::{Rect, Tile};
use juggler_camera::layer::{Guide, Layer, is_half};
pub use juggler_denoise::Denoised;
use juggler_denoise::{Features, Noisy, denoise_unless};
use juggler_math::{Rgb, Vec3};
use juggler_oidn::Library;
use juggler_render::Control;
use std::path::Path;

/// What takes the noise out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Denoiser {
    /// Our own filter: the same bits everywhere.
    Own,
    /// Intel's Open Image Denoise, where it is installed: what it gives may differ from machine to machine.
    Oidn,
}

impl Denoiser {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Own, Self::Oidn];

    /// The one of that name; an error says which was probably meant.
    pub fn by_name(name: &str) -> Result<Self, Error> {
        check_name("denoiser", name, Self::ALL.iter().map(|denoiser| denoiser.name()))?;
        // It is one of them.
        Ok(Self::ALL.into_iter().find(|denoiser| denoiser.name() == name).unwrap_or(Self::Own))
    }

    /// As it is asked for.
    pub fn name(self) -> &'static str {
        match self {
            Self::Own => "own",
            Self::Oidn => "oidn",
        }
    }
}

/// A picture in two halves of its samples, with what guides a filter; twice the same where nobody compares halves.
#[derive(Clone, Debug)]
pub struct Guides {
    region: Rect,
    color: [Vec<Rgb>; 2],
    albedo: [Vec<Rgb>; 2],
    normal: [Vec<Vec3>; 2],
    depth: [Vec<f32>; 2],
}

/// What both halves of a pixel have in sum, and how many samples they are.
struct Halves {
    sums: [Rgb; 2],
    counts: [f32; 2],
}

impl Guides {
    /// Bytes a pixel, with what filters need besides.
    pub const BYTES: u64 = 320;

    /// For a picture of these pixels, black.
    pub fn new(region: Rect) -> Self {
        let area = region.area() as usize;
        let black = || [vec![Rgb::BLACK; area], vec![Rgb::BLACK; area]];
        let none = || [vec![Vec3::ZERO; area], vec![Vec3::ZERO; area]];
        Self { region, color: black(), albedo: black(), normal: none(), depth: [vec![0.0; area], vec![0.0; area]] }
    }

    /// Takes in the pixels of a tile whose film kept the guides.
    pub fn add(&mut self, set: &LayerSet, tile: &Tile) {
        let (extras, count) = (tile.extras(), tile.count());
        let place = |layer| set.layers().place(layer);
        let layers = set.layers().planes.len();
        let (pixels, region) = (tile.pixels(), self.region);
        let sum = |pixel: usize, layer: Option<usize>| {
            let plane = layer.and_then(|layer| extras.planes.get(pixel * layers + layer));
            plane.copied().unwrap_or(Rgb::BLACK)
        };
        let means = tile.means();
        let halves = |pixel: usize, whole: Rgb, guide: Guide| match place(Layer::Half(guide)) {
            Some(place) => {
                let one = sum(pixel, Some(place));
                Halves { sums: [one, whole - one], counts: half_counts(count) }
            }
            None => Halves { sums: [whole; 2], counts: [count as f32; 2] },
        };
        for half in [0, 1] {
            let all = 0..pixels.area() as usize;
            let color = all.clone().map(|pixel| {
                let whole = means.get(pixel).map_or(Rgb::BLACK, |mean| *mean * count as f32);
                halves(pixel, whole, Guide::Color).mean(half)
            });
            pixels.copy(&color.collect::<Vec<_>>(), &region, &mut self.color[half]);
            let of = |guide: Guide| {
                all.clone().map(move |pixel| halves(pixel, sum(pixel, place(Layer::Guide(guide))), guide))
            };
            let albedo: Vec<Rgb> = of(Guide::Albedo).map(|halves| halves.mean(half)).collect();
            pixels.copy(&albedo, &region, &mut self.albedo[half]);
            let normal: Vec<Vec3> = of(Guide::Normal).map(|halves| halves.mean(half).to_array().into()).collect();
            pixels.copy(&normal, &region, &mut self.normal[half]);
            let depth: Vec<f32> = of(Guide::Depth).map(|halves| halves.ratio(half)).collect();
            pixels.copy(&depth, &region, &mut self.depth[half]);
        }
    }

    /// The picture without noise, from 2 samples a pixel on; `library` is the place of Open Image Denoise where the system does not know it. Nothing when
    /// `control` was cancelled.
    pub fn denoise(
        &self,
        with: Denoiser,
        library: Option<&Path>,
        control: &Control,
    ) -> Result<Option<Denoised>, Error> {
        let (width, height) = (self.region.width as usize, self.region.height as usize);
        match with {
            Denoiser::Own => {
                let features = Features {
                    albedo: Some(self.albedo.each_ref().map(Vec::as_slice)),
                    normal: Some(self.normal.each_ref().map(Vec::as_slice)),
                    depth: Some(self.depth.each_ref().map(Vec::as_slice)),
                };
                let noisy = Noisy::new(width, height, self.color.each_ref().map(Vec::as_slice), features);
                let noisy = noisy.map_err(|error| Error::Settings(error.to_string()))?;
                Ok(denoise_unless(&noisy, &<_>::default(), &|| control.is_cancelled()))
            }
            Denoiser::Oidn => {
                let failed = |error: juggler_oidn::Error| Error::Settings(error.to_string());
                let library = Library::open(library).map_err(failed)?;
                let both = |halves: &[Vec<Rgb>; 2]| -> Vec<Rgb> {
                    halves[0].iter().zip(&halves[1]).map(|(a, b)| (*a + *b) * 0.5).collect()
                };
                let normal: Vec<Vec3> =
                    self.normal[0].iter().zip(&self.normal[1]).map(|(a, b)| (*a + *b) * 0.5).collect();
                let (color, albedo) = (both(&self.color), both(&self.albedo));
                let pixels = library.denoise(width, height, &color, Some(&albedo), Some(&normal)).map_err(failed)?;
                Ok(Some(Denoised { pixels, moved: 0.0 }))
            }
        }
    }
}

impl Halves {
    fn mean(&self, half: usize) -> Rgb {
        self.sums[half] / self.counts[half].max(1.0)
    }

    /// The first channel over the second.
    fn ratio(&self, half: usize) -> f32 {
        let Rgb { r, g, .. } = self.sums[half];
        if g > 0.0 { r / g } else { 0.0 }
    }
}

/// How many of the first samples are in the half that [`Layer::Half`] keeps, and how many in the other.
fn half_counts(count: u32) -> [f32; 2] {
    // Of two neighbours one is.
    let one = count / 2 + u32::from(count % 2 == 1 && is_half(count - 1));
    [one as f32, (count - one) as f32]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_are_counted() {
        for count in 0..300 {
            let one = (0..count).filter(|sample| is_half(*sample)).count() as f32;
            assert_eq!(half_counts(count), [one, count as f32 - one], "{count}");
        }
    }
}
