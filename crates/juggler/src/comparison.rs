//! Comparison of two images: error metrics, and a test of whether noise explains the difference.

use crate::image::of_pixels;
use crate::{AovSet, Error, RenderedImage, SAMPLES, estimate};
use juggler_camera::film::{BLOCK_SAMPLES, Rect};
use juggler_film::{Merge, MergeGoal, RenderDescription};
use juggler_imaging::flip::{self, DynamicRange, Flip};
use juggler_imaging::layered::read_layer;
use juggler_imaging::significance::{NoisyImage, Significance, significance};
use juggler_imaging::{
    AlphaImage, Difference, ImageError, ImageFormat, ImageInfo, compare, inspect, read_with_alpha, regular,
};
use juggler_math::{Image, Rgb};
use std::path::Path;

/// Image to compare, with the variances of its pixels if they are known.
#[derive(Clone, Debug)]
pub struct ComparedImage {
    /// Pixels, over black if the source has alpha.
    pub image: Image,
    /// Alpha of the pixels, if the source has it.
    pub alpha: Option<Vec<f32>>,
    /// Pixels with their variances, if the source contains variances.
    pub estimate: Option<NoisyImage>,
    /// Whether the pixels are display values instead of linear radiance.
    pub is_tone_mapped: bool,
    /// Whether the image was denoised.
    pub is_denoised: bool,
    /// Metadata: keys and values.
    pub metadata: Vec<(String, String)>,
}

impl ComparedImage {
    /// Reads an image file, or a `.jfilm` file that holds a complete image.
    pub fn read(path: &Path) -> Result<Self, Error> {
        if is_partial_render(path) { Self::from_partial_render(path) } else { Self::from_file(path) }
    }

    /// Takes a rendered image, whose AOV `variance` has the variances.
    pub fn from_rendered(rendered: &RenderedImage) -> Self {
        let ([width, height], pixels) = (rendered.size(), rendered.pixels().to_vec());
        let layer =
            |name: &str| rendered.layers().find(|(header, _)| header.name == name).map(|(_, channels)| channels);
        let variance = layer("variance").and_then(|channels| match channels {
            [r, g, b] => Some(r.iter().zip(g).zip(b).map(|((r, g), b)| Rgb::new(*r, *g, *b)).collect::<Vec<_>>()),
            _ => None,
        });
        let samples = match layer("samples").and_then(<[_]>::first) {
            Some(samples) => samples.iter().map(|count| *count as u32).collect(),
            None => vec![rendered.stats().samples.min; pixels.len()],
        };
        let estimate = variance.map(|variance| noisy_image([width, height], &pixels, &variance, &samples));
        Self {
            image: of_pixels([width, height], pixels),
            alpha: rendered.alpha().map(<[f32]>::to_vec),
            estimate,
            is_tone_mapped: false,
            is_denoised: rendered.aovs().denoiser().is_some(),
            metadata: rendered.header.metadata.clone(),
        }
    }

    fn from_partial_render(path: &Path) -> Result<Self, Error> {
        let merge = Merge::open(&[path], MergeGoal::Whole)?;
        let RenderDescription { region, metadata, .. } = merge.description();
        let region = *region;
        let mut estimate = estimate::empty(region);
        let mut pixels: Vec<Rgb> = Vec::with_capacity(region.area() as usize);
        let mut alpha: Option<Vec<f32>> = None;
        let set = AovSet::from_description(&merge.description().aovs)?;
        merge.tile_rows(|band, tiles, rows| {
            tiles.iter().for_each(|tile| estimate::add(&mut estimate, region, tile));
            pixels.extend_from_slice(rows);
            if let Some(rows) = set.alpha(band, tiles) {
                alpha.get_or_insert_default().extend(rows);
            }
            Ok::<(), Error>(())
        })?;
        let Rect { width, height, .. } = region;
        let (image, metadata) = (of_pixels([width, height], pixels), metadata.clone());
        Ok(Self { image, alpha, estimate: Some(estimate), is_tone_mapped: false, is_denoised: false, metadata })
    }

