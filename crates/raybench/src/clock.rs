//! Wall-clock time and CPU time. Where other programs run too, only CPU time tells the cost of a
//! computation.

use std::time::{Duration, Instant};

/// Threads whose CPU time counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CpuClock {
    /// The calling thread.
    Thread,
    /// All threads of this process together.
    Process,
}

/// Elapsed time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Elapsed {
    /// Wall-clock time in seconds.
    pub wall: f64,
    /// CPU time in seconds; wall-clock time where the system does not report it (not Unix).
    pub cpu: f64,
}

/// A stopwatch that runs from its construction.
#[derive(Debug)]
pub struct Stopwatch {
    clock: CpuClock,
    wall: Instant,
    cpu: Option<Duration>,
}

impl Stopwatch {
    /// Starts the stopwatch. With [`CpuClock::Thread`], [`Stopwatch::elapsed`] must be called from the
    /// same thread.
    pub fn start(clock: CpuClock) -> Self {
        Self { clock, wall: Instant::now(), cpu: cpu_time(clock) }
    }

    /// Time since the start.
    pub fn elapsed(&self) -> Elapsed {
        let cpu = self.cpu.zip(cpu_time(self.clock)).map(|(start, now)| now.saturating_sub(start).as_secs_f64());
        let wall = self.wall.elapsed().as_secs_f64();
        Elapsed { wall, cpu: cpu.unwrap_or(wall) }
    }
}

#[cfg(unix)]
fn cpu_time(clock: CpuClock) -> Option<Duration> {
    use rustix::time::{ClockId, clock_gettime};
    let time = clock_gettime(match clock {
        CpuClock::Thread => ClockId::ThreadCPUTime,
        CpuClock::Process => ClockId::ProcessCPUTime,
    });
    Some(Duration::new(time.tv_sec.try_into().ok()?, time.tv_nsec.try_into().ok()?))
}

#[cfg(not(unix))]
fn cpu_time(_clock: CpuClock) -> Option<Duration> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::hint::black_box;

    fn work() -> u32 {
        (0..5_000_000).fold(0, |sum, i| juggler_math::hash::combine(black_box(sum), i))
    }

    #[test]
    fn sleep_costs_no_processor() {
        let watch = Stopwatch::start(CpuClock::Thread);
        std::thread::sleep(Duration::from_millis(60));
        let Elapsed { wall, cpu } = watch.elapsed();
        assert!(wall >= 0.06, "{wall}");
        assert!(cfg!(not(unix)) || cpu < 0.03, "{cpu}");
    }

    #[test]
    fn process_clock_includes_other_threads_and_thread_clock_does_not() {
        let (thread, process) = (Stopwatch::start(CpuClock::Thread), Stopwatch::start(CpuClock::Process));
        let busy = std::thread::spawn(|| {
            let watch = Stopwatch::start(CpuClock::Thread);
            black_box(work());
            watch.elapsed().cpu
        });
        let busy = busy.join().unwrap();
        assert!(busy > 0.001 && process.elapsed().cpu >= busy * 0.9, "{busy}");
        assert!(cfg!(not(unix)) || thread.elapsed().cpu < busy * 0.5, "{busy}");
    }
}
