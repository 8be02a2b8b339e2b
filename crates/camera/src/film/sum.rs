//! Sums over blocks of samples, joined along a fixed binary tree.

use super::{AovSums, BLOCK_SAMPLES, HitIds};
use arrayvec::ArrayVec;
use juggler_math::Rgb;
use std::ops::Range;

/// Maximum number of runs of a pixel's samples: one for each bit of the block number on the way up
/// the tree, one on the way down, and an open block.
pub(super) const MAX_RUNS: usize = 64;

/// Weight of a deviation per level down the tree. Each level has twice as many joins as the one
/// above, so its total weight is half.
const LEVEL_WEIGHT: f64 = 0.25;

/// Largest channel of a sample that is counted: the `f32` sum of a block of such samples is finite.
const MAX_SAMPLE: f32 = 1e36;

/// Whether a sample counts. A sample with a channel that is NaN, infinite or beyond 10^36 counts as
/// black, so the sums of a film are always finite.
#[inline]
pub fn is_counted(sample: Rgb) -> bool {
    sample.to_array().iter().all(|channel| channel.abs() <= MAX_SAMPLE)
}

/// Sum over one pixel's samples of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sum {
    /// Sum of the samples, linear RGB.
    pub total: [f64; 3],
    /// Weighted sum of the squared deviations between the two sides of each join of the run's
    /// blocks (Chan, Golub and LeVeque 1979), where each level down the tree has a quarter of the
    /// weight. Well-distributed samples make long runs more alike than short ones, and the long
    /// runs tell the error of the mean.
    pub squared_deviations: [f32; 3],
    /// Radiance that clamping removed: the sum over the samples of the mean of the channels.
    pub clamped: f32,
}

impl Sum {
    fn from_block(block: Rgb) -> Self {
        Self { total: block.to_array().map(f64::from), ..Self::default() }
    }

    /// Joins the run that follows; `blocks` are the numbers of blocks of both runs.
    #[must_use]
    pub fn joined(&self, next: &Self, blocks: [u32; 2]) -> Self {
        let [a, b] = blocks.map(f64::from);
        let clamped = clamp_finite(self.clamped + next.clamped);
        let mut sum = Self { clamped, ..Self::default() };
        for i in 0..3 {
            sum.total[i] = self.total[i] + next.total[i];
            let apart = next.total[i] / b.max(1.0) - self.total[i] / a.max(1.0);
            let between = apart * apart * (a * b / (a + b).max(1.0));
            sum.squared_deviations[i] = clamp_finite(
                (self.squared_deviations[i] + next.squared_deviations[i]) * LEVEL_WEIGHT as f32 + between as f32,
            );
        }
        sum
    }
}

/// Clamps infinite values to the largest finite number.
fn clamp_finite(number: f32) -> f32 {
    number.clamp(f32::MIN, f32::MAX)
}

/// Divisor of a run's `squared_deviations` that gives the variance of a block, for independent
/// blocks.
pub(super) fn variance_divisor(level: u32) -> f64 {
    (0..level).fold(0.0, |below, _| joined_divisor(below, below))
}

/// [`variance_divisor`] of two joined runs.
pub(super) fn joined_divisor(a: f64, b: f64) -> f64 {
    1.0 + LEVEL_WEIGHT * (a + b)
}

/// Level of a run in the binary tree over all blocks: a run has 2^level blocks, and 2^level divides
/// the number of its first block. `None` if the samples are not a node of the tree.
pub(super) fn tree_level(samples: &Range<u32>) -> Option<u32> {
    let blocks = (samples.end.checked_sub(samples.start)?) / BLOCK_SAMPLES;
    let whole = samples.start.is_multiple_of(BLOCK_SAMPLES) && samples.end.is_multiple_of(BLOCK_SAMPLES);
    let aligned = blocks.is_power_of_two() && (samples.start / BLOCK_SAMPLES).is_multiple_of(blocks);
    (whole && aligned).then(|| blocks.trailing_zeros())
}

/// Whether the samples are the first samples of a block, but not the whole block.
pub(super) fn is_open(samples: &Range<u32>) -> bool {
    samples.start.is_multiple_of(BLOCK_SAMPLES)
        && samples.end > samples.start
        && samples.end - samples.start < BLOCK_SAMPLES
}

/// Consecutive samples of one pixel.
#[derive(Clone, Copy, Debug, Default)]
pub struct PixelSamples<'s> {
    /// Radiance of each sample.
    pub radiance: &'s [Rgb],
    /// Radiance that clamping removed from each sample; empty if nothing is clamped.
    pub clamped: &'s [f32],
    /// AOV values, the same number per sample.
    pub planes: &'s [Rgb],
    /// Identifiers of each sample for masks; empty unless requested.
    pub hit_ids: &'s [HitIds],
}

impl<'s> PixelSamples<'s> {
    /// Number of samples.
    #[inline]
    pub fn len(&self) -> usize {
        self.radiance.len()
    }

    /// Whether there are no samples.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.radiance.is_empty()
    }

    /// Splits into the first `count` samples and the rest.
    #[inline]
    pub fn split_at(self, count: usize) -> (Self, Self) {
        let count = count.min(self.len());
        let planes = self.planes.len() / self.len().max(1);
        let (radiance, radiance_later) = self.radiance.split_at(count);
        let (clamped, clamped_later) = self.clamped.split_at(count.min(self.clamped.len()));
        let (colors, colors_later) = self.planes.split_at(count * planes);
        let (hit_ids, marks_later) = self.hit_ids.split_at(count.min(self.hit_ids.len()));
        let later =
            Self { radiance: radiance_later, clamped: clamped_later, planes: colors_later, hit_ids: marks_later };
        (Self { radiance, clamped, planes: colors, hit_ids }, later)
    }

    /// AOVs and mask identifiers of each sample; empty if there are none.
    fn aovs(&self) -> impl Iterator<Item = (&'s [Rgb], Option<&'s HitIds>)> {
        let Self { radiance, planes, hit_ids, .. } = *self;
        let count = planes.len() / radiance.len().max(1);
        let of = if count == 0 && hit_ids.is_empty() { 0 } else { radiance.len() };
        (0..of).map(move |i| (planes.get(i * count..(i + 1) * count).unwrap_or_default(), hit_ids.get(i)))
    }
}

