//! FLIP: perceived difference between two images shown in alternation, per pixel from 0 (equal) to
//! 1.
//!
//! - LDR-FLIP (Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, FLIP: a
//!   difference evaluator for alternating images, 2020): color differences after contrast
//!   sensitivity filtering, measured in a perceptually uniform space, combined with differences of
//!   edges and points.
//! - HDR-FLIP (Andersson, Nilsson, Shirley and Akenine-Möller, Visualizing errors in rendered high
//!   dynamic range images, 2021): maximum LDR-FLIP of each pixel over a range of exposures, after
//!   tone mapping.

mod color;
mod color_map;
mod features;
mod filter;
mod hdr;

pub use color_map::color_map;

use crate::ImageError;
use crate::compare::{Largest, same_size};
use color::{ColorFilters, Opponent};
use features::FeatureFilters;
use hdr::Exposures;
use juggler_math::{Image, Rgb, portable};

/// Default pixels per degree of visual angle: a display of 0.7 m width with 3840 pixels, seen from
/// 0.7 m.
pub const PIXELS_PER_DEGREE: f32 = 67.020_64;

/// Upper clamp for radiance in files.
const MAX_RADIANCE: f32 = 1e9;

/// Dynamic range of the compared images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DynamicRange {
    /// LDR-FLIP: display values, linear from 0 to 1.
    Ldr,
    /// HDR-FLIP: scene-referred radiance, over several exposures.
    Hdr,
}

impl DynamicRange {
    /// Name as used in the papers.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ldr => "LDR",
            Self::Hdr => "HDR",
        }
    }
}

/// Result of a FLIP comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct Flip {
    /// Mean over all pixels, 0 to 1.
    pub mean: f64,
    /// Variant that was used.
    pub range: DynamicRange,
    /// Difference of each pixel, 0 to 1, row by row.
    pub map: Vec<f32>,
}

impl Flip {
    /// Largest difference of a pixel with column and row of the first such pixel, for images of this
    /// width; `None` without differences.
    pub fn largest(&self, width: u32) -> Option<(f64, [u32; 2])> {
        let mut largest = Largest::default();
        self.map.iter().enumerate().for_each(|(index, value)| largest.include(f64::from(*value), index));
        Some((largest.value, largest.pixel(width)?))
    }
}

/// Computes FLIP between an image and a reference, both in linear RGB. Negative values and NaN
/// count as 0; for [`DynamicRange::Ldr`], values above 1 count as 1. `pixels_per_degree` is clamped
/// to 1 to 1000.
///
/// # Errors
///
/// [`ImageError::SizesDiffer`] if the sizes differ.
pub fn flip(
    picture: &Image,
    reference: &Image,
    range: DynamicRange,
    pixels_per_degree: f32,
) -> Result<Flip, ImageError> {
    same_size(picture, reference)?;
    let filters = Filters::new(pixels_per_degree);
    let map = match range {
        DynamicRange::Ldr => {
            let [picture, reference] = [picture, reference].map(|image| opponent(image, |v| v.clamp(0.0, 1.0)));
            filters.differences(&picture, &reference)
        }
        DynamicRange::Hdr => {
            let mut most = vec![0.0; reference.pixels().len()];
            for exposure in Exposures::from_reference(reference.pixels().iter().map(|pixel| sanitize(*pixel))).steps() {
                let gain = portable::exp2(exposure);
                let [picture, reference] =
                    [picture, reference].map(|image| opponent(image, |v| hdr::tone_mapped(v * gain)));
                let differences = filters.differences(&picture, &reference);
                most.iter_mut().zip(differences).for_each(|(most, v)| *most = v.max(*most));
            }
            most
        }
    };
    let mean = map.iter().map(|v| f64::from(*v)).sum::<f64>() / map.len().max(1) as f64;
    Ok(Flip { mean, range, map })
}

/// Clamps channels to finite, non-negative values.
fn sanitize(pixel: Rgb) -> Rgb {
    pixel.map(|v| if v.is_nan() { 0.0 } else { v.clamp(0.0, MAX_RADIANCE) })
}

fn opponent(image: &Image, display: impl Fn(f32) -> f32) -> Opponent {
    Opponent::from_linear(image.width() as usize, image.pixels().iter().map(|pixel| sanitize(*pixel).map(&display)))
}

/// Filters for one viewing distance.
struct Filters {
    color: ColorFilters,
    feature: FeatureFilters,
}

impl Filters {
    fn new(pixels_per_degree: f32) -> Self {
        let resolution = if pixels_per_degree.is_nan() { PIXELS_PER_DEGREE } else { pixels_per_degree };
        let pixels_per_degree = f64::from(resolution.clamp(1.0, 1000.0));
        Self { color: ColorFilters::new(pixels_per_degree), feature: FeatureFilters::new(pixels_per_degree) }
    }

    /// LDR-FLIP of each pixel (2020, equation 17): feature differences amplify color differences.
    fn differences(&self, picture: &Opponent, reference: &Opponent) -> Vec<f32> {
        let mut colors = self.color.differences(picture, reference);
        let features = self.feature.differences(&picture.luminance, &reference.luminance);
        for (color, feature) in colors.iter_mut().zip(features) {
            *color = if *color > 0.0 { portable::powf(*color, 1.0 - feature) } else { 0.0 };
        }
        colors
    }
}

#[cfg(test)]
mod tests;
