//! Progressive rendering: the tiles of a film receive samples in rounds until their stopping
//! criterion is met. Existing samples are kept. The schedule cannot change a pixel, since a tile's
//! number of samples depends only on the criterion and on the tile's own samples.

use super::rounds::{Round, RoundGuard, Rounds, StopCriterion, short_round_after};
use super::wavefront::Engine;
use super::{Cancelled, Control, Job};
use juggler_camera::film::{Film, runs};
use std::ops::Range;

/// Renders `film` on the threads of the current rayon pool until every tile meets `stop`, or until
/// [`Control::finish`], which completes the tiles in progress. Cancellation discards them. Other
/// threads may read `film` meanwhile.
///
/// # Errors
///
/// [`Cancelled`] if `control` is cancelled.
pub fn render_progressive(job: &Job, film: &Film, stop: StopCriterion, control: &Control) -> Result<(), Cancelled> {
    // Choose the number of camera rays before all threads need it.
    job.camera_rays.count(job, control)?;
    let render = ProgressiveRender::new(job, film, stop);
    rayon::broadcast(|_| {
        let mut worker = render.worker();
        while worker.step(u32::MAX, control).is_some() {}
    });
    if control.is_cancelled() { Err(Cancelled) } else { Ok(()) }
}

/// Progressive render of a film by any number of [`Worker`]s. [`render_progressive`] runs one on
/// each thread; a single one never waits, so it also works step by step without threads.
pub struct ProgressiveRender<'j> {
    job: &'j Job<'j>,
    rounds: Rounds<'j>,
}

impl<'j> ProgressiveRender<'j> {
    /// Creates a render that continues from the film's samples.
    pub fn new(job: &'j Job<'j>, film: &'j Film, stop: StopCriterion) -> Self {
        Self { job, rounds: Rounds::new(film, stop) }
    }

    /// Creates a worker.
    pub fn worker(&self) -> Worker<'_> {
        Worker { rounds: &self.rounds, engine: Engine::new(self.job) }
    }
}

/// Worker of a progressive render, for one thread.
pub struct Worker<'e> {
    rounds: &'e Rounds<'e>,
    engine: Engine<'e>,
}

impl Worker<'_> {
    /// Renders the next round of a tile, by at most `max_samples` samples per pixel, and returns
    /// the tile's index. Returns `None` if all tiles are finished or `control` requests an end.
    /// Blocks only while other workers render the remaining rounds.
    pub fn step(&mut self, max_samples: u32, control: &Control) -> Option<usize> {
        let prefix = RoundGuard::next(self.rounds, max_samples, control)?;
        Some(prefix.render(&mut self.engine, control))
    }
}

/// Whether every tile of the film meets `stop`.
pub fn is_finished(film: &Film, stop: StopCriterion) -> bool {
    (0..film.len()).all(|place| is_tile_finished(film, stop, place))
}

/// Whether the tile at index `index` meets `stop`.
pub fn is_tile_finished(film: &Film, stop: StopCriterion, index: usize) -> bool {
    Round::after(film, stop, index, 0).is_none()
}

/// Maximum number of tiles that [`estimate_noise`] inspects.
const MAX_TILES_INSPECTED: usize = 1024;

/// Noise of a film relative to a target level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseEstimate {
    /// Largest relative error of a tile, as in [`StopCriterion::Noise`].
    pub noise: f64,
    /// Number of samples divided by the estimated number required, from 0 to 1. The estimate
    /// assumes that the variance of the samples stays constant.
    pub fraction: f64,
}

