//! Camera rays: film, lens and time samples of pixels, in packets of [`LANES`] rays.

use super::{Job, Work};
use juggler_camera::LANES;
use juggler_camera::aov::is_in_second_half;
use juggler_camera::sampler::Sampler;
use juggler_integrator::{PathHistory, PathState, Queue, RayCone};
use juggler_math::{Rgb, UVec2, Vec2};
use std::ops::Range;

mod split;

/// Number of film samples drawn at once.
const POINTS: usize = 64;
/// Sample dimensions of camera rays: film position and lens position.
const FILM_DIMENSIONS: u32 = 1;
const LENS_DIMENSIONS: u32 = 1;
/// Sample dimension of the time, beyond all dimensions that paths reach. Static scenes do not draw
/// it.
const TIME_DIMENSION: u32 = 1 << 31;
/// Sampler branch of the second half of the samples, if half buffers are kept.
const HALF_BRANCH: u32 = 1 << 31;

/// Diameter of the ray cones of camera rays, in pixels. Below 1, since averaging a pixel's samples
/// already filters textures.
const CONE_WIDTH: f32 = 0.5;

/// Middle of the shutter interval.
const MIDDLE: f32 = 0.5;
/// Number of steps of the shutter interval at whose ends the solids around the camera are compared.
const INTERIOR_STEPS: u32 = 16;

/// Initial state of camera paths.
#[derive(Clone, Copy, Debug)]
pub struct PathStart {
    history: PathHistory,
    cone: RayCone,
    /// Whether the camera enters or leaves a solid while the shutter is open.
    interiors_change: bool,
    /// Number of camera rays of each sample.
    pub camera_rays: u32,
}

/// Initial state of paths: the solids that contain the camera, and the ray cone at mid-shutter.
pub fn path_start(job: &Job) -> PathStart {
    let [width, spread] = job.camera.projection_at(MIDDLE).pixel_footprint().map(|size| size * CONE_WIDTH);
    let history = history_at(job, MIDDLE);
    let changes = |step: u32| history_at(job, step as f32 / INTERIOR_STEPS as f32).interiors != history.interiors;
    let may_change = !job.world.interiors().is_empty() && (job.world.moves() || job.camera.moves());
    let interiors_change = may_change && (0..=INTERIOR_STEPS).any(changes);
    PathStart { history, cone: RayCone { width, spread }, interiors_change, camera_rays: 1 }
}

/// History of a path that starts at a time of the shutter interval: the solids that contain the
/// camera. Kept out of line, since few cameras need it for each path.
#[inline(never)]
fn history_at(job: &Job, time: f32) -> PathHistory {
    let eye = job.camera.projection_at(time).eye();
    PathHistory { interiors: job.world.interiors_at(eye, time), ..PathHistory::CAMERA }
}

/// Pushes the camera rays of `slots`, indices into the samples of `work`, pixel by pixel with
/// `samples` per pixel. Of several rays of a sample, the one that continues comes first.
pub fn push_camera_rays(job: &Job, start: &PathStart, work: &Work, samples: u64, slots: Range<u64>, queue: &mut Queue) {
    queue.from_camera = true;
    let (sampler, halves) = (Sampler::new(job.pattern, job.seed), job.aovs.has_halves());
    let context = PixelContext { job, start, sampler, halves };
    if job.samples == 1 {
        return push_center_rays(&context, work, slots, queue);
    }
    let mut points = [Vec2::ZERO; POINTS];
    let mut slot = 0;
    let mut at = slots.start;
    while at < slots.end {
        let index = at / samples;
        let pixel = Pixel::new(&context, work, Pixel::place(work, index));
        let count = (slots.end.min((index + 1) * samples) - at) as u32;
        let first = work.samples.start + (at % samples) as u32;
        if start.camera_rays > 1 {
            pixel.push_split_rays(first, slot..slot + count, queue);
        } else {
            pixel.push_rays(first, slot..slot + count, &mut points, queue);
        }
        slot += count;
        at += u64::from(count);
    }
}

