//! Distribution of samples among workers: rounds of a tile's samples, tiles with the fewest samples
//! first.

use super::wavefront::Engine;
use super::{Cancelled, Control, Work};
use juggler_camera::film::{BLOCK_SAMPLES, Film};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Range;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Minimum number of samples before the noise of a tile is estimated.
const MIN_SAMPLES_NOISE: u32 = 4 * BLOCK_SAMPLES;
/// Maximum number of samples per pixel in a round.
const MAX_ROUND_SAMPLES: u32 = 16 * BLOCK_SAMPLES;

/// Criterion by which a tile is finished. No tile receives more samples than its film requests.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum StopCriterion {
    /// All requested samples, in rounds of up to 256 per pixel, whose rays are coherent.
    #[default]
    Samples,
    /// All requested samples, in short rounds, which end at 1, 4, 16, 32 samples and so on, so that
    /// all tiles advance evenly. For films that are displayed or may be stopped early.
    Evenly,
    /// Root mean square of the relative errors of the tile's pixels is at most this level, tested
    /// after fixed numbers of samples: 64, 80, 96, 112, 128, 160, 192, 224, 256 and so on.
    Noise(f32),
}

/// A range of samples of one tile.
pub struct Round {
    tile_index: usize,
    samples: Range<u32>,
}

impl Round {
    /// Next round of the tile at index `tile_index`; samples before `from` are already assigned.
    pub fn after(film: &Film, stop: StopCriterion, tile_index: usize, from: u32) -> Option<Self> {
        let tile = film.tile(tile_index)?;
        let requested = film.requested(tile_index).iter().filter(|requested| requested.end > from);
        let missing =
            requested.into_iter().find_map(|requested| tile.missing(requested.start.max(from)..requested.end))?;
        if let StopCriterion::Noise(level) = stop
            && is_round(missing.start)
            && missing.start >= MIN_SAMPLES_NOISE
            && tile.relative_variance().is_some_and(|square| square <= f64::from(level) * f64::from(level))
        {
            return None;
        }
        let round_after = match stop {
            StopCriterion::Samples => long_round_after,
            StopCriterion::Evenly => even_round_after,
            StopCriterion::Noise(_) => short_round_after,
        };
        let end = missing.end.min(round_after(missing.start));
        Some(Self { tile_index, samples: missing.start..end })
    }

    fn render(&self, film: &Film, engine: &mut Engine, control: &Control) {
        let Some((pixels, open_block)) =
            film.tile(self.tile_index).map(|mut tile| (tile.pixels(), tile.take_open_block(self.samples.start)))
        else {
            return;
        };
        let work = Work { pixels, samples: self.samples.clone(), open_block: open_block.clone() };
        let rendered = engine.render(&work, control);
        let Some(mut tile) = film.tile(self.tile_index) else { return };
        let added = match (rendered, open_block) {
            (Ok(new), _) => tile.merge(new),
            (Err(Cancelled), Some(open_block)) => tile.add(open_block),
            (Err(Cancelled), None) => Ok(()),
        };
        debug_assert_eq!(added, Ok(()), "samples are given out once");
    }
}

/// End of the long round that contains this sample: 256, 512, 768 and so on.
fn long_round_after(sample: u32) -> u32 {
    (sample / MAX_ROUND_SAMPLES).saturating_add(1).saturating_mul(MAX_ROUND_SAMPLES)
}

/// End of the short round that contains this sample: 16, 32, 64, 80, 96, 112, 128, 160, 192, 224,
/// 256 and so on.
pub fn short_round_after(sample: u32) -> u32 {
    let power = (sample.checked_ilog2()).map_or(0, |bits| 1 << bits);
    if sample < BLOCK_SAMPLES {
        return BLOCK_SAMPLES;
    }
    if sample < MIN_SAMPLES_NOISE {
        return power * 2;
    }
    let length = (power / 4).min(MAX_ROUND_SAMPLES);
    (sample / length).saturating_add(1).saturating_mul(length)
}

/// End of the round of [`StopCriterion::Evenly`] that contains this sample: 1, 4, 16, 32 and so on.
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