/// Estimates the noise of a film from at most 1,024 of its tiles, which takes about ten
/// milliseconds. Returns `None` until each of these tiles has enough samples for an estimate.
pub fn estimate_noise(film: &Film, level: f32) -> Option<NoiseEstimate> {
    let (limit, step) = (f64::from(level) * f64::from(level), film.len().div_ceil(MAX_TILES_INSPECTED).max(1));
    let (mut worst, mut done, mut needed) = (0.0_f64, 0.0, 0.0);
    for place in (0..film.len()).step_by(step) {
        let max_samples = film.requested(place).last().map_or(0, |requested| requested.end);
        let tile = film.tile(place)?;
        let (area, count, variance) =
            (tile.pixels().area() as f64, f64::from(tile.samples_per_pixel()), tile.relative_variance()?);
        worst = worst.max(variance);
        done += area * count;
        // The variance of a mean is inversely proportional to the number of samples.
        needed += area * (count * (variance / limit).max(1.0)).min(f64::from(max_samples).max(count));
    }
    (needed > 0.0).then(|| NoiseEstimate { noise: worst.sqrt(), fraction: done / needed })
}

/// Maximum number of runs that a tile holds on its way to the samples `requested`. Each run takes a
/// [`Sum`](juggler_camera::film::Sum) per pixel until it is merged with its neighbors.
pub fn max_runs(requested: &Range<u32>) -> usize {
    let next = |end: &u32| (*end < requested.end).then(|| short_round_after(*end).min(requested.end));
    let ends = std::iter::successors(Some(requested.start), next).skip(1);
    ends.map(|end| runs(requested.start..end).len()).max().unwrap_or(0)
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::Work;
    use super::super::tests::{busy, job, look};
    use super::*;
    use juggler_camera::film::{Rect, Tiling};
    use juggler_integrator::{AnyIntegrator, Classic};
    use juggler_math::{Rgb, UVec2, Vec3};
    use rayon::ThreadPoolBuilder;

    const REGION: Rect = Rect { x: 0, y: 0, width: 35, height: 20 };

    pub fn with_job<T: Send>(threads: usize, test: impl FnOnce(&Job) -> T + Send) -> T {
        let world = busy();
        let camera = look(Vec3::new(0.0, 1.0, 6.0), Vec3::ZERO, "40", UVec2::new(REGION.width, REGION.height));
        let integrator: AnyIntegrator =
            Classic { max_depth: 1, min_weight: 1e-2, occlusion_distance: Some(2.0) }.into();
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| test(&job(&world, &camera, &integrator, 1000)))
    }

    fn means(film: &Film) -> Vec<Vec<Rgb>> {
        (0..film.len()).map(|place| film.tile(place).unwrap().means()).collect()
    }

    fn finished_film(job: &Job, film: Film, stop: StopCriterion) -> Film {
        render_progressive(job, &film, stop, &Control::default()).unwrap();
        assert!(is_finished(&film, stop));
        film
    }

    pub fn whole(samples: Range<u32>) -> Film {
        Film::new(Tiling::new(REGION), samples)
    }

    #[test]
    fn max_runs_counts_the_unmerged_sample_runs() {
        let known = [(0, 0), (1, 1), (16, 1), (17, 2), (64, 1), (96, 2), (192, 3), (256, 3), (1024, 3), (1 << 16, 8)];
        for (samples, runs) in known {
            assert_eq!(max_runs(&(0..samples)), runs, "{samples}");
        }
        // 16..32, and 32..48 before it grows to 32..64.
        assert_eq!(max_runs(&(16..64)), 2);
    }

    #[test]
    fn rounds_give_the_film_of_one_run() {
        with_job(3, |job| {
            let film = finished_film(job, whole(0..37), StopCriterion::Samples);
            for place in 0..film.len() {
                let tile = film.tile(place).unwrap();
                assert_eq!(*tile, job.render(&Work::first(tile.pixels(), 37), &Control::default()).unwrap());
            }
        });
    }

    #[test]
    fn shards_and_extensions_give_the_film_of_one_run() {
        with_job(2, |job| {
            let straight = finished_film(job, whole(0..70), StopCriterion::Samples);
            // Render a prefix of all tiles and ranges of some tiles, then the rest.
            let prefix = finished_film(job, whole(0..21), StopCriterion::Samples);
            let film = whole(0..70);
            prefix.tiles().for_each(|(number, tile)| assert_eq!(film.add(number, tile), Ok(true)));
            let some =
                finished_film(job, Film::from_tiles(film.tiling(), [(1, 32..64), (4, 48..70)]), StopCriterion::Evenly);
            some.tiles().for_each(|(number, tile)| assert_eq!(film.add(number, tile), Ok(true)));
            assert!(!is_finished(&film, StopCriterion::Samples));
            assert_eq!(means(&finished_film(job, film, StopCriterion::Samples)), means(&straight));
        });
    }

    #[test]
    fn steps_of_any_length_equal_one_pass() {
        with_job(1, |job| {
            for stop in [StopCriterion::Samples, StopCriterion::Evenly, StopCriterion::Noise(0.008)] {
                let (film, control) = (whole(0..100), Control::default());
                // Recreate the worker every 20 steps, as interactive callers do.
                for max_samples in [7, 16, 40, 100, 1].into_iter().cycle() {
                    let render = ProgressiveRender::new(job, &film, stop);
                    let mut worker = render.worker();
                    let steps = std::iter::repeat_with(|| worker.step(max_samples, &control)).take(20);
                    if steps.flatten().count() < 20 {
                        break;
                    }
                }
                let straight = finished_film(job, whole(0..100), stop);
                assert_eq!(film.counts(), straight.counts(), "{stop:?}");
                assert_eq!(means(&film), means(&straight), "{stop:?}");
            }
        });
    }

    #[test]
    fn noise_criterion_does_not_depend_on_threads_or_interruptions() {
        let stop = StopCriterion::Noise(0.008);
        let straight = with_job(1, |job| finished_film(job, whole(0..600), stop));
        let counts = straight.counts();
        assert!(counts.contains(&64) && counts.iter().any(|count| *count > 64), "{counts:?}");
        let stopped = with_job(3, |job| {
            let control = Control::default();
            let film = whole(0..600);
            rayon::join(
                || render_progressive(job, &film, stop, &control),
                || {
                    while control.samples() < 20_000 {
                        std::thread::yield_now();
                    }
                    control.cancel();
                },
            )
            .0
            .unwrap_err();
            assert!(film.samples() < straight.samples());
            finished_film(job, film, stop)
        });
        assert_eq!(stopped.counts(), counts);
        assert_eq!(means(&stopped), means(&straight));
    }

    #[test]
    fn noise_estimate_falls_to_the_requested_level() {
        with_job(2, |job| {
            assert_eq!(estimate_noise(&whole(0..600), 0.008), None);
            let prefix = finished_film(job, whole(0..32), StopCriterion::Samples);
            let film = whole(0..600);
            prefix.tiles().for_each(|(number, tile)| assert_eq!(film.add(number, tile), Ok(true)));
            let early = estimate_noise(&film, 0.008).unwrap();
            assert!(early.noise > 0.008 && early.fraction > 0.0 && early.fraction < 1.0, "{early:?}");
            let late = estimate_noise(&finished_film(job, film, StopCriterion::Noise(0.008)), 0.008).unwrap();
            assert!(late.noise <= 0.008 && late.fraction == 1.0, "{late:?}");
        });
    }

    #[test]
    fn early_finish_completes_whole_rounds_of_the_first_tiles() {
        let film = with_job(2, |job| {
            let (film, control) = (whole(0..1000), Control::default());
            std::thread::scope(|scope| {
                scope.spawn(|| {
                    while control.samples() < 30_000 {
                        std::thread::yield_now();
                    }
                    control.finish();
                });
                render_progressive(job, &film, StopCriterion::Evenly, &control).unwrap();
            });
            film
        });
        let counts = film.counts();
        assert!(counts.windows(2).all(|pair| pair[0] >= pair[1]) && counts[0] < 1000, "{counts:?}");
        assert!((0..film.len()).all(|place| film.tile(place).unwrap().is_gapless()));
    }
}
