//! A film exposed round by round, each tile until its rule says that it has enough. What is there already is
//! gone on with. Nothing here can change a bit of the picture: which samples a tile gets follows from the rule and
//! from its own samples alone.

use super::rounds::{Begun, Round, Rounds, Stop, short_round_after};
use super::wavefront::Engine;
use super::{Control, Job, Stopped};
use juggler_camera::film::{Film, runs};
use std::ops::Range;

/// Exposes `film` on the threads of the current rayon pool until every tile has enough, or until
/// [`Control::finish`]: then what is begun is done, and the rest left. When cancelled, what is begun is lost. `film` may
/// be read meanwhile.
pub fn expose(job: &Job, film: &Film, stop: Stop, control: &Control) -> Result<(), Stopped> {
    let exposure = Exposure::new(job, film, stop);
    rayon::broadcast(|_| {
        let mut hand = exposure.hand();
        while hand.step(u32::MAX, control).is_some() {}
    });
    if control.is_cancelled() { Err(Stopped) } else { Ok(()) }
}

/// A film that is being exposed by as many [`Hand`]s as are wanted; [`expose`] has one on each thread. One alone never
/// waits, so it can work where there are no threads, a step at a time.
pub struct Exposure<'j> {
    job: &'j Job<'j>,
    rounds: Rounds<'j>,
}

impl<'j> Exposure<'j> {
    /// Goes on with what the film has.
    pub fn new(job: &'j Job<'j>, film: &'j Film, stop: Stop) -> Self {
        Self { job, rounds: Rounds::new(film, stop) }
    }

    /// Somebody who exposes it, on one thread.
    pub fn hand(&self) -> Hand<'_> {
        Hand { rounds: &self.rounds, engine: Engine::new(self.job) }
    }
}

/// Exposes a film, step by step.
pub struct Hand<'e> {
    rounds: &'e Rounds<'e>,
    engine: Engine<'e>,
}

impl Hand<'_> {
    /// Exposes the next tile, by no more than `most` samples a pixel, and returns its place. `None` when all tiles have
    /// enough or `control` says that it is to end. Waits only for other hands.
    pub fn step(&mut self, most: u32, control: &Control) -> Option<usize> {
        let begun = Begun::next(self.rounds, most, control)?;
        Some(begun.render(&mut self.engine, control))
    }
}

/// Whether every tile of the film has enough.
pub fn is_finished(film: &Film, stop: Stop) -> bool {
    (0..film.len()).all(|place| Round::after(film, stop, place, 0).is_none())
}

/// Most tiles that [`noise_so_far`] looks at.
const MOST_LOOKED_AT: usize = 1024;

/// How far a film is from a level of noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseSoFar {
    /// Largest relative error of a tile, as [`Stop::Noise`] has it.
    pub noise: f64,
    /// Samples so far over those that will be needed, from 0 to 1, if the variance of samples stays
    /// what it is.
    pub fraction: f64,
}

/// How far a film is from a level of noise, estimated from at most 1024 of its tiles, which takes
/// about ten milliseconds; `None` until each of these has samples enough to tell.
pub fn noise_so_far(film: &Film, level: f32) -> Option<NoiseSoFar> {
    let (limit, step) = (f64::from(level) * f64::from(level), film.len().div_ceil(MOST_LOOKED_AT).max(1));
    let (mut worst, mut done, mut needed) = (0.0_f64, 0.0, 0.0);
    for place in (0..film.len()).step_by(step) {
        let most = film.wanted(place).last().map_or(0, |wanted| wanted.end);
        let tile = film.tile(place)?;
        let (area, count, variance) = (tile.pixels().area() as f64, f64::from(tile.count()), tile.relative_variance()?);
        worst = worst.max(variance);
        done += area * count;
        // The variance of a mean falls as the number of its samples rises.
        needed += area * (count * (variance / limit).max(1.0)).min(f64::from(most).max(count));
    }
    (needed > 0.0).then(|| NoiseSoFar { noise: worst.sqrt(), fraction: done / needed })
}

