//! One of the compared pictures, with its noise estimate.

use crate::failure::Failure;
use juggler::SAMPLES;
use juggler::camera::film::{BLOCK_SAMPLES, Rect};
use juggler::estimate;
use juggler::film::{self, Merge, MergeGoal, RenderDescription};
use juggler::imaging::layered::read_layer;
use juggler::imaging::significance::NoisyImage;
use juggler::imaging::{self, ImageFormat, ImageInfo, regular};
use juggler::math::{Image, Rgb};
use std::path::Path;

/// A picture to compare.
pub struct ComparedPicture {
    /// Pixels.
    pub image: Image,
    /// Pixels with their variances, if the file contains variances.
    pub estimate: Option<NoisyImage>,
    /// Whether the pixels are display values instead of linear radiance.
    pub is_tone_mapped: bool,
    /// Whether the picture was denoised.
    pub is_denoised: bool,
    /// Metadata: keys and values.
    pub metadata: Vec<(String, String)>,
}

impl ComparedPicture {
    /// Reads a picture, or a `.jfilm` file that holds a complete one.
    pub fn read(name: &str) -> Result<Self, Failure> {
        let path = Path::new(name);
        if is_partial_render(path) { Self::from_partial_render(path) } else { Self::from_picture(path) }
    }

    fn from_partial_render(path: &Path) -> Result<Self, Failure> {
        let merge = Merge::open(&[path], MergeGoal::Whole)?;
        let RenderDescription { region, metadata, .. } = merge.description();
        let region = *region;
        let mut estimate = estimate::empty(region);
        let mut pixels: Vec<Rgb> = Vec::with_capacity(region.area() as usize);
        merge.tile_rows(|_, tiles, rows| {
            tiles.iter().for_each(|tile| estimate::add(&mut estimate, region, tile));
            pixels.extend_from_slice(rows);
            Ok::<(), Failure>(())
        })?;
        let Rect { width, height, .. } = region;
        let image = Image::from_pixels(width, height, pixels);
        let image = image
            .ok_or_else(|| Failure::System(format!("cannot read `{}`: unexpected end of file", path.display())))?;
        let metadata = metadata.clone();
        Ok(Self { image, estimate: Some(estimate), is_tone_mapped: false, is_denoised: false, metadata })
    }

    fn from_picture(path: &Path) -> Result<Self, Failure> {
        let image = imaging::read(path)?;
        let ImageInfo { format, is_tone_mapped, metadata, .. } = imaging::inspect(path)?;
        let estimate = if format == ImageFormat::Exr { variances(path, &image, &metadata)? } else { None };
        let command = text(&metadata, "Command");
        let is_denoised = command.is_some_and(|command| command.contains(" --denoise"));
        Ok(Self { image, estimate, is_tone_mapped, is_denoised, metadata })
    }

    /// Metadata of this key.
    pub fn text(&self, key: &str) -> Option<&str> {
        text(&self.metadata, key)
    }
}

/// Whether a file is a partial render, by its first bytes.
pub fn is_partial_render(path: &Path) -> bool {
    regular::first_bytes(path, 12).is_ok_and(|start| film::is_partial_render(&start))
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
fn variances(path: &Path, image: &Image, metadata: &[(String, String)]) -> Result<Option<NoisyImage>, Failure> {
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
    let blocks: Vec<u32> = variance
        .iter()
        .zip(&samples)
        .map(
            |(variance, samples)| {
                if variance.iter().all(|value| value.is_finite()) { samples / BLOCK_SAMPLES } else { 0 }
            },
        )
        .collect();
    let pixels = variance.iter().zip(blocks.iter().zip(&samples));
    let variance = pixels
        .map(|(value, (blocks, samples))| estimate::variance_of_mean(Rgb::from(*value), *blocks, *samples))
        .collect();
    Ok(Some(NoisyImage { width, height, mean: image.pixels().to_vec(), variance, blocks }))
}
