//! Accumulates the samples of one piece of work into runs, in order of pixels and of the samples of
//! a pixel.

use super::Work;
use juggler_camera::aov::{FilmAov, FilmAovs, is_in_second_half};
use juggler_camera::film::{Accumulator, PixelSamples, SampleRun, Tile, is_counted, runs};
use juggler_math::Rgb;

/// Runs of samples under construction.
pub struct TileSamples<'w> {
    work: &'w Work,
    runs: Vec<SampleRun>,
    /// Planes of the half buffers, which receive only one half of the samples.
    halves: Vec<usize>,
    /// Plane of [`FilmAov::Coverage`], which counts samples that are not finite and samples that
    /// were clamped.
    coverage: Option<usize>,
    /// Scratch memory for modified AOV planes.
    planes: Vec<Rgb>,
    /// Sums of the current pixel.
    pixel: Accumulator,
    /// Index of the current pixel, and the number of its samples still missing.
    pixel_index: usize,
    samples_missing: usize,
}

impl<'w> TileSamples<'w> {
    /// Creates an accumulator without samples.
    pub fn new(work: &'w Work, aovs: &FilmAovs) -> Self {
        let area = work.pixels.area() as usize;
        let run = |samples| SampleRun::new(samples, Vec::with_capacity(area));
        let runs = runs(work.samples.clone()).into_iter().map(run).collect();
        let is_halved = |(place, aov): (usize, &FilmAov)| matches!(aov, FilmAov::HalfFeature(_)).then_some(place);
        let halves = aovs.planes.iter().enumerate().filter_map(is_halved).collect();
        let (pixel, planes) = (Accumulator::default(), Vec::new());
        let coverage = aovs.index_of(FilmAov::Coverage);
        let mut film = Self { work, runs, halves, coverage, planes, pixel, pixel_index: 0, samples_missing: 0 };
        film.begin();
        film
    }

    fn begin(&mut self) {
        self.samples_missing = self.work.samples.len();
        let open_block = self.work.open_block.as_ref().and_then(|open_block| {
            let sum = open_block.sums.get(self.pixel_index)?;
            Some((sum, open_block.aov_sums.pixel(self.pixel_index, open_block.sums.len())))
        });
        self.pixel.begin(self.work.samples.start, open_block);
    }

    /// Adds the next finished samples. Returns how many were not finite.
    pub fn add(&mut self, mut samples: PixelSamples) -> u64 {
        let mut lost = 0;
        while !samples.is_empty() {
            let (now, later) = samples.split_at(self.samples_missing);
            lost += self.add_to_pixel(now);
            self.samples_missing -= now.len();
            samples = later;
            if self.samples_missing == 0 {
                self.runs.iter_mut().zip(self.pixel.sums()).for_each(|(run, sum)| run.sums.push(sum));
                self.runs.iter_mut().zip(self.pixel.aov_sums()).for_each(|(run, aov_sums)| run.aov_sums.push(aov_sums));
                self.pixel_index += 1;
                self.begin();
            }
        }
        lost
    }

    fn add_to_pixel(&mut self, samples: PixelSamples) -> u64 {
        let is_lost = |radiance: &Rgb| !is_counted(*radiance);
        let is_clamped = |removed: &f32| *removed != 0.0;
        let is_any = samples.radiance.iter().any(is_lost) || samples.clamped.iter().any(is_clamped);
        let counted = self.coverage.filter(|_| is_any);
        if self.halves.is_empty() && counted.is_none() {
            return self.pixel.add_samples(samples);
        }
        let first = self.work.samples.end - self.samples_missing as u32;
        let count = samples.planes.len() / samples.len().max(1);
        self.planes.clear();
        self.planes.extend_from_slice(samples.planes);
        let planes = self.planes.chunks_exact_mut(count.max(1));
        let clamped = samples.clamped.iter().map(is_clamped).chain(std::iter::repeat(false));
        for ((number, clamped), (planes, radiance)) in (first..).zip(clamped).zip(planes.zip(samples.radiance)) {
            if !is_in_second_half(number) {
                self.halves.iter().for_each(|place| planes[*place] = Rgb::BLACK);
            }
            if let Some(place) = counted {
                planes[place].g = f32::from(is_lost(radiance));
                planes[place].b = f32::from(clamped);
            }
        }
        self.pixel.add_samples(PixelSamples { planes: &self.planes, ..samples })
    }

    /// Tile of all runs.
    pub fn tile(self) -> Tile {
        let mut tile = Tile::new(self.work.pixels);
        for run in self.runs {
            // Runs of one range are complete and do not overlap.
            let added = tile.add(run);
            debug_assert_eq!(added, Ok(()));
        }
        tile
    }
}
