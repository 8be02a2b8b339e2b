//! Denoising of a film: gathers its half buffers and feature buffers tile by tile.

use crate::aovs::Coverage;
use crate::{AovSet, Error, check_name};
use juggler_camera::aov::{DenoisingFeature, FilmAov, is_in_second_half};
use juggler_camera::film::{Rect, Tile};
pub use juggler_denoise::Denoised;
use juggler_denoise::{Features, Noisy, denoise_unless, split};
use juggler_math::{PixelRows, Rgb, Vec3};
use juggler_oidn::Oidn;
use juggler_render::Control;
use std::path::Path;

/// Denoising algorithm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Denoiser {
    /// Own filter, bit-identical on all machines.
    Own,
    /// Intel Open Image Denoise, if installed; its result may differ between machines.
    Oidn,
}

impl Denoiser {
    /// All denoisers.
    pub const ALL: [Self; 2] = [Self::Own, Self::Oidn];

    /// Returns the denoiser of a name. The error suggests similar names.
    pub fn by_name(name: &str) -> Result<Self, Error> {
        let known = Self::ALL.iter().map(|denoiser| denoiser.name());
        check_name("denoiser", name, known).map_err(|error| error.for_setting("denoise"))?;
        // The check above ensures that the name exists.
        Ok(Self::ALL.into_iter().find(|denoiser| denoiser.name() == name).unwrap_or(Self::Own))
    }

    /// Returns the name that settings and the command line use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Own => "own",
            Self::Oidn => "oidn",
        }
    }
}

/// Input of a denoiser: color and feature buffers, each as two halves of the samples. Both are
/// equal where the film stores no halves.
#[derive(Clone, Debug)]
pub struct DenoiserInput {
    region: Rect,
    color: [Vec<Rgb>; 2],
    albedo: [Vec<Rgb>; 2],
    normal: [Vec<Vec3>; 2],
    depth: [Vec<f32>; 2],
    /// What the pixels see; empty if the picture is opaque.
    coverage: Vec<Coverage>,
}

/// Sums of a pixel over both halves of its samples, with their numbers of samples.
struct Halves {
    sums: [Rgb; 2],
    counts: [f32; 2],
}

impl DenoiserInput {
    /// Peak memory in bytes per pixel of an opaque or transparent picture, including the filter's own
    /// buffers.
    pub fn bytes_per_pixel(transparent: bool) -> u64 {
        if transparent { 400 } else { 320 }
    }

    /// Creates black buffers for the pixels of `region`.
    pub fn new(region: Rect) -> Self {
        let area = region.area() as usize;
        let black = || [vec![Rgb::BLACK; area], vec![Rgb::BLACK; area]];
        let none = || [vec![Vec3::ZERO; area], vec![Vec3::ZERO; area]];
        let depth = [vec![0.0; area], vec![0.0; area]];
        Self { region, color: black(), albedo: black(), normal: none(), depth, coverage: Vec::new() }
    }

