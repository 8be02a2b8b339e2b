//! Denoising of images that were rendered without a denoiser.

use super::{RenderedImage, digest};
use crate::denoise::{Denoiser, NoisyPixels, PixelFeatures, denoise_pixels, hide_transparent};
use crate::{Aov, Error};
use juggler_camera::film::{FilmSummary, Rect};
use juggler_math::{Rgb, Vec3};
use juggler_render::{Cancelled, Control};
use std::path::Path;
use std::time::Instant;

impl RenderedImage {
    /// Denoises the image with those of the AOVs `albedo`, `normal` and `depth` that it has. A render
    /// with a denoiser knows more of the noise, and gives a sharper image. An image that a denoiser
    /// has made already stays as it is. `library` is the path of Open Image Denoise where the system
    /// does not find it. Fails if `control` cancels the work, or if that library cannot be loaded.
    pub fn denoised(&self, with: Denoiser, library: Option<&Path>, control: &Control) -> Result<Self, Error> {
        if !self.stats.denoise.is_zero() {
            return Ok(self.clone());
        }
        let (start, [width, height]) = (Instant::now(), self.size());
        let albedo = self.vectors(Aov::Albedo).map(|vectors| vectors.into_iter().map(Rgb::from).collect::<Vec<_>>());
        let normal = self.vectors(Aov::Normal).map(|vectors| vectors.into_iter().map(Vec3::from).collect::<Vec<_>>());
        let features = PixelFeatures {
            albedo: albedo.as_deref(),
            normal: normal.as_deref(),
            depth: self.channels_of(Aov::Depth).and_then(<[_]>::first).map(Vec::as_slice),
        };
        let noisy = NoisyPixels::Whole(&self.pixels);
        let denoised = denoise_pixels([width, height], noisy, &features, with, library, control)?;
        let mut pixels = denoised.ok_or(Error::Cancelled(Cancelled))?.pixels;
        hide_transparent(&mut pixels, self.alpha());
        let mut image = Self { pixels, ..self.clone() };
        let FilmSummary { hash, mean, .. } = digest(image.pixel_rows(), Rect { x: 0, y: 0, width, height });
        image.stats.film = FilmSummary { hash, mean, ..self.stats.film.clone() };
        image.stats.denoise = start.elapsed();
        Ok(image)
    }

    /// Channels of the layer of an AOV, if the image has it.
    fn channels_of(&self, aov: Aov) -> Option<&[Vec<f32>]> {
        self.layers().find(|(layer, _)| layer.name == aov.name()).map(|(_, channels)| channels)
    }

    /// Three channels of a layer as vectors.
    fn vectors(&self, aov: Aov) -> Option<Vec<[f32; 3]>> {
        let [x, y, z] = self.channels_of(aov)? else { return None };
        Some(x.iter().zip(y).zip(z).map(|((x, y), z)| [*x, *y, *z]).collect())
    }
}
