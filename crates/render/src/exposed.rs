//! The film under one piece of work: the samples of a pixel come one after the other, and pixel after pixel.

use super::Work;
use juggler_camera::film::{Accumulator, Run, Samples, Tile, is_counted, runs};
use juggler_camera::layer::{Layer, Layers, is_half};
use juggler_math::Rgb;

/// The runs of samples that come to be.
pub struct Exposed<'w> {
    work: &'w Work,
    runs: Vec<Run>,
    /// Layers to which only one half of the samples goes.
    halves: Vec<usize>,
    /// The layer that counts samples that are no finite numbers, and those that are clamped.
    coverage: Option<usize>,
    /// Room for samples whose layers are changed.
    planes: Vec<Rgb>,
    /// Of the pixel whose samples come now.
    pixel: Accumulator,
    /// Which pixel that is, and how many of its samples are to come.
    number: usize,
    missing: usize,
}

impl<'w> Exposed<'w> {
    /// Without samples yet.
    pub fn new(work: &'w Work, layers: &Layers) -> Self {
        let area = work.pixels.area() as usize;
        let run = |samples| Run::new(samples, Vec::with_capacity(area));
        let runs = runs(work.samples.clone()).into_iter().map(run).collect();
        let is_halved = |(place, layer): (usize, &Layer)| matches!(layer, Layer::Half(_)).then_some(place);
        let halves = layers.planes.iter().enumerate().filter_map(is_halved).collect();
        let (pixel, planes) = (Accumulator::default(), Vec::new());
        let coverage = layers.place(Layer::Coverage);
        let mut film = Self { work, runs, halves, coverage, planes, pixel, number: 0, missing: 0 };
        film.begin();
        film
    }

    fn begin(&mut self) {
        self.missing = self.work.samples.len();
        let open = self.work.open.as_ref().and_then(|open| {
            let sum = open.sums.get(self.number)?;
            Some((sum, open.extras.pixel(self.number, open.sums.len())))
        });
        self.pixel.begin(self.work.samples.start, open);
    }

    /// Adds the next finished samples to their pixels. Returns how many were no finite numbers.
    pub fn add(&mut self, mut samples: Samples) -> u64 {
        let mut lost = 0;
        while !samples.is_empty() {
            let (now, later) = samples.split_at(self.missing);
            lost += self.add_to_pixel(now);
            self.missing -= now.len();
            samples = later;
            if self.missing == 0 {
                self.runs.iter_mut().zip(self.pixel.sums()).for_each(|(run, sum)| run.sums.push(sum));
                self.runs.iter_mut().zip(self.pixel.extras()).for_each(|(run, extras)| run.extras.push(extras));
                self.number += 1;
                self.begin();
            }
        }
        lost
    }

    fn add_to_pixel(&mut self, samples: Samples) -> u64 {
        let is_lost = |radiance: &Rgb| !is_counted(*radiance);
        let is_cut = |taken: &f32| *taken != 0.0;
        let is_any = samples.radiance.iter().any(is_lost) || samples.clamped.iter().any(is_cut);
        let counted = self.coverage.filter(|_| is_any);
        if self.halves.is_empty() && counted.is_none() {
            return self.pixel.add_samples(samples);
        }
        let first = self.work.samples.end - self.missing as u32;
        let count = samples.planes.len() / samples.len().max(1);
        self.planes.clear();
        self.planes.extend_from_slice(samples.planes);
        let planes = self.planes.chunks_exact_mut(count.max(1));
        let cut = samples.clamped.iter().map(is_cut).chain(std::iter::repeat(false));
        for ((number, cut), (planes, radiance)) in (first..).zip(cut).zip(planes.zip(samples.radiance)) {
            if !is_half(number) {
                self.halves.iter().for_each(|place| planes[*place] = Rgb::BLACK);
            }
            if let Some(place) = counted {
                planes[place].g = f32::from(is_lost(radiance));
                planes[place].b = f32::from(cut);
            }
        }
        self.pixel.add_samples(Samples { planes: &self.planes, ..samples })
    }

    /// All of it.
    pub fn tile(self) -> Tile {
        let mut tile = Tile::new(self.work.pixels);
        for run in self.runs {
            // Runs of one range: none overlaps, all are whole.
            let added = tile.add(run);
            debug_assert_eq!(added, Ok(()));
        }
        tile
    }
}