    /// Adds the pixels of a tile whose film stored the features.
    pub fn add(&mut self, set: &AovSet, tile: &Tile) {
        let (aov_sums, count) = (tile.aov_sums(), tile.samples_per_pixel());
        let place = |aov| set.film_aovs().index_of(aov);
        let plane_count = set.film_aovs().planes.len();
        let (pixels, region) = (tile.pixels(), self.region);
        if let Some(coverage) = set.coverage(tile) {
            self.coverage.resize(region.area() as usize, Coverage::default());
            pixels.copy_into(&coverage, &region, &mut self.coverage);
        }
        let sum = |pixel: usize, aov: Option<usize>| {
            let plane = aov.and_then(|aov| aov_sums.planes.get(pixel * plane_count + aov));
            plane.copied().unwrap_or(Rgb::BLACK)
        };
        let means = tile.means();
        let halves = |pixel: usize, whole: Rgb, feature: DenoisingFeature| match place(FilmAov::HalfFeature(feature)) {
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
                halves(pixel, whole, DenoisingFeature::Color).mean(half)
            });
            pixels.copy_into(&color.collect::<Vec<_>>(), &region, &mut self.color[half]);
            let of = |feature: DenoisingFeature| {
                all.clone().map(move |pixel| halves(pixel, sum(pixel, place(FilmAov::Feature(feature))), feature))
            };
            let albedo: Vec<Rgb> = of(DenoisingFeature::Albedo).map(|halves| halves.mean(half)).collect();
            pixels.copy_into(&albedo, &region, &mut self.albedo[half]);
            let normal: Vec<Vec3> =
                of(DenoisingFeature::Normal).map(|halves| halves.mean(half).to_array().into()).collect();
            pixels.copy_into(&normal, &region, &mut self.normal[half]);
            let depth: Vec<f32> = of(DenoisingFeature::Depth).map(|halves| halves.ratio(half)).collect();
            pixels.copy_into(&depth, &region, &mut self.depth[half]);
        }
    }

    /// Returns the denoised image; `None` if `control` was cancelled. It needs 2 samples per pixel
    /// or more. `library` is the path of Open Image Denoise where the system does not find it.
    /// Fails if that library cannot be loaded or rejects the image.
    pub fn denoise(
        &self,
        with: Denoiser,
        library: Option<&Path>,
        control: &Control,
    ) -> Result<Option<DenoisedPicture>, Error> {
        let Some(color) = self.denoise_color(with, library, control)? else { return Ok(None) };
        let Denoised { mut pixels, moved_energy } = color;
        let Some(alpha) = self.denoise_alpha(with, library, control)? else { return Ok(None) };
        let alpha = Some(alpha).filter(|alpha| !alpha.is_empty());
        hide_transparent(&mut pixels, alpha.as_deref());
        Ok(Some(DenoisedPicture { pixels, alpha, moved_energy }))
    }

    fn denoise_color(
        &self,
        with: Denoiser,
        library: Option<&Path>,
        control: &Control,
    ) -> Result<Option<Denoised>, Error> {
        let size = [self.region.width, self.region.height];
        match with {
            Denoiser::Own => {
                let features = Features {
                    albedo: Some(self.albedo.each_ref().map(Vec::as_slice)),
                    normal: Some(self.normal.each_ref().map(Vec::as_slice)),
                    depth: Some(self.depth.each_ref().map(Vec::as_slice)),
                };
                own(size, self.color.each_ref().map(Vec::as_slice), features, control)
            }
            Denoiser::Oidn => {
                let both = |halves: &[Vec<Rgb>; 2]| -> Vec<Rgb> {
                    halves[0].iter().zip(&halves[1]).map(|(a, b)| (*a + *b) * 0.5).collect()
                };
                let normal: Vec<Vec3> =
                    self.normal[0].iter().zip(&self.normal[1]).map(|(a, b)| (*a + *b) * 0.5).collect();
                let (color, albedo) = (both(&self.color), both(&self.albedo));
                let features = PixelFeatures { albedo: Some(&albedo), normal: Some(&normal), depth: None };
                open_image_denoise(size, &color, &features, library).map(Some)
            }
        }
    }

    /// Alpha with denoised shadows on shadow catchers; empty if the picture is opaque, `None` if
    /// `control` was cancelled. What the pixels see keeps shadows apart from the outlines of objects,
    /// which stay as they are.
    fn denoise_alpha(
        &self,
        with: Denoiser,
        library: Option<&Path>,
        control: &Control,
    ) -> Result<Option<Vec<f32>>, Error> {
        if self.coverage.iter().all(|seen| seen.caught == 0.0) {
            return Ok(Some(self.coverage.iter().map(Coverage::alpha).collect()));
        }
        let lost: Vec<Rgb> = self.coverage.iter().map(|seen| Rgb::splat(seen.lost)).collect();
        let parts = |seen: &Coverage| {
            let weights = Vec3::new(seen.opaque, seen.transmitted, seen.caught);
            weights / weights.element_sum().max(f32::MIN_POSITIVE)
        };
        let seen: Vec<Vec3> = self.coverage.iter().map(parts).collect();
        let size = [self.region.width, self.region.height];
        let features = PixelFeatures { normal: Some(&seen), ..PixelFeatures::default() };
        let denoised = denoise_pixels(size, NoisyPixels::Whole(&lost), &features, with, library, control)?;
        let with_lost = |(seen, lost): (&Coverage, &Rgb)| Coverage { lost: lost.g.clamp(0.0, 1.0), ..*seen }.alpha();
        Ok(denoised.map(|denoised| self.coverage.iter().zip(&denoised.pixels).map(with_lost).collect()))
    }
}

/// Denoised pixels of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DenoisedPicture {
    /// Colors in linear light, row by row from the top.
    pub pixels: Vec<Rgb>,
    /// Alpha of the pixels, 0 to 1; `None` if the picture is opaque.
    pub alpha: Option<Vec<f32>>,
    /// Part of the light that moved from single bright pixels to their neighbors, 0 to 1.
    pub moved_energy: f64,
}

impl DenoisedPicture {
    /// The pixels with their alpha.
    pub fn rows(&self) -> PixelRows<'_> {
        PixelRows { colors: &self.pixels, alpha: self.alpha.as_deref() }
    }
}

/// Blackens pixels with an alpha of 0, on which a denoiser may have spread the light of others.
pub(crate) fn hide_transparent(pixels: &mut [Rgb], alpha: Option<&[f32]>) {
    let transparent = pixels.iter_mut().zip(alpha.unwrap_or_default()).filter(|(_, alpha)| **alpha == 0.0);
    transparent.for_each(|(pixel, _)| *pixel = Rgb::BLACK);
}

