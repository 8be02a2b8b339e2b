//! Whether two noisy pictures are the same but for their noise: a test of the hypothesis that both have the same mean
//! (Subr and Arvo, Statistical Hypothesis Testing for Assessing Monte Carlo Estimators, 2007; a test of each pixel with the correction of
//! Šidák is how renderers are tested, Mitsuba among them).
//!
//! Single pixels of few samples are far from normally distributed, and their variances are known by two blocks of samples at worst. So
//! sums are tested: over blocks of 16 × 16 pixels, over 2 × 2 of these, and so on, and over the whole picture; channel by channel. Such
//! a sum's difference Σ d is divided by the root of the smaller one of two numbers:
//! - Σ v + max d², where v are the variances of its pixels' means and max d² is the largest square of a single pixel's difference: one
//!   pixel alone, which may be a sample that nobody could have foreseen, never decides;
//! - Σ d², which is the variance itself where both are the same: samples that are well spread err less than their blocks tell, since
//!   what one block errs the next one makes up for. (Sums that are normalised by themselves are no more likely to be large than Student's t,
//!   whatever the distribution, if only it is symmetric: Efron 1969.)
//!
//! The quotient is held against Student's t. Its degrees of freedom are the number of pixels that take part in the difference,
//! (Σ d²)² / Σ d⁴, or, where variances decide and they are fewer, those of Welch (1947) with the correction by which pixels of few
//! degrees do not count twice, (Σ v)² / Σ (v² / (ν + 2)) - 2.
//!
//! The smallest chance among the blocks is corrected for their number and for the channels (Šidák 1967), whose number counts less the
//! more alike they err (Nyholt 2004); the whole picture is a question of its own, so that a small change of all of it is found as
//! well as a large one of a part.

mod cells;
mod student;

use cells::{Cells, Tested};
use juggler_math::{Rgb, fun};

/// A picture that is known with an error: means of samples and their variances.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Linear light, row by row.
    pub mean: Vec<Rgb>,
    /// Variance of each; infinite where it is not known.
    pub variance: Vec<Rgb>,
    /// Blocks of samples that each variance was drawn from.
    pub blocks: Vec<u32>,
}

/// What the test says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Significance {
    /// The chance of pictures of one and the same mean to differ as much.
    pub p: f64,
    /// Blocks that were tested, of all sizes.
    pub blocks: usize,
    /// The block that differs most.
    pub worst: Option<Worst>,
}

/// Where pictures differ most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// Left, top, width and height in pixels.
    pub area: [u32; 4],
    /// Which channel: 0 red, 1 green, 2 blue.
    pub channel: usize,
    /// Its difference in standard errors; positive where the first picture is brighter.
    pub deviation: f64,
}

/// Why there is no test.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Untested {
    /// Variances are not known.
    #[error("there are too few samples: variances need 32 a pixel or more")]
    TooFew,
    /// Some numbers are none.
    #[error("a picture holds values that are no finite numbers")]
    NotFinite,
    /// They cannot be laid over each other.
    #[error("the pictures differ in size")]
    Sizes,
}

/// Tests whether both are estimates of the same picture. They must not share samples.
pub fn significance(a: &Estimate, b: &Estimate) -> Result<Significance, Untested> {
    let count = a.width as usize * a.height as usize;
    let is_whole = |one: &Estimate| [one.mean.len(), one.variance.len(), one.blocks.len()] == [count; 3];
    if (a.width, a.height) != (b.width, b.height) || !is_whole(a) || !is_whole(b) {
        return Err(Untested::Sizes);
    }
    if [a, b].iter().any(|one| one.blocks.iter().any(|blocks| *blocks < 2)) {
        return Err(Untested::TooFew);
    }
    if [a, b].iter().any(|one| one.mean.iter().chain(&one.variance).any(|pixel| !pixel.is_finite())) {
        return Err(Untested::NotFinite);
    }
    let mut cells = Cells::new(a, b);
    let channels = cells.independent_channels();
    let (mut local, mut blocks) = (Tested::default(), 0);
    while cells.count() > 1 {
        let tested = cells.test();
        blocks += tested.cells;
        local = local.or(tested);
        cells = cells.coarser();
    }
    let whole = cells.test();
    let p_whole = sidak(whole.p, channels);
    let p_local = sidak(local.p, channels * blocks as f64);
    let p = if blocks == 0 { p_whole } else { sidak(p_whole.min(p_local), 2.0) };
    let worst = if p_local < p_whole { local.worst } else { whole.worst };
    Ok(Significance { p, blocks: blocks + whole.cells, worst })
}

/// The chance that the smallest of so many independent chances is at most `p` (Šidák 1967).
fn sidak(p: f64, count: f64) -> f64 {
    if p * count < 1e-6 {
        return p * count;
    }
    if p >= 1.0 { 1.0 } else { 1.0 - fun::exp_f64(count * fun::ln_f64(1.0 - p)) }
}

/// Degrees of freedom of a variance that was drawn from so many blocks of samples, of which the differences of longer runs count four
/// times as much as those of runs of half the length: (Σ w)² / Σ w² (Satterthwaite 1946).
pub fn freedom(blocks: u32) -> f64 {
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