/// Pushes a ray through the center of each pixel of `range`.
fn push_center_rays(context: &PixelContext, work: &Work, range: Range<u64>, queue: &mut Queue) {
    let mut next = Pixel::place(work, range.start);
    for start in range.clone().step_by(LANES) {
        let count = LANES.min((range.end - start) as usize);
        // Lanes beyond the last pixel are ignored.
        let pixels: [Pixel; LANES] = std::array::from_fn(|_| {
            let place = next;
            next.x += 1;
            if next.x == work.pixels.width {
                next = UVec2::new(0, next.y + 1);
            }
            Pixel::new(context, work, place)
        });
        let films = [pixels.each_ref().map(|pixel| pixel.center.x), pixels.each_ref().map(|pixel| pixel.center.y)];
        let lenses = pixels.each_ref().map(|pixel| pixel.lens(&pixel.sampler(0)));
        context.job.camera.rays(&films, &lenses, &[MIDDLE; LANES], count, &mut queue.rays);
        let slot = (start - range.start) as u32;
        let path = |(i, pixel): (u32, &Pixel)| pixel.path(&pixel.sampler(0), slot + i, 1.0);
        queue.paths.extend((0..).zip(&pixels).take(count).map(path));
        set_interiors(context.job, context.start, &[MIDDLE; LANES][..count], queue);
    }
}

/// Data shared by all pixels.
struct PixelContext<'j> {
    job: &'j Job<'j>,
    start: &'j PathStart,
    sampler: Sampler,
    /// Whether half buffers are kept.
    halves: bool,
}

/// A pixel of the film.
struct Pixel<'j> {
    job: &'j Job<'j>,
    start: &'j PathStart,
    center: Vec2,
    stream: Sampler,
    /// Sampler of the second half of the samples, if half buffers are kept.
    second_half: Option<Sampler>,
    /// Whether the camera or the scene moves, so that samples need a time.
    needs_time: bool,
}

impl<'j> Pixel<'j> {
    /// Column and row within the work's rectangle of pixel `index` in row-major order.
    fn place(work: &Work, index: u64) -> UVec2 {
        let width = u64::from(work.pixels.width);
        UVec2::new((index % width) as u32, (index / width) as u32)
    }

    /// Pixel at `place`, in pixels from the corner of the work's rectangle.
    fn new(context: &PixelContext<'j>, work: &Work, place: UVec2) -> Self {
        let PixelContext { job, start, sampler, halves } = context;
        let pixel = UVec2::new(work.pixels.x, work.pixels.y).wrapping_add(place);
        let needs_time = job.camera.moves() || job.world.moves();
        let stream = sampler.pixel(pixel);
        let second_half = halves.then(|| stream.branch(HALF_BRANCH));
        Self { job, start, center: pixel.as_vec2() + 0.5, stream, second_half, needs_time }
    }

    /// Sampler of a sample, at its first dimension.
    fn sampler(&self, sample: u32) -> Sampler {
        match &self.second_half {
            None => self.stream.sample(sample),
            Some(second_half) => {
                (if is_in_second_half(sample) { second_half } else { &self.stream }).sample(sample / 2)
            }
        }
    }

    /// Lens sample in the unit square. The sampler is at its first dimension, here and below.
    fn lens(&self, sampler: &Sampler) -> Vec2 {
        if self.job.camera.needs_lens() { sampler.skipped(FILM_DIMENSIONS).next_2d() } else { Vec2::splat(0.5) }
    }

    /// Time of a ray, from 0 (shutter opens) to 1 (shutter closes), stratified over the pixel's samples
    /// independently of their film positions.
    fn time(&self, sampler: &Sampler) -> f32 {
        if self.needs_time { sampler.skipped(TIME_DIMENSION).next_1d() } else { 0.0 }
    }

    /// Path of the camera ray of a sample.
    fn path(&self, sampler: &Sampler, slot: u32, weight: f32) -> PathState {
        PathState {
            beta: Rgb::splat(weight),
            depth: 0,
            sampler: sampler.skipped(FILM_DIMENSIONS + LENS_DIMENSIONS),
            history: self.start.history,
            cone: self.start.cone,
            slot,
        }
    }

    /// Pushes the rays of the samples `first` and following. `points` is scratch memory.
    fn push_rays(&self, first: u32, slots: Range<u32>, points: &mut [Vec2; POINTS], queue: &mut Queue) {
        for start in slots.clone().step_by(POINTS) {
            let count = POINTS.min((slots.end - start) as usize);
            let first = first + (start - slots.start);
            let drawn = &mut points[..count.next_multiple_of(LANES)];
            if self.second_half.is_none() {
                self.stream.first_points(first, drawn);
            } else {
                (first..).zip(drawn).for_each(|(sample, place)| *place = self.sampler(sample).skipped(0).next_2d());
            }
            for (packet, points) in points[..count].chunks(LANES).enumerate() {
                let skipped = (packet * LANES) as u32;
                let samplers = std::array::from_fn(|i| self.sampler(first + skipped + i as u32));
                let slot = start + skipped;
                self.push_packet(points, &samplers, queue, |i, weight| {
                    self.path(&samplers[i], slot + i as u32, weight)
                });
            }
        }
    }

