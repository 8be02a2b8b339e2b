//! The camera's rays: samples of the film's pixels, eight side by side.

use super::{Job, Work};
use crate::camera::LANES;
use crate::integrator::{Path, Queue};
use crate::sampler::Sampler;
use juggler_math::{Rgb, UVec2, Vec2};
use std::ops::Range;

/// Places on the film that are drawn at once.
const PLACES: usize = 64;
/// Dimensions of a sample that the camera takes: the place on the film, the place on the lens.
const FILM: u32 = 1;
const LENS: u32 = 1;

/// The rays of the samples `slots` of all samples of `work`, `samples` a pixel, pixel by pixel.
pub fn expose(job: &Job, work: &Work, samples: u64, slots: Range<u64>, queue: &mut Queue) {
    let mut slot = 0;
    let mut at = slots.start;
    while at < slots.end {
        let pixel = at / samples;
        let column = work.pixels.x + (pixel % u64::from(work.pixels.width)) as u32;
        let row = work.pixels.y + (pixel / u64::from(work.pixels.width)) as u32;
        let stream = Sampler::new(job.pattern, job.seed, UVec2::new(column, row));
        let exposure = Pixel { job, center: Vec2::new(column as f32, row as f32) + 0.5, stream };
        let count = (slots.end.min((pixel + 1) * samples) - at) as u32;
        exposure.expose(work.samples.start + (at % samples) as u32, slot..slot + count, queue);
        slot += count;
        at += u64::from(count);
    }
}

/// One pixel of the film.
struct Pixel<'j> {
    job: &'j Job<'j>,
    center: Vec2,
    stream: Sampler,
}

impl Pixel<'_> {
    /// The rays of the samples from `first` on.
    fn expose(&self, first: u32, slots: Range<u32>, queue: &mut Queue) {
        let mut places = [Vec2::splat(0.5); PLACES];
        for start in slots.clone().step_by(PLACES) {
            let count = PLACES.min((slots.end - start) as usize);
            let first = first + (start - slots.start);
            if self.job.samples > 1 {
                self.stream.first_points(first, &mut places[..count.next_multiple_of(LANES)]);
            }
            for (group, places) in places[..count].chunks(LANES).enumerate() {
                let skipped = (group * LANES) as u32;
                self.group(first + skipped, start + skipped, places, queue);
            }
        }
    }

    /// The rays of up to eight samples.
    fn group(&self, first: u32, slot: u32, places: &[Vec2], queue: &mut Queue) {
        let Job { camera, filter, samples, .. } = self.job;
        let (mut films, mut weights) = ([[self.center.x; LANES], [self.center.y; LANES]], [1.0; LANES]);
        if *samples > 1 {
            for (i, place) in places.iter().enumerate() {
                let sample = filter.sample(*place);
                films[0][i] += sample.offset.x;
                films[1][i] += sample.offset.y;
                weights[i] = sample.weight;
            }
        }
        let sampler = |i: usize, dimension| {
            let mut sampler = self.stream.sample(first + i as u32);
            sampler.skip(dimension);
            sampler
        };
        let mut lenses = [Vec2::splat(0.5); LANES];
        if camera.needs_lens() {
            lenses = std::array::from_fn(|i| sampler(i, FILM).next_2d());
        }
        camera.rays(&films, &lenses, places.len(), &mut queue.rays);
        let path = |(i, weight): (usize, &f32)| Path {
            weight: Rgb::splat(*weight),
            depth: 0,
            sampler: sampler(i, FILM + LENS),
            slot: slot + i as u32,
        };
        queue.paths.extend(weights.iter().take(places.len()).enumerate().map(path));
    }
}
