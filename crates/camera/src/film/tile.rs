//! Tile: a rectangle of pixels with the samples accumulated so far.

use super::sum::{Sum, is_open, joined_divisor, tree_level, variance_divisor};
use super::{AovSums, BLOCK_SAMPLES, ClampedRadiance, Rect};
use juggler_math::Rgb;
use std::ops::Range;

/// Added to the squared mean in the relative error. Below a mean of 0.1 the error becomes absolute,
/// so that of dark pixels stays finite.
const MEAN_OFFSET: f64 = 0.01;

/// Consecutive samples of every pixel of a tile: a node of the tree over all blocks, or the start
/// of a block.
#[derive(Clone, Debug, PartialEq)]
pub struct SampleRun {
    /// Sample indices.
    pub samples: Range<u32>,
    /// Sums of the samples, pixel by pixel, row by row.
    pub sums: Vec<Sum>,
    /// Sums of AOVs and masks, in the same order; empty unless requested.
    pub aov_sums: AovSums,
}

impl SampleRun {
    /// Creates a run without AOVs.
    pub fn new(samples: Range<u32>, sums: Vec<Sum>) -> Self {
        Self { samples, sums, aov_sums: AovSums::default() }
    }
}

/// Rectangle of pixels with the samples accumulated so far, the same samples for all pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    pixels: Rect,
    /// Runs in order, without overlap; siblings in the tree are joined.
    runs: Vec<SampleRun>,
}

/// Error when adding samples to a tile.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TileError {
    /// The tile already has some of the samples.
    #[error("the samples {} to {} occur twice", .0.start, .0.end)]
    Duplicate(Range<u32>),
    /// The samples are neither a node of the tree over blocks nor the start of a block.
    #[error("the samples {} to {} do not align with blocks", .0.start, .0.end)]
    Misaligned(Range<u32>),
    /// The samples belong to other pixels.
    #[error("the samples belong to other pixels")]
    OtherPixels,
    /// The samples have other AOVs or masks than the tile.
    #[error("the samples have other AOVs than the tile")]
    FilmAovs,
}

impl Tile {
    /// Creates a tile without samples.
    pub fn new(pixels: Rect) -> Self {
        Self { pixels, runs: Vec::new() }
    }

    /// Pixels of the tile.
    pub fn pixels(&self) -> Rect {
        self.pixels
    }

    /// Runs of the tile, in order.
    pub fn runs(&self) -> &[SampleRun] {
        &self.runs
    }

    /// The runs of the tile, in order.
    pub fn into_runs(self) -> Vec<SampleRun> {
        self.runs
    }

    /// Number of samples per pixel from the first up to the first missing one.
    pub fn gapless_samples(&self) -> u32 {
        self.runs.iter().fold(0, |end, run| if run.samples.start == end { run.samples.end } else { end })
    }

    /// Whether no sample is missing before the last one.
    pub fn is_gapless(&self) -> bool {
        self.gapless_samples() == self.runs.last().map_or(0, |run| run.samples.end)
    }

    /// Whether the tile has no samples.
    pub fn is_empty(&self) -> bool {
        self.runs.is_empty()
    }

    /// Number of samples per pixel.
    pub fn samples_per_pixel(&self) -> u32 {
        self.runs.iter().map(|run| run.samples.end - run.samples.start).sum()
    }

    /// First contiguous range of missing samples within `among`.
    pub fn missing(&self, among: Range<u32>) -> Option<Range<u32>> {
        let mut start = among.start;
        for run in &self.runs {
            if run.samples.start > start {
                return (start < among.end).then(|| start..among.end.min(run.samples.start));
            }
            start = start.max(run.samples.end);
        }
        (start < among.end).then_some(start..among.end)
    }

    /// All contiguous ranges of missing samples within `among`, in order.
    pub fn all_missing(&self, among: Range<u32>) -> Vec<Range<u32>> {
        let next = |missing: &Range<u32>| self.missing(missing.end..among.end);
        std::iter::successors(self.missing(among.clone()), next).collect()
    }

    /// Removes and returns the incomplete block that ends before sample `end`, to continue it.
    pub fn take_open_block(&mut self, end: u32) -> Option<SampleRun> {
        let index = self.runs.iter().position(|run| run.samples.end == end && is_open(&run.samples))?;
        Some(self.runs.remove(index))
    }

    /// Adds a run. Runs may come in any order; the result is the same to the bit.
    pub fn add(&mut self, run: SampleRun) -> Result<(), TileError> {
        let Range { start, end } = run.samples;
        if run.sums.len() as u64 != self.pixels.area() || !run.aov_sums.fits_pixels(run.sums.len()) {
            return Err(TileError::OtherPixels);
        }
        if self.runs.first().is_some_and(|other| !other.aov_sums.fits(&run.aov_sums)) {
            return Err(TileError::FilmAovs);
        }
        if tree_level(&run.samples).is_none() && !is_open(&run.samples) {
            return Err(TileError::Misaligned(run.samples));
        }
        let index = self.runs.partition_point(|other| other.samples.start < start);
        let doubled = |other: &SampleRun| other.samples.start < end && other.samples.end > start;
        let neighbors = [index.checked_sub(1), Some(index)];
        if neighbors.into_iter().flatten().filter_map(|at| self.runs.get(at)).any(doubled) {
            return Err(TileError::Duplicate(run.samples));
        }
        self.runs.insert(index, run);
        self.join(index);
        Ok(())
    }