    /// Pushes up to [`LANES`] rays, each with a point in [0, 1)² from which its film position follows,
    /// and a sampler. `path` is the path of a ray by its index and filter weight.
    #[inline(always)]
    fn push_packet(
        &self,
        points: &[Vec2],
        samplers: &[Sampler; LANES],
        queue: &mut Queue,
        path: impl Fn(usize, f32) -> PathState,
    ) {
        let Job { camera, filter, .. } = self.job;
        let (mut films, mut weights) = ([[self.center.x; LANES], [self.center.y; LANES]], [1.0; LANES]);
        for (i, place) in points.iter().enumerate() {
            let sample = filter.sample(*place);
            films[0][i] += sample.offset.x;
            films[1][i] += sample.offset.y;
            weights[i] = sample.weight;
        }
        let lenses = samplers.each_ref().map(|sampler| self.lens(sampler));
        let times = samplers.each_ref().map(|sampler| self.time(sampler));
        camera.rays(&films, &lenses, &times, points.len(), &mut queue.rays);
        queue.paths.extend(weights.iter().take(points.len()).enumerate().map(|(i, weight)| path(i, *weight)));
        set_interiors(self.job, self.start, &times[..points.len()], queue);
    }
}

/// Sets the solids that contain the last rays of the queue, at these times, if the solids around the
/// camera change while the shutter is open.
#[inline]
fn set_interiors(job: &Job, start: &PathStart, times: &[f32], queue: &mut Queue) {
    if start.interiors_change {
        for (path, time) in queue.paths.iter_mut().rev().zip(times.iter().rev()) {
            path.history = PathHistory { is_split: path.history.is_split, ..history_at(job, *time) };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{job, read, world};
    use super::*;
    use juggler_camera::{AnyCamera, ShutterCamera};
    use juggler_integrator::{AnyIntegrator, Path};
    use juggler_math::Vec3;

    /// Film position, lens position and time of a pixel's samples are independent: the correlation
    /// of any two of them is small.
    #[test]
    fn film_lens_and_time_are_independent() {
        const SAMPLES: u32 = 256;
        let key = |z: f32| {
            let lens = format!(
                r#"{{"thin_lens": {{"eye": [0, 0, {z}], "direction": [0, 0, -1], "lens_radius": 1, "focus_distance": 4}}}}"#
            );
            read::<AnyCamera>(&lens).projection(UVec2::ONE).unwrap()
        };
        let camera = ShutterCamera::from_keys(key(5.0), vec![key(6.0)]);
        let (world, integrator) = (world(&[], &[], Rgb::WHITE), AnyIntegrator::from(Path::default()));
        let job = job(&world, &camera, &integrator, SAMPLES);
        let work = Work::first(juggler_camera::film::Rect { x: 0, y: 0, width: 1, height: 1 }, SAMPLES);
        let mut queue = Queue::default();
        push_camera_rays(&job, &path_start(&job), &work, SAMPLES.into(), 0..SAMPLES.into(), &mut queue);
        // The focal plane shows the film position, and the origin the lens position.
        let of_ray = |ray: &juggler_math::Ray| {
            let focus: Vec3 = ray.origin + ray.direction * (4.0 / -ray.direction.z);
            [focus.x, focus.y, ray.origin.x, ray.origin.y, ray.time]
        };
        let rays: Vec<[f32; 5]> = queue.rays.iter().map(of_ray).collect();
        let mean = |f: &dyn Fn(&[f32; 5]) -> f32| rays.iter().map(f).sum::<f32>() / rays.len() as f32;
        let means: [f32; 5] = std::array::from_fn(|i| mean(&|ray| ray[i]));
        let covariance = |i: usize, j: usize| mean(&|ray| (ray[i] - means[i]) * (ray[j] - means[j]));
        for (i, j) in (0..5).flat_map(|i| (0..i).map(move |j| (i, j))) {
            let correlation = covariance(i, j) / (covariance(i, i) * covariance(j, j)).sqrt();
            assert!(correlation.abs() < 0.15, "components {i} and {j}: {correlation}");
        }
    }

    #[test]
    fn dimensions_of_a_camera_ray_are_distinct() {
        let dimensions = [0, FILM_DIMENSIONS, FILM_DIMENSIONS + LENS_DIMENSIONS, TIME_DIMENSION];
        assert!(dimensions.is_sorted_by(|a, b| a < b), "{dimensions:?}");
    }
}