/// Queue of rounds; those of the tiles with the fewest samples come first.
pub struct Rounds<'f> {
    film: &'f Film,
    stop: StopCriterion,
    /// Number of threads that may take rounds.
    threads: usize,
    state: Mutex<State>,
    changed: Condvar,
}

struct State {
    /// First sample, tile index and end of each waiting round.
    waiting: BinaryHeap<Reverse<(u32, usize, u32)>>,
    /// Number of rounds in progress.
    in_progress: usize,
}

impl<'f> Rounds<'f> {
    /// Queue of all samples that the film lacks.
    pub fn new(film: &'f Film, stop: StopCriterion) -> Self {
        let first = (0..film.len()).filter_map(|tile_index| Round::after(film, stop, tile_index, 0));
        let waiting = first.map(|round| round.entry()).collect();
        let (state, threads) = (Mutex::new(State { waiting, in_progress: 0 }), rayon::current_num_threads());
        Self { film, stop, threads, state, changed: Condvar::new() }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether the round that starts at this sample depends on the previous one: if noise is
    /// estimated in between, or within a block, whose samples are summed in order.
    fn waits_for_previous(&self, sample: u32) -> bool {
        matches!(self.stop, StopCriterion::Noise(_)) || !sample.is_multiple_of(BLOCK_SAMPLES)
    }

    /// Number of samples of a round that one thread takes, where `rounds` rounds are left: the last
    /// ones are cut at blocks, so that no thread is idle while another renders a long round.
    fn share(&self, samples: Range<u32>, rounds: usize) -> u32 {
        let length = samples.end.saturating_sub(samples.start);
        if rounds >= self.threads || matches!(self.stop, StopCriterion::Noise(_)) {
            return length;
        }
        let pieces = self.threads.div_ceil(rounds.max(1)).min(MAX_ROUND_SAMPLES as usize) as u32;
        let end = (samples.start + length.div_ceil(pieces)).next_multiple_of(BLOCK_SAMPLES);
        end.saturating_sub(samples.start).min(length)
    }

    fn next(&self, max_samples: u32, control: &Control) -> Option<Round> {
        let mut state = self.lock();
        loop {
            if control.is_finishing() {
                return None;
            }
            if let Some(Reverse((start, tile_index, end))) = state.waiting.pop() {
                state.in_progress += 1;
                let most = self.share(start..end, state.waiting.len() + 1).min(max_samples.max(1));
                let now = end.min(start.saturating_add(most));
                let rest = Round { tile_index, samples: now..end };
                if !self.waits_for_previous(now) {
                    let next = if now < end { Some(rest) } else { Round::after(self.film, self.stop, tile_index, end) };
                    state.waiting.extend(next.map(|next| next.entry()));
                }
                return Some(Round { tile_index, samples: start..now });
            }
            if state.in_progress == 0 {
                return None;
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Marks a round as done, and `well` if it was not lost by a panic. Earlier rounds of its tile
    /// may still be in progress.
    fn done(&self, round: &Round, well: bool) {
        let (tile_index, end) = (round.tile_index, round.samples.end);
        let waits_for_previous = well && self.waits_for_previous(end);
        let next = if waits_for_previous { Round::after(self.film, self.stop, tile_index, end) } else { None };
        let mut state = self.lock();
        state.in_progress -= 1;
        state.waiting.extend(next.map(|round| round.entry()));
        self.changed.notify_all();
    }
}

/// A round in progress. Dropping it marks it as done, even by a panic, so that other workers do not
/// wait forever.
pub struct RoundGuard<'f> {
    rounds: &'f Rounds<'f>,
    round: Round,
}

impl<'f> RoundGuard<'f> {
    /// Waits for a round and takes at most `max_samples` of its samples. Returns `None` if no round
    /// is left.
    pub fn next(rounds: &'f Rounds<'f>, max_samples: u32, control: &Control) -> Option<Self> {
        rounds.next(max_samples, control).map(|round| Self { rounds, round })
    }

    /// Renders the round and returns the index of its tile.
    pub fn render(self, engine: &mut Engine, control: &Control) -> usize {
        self.round.render(self.rounds.film, engine, control);
        self.round.tile_index
    }
}

impl Drop for RoundGuard<'_> {
    fn drop(&mut self) {
        self.rounds.done(&self.round, !std::thread::panicking());
    }
}

impl Round {
    fn entry(&self) -> Reverse<(u32, usize, u32)> {
        Reverse((self.samples.start, self.tile_index, self.samples.end))
    }
}

#[cfg(test)]
mod tests {
    use super::super::progressive::is_finished;
    use super::super::progressive::tests::{whole, with_job};
    use super::*;

    #[test]
    fn rounds_end_at_sample_blocks_and_grow_by_at_most_a_quarter() {
        let mut ends = vec![0];
        while *ends.last().unwrap() < 3000 {
            ends.push(short_round_after(*ends.last().unwrap()));
        }
        assert_eq!(ends[..14], [0, 16, 32, 64, 80, 96, 112, 128, 160, 192, 224, 256, 320, 384]);
        assert!(ends[3..].windows(2).all(|pair| pair[1] <= pair[0] + pair[0] / 4));
        assert!(ends.windows(2).all(|pair| pair[1] - pair[0] <= MAX_ROUND_SAMPLES && pair[1] % BLOCK_SAMPLES == 0));
        assert!(ends[1..].iter().all(|end| is_round(*end) && !is_round(*end + 1)));
        assert_eq!(short_round_after(70), 80, "within a round, to its end");
        assert_eq!([0, 70, 255, 256].map(long_round_after), [256, 256, 256, 512]);
        assert_eq!([0, 1, 2, 4, 16, 70].map(even_round_after), [1, 4, 4, 16, 32, 80]);
    }

    #[test]
    fn rounds_are_assigned_once_in_any_order_of_completion() {
        for (stop, requested) in [(StopCriterion::Samples, [0..16, 32..40]), (StopCriterion::Evenly, [0..40, 48..71])] {
            with_job(1, |job| {
                let film =
                    Film::from_tiles(whole(0..1).tiling(), [(3, requested[0].clone()), (3, requested[1].clone())]);
                let (rounds, control, mut engine) = (Rounds::new(&film, stop), Control::default(), Engine::new(job));
                let mut given = 0;
                loop {
                    // Start two rounds, and complete the later one first.
                    let mut started: Vec<Round> = Vec::new();
                    while started.len() < 2 && !rounds.lock().waiting.is_empty() {
                        started.extend(rounds.next(u32::MAX, &control));
                    }
                    if started.is_empty() {
                        break;
                    }
                    for round in started.iter().rev() {
                        given += round.samples.len();
                        round.render(&film, &mut engine, &control);
                        rounds.done(round, true);
                    }
                }
                assert_eq!(given, requested.iter().map(Range::len).sum::<usize>(), "{stop:?}");
                assert!(is_finished(&film, stop));
            });
        }
    }

    #[test]
    fn threads_share_the_last_rounds() {
        let film = whole(0..512);
        let rounds = |threads: usize, stop: StopCriterion| Rounds { threads, ..Rounds::new(&film, stop) };
        let many = rounds(128, StopCriterion::Samples);
        assert_eq!([1, 2, 64, 127, 128].map(|left| many.share(0..256, left)), [16, 16, 128, 128, 256]);
        assert_eq!((many.share(256..300, 1), many.share(5..256, 1), many.share(256..260, 100)), (16, 11, 4));
        assert_eq!(rounds(2, StopCriterion::Samples).share(0..256, 1), 128);
        assert_eq!(rounds(1, StopCriterion::Samples).share(0..256, 1), 256);
        assert_eq!(rounds(128, StopCriterion::Noise(0.1)).share(64..80, 1), 16);
    }

    #[test]
    fn panicking_round_does_not_block_other_threads() {
        let film = whole(0..16);
        let (rounds, control) = (Rounds::new(&film, StopCriterion::Samples), Control::default());
        let fault = std::thread::scope(|scope| {
            let fault = || {
                let _guard = RoundGuard::next(&rounds, 16, &control).unwrap();
                std::panic::resume_unwind(Box::new("a fault"));
            };
            scope.spawn(fault).join()
        });
        assert!(fault.is_err());
        assert_eq!(rounds.lock().in_progress, 0);
    }
}
