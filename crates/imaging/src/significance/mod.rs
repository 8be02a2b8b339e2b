//! Statistical test whether two noisy images have the same mean, so that they differ by noise alone
//! (Subr and Arvo, Statistical Hypothesis Testing for Assessing Monte Carlo Estimators, 2007;
//! renderers such as Mitsuba test each pixel with the Šidák correction).
//!
//! Single pixels with few samples are far from normally distributed, and their variances come from
//! as few as two blocks of samples. The test therefore uses sums over pixels: per channel over
//! blocks of 16 × 16 pixels, over 2 × 2 of these and so on, up to the whole image. A sum of
//! differences Σ d is divided by the square root of the smaller of two values:
//! - Σ v + max d², where v is the variance of a pixel's mean and max d² the largest squared
//!   difference of a pixel. A single pixel, which may be a firefly, can never decide the test.
//! - Σ d², an estimate of the variance under the null hypothesis. Low-discrepancy samples have a
//!   smaller error than the variance between blocks suggests, since the errors of blocks cancel.
//!   (Self-normalized sums have tails no heavier than Student's t for any symmetric distribution:
//!   Efron 1969.)
//!
//! The quotient is compared with Student's t distribution. The degrees of freedom are the effective
//! number of pixels in the difference, (Σ d²)² / Σ d⁴, or if fewer and the variances decide, those
//! of Welch (1947) corrected for pixels of few degrees of freedom ν, (Σ v)² / Σ (v² / (ν + 2)) - 2.
//!
//! The smallest p-value over all blocks is corrected for the number of blocks and channels (Šidák
//! 1967); the effective number of channels is lower if their errors are correlated (Nyholt 2004).
//! The whole image is tested separately, so that the test detects a small global change as well as
//! a large local one.

mod pixel_blocks;
mod student;

use juggler_math::{Rgb, portable};
use pixel_blocks::{PixelBlocks, Tested};

/// Noisy image: pixel means with their variances.
#[derive(Clone, Debug, PartialEq)]
pub struct NoisyImage {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Means in linear RGB, row by row.
    pub mean: Vec<Rgb>,
    /// Variance of each mean; infinite if unknown.
    pub variance: Vec<Rgb>,
    /// Number of sample blocks that each variance was estimated from.
    pub blocks: Vec<u32>,
}

/// Result of the test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Significance {
    /// Probability that two images of equal mean differ at least as much.
    pub p: f64,
    /// Number of blocks tested, over all sizes.
    pub blocks: usize,
    /// Block of the most significant difference.
    pub worst: Option<LargestDifference>,
}

/// Location of the most significant difference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LargestDifference {
    /// Left, top, width and height in pixels.
    pub area: [u32; 4],
    /// Channel: 0 red, 1 green, 2 blue.
    pub channel: usize,
    /// Difference in standard errors; positive if the first image is brighter.
    pub deviation: f64,
}

/// Why the images cannot be tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SignificanceError {
    /// A pixel has fewer than two blocks of samples, so its variance is unknown.
    #[error("there are too few samples: variances need at least 32 per pixel")]
    TooFew,
    /// A mean or variance is infinite or NaN.
    #[error("a picture contains values that are not finite")]
    NotFinite,
    /// The sizes differ.
    #[error("the pictures differ in size")]
    Sizes,
}

/// Tests whether two images are estimates of the same mean. They must not share samples.
///
/// # Errors
///
/// The sizes differ, a pixel has too few samples, or a value is not finite.
pub fn significance(a: &NoisyImage, b: &NoisyImage) -> Result<Significance, SignificanceError> {
    let count = a.width as usize * a.height as usize;
    let is_whole = |one: &NoisyImage| [one.mean.len(), one.variance.len(), one.blocks.len()] == [count; 3];
    if (a.width, a.height) != (b.width, b.height) || !is_whole(a) || !is_whole(b) {
        return Err(SignificanceError::Sizes);
    }
    if [a, b].iter().any(|one| one.blocks.iter().any(|blocks| *blocks < 2)) {
        return Err(SignificanceError::TooFew);
    }
    if [a, b].iter().any(|one| one.mean.iter().chain(&one.variance).any(|pixel| !pixel.is_finite())) {
        return Err(SignificanceError::NotFinite);
    }
    let mut grid = PixelBlocks::new(a, b);
    let channels = grid.independent_channels();
    let (mut local, mut blocks) = (Tested::default(), 0);
    while grid.count() > 1 {
        let tested = grid.test();
        blocks += tested.blocks;
        local = local.min_p(tested);
        grid = grid.coarser();
    }
    let whole = grid.test();
    let p_whole = sidak(whole.p, channels);
    let p_local = sidak(local.p, channels * blocks as f64);
    let p = if blocks == 0 { p_whole } else { sidak(p_whole.min(p_local), 2.0) };
    let worst = if p_local < p_whole { local.worst } else { whole.worst };
    Ok(Significance { p, blocks: blocks + whole.blocks, worst })
}

/// Probability that the smallest of `count` independent p-values is at most `p` (Šidák 1967).
fn sidak(p: f64, count: f64) -> f64 {
    if p * count < 1e-6 {
        return p * count;
    }
    if p >= 1.0 { 1.0 } else { 1.0 - portable::exp_f64(count * portable::ln_f64(1.0 - p)) }
}

/// Degrees of freedom of a variance estimated from `blocks` blocks of samples, where differences
/// between runs of twice the length have four times the weight: (Σ w)² / Σ w² (Satterthwaite 1946).
pub fn degrees_of_freedom(blocks: u32) -> f64 {
    let (mut sum, mut squares, mut weight, mut joins) = (0.0, 0.0, 1.0, 1.0);
    for _ in 0..blocks.checked_ilog2().unwrap_or(0) {
        sum += weight * joins;
        squares += weight * weight * joins;
        weight *= 0.25;
        joins *= 2.0;
    }
    if squares > 0.0 { sum * sum / squares } else { 0.0 }
}

#[cfg(test)]
mod tests;
