//! The camera's rays: samples of the film's pixels, eight side by side, each at its time.

use super::{Job, Work};
use juggler_camera::LANES;
use juggler_camera::layer::is_half;
use juggler_camera::sampler::Sampler;
use juggler_integrator::{Cone, PathState, Queue, Trail};
use juggler_math::{Rgb, UVec2, Vec2};
use std::ops::Range;

/// Places on the film that are drawn at once.
const PLACES: usize = 64;
/// Dimensions of a sample that the camera takes: the place on the film, the place on the lens.
const FILM: u32 = 1;
const LENS: u32 = 1;
/// The dimension of a sample's time, beyond all that paths come to: still pictures do without it.
const TIME: u32 = 1 << 31;
/// The stream of the second half of the samples, where halves are compared.
const HALF: u32 = 1 << 31;

/// How wide camera rays are, in pixels. Samples of a pixel lie apart from each other, and what they mix need not be smoothed
/// twice.
const PIXELS: f32 = 0.5;

/// How paths begin.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    trail: Trail,
    cone: Cone,
}

/// What paths remember when they leave a camera: the solids that it is in, half way between opening and closing of the
/// shutter, and how wide they are.
pub fn start(job: &Job) -> Start {
    const MIDDLE: f32 = 0.5;
    let camera = job.camera.at(MIDDLE);
    let [width, spread] = camera.pixel().map(|size| size * PIXELS);
    let trail = Trail { inside: job.world.inside(camera.eye(), MIDDLE), ..Trail::CAMERA };
    Start { trail, cone: Cone { width, spread } }
}

/// The rays of the samples `slots` of all samples of `work`, `samples` a pixel, pixel by pixel; they begin with `start`.
pub fn expose(job: &Job, start: &Start, work: &Work, samples: u64, slots: Range<u64>, queue: &mut Queue) {
    let (sampler, halves) = (Sampler::new(job.pattern, job.seed), job.layers.has_halves());
    let picture = Picture { job, start, sampler, halves };
    if job.samples == 1 {
        return expose_centers(&picture, work, slots, queue);
    }
    let mut places = [Vec2::ZERO; PLACES];
    let mut slot = 0;
    let mut at = slots.start;
    while at < slots.end {
        let pixel = at / samples;
        let exposure = Pixel::new(&picture, work, Pixel::place(work, pixel));
        let count = (slots.end.min((pixel + 1) * samples) - at) as u32;
        exposure.expose(work.samples.start + (at % samples) as u32, slot..slot + count, &mut places, queue);
        slot += count;
        at += u64::from(count);
    }
}

/// One ray through the centre of each of the pixels `range`.
fn expose_centers(picture: &Picture, work: &Work, range: Range<u64>, queue: &mut Queue) {
    let mut next = Pixel::place(work, range.start);
    for start in range.clone().step_by(LANES) {
        let count = LANES.min((range.end - start) as usize);
        // Lanes beyond the last pixel hold places that nobody asks for.
        let pixels: [Pixel; LANES] = std::array::from_fn(|_| {
            let place = next;
            next.x += 1;
            if next.x == work.pixels.width {
                next = UVec2::new(0, next.y + 1);
            }
            Pixel::new(picture, work, place)
        });
        let films = [pixels.each_ref().map(|pixel| pixel.center.x), pixels.each_ref().map(|pixel| pixel.center.y)];
        let lenses = pixels.each_ref().map(|pixel| pixel.lens(0));
        picture.job.camera.rays(&films, &lenses, &[0.5; LANES], count, &mut queue.rays);
        let slot = (start - range.start) as u32;
        let path = |(i, pixel): (u32, &Pixel)| pixel.path(0, slot + i, 1.0);
        queue.paths.extend((0..).zip(&pixels).take(count).map(path));
    }
}

/// What all pixels have in common.
struct Picture<'j> {
    job: &'j Job<'j>,
    start: &'j Start,
    sampler: Sampler,
    /// Whether halves of the samples are compared.
    halves: bool,
}

/// One pixel of the film.
struct Pixel<'j> {
    job: &'j Job<'j>,
    start: &'j Start,
    center: Vec2,
    stream: Sampler,
    /// That of the second half of the samples, where it has its own.
    second: Option<Sampler>,
    /// Whether time makes a difference.
    moves: bool,
}