/// Noisy pixels in linear light, row by row from the top.
#[derive(Clone, Copy, Debug)]
pub enum NoisyPixels<'a> {
    /// Means of all samples. The own filter estimates the noise from neighboring pixels, so that its
    /// result is softer than that of halves.
    Whole(&'a [Rgb]),
    /// Means of two disjoint halves of the samples, whose difference is the noise.
    Halves([&'a [Rgb]; 2]),
}

/// Features of the pixels of a picture, row by row from the top; all optional.
#[derive(Clone, Copy, Debug, Default)]
pub struct PixelFeatures<'a> {
    /// Albedo, 0 to 1 in each channel; black where there is no surface.
    pub albedo: Option<&'a [Rgb]>,
    /// Shading normal, in world space; zero where there is no surface.
    pub normal: Option<&'a [Vec3]>,
    /// Distance along the ray, in scene units; zero or infinite where there is no surface.
    pub depth: Option<&'a [f32]>,
}

/// Denoises pixels of any origin: an image that was rendered without a denoiser, or by another
/// program. Returns `None` if `control` was cancelled.
///
/// # Errors
///
/// A buffer does not have a value for each of the width × height pixels, or Open Image Denoise
/// cannot be loaded or rejects the image.
pub fn denoise_pixels(
    size: [u32; 2],
    noisy: NoisyPixels,
    features: &PixelFeatures,
    with: Denoiser,
    library: Option<&Path>,
    control: &Control,
) -> Result<Option<Denoised>, Error> {
    match (with, noisy) {
        (Denoiser::Own, NoisyPixels::Whole(pixels)) => {
            let [a, b] = split((size[0] as usize).max(1), pixels, features.albedo);
            denoise_pixels(size, NoisyPixels::Halves([&a, &b]), features, with, library, control)
        }
        (Denoiser::Own, NoisyPixels::Halves(halves)) => {
            let PixelFeatures { albedo, normal, depth } = *features;
            let features = Features {
                albedo: albedo.map(|pixels| [pixels; 2]),
                normal: normal.map(|pixels| [pixels; 2]),
                depth: depth.map(|pixels| [pixels; 2]),
            };
            own(size, halves, features, control)
        }
        (Denoiser::Oidn, NoisyPixels::Whole(pixels)) => open_image_denoise(size, pixels, features, library).map(Some),
        (Denoiser::Oidn, NoisyPixels::Halves([a, b])) => {
            let pixels: Vec<Rgb> = a.iter().zip(b).map(|(a, b)| (*a + *b) * 0.5).collect();
            open_image_denoise(size, &pixels, features, library).map(Some)
        }
    }
}

/// Runs the own filter; `None` if `control` was cancelled.
fn own(
    [width, height]: [u32; 2],
    halves: [&[Rgb]; 2],
    features: Features,
    control: &Control,
) -> Result<Option<Denoised>, Error> {
    let noisy = Noisy::new(width as usize, height as usize, halves, features);
    let noisy = noisy.map_err(|error| Error::setting("denoise", error.to_string()))?;
    Ok(denoise_unless(&noisy, &<_>::default(), &|| control.is_cancelled()))
}

/// Runs Open Image Denoise, which does not read the depth.
fn open_image_denoise(
    [width, height]: [u32; 2],
    color: &[Rgb],
    features: &PixelFeatures,
    library: Option<&Path>,
) -> Result<Denoised, Error> {
    let failed = |error: juggler_oidn::Error| Error::setting("denoise", error.to_string());
    let library = Oidn::open(library).map_err(failed)?;
    let (width, height) = (width as usize, height as usize);
    let pixels = library.denoise(width, height, color, features.albedo, features.normal).map_err(failed)?;
    Ok(Denoised { pixels, moved_energy: 0.0 })
}

impl Halves {
    fn mean(&self, half: usize) -> Rgb {
        self.sums[half] / self.counts[half].max(1.0)
    }

    /// Returns the first channel over the second: the mean depth of the samples that hit a surface.
    fn ratio(&self, half: usize) -> f32 {
        let Rgb { r, g, .. } = self.sums[half];
        if g > 0.0 { r / g } else { 0.0 }
    }
}

/// Returns how many of the first `count` samples belong to the half that [`FilmAov::HalfFeature`]
/// stores, and how many to the other.
fn half_counts(count: u32) -> [f32; 2] {
    // Each pair of samples 2k and 2k + 1 has one in that half.
    let one = count / 2 + u32::from(count % 2 == 1 && is_in_second_half(count - 1));
    [one as f32, (count - one) as f32]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_are_counted() {
        for count in 0..300 {
            let one = (0..count).filter(|sample| is_in_second_half(*sample)).count() as f32;
            assert_eq!(half_counts(count), [one, count as f32 - one], "{count}");
        }
    }
}
