//! Who gets which samples next: rounds of a tile's samples, given out so that the tiles with the fewest come first.

use super::wavefront::Engine;
use super::{Control, Stopped, Work};
use juggler_camera::film::{BLOCK, Film};
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

/// Some samples of one tile.
pub struct Round {
    place: usize,
    samples: Range<u32>,
}

impl Round {
    /// The next samples of the tile at `place`, those before `from` being given to somebody already.
    pub fn after(film: &Film, stop: Stop, place: usize, from: u32) -> Option<Self> {
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
        let work = Work { pixels, samples: self.samples.clone(), open: open.clone() };
        let rendered = engine.render(&work, control);
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
pub fn short_round_after(sample: u32) -> u32 {
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
pub struct Rounds<'f> {
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
    /// Of all that a film lacks.
    pub fn new(film: &'f Film, stop: Stop) -> Self {
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

    /// Somebody is done with a round, and with it `well` or not. Earlier rounds of its tile may still be somebody's.
    fn done(&self, round: &Round, well: bool) {
        let (place, end) = (round.place, round.samples.end);
        let follows = well && self.follows(end);
        let next = if follows { Round::after(self.film, self.stop, place, end) } else { None };
        let mut state = self.lock();
        state.begun -= 1;
        state.waiting.extend(next.map(|round| round.entry()));
        self.changed.notify_all();
    }
}

/// A round that somebody is busy with. It ends even by a panic: the others would wait for it forever.
pub struct Begun<'f> {
    rounds: &'f Rounds<'f>,
    round: Round,
}

impl<'f> Begun<'f> {
    /// Waits for a round, of which no more than `most` samples are taken now; `None` when there is none to come.
    pub fn next(rounds: &'f Rounds<'f>, most: u32, control: &Control) -> Option<Self> {
        rounds.next(most, control).map(|round| Self { rounds, round })
    }

    /// Exposes it; the place of its tile.
    pub fn render(self, engine: &mut Engine, control: &Control) -> usize {
        self.round.render(self.rounds.film, engine, control);
        self.round.place
    }
}

impl Drop for Begun<'_> {
    fn drop(&mut self) {
        self.rounds.done(&self.round, !std::thread::panicking());
    }
}

impl Round {
    fn entry(&self) -> Reverse<(u32, usize, u32)> {
        Reverse((self.samples.start, self.place, self.samples.end))
    }
}

#[cfg(test)]
mod tests {
    use super::super::progressive::is_finished;
    use super::super::progressive::tests::{whole, with_job};
    use super::*;

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
    fn no_round_is_given_out_twice_whichever_is_done_first() {
        for (stop, wanted) in [(Stop::Samples, [0..16, 32..40]), (Stop::Evenly, [0..40, 48..71])] {
            with_job(1, |job| {
                let film = Film::of(whole(0..1).layout(), [(3, wanted[0].clone()), (3, wanted[1].clone())]);
                let (rounds, control, mut engine) = (Rounds::new(&film, stop), Control::default(), Engine::new(job));
                let mut given = 0;
                loop {
                    // Two hands at once, of which the one that began last is done first.
                    let mut begun: Vec<Round> = Vec::new();
                    while begun.len() < 2 && !rounds.lock().waiting.is_empty() {
                        begun.extend(rounds.next(u32::MAX, &control));
                    }
                    if begun.is_empty() {
                        break;
                    }
                    for round in begun.iter().rev() {
                        given += round.samples.len();
                        round.render(&film, &mut engine, &control);
                        rounds.done(round, true);
                    }
                }
                assert_eq!(given, wanted.iter().map(Range::len).sum::<usize>(), "{stop:?}");
                assert!(is_finished(&film, stop));
            });
        }
    }

    #[test]
    fn a_round_that_ends_by_a_panic_keeps_nobody_waiting() {
        let film = whole(0..16);
        let (rounds, control) = (Rounds::new(&film, Stop::Samples), Control::default());
        let fault = std::thread::scope(|scope| {
            let fault = || {
                let _begun = Begun::next(&rounds, 16, &control).unwrap();
                std::panic::resume_unwind(Box::new("a fault"));
            };
            scope.spawn(fault).join()
        });
        assert!(fault.is_err());
        assert_eq!(rounds.lock().begun, 0);
    }
}
