//! Sums over blocks of samples, joined along a fixed binary tree.

use super::{BLOCK, Extras, Mark};
use arrayvec::ArrayVec;
use juggler_math::Rgb;
use std::ops::Range;

/// Most runs that the samples of a pixel fall into: one for each bit of a number of blocks on the way up, one on
/// the way down, and an open block.
pub(super) const MAX_RUNS: usize = 64;

/// What a difference counts one join further down. Joins double a level, so each level counts half of the one above.
const DEEPER: f64 = 0.25;

/// Largest channel of a sample that is counted: the `f32` sum of a block of such samples is finite.
const MAX_SAMPLE: f32 = 1e36;

/// Whether a sample counts: a sample with a channel that is NaN, infinite or beyond 10^36 counts as black, so that no sum
/// of a film is ever infinite or NaN.
#[inline]
pub fn is_counted(sample: Rgb) -> bool {
    sample.to_array().iter().all(|channel| channel.abs() <= MAX_SAMPLE)
}

/// What is known of one pixel's samples of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sum {
    /// The sum of the samples, linear RGB.
    pub total: [f64; 3],
    /// How much the sums of the run's blocks differ: the squared deviations between the two sides of each join, as
    /// Chan, Golub and LeVeque (1979) add them up, but those of deeper joins count less, by a quarter a level. Well
    /// spread samples make long runs differ less than short ones; it is the long ones that tell how good the mean is.
    pub spread: [f32; 3],
    /// What clamping took off the samples: the sum of the means of their channels.
    pub clamped: f32,
}

impl Sum {
    fn of_block(block: Rgb) -> Self {
        Self { total: block.to_array().map(f64::from), ..Self::default() }
    }

    /// With the run that follows; they have `blocks` blocks each.
    #[must_use]
    pub fn joined(&self, next: &Self, blocks: [u32; 2]) -> Self {
        let [a, b] = blocks.map(f64::from);
        let clamped = limited(self.clamped + next.clamped);
        let mut sum = Self { clamped, ..Self::default() };
        for i in 0..3 {
            sum.total[i] = self.total[i] + next.total[i];
            let apart = next.total[i] / b.max(1.0) - self.total[i] / a.max(1.0);
            let between = apart * apart * (a * b / (a + b).max(1.0));
            sum.spread[i] = limited((self.spread[i] + next.spread[i]) * DEEPER as f32 + between as f32);
        }
        sum
    }
}

/// The number, or the largest finite one of its sign.
fn limited(number: f32) -> f32 {
    number.clamp(f32::MIN, f32::MAX)
}

/// By what a run's spread must be divided to give the variance of a block, if all blocks were independent.
pub(super) fn weight(level: u32) -> f64 {
    (0..level).fold(0.0, |below, _| joined_weight(below, below))
}

/// [`weight`] of two runs that are joined.
pub(super) fn joined_weight(a: f64, b: f64) -> f64 {
    1.0 + DEEPER * (a + b)
}

/// The blocks of a run are as many as a power of two, and their number divides the number of the first: the runs
/// are the nodes of a binary tree over all blocks.
pub(super) fn level(samples: &Range<u32>) -> Option<u32> {
    let blocks = (samples.end.checked_sub(samples.start)?) / BLOCK;
    let whole = samples.start.is_multiple_of(BLOCK) && samples.end.is_multiple_of(BLOCK);
    let aligned = blocks.is_power_of_two() && (samples.start / BLOCK).is_multiple_of(blocks);
    (whole && aligned).then(|| blocks.trailing_zeros())
}

/// Whether the samples are the first of one block, but not all of it.
pub(super) fn is_open(samples: &Range<u32>) -> bool {
    samples.start.is_multiple_of(BLOCK) && samples.end > samples.start && samples.end - samples.start < BLOCK
}

/// Samples of one pixel that follow each other.
#[derive(Clone, Copy, Debug, Default)]
pub struct Samples<'s> {
    /// What came along their rays.
    pub radiance: &'s [Rgb],
    /// What clamping took off each; nothing where no sample is clamped.
    pub clamped: &'s [f32],
    /// As many colours a sample as there are layers.
    pub planes: &'s [Rgb],
    /// What each shows; nothing where nobody asks.
    pub marks: &'s [Mark],
}

impl<'s> Samples<'s> {
    /// How many.
    #[inline]
    pub fn len(&self) -> usize {
        self.radiance.len()
    }

    /// Whether there are none.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.radiance.is_empty()
    }

    /// The first `count`, and the others.
    #[inline]
    pub fn split_at(self, count: usize) -> (Self, Self) {
        let count = count.min(self.len());
        let planes = self.planes.len() / self.len().max(1);
        let (radiance, radiance_later) = self.radiance.split_at(count);
        let (clamped, clamped_later) = self.clamped.split_at(count.min(self.clamped.len()));
        let (colors, colors_later) = self.planes.split_at(count * planes);
        let (marks, marks_later) = self.marks.split_at(count.min(self.marks.len()));
        let later = Self { radiance: radiance_later, clamped: clamped_later, planes: colors_later, marks: marks_later };
        (Self { radiance, clamped, planes: colors, marks }, later)
    }

    /// What each has beside its radiance, if anything.
    fn extras(&self) -> impl Iterator<Item = (&'s [Rgb], Option<&'s Mark>)> {
        let Self { radiance, planes, marks, .. } = *self;
        let count = planes.len() / radiance.len().max(1);
        let of = if count == 0 && marks.is_empty() { 0 } else { radiance.len() };
        (0..of).map(move |i| (planes.get(i * count..(i + 1) * count).unwrap_or_default(), marks.get(i)))
    }
}

