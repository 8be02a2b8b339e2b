//! Rates of tracers. Within every repeat the tracers take turns, in rotating order: disturbances of
//! the machine affect all alike, so ratios are reliable where rates are not.

use crate::clock::{CpuClock, Elapsed, Stopwatch};
use crate::kernel::Scratch;
use juggler_bvh::TriangleHit;
use juggler_math::Ray;
use std::fmt;
use std::iter::Sum;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Number of rays that a thread takes at a time: few, so that threads finish together.
const CHUNK: usize = 512;
/// Minimum work per thread and repeat, in seconds; rays are traced repeatedly until then. In a few
/// milliseconds the start of the threads would matter.
const MIN_SECONDS: f64 = 0.05;

/// Summary of hits, to check whether tracers agree.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HitSummary {
    /// Number of rays that hit something.
    pub hits: u64,
    /// Sum of the distances of the closest hits.
    pub distance: f64,
}

impl HitSummary {
    /// Sums up closest hits.
    pub fn from_hits(hits: impl Iterator<Item = Option<TriangleHit>>) -> Self {
        Self::from_distances(hits.map(|hit| hit.map(|hit| hit.t)))
    }

    /// Sums up distances of closest hits; `None` is a miss.
    pub fn from_distances(distances: impl Iterator<Item = Option<f32>>) -> Self {
        let mut summary = Self::default();
        for distance in distances.flatten() {
            summary.hits += 1;
            summary.distance += f64::from(distance);
        }
        summary
    }

    /// Counts occluded rays; the distance is 0.
    pub fn from_occluded(occluded: impl Iterator<Item = bool>) -> Self {
        Self { hits: occluded.filter(|hit| *hit).count() as u64, distance: 0.0 }
    }

    /// Whether hits are equal and distances agree up to the order of summation.
    pub fn agrees(&self, other: &Self) -> bool {
        self.hits == other.hits && (self.distance - other.distance).abs() <= 1e-9 * self.distance.abs()
    }
}

impl Sum for HitSummary {
    fn sum<I: Iterator<Item = Self>>(summaries: I) -> Self {
        summaries.fold(Self::default(), |a, b| Self { hits: a.hits + b.hits, distance: a.distance + b.distance })
    }
}

impl fmt::Display for HitSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} hits, distances {:.6e}", self.hits, self.distance)
    }
}

/// A tracer under measurement: traces a few hundred rays. The dynamic call is negligible.
pub type Trace<'a> = &'a (dyn Fn(&[Ray], &mut Scratch) -> HitSummary + Sync);

/// Measurements of one tracer, repeat by repeat.
#[derive(Clone, Debug, Default)]
pub struct Timing {
    /// Number of rays per repeat.
    pub rays: usize,
    /// Time of each repeat: wall-clock time, and CPU time of all threads together.
    pub repeats: Vec<Elapsed>,
    /// Summary of the hits.
    pub summary: HitSummary,
}

impl Timing {
    /// Millions of rays per second of CPU time, median of the repeats; NaN without rays.
    pub fn cpu_rate(&self) -> f64 {
        self.rate(|time| time.cpu)
    }

    /// Millions of rays per second of wall-clock time, all threads together, median of the repeats;
    /// NaN without rays.
    pub fn wall_rate(&self) -> f64 {
        self.rate(|time| time.wall)
    }

    fn rate(&self, seconds: fn(&Elapsed) -> f64) -> f64 {
        let rays = if self.rays == 0 { f64::NAN } else { self.rays as f64 };
        rays * 1e-6 / median(self.repeats.iter().map(seconds))
    }

    /// Speedup over the other tracer by CPU time: median of the ratios of each repeat.
    pub fn speedup_over(&self, other: &Self) -> f64 {
        median(self.repeats.iter().zip(&other.repeats).map(|(own, other)| other.cpu / own.cpu))
    }
}

/// Median of the values, the mean of the middle two for an even number; NaN without values.
pub fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.into_iter().collect();
    sorted.sort_by(f64::total_cmp);
    let at = |i: usize| sorted.get(i).copied().unwrap_or(f64::NAN);
    (at(sorted.len() / 2) + at(sorted.len().saturating_sub(1) / 2)) / 2.0
}

/// Measures every tracer on the same rays: a warm-up, which determines the number of passes from
/// the fastest tracer, then `repeats` repeats.
pub fn measure_alternately(rays: &[Ray], tracers: &[Trace], threads: usize, repeats: usize) -> Vec<Timing> {
    let first: Vec<(Elapsed, HitSummary)> = tracers.iter().map(|trace| run(rays, *trace, threads, 1)).collect();
    let fastest = first.iter().map(|(time, _)| time.cpu).fold(f64::INFINITY, f64::min);
    let passes = (MIN_SECONDS * threads as f64 / fastest.max(1e-5)).ceil().max(1.0) as usize;
    let timing = |(_, summary)| Timing { rays: rays.len(), repeats: Vec::new(), summary };
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

/// Traces all rays `passes` times; idle threads take the next chunk. Returns time and sums of one
/// pass.
fn run(rays: &[Ray], trace: Trace, threads: usize, passes: usize) -> (Elapsed, HitSummary) {
    let (next, chunks) = (AtomicUsize::new(0), rays.len().div_ceil(CHUNK));
    let work = || {
        let (watch, mut scratch, mut summary) =
            (Stopwatch::start(CpuClock::Thread), Scratch::default(), HitSummary::default());
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= chunks * passes {
                return (watch.elapsed().cpu, summary);
            }
            let start = number % chunks * CHUNK;
            let chunk = &rays[start..(start + CHUNK).min(rays.len())];
            summary = [summary, trace(chunk, &mut scratch)].into_iter().sum();
        }
    };
    let watch = Stopwatch::start(CpuClock::Thread);
    let mut cpu = 0.0;
    let summary: HitSummary = std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads.max(1)).map(|_| scope.spawn(work)).collect();
        let own = work();
        // A panicked thread has reported its error; its rays are missing from the sums.
        let parts = others.into_iter().filter_map(|thread| thread.join().ok()).chain([own]);
        let count = |(time, summary)| {
            cpu += time;
            summary
        };
        parts.map(count).sum()
    });
    let one = |all: f64| all / passes as f64;
    let summary = HitSummary { hits: summary.hits / passes as u64, distance: one(summary.distance) };
    (Elapsed { wall: one(watch.elapsed().wall), cpu: one(cpu) }, summary)
}

#[cfg(test)]
mod tests;
