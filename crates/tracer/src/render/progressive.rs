//! A film exposed round by round, each tile until its rule says that it has enough. What is there already is
//! gone on with. Nothing here can change a bit of the picture: which samples a tile gets follows from the rule and
//! from its own samples alone.

use super::wavefront::Engine;
use super::{Control, Job, Stopped, Work};
use crate::film::{BLOCK, Film, runs};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Range;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Fewest samples from which noise is told.
const LEAST_FOR_NOISE: u32 = 4 * BLOCK;
/// Most samples of a pixel in a round.
const LONGEST_ROUND: u32 = 16 * BLOCK;

/// When a tile has enough samples. In any case it gets no more than the film wants.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Stop {
    /// When it has as many as the film wants, in long rounds: the rays of many samples of a pixel go similar ways.
    #[default]
    Samples,
    /// The same in short rounds, the first of 1 and 4 samples, so that all tiles grow evenly: for a film that somebody
    /// looks at, or ends early.
    Evenly,
    /// When the root mean square of its pixels' relative errors is at most this level, looked at after fixed
    /// numbers of samples: 64, 80, 96, 112, 128, 160, 192, 224, 256 and so on.
    Noise(f32),
}

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
        let round = self.rounds.next(most, control)?;
        round.render(self.rounds.film, &mut self.engine, control);
        self.rounds.done(&round);
        Some(round.place)
    }
}

/// Whether every tile of the film has enough.
pub fn is_finished(film: &Film, stop: Stop) -> bool {
    (0..film.len()).all(|place| Round::after(film, stop, place, 0).is_none())
}

/// The most runs of samples that a tile may hold on its way to the samples `wanted`, each a [`Sum`](crate::film::Sum) a
/// pixel: after some rounds the sums of a tile are not yet joined into one.
pub fn most_runs(wanted: &Range<u32>) -> usize {
    let next = |end: &u32| (*end < wanted.end).then(|| short_round_after(*end).min(wanted.end));
    let ends = std::iter::successors(Some(wanted.start), next).skip(1);
    ends.map(|end| runs(wanted.start..end).len()).max().unwrap_or(0)
}

/// Some samples of one tile.
struct Round {
    place: usize,
    samples: Range<u32>,
}

impl Round {
    /// The next samples of the tile at `place`, those before `from` being given to somebody already.
    fn after(film: &Film, stop: Stop, place: usize, from: u32) -> Option<Self> {
        let tile = film.tile(place)?;
        let wanted = film.wanted(place).iter().filter(|wanted| wanted.end > from);
        let missing = wanted.into_iter().find_map(|wanted| tile.missing(wanted.start.max(from)..wanted.end))?;
        if let Stop::Noise(level) = stop
            && is_round(missing.start)
            && missing.start >= LEAST_FOR_NOISE
            && tile.relative_variance().is_some_and(|square| square <= f64::from(level) * f64::from(level))
        {
            return None;
        }
        let round_after = match stop {
            Stop::Samples => long_round_after,
            Stop::Evenly => even_round_after,
            Stop::Noise(_) => short_round_after,
        };
        let end = missing.end.min(round_after(missing.start));
        Some(Self { place, samples: missing.start..end })
    }

    fn render(&self, film: &Film, engine: &mut Engine, control: &Control) {
        let Some((pixels, open)) =
            film.tile(self.place).map(|mut tile| (tile.pixels(), tile.take_open(self.samples.start)))
        else {
            return;
        };
        let sums = open.as_ref().map_or_else(Vec::new, |run| run.sums.clone());
        let rendered = engine.render(&Work { pixels, samples: self.samples.clone(), open: sums }, control);
        let Some(mut tile) = film.tile(self.place) else { return };
        let added = match (rendered, open) {
            (Ok(new), _) => tile.merge(new),
            (Err(Stopped), Some(open)) => tile.add(open),
            (Err(Stopped), None) => Ok(()),
        };
        debug_assert_eq!(added, Ok(()), "samples are given out once");
    }
}

/// The end of the long round that begins with this sample: 256, 512, 768 and so on.
fn long_round_after(sample: u32) -> u32 {
    (sample / LONGEST_ROUND).saturating_add(1).saturating_mul(LONGEST_ROUND)
}

/// The end of the short round that begins with this sample: 16, 32, 64, 80, 96, 112, 128, 160, 192, 224, 256 and so on.
fn short_round_after(sample: u32) -> u32 {
    let power = (sample.checked_ilog2()).map_or(0, |bits| 1 << bits);
    if sample < BLOCK {
        return BLOCK;
    }
    if sample < LEAST_FOR_NOISE {
        return power * 2;
    }
    let length = (power / 4).min(LONGEST_ROUND);
    (sample / length).saturating_add(1).saturating_mul(length)
}

