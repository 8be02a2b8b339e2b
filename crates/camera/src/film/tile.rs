//! A rectangle of pixels with the samples that are there so far.

use super::sum::{Sum, is_open, joined_weight, level, weight};
use super::{BLOCK, Clamped, Extras, Rect};
use juggler_math::Rgb;
use std::ops::Range;

/// What keeps the relative error of dark pixels finite: below 0.1 it goes over into an absolute one.
const DARK: f64 = 0.01;

/// Consecutive samples of every pixel of a tile: a node of the tree over all blocks, or the beginning of a block.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Which samples.
    pub samples: Range<u32>,
    /// Their sums, pixel by pixel, row by row.
    pub sums: Vec<Sum>,
    /// The same of what they have beside their radiance, if anything was asked for.
    pub extras: Extras,
}

impl Run {
    /// Of nothing but radiance.
    pub fn new(samples: Range<u32>, sums: Vec<Sum>) -> Self {
        Self { samples, sums, extras: Extras::default() }
    }
}

/// A rectangle of pixels with the samples that are there so far, all pixels alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    pixels: Rect,
    /// In order, none overlapping, neighbours in the tree joined.
    runs: Vec<Run>,
}

/// Why samples cannot be added to a tile.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TileError {
    /// Some of them are there already.
    #[error("the samples {} to {} are there twice", .0.start, .0.end)]
    Doubled(Range<u32>),
    /// They are not cut at blocks of samples as they must be.
    #[error("the samples {} to {} are no whole run of blocks", .0.start, .0.end)]
    Uneven(Range<u32>),
    /// They are of other pixels.
    #[error("the samples are of other pixels")]
    Pixels,
    /// They have other layers than those that are there.
    #[error("the samples have other layers than those that are there")]
    Layers,
}

impl Tile {
    /// Without samples.
    pub fn new(pixels: Rect) -> Self {
        Self { pixels, runs: Vec::new() }
    }

    /// Which pixels.
    pub fn pixels(&self) -> Rect {
        self.pixels
    }

    /// The samples that are there, in order.
    pub fn runs(&self) -> &[Run] {
        &self.runs
    }

    /// How many samples from the first on are there without a gap.
    pub fn samples(&self) -> u32 {
        self.runs.iter().fold(0, |end, run| if run.samples.start == end { run.samples.end } else { end })
    }

    /// Whether there is no gap from the first sample to the last that is there.
    pub fn is_gapless(&self) -> bool {
        self.samples() == self.runs.last().map_or(0, |run| run.samples.end)
    }

    /// Whether no samples are there.
    pub fn is_empty(&self) -> bool {
        self.runs.is_empty()
    }

    /// How many samples are there.
    pub fn count(&self) -> u32 {
        self.runs.iter().map(|run| run.samples.end - run.samples.start).sum()
    }

    /// The first of the samples `among` that are missing, as far as they follow each other.
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

    /// Takes the begun block out whose samples end before `end`, to go on with it.
    pub fn take_open(&mut self, end: u32) -> Option<Run> {
        let place = self.runs.iter().position(|run| run.samples.end == end && is_open(&run.samples))?;
        Some(self.runs.remove(place))
    }

    /// Adds a run, whatever the order in which runs come: the result is the same to the bit.
    pub fn add(&mut self, run: Run) -> Result<(), TileError> {
        let Range { start, end } = run.samples;
        if run.sums.len() as u64 != self.pixels.area() || !run.extras.is_of(run.sums.len()) {
            return Err(TileError::Pixels);
        }
        if self.runs.first().is_some_and(|other| !other.extras.fits(&run.extras)) {
            return Err(TileError::Layers);
        }
        if level(&run.samples).is_none() && !is_open(&run.samples) {
            return Err(TileError::Uneven(run.samples));
        }
        let place = self.runs.partition_point(|other| other.samples.start < start);
        let doubled = |other: &Run| other.samples.start < end && other.samples.end > start;
        let neighbours = [place.checked_sub(1), Some(place)];
        if neighbours.into_iter().flatten().filter_map(|at| self.runs.get(at)).any(doubled) {
            return Err(TileError::Doubled(run.samples));
        }
        self.runs.insert(place, run);
        self.join(place);
        Ok(())
    }

    /// Adds everything that another tile of the same pixels holds.
    pub fn merge(&mut self, other: Self) -> Result<(), TileError> {
        if other.pixels != self.pixels {
            return Err(TileError::Pixels);
        }
        other.runs.into_iter().try_for_each(|run| self.add(run))
    }