    fn from_file(path: &Path) -> Result<Self, Error> {
        let AlphaImage { colors: image, alpha } = read_with_alpha(path)?;
        let ImageInfo { format, is_tone_mapped, metadata, .. } = inspect(path)?;
        let estimate = if format == ImageFormat::Exr { variances(path, &image, &metadata)? } else { None };
        let command = text(&metadata, "Command");
        let is_denoised = command.is_some_and(|command| command.contains(" --denoise"));
        Ok(Self { image, alpha, estimate, is_tone_mapped, is_denoised, metadata })
    }

    /// The image over a gray, opaque.
    fn over(&self, gray: f32) -> Image {
        let Some(alpha) = self.alpha.as_ref().filter(|_| gray != 0.0) else { return self.image.clone() };
        let mut image = self.image.clone();
        let pixels = image.pixels_mut().iter_mut().zip(alpha);
        pixels.for_each(|(pixel, alpha)| *pixel += Rgb::splat((1.0 - alpha) * gray));
        image
    }

    fn text(&self, key: &str) -> Option<&str> {
        text(&self.metadata, key)
    }
}

/// Grays over which transparent images are compared: what differs in color or alpha differs over one of
/// them.
const GRAYS: [f32; 2] = [0.0, 1.0];

/// Grays over which two images are compared; black alone if both are opaque.
fn grays(a: &ComparedImage, b: &ComparedImage) -> &'static [f32] {
    if a.alpha.is_some() || b.alpha.is_some() { &GRAYS } else { &GRAYS[..1] }
}

/// Compares an image with a reference. Transparent images are compared over black and over white; the
/// larger errors count.
///
/// # Errors
///
/// [`ImageError::SizesDiffer`] if the sizes differ.
pub fn difference(image: &ComparedImage, reference: &ComparedImage) -> Result<Difference, ImageError> {
    let mut found: Option<Difference> = None;
    for gray in grays(image, reference) {
        let next = compare(&image.over(*gray), &reference.over(*gray))?;
        let same_alpha = same_bits(image.alpha.as_deref(), reference.alpha.as_deref());
        let next = Difference { same_bits: next.same_bits && same_alpha, ..next };
        found = Some(found.map_or(next, |before| before.larger(&next)));
    }
    found.map_or_else(|| compare(&image.image, &reference.image), Ok)
}

/// Whether alpha is equal to the bit.
fn same_bits(a: Option<&[f32]>, b: Option<&[f32]>) -> bool {
    let bits = |alpha: Option<&[f32]>| alpha.map(|alpha| alpha.iter().map(|value| value.to_bits()).collect::<Vec<_>>());
    bits(a) == bits(b)
}

/// Whether two images are compared as display values: if both hold such, as tone-mapped files do.
pub fn dynamic_range(image: &ComparedImage, reference: &ComparedImage) -> DynamicRange {
    if image.is_tone_mapped && reference.is_tone_mapped { DynamicRange::Ldr } else { DynamicRange::Hdr }
}

/// Perceived difference of an image and a reference (FLIP) as [`dynamic_range`] says. Of transparent images, the larger difference over black and
/// over white counts.
///
/// # Errors
///
/// [`ImageError::SizesDiffer`] if the sizes differ.
pub fn perceived_difference(image: &ComparedImage, reference: &ComparedImage) -> Result<Flip, ImageError> {
    let range = dynamic_range(image, reference);
    let over = |gray: f32| flip::flip(&image.over(gray), &reference.over(gray), range, flip::PIXELS_PER_DEGREE);
    let mut found = over(0.0)?;
    for gray in grays(image, reference).iter().skip(1) {
        let next = over(*gray)?;
        found = if next.mean > found.mean { next } else { found };
    }
    Ok(found)
}

/// Whether a file is a partial render, by its first bytes.
pub fn is_partial_render(path: &Path) -> bool {
    regular::first_bytes(path, 12).is_ok_and(|start| juggler_film::is_partial_render(&start))
}