/// The most runs of samples that a tile may hold on its way to the samples `wanted`, each a
/// [`Sum`](juggler_camera::film::Sum) a pixel: after some rounds the sums of a tile are not yet
/// joined into one.
pub fn most_runs(wanted: &Range<u32>) -> usize {
    let next = |end: &u32| (*end < wanted.end).then(|| short_round_after(*end).min(wanted.end));
    let ends = std::iter::successors(Some(wanted.start), next).skip(1);
    ends.map(|end| runs(wanted.start..end).len()).max().unwrap_or(0)
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::Work;
    use super::super::tests::{busy, job, look};
    use super::*;
    use juggler_camera::film::{Layout, Rect};
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

    fn exposed(job: &Job, film: Film, stop: Stop) -> Film {
        expose(job, &film, stop, &Control::default()).unwrap();
        assert!(is_finished(&film, stop));
        film
    }

    pub fn whole(samples: Range<u32>) -> Film {
        Film::new(Layout::new(REGION), samples)
    }

    #[test]
    fn runs_that_wait_to_be_joined_are_counted() {
        let known = [(0, 0), (1, 1), (16, 1), (17, 2), (64, 1), (96, 2), (192, 3), (256, 3), (1024, 3), (1 << 16, 8)];
        for (samples, runs) in known {
            assert_eq!(most_runs(&(0..samples)), runs, "{samples}");
        }
        // 16 to 32, and 32 to 48 before it grows to 64.
        assert_eq!(most_runs(&(16..64)), 2);
    }

    #[test]
    fn a_film_is_what_one_piece_of_work_gives() {
        with_job(3, |job| {
            let film = exposed(job, whole(0..37), Stop::Samples);
            for place in 0..film.len() {
                let tile = film.tile(place).unwrap();
                assert_eq!(*tile, job.render(&Work::first(tile.pixels(), 37), &Control::default()).unwrap());
            }
        });
    }

    #[test]
    fn parts_and_extensions_are_one_straight_run() {
        with_job(2, |job| {
            let straight = exposed(job, whole(0..70), Stop::Samples);
            // Some of it, and more of some tiles, then all.
            let begun = exposed(job, whole(0..21), Stop::Samples);
            let film = whole(0..70);
            begun.tiles().for_each(|(number, tile)| assert_eq!(film.add(number, tile), Ok(true)));
            let some = exposed(job, Film::of(film.layout(), [(1, 32..64), (4, 48..70)]), Stop::Evenly);
            some.tiles().for_each(|(number, tile)| assert_eq!(film.add(number, tile), Ok(true)));
            assert!(!is_finished(&film, Stop::Samples));
            assert_eq!(means(&exposed(job, film, Stop::Samples)), means(&straight));
        });
    }

    #[test]
    fn steps_of_any_length_are_one_straight_run() {
        with_job(1, |job| {
            for stop in [Stop::Samples, Stop::Evenly, Stop::Noise(0.008)] {
                let (film, control) = (whole(0..100), Control::default());
                // Others end and begin anew, as they do who have something else to do between.
                for most in [7, 16, 40, 100, 1].into_iter().cycle() {
                    let exposure = Exposure::new(job, &film, stop);
                    let mut hand = exposure.hand();
                    let steps = std::iter::repeat_with(|| hand.step(most, &control)).take(20);
                    if steps.flatten().count() < 20 {
                        break;
                    }
                }
                let straight = exposed(job, whole(0..100), stop);
                assert_eq!(film.counts(), straight.counts(), "{stop:?}");
                assert_eq!(means(&film), means(&straight), "{stop:?}");
            }
        });
    }

    #[test]
    fn noise_decides_the_same_on_any_number_of_threads_and_after_any_stop() {
        let stop = Stop::Noise(0.008);
        let straight = with_job(1, |job| exposed(job, whole(0..600), stop));
        let counts = straight.counts();
        assert!(counts.contains(&64) && counts.iter().any(|count| *count > 64), "{counts:?}");
        let stopped = with_job(3, |job| {
            let control = Control::default();
            let film = whole(0..600);
            rayon::join(
                || expose(job, &film, stop, &control),
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
            exposed(job, film, stop)
        });
        assert_eq!(stopped.counts(), counts);
        assert_eq!(means(&stopped), means(&straight));
    }

    #[test]
    fn noise_so_far_falls_to_its_level() {
        with_job(2, |job| {
            assert_eq!(noise_so_far(&whole(0..600), 0.008), None);
            let begun = exposed(job, whole(0..32), Stop::Samples);
            let film = whole(0..600);
            begun.tiles().for_each(|(number, tile)| assert_eq!(film.add(number, tile), Ok(true)));
            let early = noise_so_far(&film, 0.008).unwrap();
            assert!(early.noise > 0.008 && early.fraction > 0.0 && early.fraction < 1.0, "{early:?}");
            let late = noise_so_far(&exposed(job, film, Stop::Noise(0.008)), 0.008).unwrap();
            assert!(late.noise <= 0.008 && late.fraction == 1.0, "{late:?}");
        });
    }

    #[test]
    fn finishing_leaves_whole_rounds_of_the_first_tiles() {
        let film = with_job(2, |job| {
            let (film, control) = (whole(0..1000), Control::default());
            std::thread::scope(|scope| {
                scope.spawn(|| {
                    while control.samples() < 30_000 {
                        std::thread::yield_now();
                    }
                    control.finish();
                });
                expose(job, &film, Stop::Evenly, &control).unwrap();
            });
            film
        });
        let counts = film.counts();
        assert!(counts.windows(2).all(|pair| pair[0] >= pair[1]) && counts[0] < 1000, "{counts:?}");
        assert!((0..film.len()).all(|place| film.tile(place).unwrap().is_gapless()));
    }
}
