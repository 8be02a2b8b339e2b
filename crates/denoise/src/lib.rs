//! Denoiser for path-traced pictures. The result is bit for bit the same on every machine and with
//! any number of threads.
//!
//! The input consists of two half buffers: means of disjoint halves of the samples. Their
//! difference estimates the variance, and each half can be filtered with weights from the other
//! (cross filtering), so that the weights are independent of the noise that they filter. Feature
//! buffers of albedo, normal and depth come as halves, too.
//!
//! 1. Replace values that are not finite, clamp outliers that the other half does not confirm
//!    (`outliers`), prefilter the features (`features`), and divide the color by the albedo
//!    (`prepare`).
//! 2. Compute non-local means weights of each half for the other (`weights`: Rousselle, Knaus,
//!    Zwicker 2012; Rousselle, Manzi, Zwicker 2013).
//! 3. Around every other pixel of every other row, fit the color by a linear function of position
//!    and features, and accumulate the fitted values over the window (`regression`: Bitterli et al.
//!    2016, sections 4 and 5). Deviations: windows on a grid, one bandwidth, ridge regression
//!    instead of truncated singular values, features also in the weights.
//! 4. Estimate the filter's bias and the input's variance from filtered and unfiltered halves, and
//!    blend filter and input accordingly (`blend`), so that pictures of many samples stay
//!    unchanged.
//! 5. Clamp single bright pixels that remain (`speckles`), and restore the mean of the input in
//!    every neighborhood and in the whole picture (`energy`). In between, dim pixels that are
//!    brighter than both halves allow (`upper_bound`), and limit single bright pixels again
//!    (`highlights`).

mod blend;
mod blur;
mod energy;
mod features;
mod grid;
mod highlights;
mod noise;
mod outliers;
mod prepare;
mod regression;
mod speckles;
mod split;
mod strips;
mod tile;
mod upper_bound;
mod weights;
mod window;

#[cfg(test)]
mod tests;

pub use fearless_simd::Level as SimdLevel;
pub use split::split;

use juggler_math::{Rgb, Vec3};
use std::ops::Range;

/// Feature buffers, each as two halves like the color; all optional.
#[derive(Clone, Copy, Debug, Default)]
pub struct Features<'a> {
    /// Albedo, 0 to 1 in each channel; black where there is no surface.
    pub albedo: Option<[&'a [Rgb]; 2]>,
    /// Shading normal, in world space; zero where there is no surface. The mean of different
    /// normals is shorter than 1.
    pub normal: Option<[&'a [Vec3]; 2]>,
    /// Distance along the ray, in scene units; zero or infinite where there is no surface.
    pub depth: Option<[&'a [f32]; 2]>,
}

/// A noisy picture as two halves, with features. Pixels are in row-major order from the top left.
#[derive(Clone, Copy, Debug)]
pub struct Noisy<'a> {
    width: usize,
    height: usize,
    halves: [&'a [Rgb]; 2],
    features: Features<'a>,
}

/// A buffer does not have `width × height` pixels, or the picture is empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what} has {found} pixels instead of {width} × {height}")]
pub struct SizeError {
    what: &'static str,
    found: usize,
    width: usize,
    height: usize,
}

impl<'a> Noisy<'a> {
    /// Creates the input from `halves`, means of two disjoint halves of the samples in linear
    /// light. Colors that are not finite count as unknown.
    pub fn new(width: usize, height: usize, halves: [&'a [Rgb]; 2], features: Features<'a>) -> Result<Self, SizeError> {
        let check = |what: &'static str, found: usize| match width.checked_mul(height) {
            Some(expected) if expected == found && expected > 0 => Ok(()),
            _ => Err(SizeError { what, found, width, height }),
        };
        halves.iter().try_for_each(|half| check("half of the picture", half.len()))?;
        features.albedo.iter().flatten().try_for_each(|half| check("albedo", half.len()))?;
        features.normal.iter().flatten().try_for_each(|half| check("normal", half.len()))?;
        features.depth.iter().flatten().try_for_each(|half| check("depth", half.len()))?;
        Ok(Self { width, height, halves, features })
    }

    /// A range of the picture's rows.
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

/// Settings of the filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Filter strength: the bandwidth of color differences, relative to the tested value of 1, at
    /// least 0. Smaller values keep more detail and more noise.
    pub strength: f32,
    /// Whether to clamp outliers, pixels far brighter in one half than their surroundings in both,
    /// and single bright pixels that remain after filtering. Otherwise they leave blotches. Their
    /// energy goes to their neighborhoods; [`Denoised::moved_energy`] reports how much the first of
    /// these two steps moved.
    pub cut_outliers: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self { strength: 1.0, cut_outliers: true }
    }
}

/// A denoised picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Denoised {
    /// Linear light, in row-major order from the top left.
    pub pixels: Vec<Rgb>,
    /// Fraction of the picture's energy (mean of the channels) that was moved from outliers to
    /// their neighborhoods, 0 to 1. The mean of the picture stays that of the input.
    pub moved_energy: f64,
}

/// Denoises a picture on the threads of the current rayon pool.
pub fn denoise(noisy: &Noisy, settings: &Settings) -> Vec<Rgb> {
    denoise_unless(noisy, settings, &|| false).map(|denoised| denoised.pixels).unwrap_or_default()
}

/// [`denoise`] with cancellation: calls `cancelled` from any thread, about 50 times for a picture
/// of 1280 × 720 pixels, and returns `None` once it returns true.
pub fn denoise_unless(noisy: &Noisy, settings: &Settings, cancelled: &(dyn Fn() -> bool + Sync)) -> Option<Denoised> {
    denoise_at(SimdLevel::new(), noisy, settings, cancelled)
}

/// [`denoise_unless`] with a given SIMD instruction set, which affects only the time.
pub fn denoise_at(
    level: SimdLevel,
    noisy: &Noisy,
    settings: &Settings,
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Option<Denoised> {
    strips::denoise(level, noisy, settings, cancelled, strips::rows(noisy.width))
}