    /// Adds all runs of another tile of the same pixels.
    pub fn merge(&mut self, other: Self) -> Result<(), TileError> {
        if other.pixels != self.pixels {
            return Err(TileError::OtherPixels);
        }
        other.runs.into_iter().try_for_each(|run| self.add(run))
    }

    /// Joins the run at `index` with its sibling in the tree, and repeats with the result.
    fn join(&mut self, mut index: usize) {
        while let Some(run) = self.runs.get(index)
            && let Some(level) = tree_level(&run.samples)
        {
            let is_right = (run.samples.start / BLOCK_SAMPLES) >> level & 1 == 1;
            let left = if is_right { index.wrapping_sub(1) } else { index };
            let Some([a, b]) = self.runs.get_mut(left..).and_then(<[SampleRun]>::first_chunk_mut) else { return };
            if a.samples.end != b.samples.start || a.samples.len() != b.samples.len() {
                return;
            }
            for (sum, next) in a.sums.iter_mut().zip(&b.sums) {
                *sum = sum.joined(next, [1 << level; 2]);
            }
            a.aov_sums = std::mem::take(&mut a.aov_sums).joined(&b.aov_sums);
            a.samples.end = b.samples.end;
            self.runs.remove(left + 1);
            index = left;
        }
    }

    /// Finished pixels, row by row: the means of the samples.
    pub fn means(&self) -> Vec<Rgb> {
        let count = f64::from(self.samples_per_pixel().max(1));
        let mean = |total: [f64; 3]| {
            let [r, g, b] = total.map(|total| (total / count) as f32);
            Rgb::new(r, g, b)
        };
        (0..self.pixels.area() as usize).map(|pixel| mean(self.total(pixel))).collect()
    }

    /// Writes the finished pixels into `pixels`, the pixels of an enclosing `band`, row by row.
    pub fn copy_to(&self, band: &Rect, pixels: &mut [Rgb]) {
        self.pixels.copy_into(&self.means(), band, pixels);
    }

    fn total(&self, pixel: usize) -> [f64; 3] {
        self.runs.iter().filter_map(|run| run.sums.get(pixel)).fold([0.0; 3], |total, sum| {
            let mut total = total;
            for (total, more) in total.iter_mut().zip(sum.total) {
                *total += more;
            }
            total
        })
    }

    /// Sums of AOVs and masks over all samples.
    pub fn aov_sums(&self) -> AovSums {
        let mut runs = self.runs.iter().map(|run| &run.aov_sums);
        let first = runs.next().cloned().unwrap_or_default();
        runs.fold(first, AovSums::joined)
    }

    /// Radiance that clamping removed from the finished pixels.
    pub fn clamped(&self) -> ClampedRadiance {
        let count = f64::from(self.samples_per_pixel().max(1));
        (0..self.pixels.area() as usize).fold(ClampedRadiance::default(), |mut clamped, pixel| {
            let sums = self.runs.iter().filter_map(|run| run.sums.get(pixel));
            clamped.add(sums.fold(0.0, |total, sum| total + f64::from(sum.clamped)) / count);
            clamped
        })
    }

    /// Squared relative error: the mean over all pixels of the variance of the mean divided by the
    /// squared mean + 0.01 (relMSE, Rousselle, Knaus, Zwicker 2011). `None` for fewer than two
    /// blocks.
    pub fn relative_variance(&self) -> Option<f64> {
        let area = self.pixels.area() as usize;
        let mut sum = 0.0;
        for pixel in 0..area {
            let PixelStatistics { mean, variance, blocks } = self.statistics(pixel);
            if blocks < 2 {
                return None;
            }
            let gray = (mean[0] + mean[1] + mean[2]) / 3.0;
            sum += (variance[0] + variance[1] + variance[2]) / 3.0 / (gray * gray + MEAN_OFFSET);
        }
        Some(sum / area.max(1) as f64)
    }

    /// Mean of one pixel and its variance, estimated from complete blocks. The variance is 0 for
    /// fewer than two blocks.
    pub fn statistics(&self, pixel: usize) -> PixelStatistics {
        let (mut sum, mut blocks, mut divisor) = (Sum::default(), 0, 0.0);
        for run in &self.runs {
            let (Some(level), Some(next)) = (tree_level(&run.samples), run.sums.get(pixel)) else { continue };
            let more = 1 << level;
            (sum, divisor) = match blocks {
                0 => (*next, variance_divisor(level)),
                _ => (sum.joined(next, [blocks, more]), joined_divisor(divisor, variance_divisor(level))),
            };
            blocks += more;
        }
        PixelStatistics::from_sum(&sum, blocks, divisor)
    }
}

/// Mean of a pixel's samples and its variance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PixelStatistics {
    /// Mean, linear RGB.
    pub mean: [f64; 3],
    /// Variance of the mean.
    pub variance: [f64; 3],
    /// Number of blocks that both are estimated from.
    pub blocks: u32,
}

impl PixelStatistics {
    fn from_sum(sum: &Sum, blocks: u32, divisor: f64) -> Self {
        let (count, size) = (f64::from(blocks.max(1)), f64::from(BLOCK_SAMPLES));
        let divisor = if divisor > 0.0 { divisor } else { 1.0 };
        Self {
            mean: sum.total.map(|total| total / (count * size)),
            variance: sum.squared_deviations.map(|deviations| f64::from(deviations) / (divisor * count * size * size)),
            blocks,
        }
    }
}