impl<'j> Pixel<'j> {
    /// Column and row in the work's rectangle of its pixel number `index`, counted row by row.
    fn place(work: &Work, index: u64) -> UVec2 {
        let width = u64::from(work.pixels.width);
        UVec2::new((index % width) as u32, (index / width) as u32)
    }

    /// The pixel at this place in the work's rectangle.
    fn new(picture: &Picture<'j>, work: &Work, place: UVec2) -> Self {
        let Picture { job, start, sampler, halves } = picture;
        let pixel = UVec2::new(work.pixels.x, work.pixels.y).wrapping_add(place);
        let moves = job.camera.moves() || job.world.moves();
        let stream = sampler.pixel(pixel);
        let second = halves.then(|| stream.branch(HALF));
        Self { job, start, center: pixel.as_vec2() + 0.5, stream, second, moves }
    }

    /// The numbers of a sample from `dimension` on.
    fn sampler(&self, sample: u32, dimension: u32) -> Sampler {
        let mut sampler = match &self.second {
            None => self.stream.sample(sample),
            Some(second) => (if is_half(sample) { second } else { &self.stream }).sample(sample / 2),
        };
        sampler.skip(dimension);
        sampler
    }

    /// Where on the lens a sample begins.
    fn lens(&self, sample: u32) -> Vec2 {
        if self.job.camera.needs_lens() { self.sampler(sample, FILM).next_2d() } else { Vec2::splat(0.5) }
    }

    /// When a sample is taken, from 0 to 1: a pixel's samples are spread evenly over the time, whatever their places.
    fn time(&self, sample: u32) -> f32 {
        if self.moves { self.sampler(sample, TIME).next_1d() } else { 0.0 }
    }

    fn path(&self, sample: u32, slot: u32, weight: f32) -> PathState {
        PathState {
            weight: Rgb::splat(weight),
            depth: 0,
            sampler: self.sampler(sample, FILM + LENS),
            trail: self.start.trail,
            cone: self.start.cone,
            slot,
        }
    }

    /// The rays of the samples from `first` on; `places` is room to work in.
    fn expose(&self, first: u32, slots: Range<u32>, places: &mut [Vec2; PLACES], queue: &mut Queue) {
        for start in slots.clone().step_by(PLACES) {
            let count = PLACES.min((slots.end - start) as usize);
            let first = first + (start - slots.start);
            let drawn = &mut places[..count.next_multiple_of(LANES)];
            if self.second.is_none() {
                self.stream.first_points(first, drawn);
            } else {
                (first..).zip(drawn).for_each(|(sample, place)| *place = self.sampler(sample, 0).next_2d());
            }
            for (group, places) in places[..count].chunks(LANES).enumerate() {
                let skipped = (group * LANES) as u32;
                self.group(first + skipped, start + skipped, places, queue);
            }
        }
    }

    /// The rays of up to eight samples.
    fn group(&self, first: u32, slot: u32, places: &[Vec2], queue: &mut Queue) {
        let Job { camera, filter, .. } = self.job;
        let (mut films, mut weights) = ([[self.center.x; LANES], [self.center.y; LANES]], [1.0; LANES]);
        for (i, place) in places.iter().enumerate() {
            let sample = filter.sample(*place);
            films[0][i] += sample.offset.x;
            films[1][i] += sample.offset.y;
            weights[i] = sample.weight;
        }
        let lenses = std::array::from_fn(|i| self.lens(first + i as u32));
        let times = std::array::from_fn(|i| self.time(first + i as u32));
        camera.rays(&films, &lenses, &times, places.len(), &mut queue.rays);
        let path = |(i, weight): (u32, &f32)| self.path(first + i, slot + i, *weight);
        queue.paths.extend((0..).zip(&weights).take(places.len()).map(path));
    }
}

#[cfg(test)]
mod tests {
    use super::{FILM, LENS, TIME};

    /// Film, lens, the first dimension of a path, time.
    #[test]
    fn dimensions_of_a_camera_ray_are_distinct() {
        let dimensions = [0, FILM, FILM + LENS, TIME];
        assert!(dimensions.is_sorted_by(|a, b| a < b), "{dimensions:?}");
    }
}
