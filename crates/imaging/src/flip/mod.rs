//! FLIP: how different two pictures look to somebody who flips between them, per pixel from 0 (the same) to 1.
//!
//! - LDR-FLIP (Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, FLIP: a difference evaluator for
//!   alternating images, 2020): colours as the eye blurs them, compared in a space where distances are as they are seen,
//!   and edges and points that one picture has and the other has not.
//! - HDR-FLIP (Andersson, Nilsson, Shirley and Akenine-Möller, Visualizing errors in rendered high dynamic range images, 2021):
//!   the largest LDR-FLIP of each pixel over all exposures that show something of the reference, after a tone curve.

mod color;
mod features;
mod filter;
mod hdr;
mod ramp;

pub use ramp::colors;

use crate::{ImageError, compare::same_size};
use color::{ColorFilters, Opponent};
use features::FeatureFilters;
use hdr::Exposures;
use juggler_math::{Image, Rgb, fun};

/// Pixels in a degree of what the eye sees where nothing else is said: a screen of 3840 pixels on 0.7 m, seen from 0.7 m.
pub const PIXELS_PER_DEGREE: f32 = 67.020_64;

/// Numbers that a file of light may hold beyond all measure; what is above counts as this.
const BRIGHTEST: f32 = 1e9;

/// Which of both was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Range {
    /// Pictures as a screen shows them: light from 0 to 1.
    Ldr,
    /// Light of a scene, by all exposures.
    Hdr,
}

impl Range {
    /// As the papers call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ldr => "LDR",
            Self::Hdr => "HDR",
        }
    }
}

/// How different two pictures look.
#[derive(Clone, Debug, PartialEq)]
pub struct Flip {
    /// Mean of all pixels, 0 to 1.
    pub mean: f64,
    /// Which of both it is.
    pub range: Range,
    /// Each pixel's difference, 0 to 1, row by row.
    pub map: Vec<f32>,
}

/// Measures how different a picture looks from a reference. Light below 0 and what is no number counts as none; for
/// [`Range::Ldr`] light above 1 counts as 1.
pub fn flip(picture: &Image, reference: &Image, range: Range, pixels_per_degree: f32) -> Result<Flip, ImageError> {
    same_size(picture, reference)?;
    let filters = Filters::new(pixels_per_degree);
    let map = match range {
        Range::Ldr => {
            let [picture, reference] = [picture, reference].map(|image| opponent(image, |v| v.clamp(0.0, 1.0)));
            filters.differences(&picture, &reference)
        }
        Range::Hdr => {
            let mut most = vec![0.0; reference.pixels().len()];
            for exposure in Exposures::of(reference.pixels().iter().map(|pixel| known(*pixel))).steps() {
                let gain = fun::exp2(exposure);
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

/// Light that can be reckoned with.
fn known(pixel: Rgb) -> Rgb {
    // The least of a number and none is the number.
    pixel.map(|v| if v.is_nan() { 0.0 } else { v.clamp(0.0, BRIGHTEST) })
}

fn opponent(image: &Image, display: impl Fn(f32) -> f32) -> Opponent {
    Opponent::of(image.width() as usize, image.pixels().iter().map(|pixel| known(*pixel).map(&display)))
}

/// All that depends on how large a pixel is seen.
struct Filters {
    color: ColorFilters,
    feature: FeatureFilters,
}

impl Filters {
    fn new(pixels_per_degree: f32) -> Self {
        let known = if pixels_per_degree.is_nan() { PIXELS_PER_DEGREE } else { pixels_per_degree };
        let pixels_per_degree = f64::from(known.clamp(1.0, 1000.0));
        Self { color: ColorFilters::new(pixels_per_degree), feature: FeatureFilters::new(pixels_per_degree) }
    }

    /// LDR-FLIP of each pixel (2020, equation 17): features make a difference of colours larger.
    fn differences(&self, picture: &Opponent, reference: &Opponent) -> Vec<f32> {
        let mut colors = self.color.differences(picture, reference);
        let features = self.feature.differences(&picture.luminance, &reference.luminance);
        for (color, feature) in colors.iter_mut().zip(features) {
            *color = if *color > 0.0 { fun::powf(*color, 1.0 - feature) } else { 0.0 };
        }
        colors
    }
}

#[cfg(test)]
mod tests;