/// Accumulator of one pixel's samples in order; joins runs as soon as two are siblings in the tree.
#[derive(Clone, Debug, Default)]
pub struct Accumulator {
    next: u32,
    block: Rgb,
    /// Radiance that clamping removed from the block's samples.
    clamped: f32,
    /// AOVs and masks of the block.
    block_aov_sums: AovSums,
    runs: ArrayVec<(u32, Sum), MAX_RUNS>,
    /// AOVs and masks of the runs; empty unless requested.
    aov_sums: Vec<AovSums>,
}

impl Accumulator {
    /// Restarts with sample `first`. Either a block begins with `first`, or `open` holds the sum of
    /// the earlier samples of its block.
    pub fn begin(&mut self, first: u32, open: Option<(&Sum, AovSums)>) {
        let (open, block_aov_sums) =
            open.map_or((Sum::default(), AovSums::default()), |(sum, block_aov_sums)| (*sum, block_aov_sums));
        // The sum of an open block is a sum of `f32`s in the same order, so the conversion is
        // exact.
        let [r, g, b] = open.total.map(|total| total as f32);
        self.block = Rgb::new(r, g, b);
        self.clamped = open.clamped;
        self.block_aov_sums = block_aov_sums;
        self.next = first;
        self.runs.clear();
        self.aov_sums.clear();
    }

    /// Adds samples without AOVs. See [`Self::add_samples`].
    pub fn add(&mut self, radiance: &[Rgb]) -> u64 {
        self.add_samples(PixelSamples { radiance, ..PixelSamples::default() })
    }

    /// Adds the next samples. A sample with a channel that is NaN, infinite or beyond 10^36 counts
    /// as black; returns the number of such samples.
    #[inline]
    pub fn add_samples(&mut self, mut samples: PixelSamples) -> u64 {
        let mut rejected = 0;
        while !samples.is_empty() {
            let room = (BLOCK_SAMPLES - self.next % BLOCK_SAMPLES) as usize;
            let (now, rest) = samples.split_at(room);
            rejected += self.add_to_block(now.radiance);
            let removed = now.radiance.iter().zip(now.clamped).filter(|(sample, _)| is_counted(**sample));
            self.clamped = removed.fold(self.clamped, |sum, (_, removed)| clamp_finite(sum + removed));
            now.aovs().for_each(|(planes, hit_ids)| self.block_aov_sums.add(planes, hit_ids));
            self.next = self.next.wrapping_add(now.len() as u32);
            if now.len() == room {
                self.finish_block();
            }
            samples = rest;
        }
        rejected
    }

    #[inline]
    fn add_to_block(&mut self, samples: &[Rgb]) -> u64 {
        let mut rejected = 0;
        for sample in samples {
            if is_counted(*sample) {
                self.block += *sample;
            } else {
                rejected += 1;
            }
        }
        rejected
    }

    fn block_sum(&self) -> Sum {
        Sum { clamped: self.clamped, ..Sum::from_block(self.block) }
    }

    fn finish_block(&mut self) {
        let mut sum = self.block_sum();
        let mut block_aov_sums = std::mem::take(&mut self.block_aov_sums);
        (self.block, self.clamped) = (Rgb::BLACK, 0.0);
        let mut level = 0;
        let mut number = self.next.wrapping_sub(1) / BLOCK_SAMPLES;
        while number & 1 == 1
            && let Some((other, left)) = self.runs.last()
            && *other == level
        {
            sum = left.joined(&sum, [1 << level; 2]);
            self.runs.pop();
            block_aov_sums = self.aov_sums.pop().map_or_else(AovSums::default, |left| left.joined(&block_aov_sums));
            level += 1;
            number >>= 1;
        }
        // At most one run per level on the way up and one on the way down: there is room.
        let _ = self.runs.try_push((level, sum));
        if !block_aov_sums.is_empty() {
            self.aov_sums.push(block_aov_sums);
        }
    }

    /// Sums of the runs in order, the open block last.
    pub fn sums(&self) -> impl Iterator<Item = Sum> {
        let open = (!self.next.is_multiple_of(BLOCK_SAMPLES)).then(|| self.block_sum());
        self.runs.iter().map(|(_, sum)| *sum).chain(open)
    }

    /// AOVs and masks of the runs, in the same order; empty unless requested.
    pub fn aov_sums(&mut self) -> impl Iterator<Item = AovSums> {
        let open = std::mem::take(&mut self.block_aov_sums);
        self.aov_sums.drain(..).chain((!open.is_empty()).then_some(open))
    }
}

/// Runs that the samples divide into, in order.
pub fn runs(samples: Range<u32>) -> Vec<Range<u32>> {
    let mut runs = Vec::new();
    let mut start = samples.start - samples.start % BLOCK_SAMPLES;
    while start < samples.end {
        let blocks = (samples.end - start) / BLOCK_SAMPLES;
        let aligned = if start == 0 { u32::MAX } else { 1 << (start / BLOCK_SAMPLES).trailing_zeros() };
        let length = match blocks {
            0 => samples.end - start,
            _ => aligned.min(1 << blocks.ilog2()) * BLOCK_SAMPLES,
        };
        runs.push(start..start + length);
        start += length;
    }
    runs
}