/// Takes in the samples of one pixel in order and joins their blocks as soon as two are neighbours in the tree.
#[derive(Clone, Debug, Default)]
pub struct Accumulator {
    next: u32,
    block: Rgb,
    /// What was taken off the block's samples.
    clamped: f32,
    /// What the block's samples have beside their radiance.
    extra: Extras,
    runs: ArrayVec<(u32, Sum), MAX_RUNS>,
    /// The same of the runs; nothing where nobody asks.
    extras: Vec<Extras>,
}

impl Accumulator {
    /// Forgets everything. The next sample is `first`: either a block begins with it, or `open` holds the sum of the
    /// samples of its block that are there already.
    pub fn begin(&mut self, first: u32, open: Option<(&Sum, Extras)>) {
        let (open, extra) = open.map_or((Sum::default(), Extras::default()), |(sum, extra)| (*sum, extra));
        // The sum of an open block was a sum of `f32`s in that order: nothing is lost on the way back.
        let [r, g, b] = open.total.map(|total| total as f32);
        self.block = Rgb::new(r, g, b);
        self.clamped = open.clamped;
        self.extra = extra;
        self.next = first;
        self.runs.clear();
        self.extras.clear();
    }

    /// Adds the next samples, of which nothing but their radiance is known.
    pub fn add(&mut self, radiance: &[Rgb]) -> u64 {
        self.add_samples(Samples { radiance, ..Samples::default() })
    }

    /// Adds the next samples. A sample with a channel that is NaN, infinite or beyond 10^36 counts as
    /// black. Returns the number of such samples.
    #[inline]
    pub fn add_samples(&mut self, mut samples: Samples) -> u64 {
        let mut lost = 0;
        while !samples.is_empty() {
            let room = (BLOCK - self.next % BLOCK) as usize;
            let (now, rest) = samples.split_at(room);
            lost += self.add_to_block(now.radiance);
            let taken = now.radiance.iter().zip(now.clamped).filter(|(sample, _)| is_counted(**sample));
            self.clamped = taken.fold(self.clamped, |sum, (_, taken)| limited(sum + taken));
            now.extras().for_each(|(planes, mark)| self.extra.add(planes, mark));
            self.next = self.next.wrapping_add(now.len() as u32);
            if now.len() == room {
                self.close();
            }
            samples = rest;
        }
        lost
    }

    #[inline]
    fn add_to_block(&mut self, samples: &[Rgb]) -> u64 {
        let mut lost = 0;
        for sample in samples {
            if is_counted(*sample) {
                self.block += *sample;
            } else {
                lost += 1;
            }
        }
        lost
    }

    fn block_sum(&self) -> Sum {
        Sum { clamped: self.clamped, ..Sum::of_block(self.block) }
    }

    fn close(&mut self) {
        let mut sum = self.block_sum();
        let mut extra = std::mem::take(&mut self.extra);
        (self.block, self.clamped) = (Rgb::BLACK, 0.0);
        let mut level = 0;
        let mut number = self.next.wrapping_sub(1) / BLOCK;
        while number & 1 == 1
            && let Some((other, left)) = self.runs.last()
            && *other == level
        {
            sum = left.joined(&sum, [1 << level; 2]);
            self.runs.pop();
            extra = self.extras.pop().map_or_else(Extras::default, |left| left.joined(&extra));
            level += 1;
            number >>= 1;
        }
        // At most one a level on the way up and one on the way down: there is room.
        let _ = self.runs.try_push((level, sum));
        if !extra.is_empty() {
            self.extras.push(extra);
        }
    }

    /// The runs' sums in order, the open block's last.
    pub fn sums(&self) -> impl Iterator<Item = Sum> {
        let open = (!self.next.is_multiple_of(BLOCK)).then(|| self.block_sum());
        self.runs.iter().map(|(_, sum)| *sum).chain(open)
    }

    /// What the runs have beside radiance, in the same order; nothing where nobody asks.
    pub fn extras(&mut self) -> impl Iterator<Item = Extras> {
        let open = std::mem::take(&mut self.extra);
        self.extras.drain(..).chain((!open.is_empty()).then_some(open))
    }
}

/// The runs that the samples fall into, in order.
pub fn runs(samples: Range<u32>) -> Vec<Range<u32>> {
    let mut runs = Vec::new();
    let mut start = samples.start - samples.start % BLOCK;
    while start < samples.end {
        let blocks = (samples.end - start) / BLOCK;
        let aligned = if start == 0 { u32::MAX } else { 1 << (start / BLOCK).trailing_zeros() };
        let length = match blocks {
            0 => samples.end - start,
            _ => aligned.min(1 << blocks.ilog2()) * BLOCK,
        };
        runs.push(start..start + length);
        start += length;
    }
    runs
}