/// The same for somebody who looks and does not want to wait: 1, 4, 16, 32 and so on.
fn even_round_after(sample: u32) -> u32 {
    match sample {
        0 => 1,
        1..4 => 4,
        _ => short_round_after(sample),
    }
}

fn is_round(sample: u32) -> bool {
    sample.checked_sub(1).is_some_and(|before| short_round_after(before) == sample)
}

/// The rounds that wait: those of the tiles with the fewest samples come first.
struct Rounds<'f> {
    film: &'f Film,
    stop: Stop,
    state: Mutex<State>,
    changed: Condvar,
}

struct State {
    /// First sample, place, end.
    waiting: BinaryHeap<Reverse<(u32, usize, u32)>>,
    /// Rounds that somebody is busy with.
    begun: usize,
}

impl<'f> Rounds<'f> {
    fn new(film: &'f Film, stop: Stop) -> Self {
        let first = (0..film.len()).filter_map(|place| Round::after(film, stop, place, 0));
        let waiting = first.map(|round| round.entry()).collect();
        Self { film, stop, state: Mutex::new(State { waiting, begun: 0 }), changed: Condvar::new() }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether the round that begins with this sample must wait for the one before: where noise is looked at, and within
    /// a block, whose samples are summed in order.
    fn follows(&self, sample: u32) -> bool {
        matches!(self.stop, Stop::Noise(_)) || !sample.is_multiple_of(BLOCK)
    }

    /// Waits for a round, of which no more than `most` samples are taken now; `None` when there is none to come.
    fn next(&self, most: u32, control: &Control) -> Option<Round> {
        let mut state = self.lock();
        loop {
            if control.is_finishing() {
                return None;
            }
            if let Some(Reverse((start, place, end))) = state.waiting.pop() {
                state.begun += 1;
                let now = end.min(start.saturating_add(most.max(1)));
                let rest = Round { place, samples: now..end };
                if !self.follows(now) {
                    let next = if now < end { Some(rest) } else { Round::after(self.film, self.stop, place, end) };
                    state.waiting.extend(next.map(|next| next.entry()));
                }
                return Some(Round { place, samples: start..now });
            }
            if state.begun == 0 {
                return None;
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn done(&self, round: &Round) {
        let follows = self.follows(round.samples.end);
        let next = if follows { Round::after(self.film, self.stop, round.place, 0) } else { None };
        let mut state = self.lock();
        state.begun -= 1;
        state.waiting.extend(next.map(|round| round.entry()));
        self.changed.notify_all();
    }
}

impl Round {
    fn entry(&self) -> Reverse<(u32, usize, u32)> {
        Reverse((self.samples.start, self.place, self.samples.end))
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{busy, job, look};
    use super::*;
    use crate::film::{Layout, Rect};
    use crate::integrator::{AnyIntegrator, Classic};
    use juggler_math::{Rgb, UVec2, Vec3};
    use rayon::ThreadPoolBuilder;

    const REGION: Rect = Rect { x: 0, y: 0, width: 35, height: 20 };

    fn with_job<T: Send>(threads: usize, test: impl FnOnce(&Job) -> T + Send) -> T {
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

    fn whole(samples: Range<u32>) -> Film {
        Film::new(Layout::new(REGION), samples)
    }

    #[test]
    fn rounds_are_whole_blocks_and_grow_by_a_quarter() {
        let mut ends = vec![0];
        while *ends.last().unwrap() < 3000 {
            ends.push(short_round_after(*ends.last().unwrap()));
        }
        assert_eq!(ends[..14], [0, 16, 32, 64, 80, 96, 112, 128, 160, 192, 224, 256, 320, 384]);
        assert!(ends[3..].windows(2).all(|pair| pair[1] <= pair[0] + pair[0] / 4));
        assert!(ends.windows(2).all(|pair| pair[1] - pair[0] <= LONGEST_ROUND && pair[1] % BLOCK == 0));
        assert!(ends[1..].iter().all(|end| is_round(*end) && !is_round(*end + 1)));
        assert_eq!(short_round_after(70), 80, "within a round, to its end");
        assert_eq!([0, 70, 255, 256].map(long_round_after), [256, 256, 256, 512]);
        assert_eq!([0, 1, 2, 4, 16, 70].map(even_round_after), [1, 4, 4, 16, 32, 80]);
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