    /// Joins the run at `place` with its neighbour in the tree, and the result with its own.
    fn join(&mut self, mut place: usize) {
        while let Some(run) = self.runs.get(place)
            && let Some(level) = level(&run.samples)
        {
            let is_right = (run.samples.start / BLOCK) >> level & 1 == 1;
            let left = if is_right { place.wrapping_sub(1) } else { place };
            let Some([a, b]) = self.runs.get_mut(left..).and_then(<[Run]>::first_chunk_mut) else { return };
            if a.samples.end != b.samples.start || a.samples.len() != b.samples.len() {
                return;
            }
            for (sum, next) in a.sums.iter_mut().zip(&b.sums) {
                *sum = sum.joined(next, [1 << level; 2]);
            }
            a.extras = std::mem::take(&mut a.extras).joined(&b.extras);
            a.samples.end = b.samples.end;
            self.runs.remove(left + 1);
            place = left;
        }
    }

    /// The finished pixels, row by row: the means of the samples that are there.
    pub fn means(&self) -> Vec<Rgb> {
        let count = f64::from(self.count().max(1));
        let mean = |total: [f64; 3]| {
            let [r, g, b] = total.map(|total| (total / count) as f32);
            Rgb::new(r, g, b)
        };
        (0..self.pixels.area() as usize).map(|pixel| mean(self.total(pixel))).collect()
    }

    /// Writes the finished pixels to their places in a `band` that holds the tile; its pixels row by row.
    pub fn copy_to(&self, band: &Rect, pixels: &mut [Rgb]) {
        self.pixels.copy(&self.means(), band, pixels);
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

    /// The sums of all that the samples have beside their radiance.
    pub fn extras(&self) -> Extras {
        let mut runs = self.runs.iter().map(|run| &run.extras);
        let first = runs.next().cloned().unwrap_or_default();
        runs.fold(first, Extras::joined)
    }

    /// What clamping took off the finished pixels.
    pub fn clamped(&self) -> Clamped {
        let count = f64::from(self.count().max(1));
        (0..self.pixels.area() as usize).fold(Clamped::default(), |mut clamped, pixel| {
            let sums = self.runs.iter().filter_map(|run| run.sums.get(pixel));
            clamped.add(sums.fold(0.0, |total, sum| total + f64::from(sum.clamped)) / count);
            clamped
        })
    }

    /// How far off the pixels are, as the square of the relative error's root mean square: the mean over all pixels of
    /// the variance of the mean over its square, kept off zero by 0.01 (relMSE, Rousselle, Knaus, Zwicker 2011).
    /// `None` of fewer than two blocks.
    pub fn relative_variance(&self) -> Option<f64> {
        let area = self.pixels.area() as usize;
        let mut sum = 0.0;
        for pixel in 0..area {
            let Statistics { mean, variance, blocks } = self.statistics(pixel);
            if blocks < 2 {
                return None;
            }
            let gray = (mean[0] + mean[1] + mean[2]) / 3.0;
            sum += (variance[0] + variance[1] + variance[2]) / 3.0 / (gray * gray + DARK);
        }
        Some(sum / area.max(1) as f64)
    }

    /// Mean and its variance, as the blocks of samples give it, of one pixel; no variance of fewer than two blocks.
    /// Blocks that are not whole are left out.
    pub fn statistics(&self, pixel: usize) -> Statistics {
        let (mut sum, mut blocks, mut divisor) = (Sum::default(), 0, 0.0);
        for run in &self.runs {
            let (Some(level), Some(next)) = (level(&run.samples), run.sums.get(pixel)) else { continue };
            let more = 1 << level;
            (sum, divisor) = match blocks {
                0 => (*next, weight(level)),
                _ => (sum.joined(next, [blocks, more]), joined_weight(divisor, weight(level))),
            };
            blocks += more;
        }
        Statistics::of(&sum, blocks, divisor)
    }
}

/// Mean of a pixel's samples, and how far off it may be.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Statistics {
    /// Linear RGB.
    pub mean: [f64; 3],
    /// Variance of the mean.
    pub variance: [f64; 3],
    /// Blocks of samples that both were drawn from.
    pub blocks: u32,
}

impl Statistics {
    fn of(sum: &Sum, blocks: u32, divisor: f64) -> Self {
        let (count, size) = (f64::from(blocks.max(1)), f64::from(BLOCK));
        let divisor = if divisor > 0.0 { divisor } else { 1.0 };
        Self {
            mean: sum.total.map(|total| total / (count * size)),
            variance: sum.spread.map(|spread| f64::from(spread) / (divisor * count * size * size)),
            blocks,
        }
    }
}
