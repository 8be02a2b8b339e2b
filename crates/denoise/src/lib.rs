//! Takes the noise out of path traced pictures, with the same bits on every machine and any number of threads.
//!
//! The picture comes as two halves: means of disjoint halves of the samples. What differs between them is noise, so they say
//! how much of it there is where, and each half can be filtered with weights that only the other one knows
//! (cross filtering: what is an accident in one half is not taken for an edge). With them come features, pictures of
//! what is seen: albedo, normal and depth, as halves too.
//!
//! 1. What is no number is filled in, outliers that the other half knows nothing of are cut (`outliers`), the features are
//!    filtered by themselves (`features`), and the colour is divided by the albedo (`prepare`).
//! 2. Non-local means of each half give weights for the other (`weights`: Rousselle, Knaus, Zwicker 2012; Rousselle,
//!    Manzi, Zwicker 2013).
//! 3. With these weights the colours around every other pixel of every other row are fitted by a linear function of place and features, which
//!    is then spread over all the pixels around it (`regression`: Bitterli et al. 2016, sections 4 and 5). Deviations: windows
//!    on a grid, no choice among bandwidths, ridge instead of truncated singular values, features also in the weights.
//! 4. The filtered halves and the unfiltered ones tell how wrong the filter is compared with the noise; by that the input is
//!    mixed in (`blend`), so that pictures of many samples are left as they are.
//! 5. Single bright pixels that are left are cut (`speckles`), and every neighborhood and the whole picture get the mean of the
//!    input (`energy`); in between, pixels that are brighter than both halves allow are dimmed (`ceiling`).

mod blend;
mod blur;
mod ceiling;
mod energy;
mod features;
mod grid;
mod outliers;
mod prepare;
mod regression;
mod speckles;
mod strips;
mod tile;
mod weights;

#[cfg(test)]
mod tests;

pub use fearless_simd::Level as SimdLevel;

use juggler_math::{Rgb, Vec3};
use std::ops::Range;

/// Pictures of what is seen in each pixel, two halves each like the colour's; all optional.
#[derive(Clone, Copy, Debug, Default)]
pub struct Features<'a> {
    /// How much light the surface gives back, 0..1 in each channel; black where there is none.
    pub albedo: Option<[&'a [Rgb]; 2]>,
    /// Shading normal, world space; zero where there is no surface. A mean of different ones is shorter than 1.
    pub normal: Option<[&'a [Vec3]; 2]>,
    /// Distance along the ray, scene units; zero or infinite where there is no surface.
    pub depth: Option<[&'a [f32]; 2]>,
}

/// A picture with noise. Pixels stand row by row from the top left.
#[derive(Clone, Copy, Debug)]
pub struct Noisy<'a> {
    width: usize,
    height: usize,
    halves: [&'a [Rgb]; 2],
    features: Features<'a>,
}

/// A part of a picture has not `width × height` pixels, or there are none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what} has {found} pixels instead of {width} × {height}")]
pub struct SizeError {
    what: &'static str,
    found: usize,
    width: usize,
    height: usize,
}

impl<'a> Noisy<'a> {
    /// `halves`: linear light, means of two disjoint halves of the samples. Colours that are not finite count as unknown.
    pub fn new(width: usize, height: usize, halves: [&'a [Rgb]; 2], features: Features<'a>) -> Result<Self, SizeError> {
        let check = |what: &'static str, found: usize| match width.checked_mul(height) {
            Some(wanted) if wanted == found && wanted > 0 => Ok(()),
            _ => Err(SizeError { what, found, width, height }),
        };
        halves.iter().try_for_each(|half| check("half of the picture", half.len()))?;
        features.albedo.iter().flatten().try_for_each(|half| check("albedo", half.len()))?;
        features.normal.iter().flatten().try_for_each(|half| check("normal", half.len()))?;
        features.depth.iter().flatten().try_for_each(|half| check("depth", half.len()))?;
        Ok(Self { width, height, halves, features })
    }

    /// Some of the picture's rows.
    fn rows(&self, rows: Range<usize>) -> Self {
        let range = rows.start * self.width..rows.end * self.width;
        let Features { albedo, normal, depth } = self.features;
        let features = Features {
            albedo: albedo.map(|halves| halves.map(|half| &half[range.clone()])),
            normal: normal.map(|halves| halves.map(|half| &half[range.clone()])),
            depth: depth.map(|halves| halves.map(|half| &half[range.clone()])),
        };
        let halves = self.halves.map(|half| &half[range.clone()]);
        Self { width: self.width, height: rows.len(), halves, features }
    }
}

/// What the filter may do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// How different colours may be, in standard deviations of their noise, to count as alike: 1 is the tried value,
    /// less keeps more noise and more detail.
    pub strength: f32,
    /// Whether pixels that are far brighter in one half than everything around them in both are cut, and single bright pixels
    /// that are left after filtering. They leave blotches otherwise. Their light goes to their neighborhoods;
    /// [`Denoised::moved`] reports how much the first of these two steps moved.
    pub cut_outliers: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self { strength: 1.0, cut_outliers: true }
    }
}

/// A picture without noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Denoised {
    /// Linear light, row by row from the top left.
    pub pixels: Vec<Rgb>,
    /// Share of the picture's light (mean of the channels) that was moved from outliers to their neighborhoods, 0 to 1. The mean
    /// of the picture stays that of the input.
    pub moved: f64,
}

/// The picture without noise, on the threads of the current rayon pool.
pub fn denoise(noisy: &Noisy, settings: &Settings) -> Vec<Rgb> {
    denoise_unless(noisy, settings, &|| false).map(|denoised| denoised.pixels).unwrap_or_default()
}

/// Like [`denoise`], but asks now and then (about 50 times a picture of 1280 × 720, from any thread) whether to stop; `None`
/// when it did.
pub fn denoise_unless(noisy: &Noisy, settings: &Settings, cancelled: &(dyn Fn() -> bool + Sync)) -> Option<Denoised> {
    denoise_at(SimdLevel::new(), noisy, settings, cancelled)
}

/// Like [`denoise_unless`], on a vector unit of the caller's choice; it shows in the time alone.
pub fn denoise_at(
    level: SimdLevel,
    noisy: &Noisy,
    settings: &Settings,
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Option<Denoised> {
    strips::denoise(level, noisy, settings, cancelled, strips::rows(noisy.width))
}
