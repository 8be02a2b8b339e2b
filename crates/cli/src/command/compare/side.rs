//! One of the pictures that are compared, with what it knows of its noise.

use crate::failure::Failure;
use crate::reproduce::SAMPLES;
use juggler::camera::film::{BLOCK, Rect};
use juggler::estimate;
use juggler::film::{self, Description, Merge, Wanted};
use juggler::imaging::layered::read_layer;
use juggler::imaging::significance::Estimate;
use juggler::imaging::{self, Facts, Format, regular};
use juggler::math::{Image, Rgb};
use std::path::Path;

/// One of the pictures.
pub struct Side {
    /// Its pixels.
    pub image: Image,
    /// The same with their variances, where it has them.
    pub estimate: Option<Estimate>,
    /// Whether it holds what a screen shows, and no light.
    pub is_tone_mapped: bool,
    /// Whether its noise was taken out.
    pub is_denoised: bool,
    /// What it says about itself.
    pub metadata: Vec<(String, String)>,
}

impl Side {
    /// Reads a picture, or a film part that holds a whole one.
    pub fn read(name: &str) -> Result<Self, Failure> {
        let path = Path::new(name);
        if is_part(path) { Self::of_part(path) } else { Self::of_picture(path) }
    }

    fn of_part(path: &Path) -> Result<Self, Failure> {
        let merge = Merge::open(&[path], Wanted::Whole)?;
        let Description { region, metadata, .. } = merge.description();
        let region = *region;
        let mut estimate = estimate::empty(region);
        let mut pixels: Vec<Rgb> = Vec::with_capacity(region.area() as usize);
        merge.rows_of_tiles(|_, tiles, rows| {
            tiles.iter().for_each(|tile| estimate::add(&mut estimate, region, tile));
            pixels.extend_from_slice(rows);
            Ok::<(), Failure>(())
        })?;
        let Rect { width, height, .. } = region;
        let image = Image::from_pixels(width, height, pixels);
        let image = image.ok_or_else(|| Failure::System(format!("`{}` ends too early", path.display())))?;
        let metadata = metadata.clone();
        Ok(Self { image, estimate: Some(estimate), is_tone_mapped: false, is_denoised: false, metadata })
    }

    fn of_picture(path: &Path) -> Result<Self, Failure> {
        let image = imaging::read(path)?;
        let Facts { format, metadata, .. } = imaging::inspect(path)?;
        let estimate = if format == Format::Exr { variances(path, &image, &metadata)? } else { None };
        let command = text(&metadata, "Command");
        let is_denoised = command.is_some_and(|command| command.contains(" --denoise"));
        Ok(Self { image, estimate, is_tone_mapped: format.is_tone_mapped(), is_denoised, metadata })
    }

    /// What it says about itself under that key.
    pub fn text(&self, key: &str) -> Option<&str> {
        text(&self.metadata, key)
    }
}

/// Whether a file is a film part, by its first bytes.
pub fn is_part(path: &Path) -> bool {
    regular::first_bytes(path, 12).is_ok_and(|start| film::is_part(&start))
}

fn text<'m>(metadata: &'m [(String, String)], key: &str) -> Option<&'m str> {
    metadata.iter().find(|(known, _)| known == key).map(|(_, text)| text.as_str())
}

/// The samples that every pixel has, as the picture says it: `64`, or `16 to 512, ...`.
fn fewest_samples(metadata: &[(String, String)]) -> Option<u32> {
    text(metadata, SAMPLES)?.split(' ').next()?.parse().ok()
}

/// What the layers `variance` and `samples` of an EXR say; without the latter, as many samples everywhere as the picture says that it has.
fn variances(path: &Path, image: &Image, metadata: &[(String, String)]) -> Result<Option<Estimate>, Failure> {
    let Some((width, height, variance)) = read_layer(path, &["variance.R", "variance.G", "variance.B"])? else {
        return Ok(None);
    };
    if (width, height) != (image.width(), image.height()) {
        return Ok(None);
    }
    let count = image.pixels().len();
    let samples = match read_layer(path, &["samples.Y"])? {
        Some((.., samples)) if samples.len() == count => samples.iter().map(|[count, ..]| *count as u32).collect(),
        _ => vec![fewest_samples(metadata).unwrap_or(2 * BLOCK); count],
    };
    let blocks: Vec<u32> = variance
        .iter()
        .zip(&samples)
        .map(|(variance, samples)| if variance.iter().all(|value| value.is_finite()) { samples / BLOCK } else { 0 })
        .collect();
    let pixels = variance.iter().zip(blocks.iter().zip(&samples));
    let variance =
        pixels.map(|(value, (blocks, samples))| estimate::of_mean(Rgb::from(*value), *blocks, *samples)).collect();
    Ok(Some(Estimate { width, height, mean: image.pixels().to_vec(), variance, blocks }))
}