fn text<'m>(metadata: &'m [(String, String)], key: &str) -> Option<&'m str> {
    metadata.iter().find(|(known, _)| known == key).map(|(_, text)| text.as_str())
}

/// Minimum number of samples per pixel, from metadata such as `64` or `16 to 512, ...`.
fn fewest_samples(metadata: &[(String, String)]) -> Option<u32> {
    text(metadata, SAMPLES)?.split(' ').next()?.parse().ok()
}

/// Reads the layers `variance` and `samples` of an EXR. Without `samples`, every pixel is assumed
/// to have the number of samples in the metadata.
fn variances(path: &Path, image: &Image, metadata: &[(String, String)]) -> Result<Option<NoisyImage>, Error> {
    let Some((width, height, variance)) = read_layer(path, &["variance.R", "variance.G", "variance.B"])? else {
        return Ok(None);
    };
    if (width, height) != (image.width(), image.height()) {
        return Ok(None);
    }
    let count = image.pixels().len();
    let samples = match read_layer(path, &["samples.Y"])? {
        Some((.., samples)) if samples.len() == count => samples.iter().map(|[count, ..]| *count as u32).collect(),
        _ => vec![fewest_samples(metadata).unwrap_or(2 * BLOCK_SAMPLES); count],
    };
    let variance: Vec<Rgb> = variance.into_iter().map(Rgb::from).collect();
    Ok(Some(noisy_image([width, height], image.pixels(), &variance, &samples)))
}

/// Estimate from the values of the AOV `variance` and the numbers of samples.
fn noisy_image([width, height]: [u32; 2], mean: &[Rgb], variance: &[Rgb], samples: &[u32]) -> NoisyImage {
    let pixels = || variance.iter().zip(samples);
    let blocks_of = |(variance, samples): (&Rgb, &u32)| if variance.is_finite() { samples / BLOCK_SAMPLES } else { 0 };
    let blocks: Vec<u32> = pixels().map(blocks_of).collect();
    let of_mean = pixels().zip(&blocks);
    let variance = of_mean.map(|((value, samples), blocks)| estimate::variance_of_mean(*value, *blocks, *samples));
    let variance = variance.collect();
    NoisyImage { width, height, mean: mean.to_vec(), variance, blocks }
}

/// Result of the test whether noise explains the difference between two images.
#[derive(Debug, PartialEq)]
pub enum NoiseTest {
    /// The test was done.
    Tested {
        /// Result of the test.
        found: Significance,
        /// Significance level.
        level: f64,
        /// Reason why the test may miss differences.
        note: Option<&'static str>,
    },
    /// Both images contain variances, but the test does not apply, for this reason.
    Untested(String),
}

impl NoiseTest {
    /// Tests two images at a significance level; `None` unless both contain variances.
    pub fn new(a: &ComparedImage, b: &ComparedImage, level: f64) -> Option<Self> {
        let (one, other) = (a.estimate.as_ref()?, b.estimate.as_ref()?);
        let both = |key: &str| a.text(key).is_some() && a.text(key) == b.text(key);
        if both("Fingerprint") {
            let reason =
                "both pictures have the same scene and seed, so they share samples: render one with another --seed";
            return Some(Self::Untested(reason.into()));
        }
        if a.is_denoised || b.is_denoised {
            return Some(Self::Untested("a picture is denoised, but its variances are those before denoising".into()));
        }
        let note =
            both("Seed").then_some("both pictures have the same seed: their correlated noise may hide differences");
        Some(match significance(one, other) {
            Ok(found) => Self::Tested { found, level, note },
            Err(reason) => Self::Untested(reason.to_string()),
        })
    }

    /// Whether noise explains the difference; `None` if untested.
    pub fn is_same(&self) -> Option<bool> {
        match self {
            Self::Tested { found, level, .. } => Some(found.p >= *level),
            Self::Untested(_) => None,
        }
    }

    /// The p-value; `None` if untested.
    pub fn p(&self) -> Option<f64> {
        match self {
            Self::Tested { found, .. } => Some(found.p),
            Self::Untested(_) => None,
        }
    }
}
