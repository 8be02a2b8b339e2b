//! Rates of tracers. They take turns within every repeat, and who comes first changes: what disturbs the machine
//! disturbs all alike, so that ratios hold where rates do not.

use crate::clock::{Elapsed, Of, Stopwatch};
use crate::kernel::Scratch;
use juggler_bvh::TriangleHit;
use juggler_math::Ray;
use std::fmt;
use std::iter::Sum;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Rays that a thread takes at a time: few, so that threads end together.
const CHUNK: usize = 512;
/// Seconds of work for each thread that are timed at least; rays are traced again and again until then. Of a few
/// milliseconds the start of threads would be a part.
const LEAST: f64 = 0.05;

/// What rays came to, to see whether tracers agree.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sums {
    /// Rays that hit something.
    pub hits: u64,
    /// Sum of the distances of closest hits.
    pub distance: f64,
}

impl Sums {
    /// Of closest hits.
    pub fn of_hits(hits: impl Iterator<Item = Option<TriangleHit>>) -> Self {
        Self::of_distances(hits.map(|hit| hit.map(|hit| hit.t)))
    }

    /// Of distances.
    pub fn of_distances(distances: impl Iterator<Item = Option<f32>>) -> Self {
        let mut sums = Self::default();
        for distance in distances.flatten() {
            sums.hits += 1;
            sums.distance += f64::from(distance);
        }
        sums
    }

    /// Of answers that know no distance.
    pub fn of_occluded(occluded: impl Iterator<Item = bool>) -> Self {
        Self { hits: occluded.filter(|hit| *hit).count() as u64, distance: 0.0 }
    }

    /// Whether both say the same, as far as the order of a sum allows.
    pub fn agrees(&self, other: &Self) -> bool {
        self.hits == other.hits && (self.distance - other.distance).abs() <= 1e-9 * self.distance.abs()
    }
}

impl Sum for Sums {
    fn sum<I: Iterator<Item = Self>>(sums: I) -> Self {
        sums.fold(Self::default(), |a, b| Self { hits: a.hits + b.hits, distance: a.distance + b.distance })
    }
}

impl fmt::Display for Sums {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} hits, distances {:.6e}", self.hits, self.distance)
    }
}

/// What is measured: traces a few hundred rays. The call costs nothing that shows.
pub type Trace<'a> = &'a (dyn Fn(&[Ray], &mut Scratch) -> Sums + Sync);

/// Measurements of one tracer, in the order of the repeats.
#[derive(Clone, Debug, Default)]
pub struct Timing {
    /// How many rays each repeat traced.
    pub rays: usize,
    /// Time of each repeat: on the wall's clock, and of all threads together on the processor.
    pub repeats: Vec<Elapsed>,
    /// What the rays came to.
    pub sums: Sums,
}

impl Timing {
    /// Millions of rays a second of one thread's time on the processor; median, NaN without rays.
    pub fn cpu_rate(&self) -> f64 {
        self.rate(|time| time.cpu)
    }

    /// Millions of rays a second of all threads together, by the wall's clock; median, NaN without rays.
    pub fn wall_rate(&self) -> f64 {
        self.rate(|time| time.wall)
    }

    fn rate(&self, seconds: fn(&Elapsed) -> f64) -> f64 {
        let rays = if self.rays == 0 { f64::NAN } else { self.rays as f64 };
        rays * 1e-6 / median(self.repeats.iter().map(seconds))
    }

    /// How many times as fast as the other, by time on the processor: median of the ratios of each repeat.
    pub fn speed_against(&self, other: &Self) -> f64 {
        median(self.repeats.iter().zip(&other.repeats).map(|(own, other)| other.cpu / own.cpu))
    }
}

/// The middle of the values, of two the mean; NaN when there are none.
pub fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.into_iter().collect();
    sorted.sort_by(f64::total_cmp);
    let at = |i: usize| sorted.get(i).copied().unwrap_or(f64::NAN);
    (at(sorted.len() / 2) + at(sorted.len().saturating_sub(1) / 2)) / 2.0
}

/// Times every tracer on the same rays, `repeats` times after one that does not count but says how often the rays
/// must be traced to give the fastest enough to do.
pub fn in_turns(rays: &[Ray], tracers: &[Trace], threads: usize, repeats: usize) -> Vec<Timing> {
    let first: Vec<(Elapsed, Sums)> = tracers.iter().map(|trace| run(rays, *trace, threads, 1)).collect();
    let fastest = first.iter().map(|(time, _)| time.cpu).fold(f64::INFINITY, f64::min);
    let passes = (LEAST * threads as f64 / fastest.max(1e-5)).ceil().max(1.0) as usize;
    let timing = |(_, sums)| Timing { rays: rays.len(), repeats: Vec::new(), sums };
    let mut timings: Vec<Timing> = first.into_iter().map(timing).collect();
    for repeat in 0..repeats {
        for turn in 0..tracers.len() {
            let which = (repeat + turn) % tracers.len();
            if let (Some(trace), Some(timing)) = (tracers.get(which), timings.get_mut(which)) {
                timing.repeats.push(run(rays, *trace, threads, passes).0);
            }
        }
    }
    timings
}

/// Traces all rays `passes` times; threads take the next few hundred when they have done theirs. Time and sums are
/// those of one pass.
fn run(rays: &[Ray], trace: Trace, threads: usize, passes: usize) -> (Elapsed, Sums) {
    let (next, chunks) = (AtomicUsize::new(0), rays.len().div_ceil(CHUNK));
    let work = || {
        let (watch, mut scratch, mut sums) = (Stopwatch::start(Of::Thread), Scratch::default(), Sums::default());
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= chunks * passes {
                return (watch.elapsed().cpu, sums);
            }
            let start = number % chunks * CHUNK;
            let chunk = &rays[start..(start + CHUNK).min(rays.len())];
            sums = [sums, trace(chunk, &mut scratch)].into_iter().sum();
        }
    };
    let watch = Stopwatch::start(Of::Thread);
    let mut cpu = 0.0;
    let sums: Sums = std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads.max(1)).map(|_| scope.spawn(work)).collect();
        let own = work();
        // A thread that panicked has said so; its rays are then missing from the sums.
        let parts = others.into_iter().filter_map(|thread| thread.join().ok()).chain([own]);
        let count = |(time, sums)| {
            cpu += time;
            sums
        };
        parts.map(count).sum()
    });
    let one = |all: f64| all / passes as f64;
    let sums = Sums { hits: sums.hits / passes as u64, distance: one(sums.distance) };
    (Elapsed { wall: one(watch.elapsed().wall), cpu: one(cpu) }, sums)
}

#[cfg(test)]
mod tests;
