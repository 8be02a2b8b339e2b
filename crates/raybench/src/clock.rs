//! Two clocks: the wall's, and the time that the processor really gave. Where other programs run too, only the
//! second says what a piece of work costs.

use std::time::{Duration, Instant};

/// Whose time on the processor counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Of {
    /// The calling thread's.
    Thread,
    /// That of all threads of this process together.
    Process,
}

/// How long something took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Elapsed {
    /// Seconds on the wall's clock.
    pub wall: f64,
    /// Seconds of the processor; where the system does not say (it is no Unix), those of the wall.
    pub cpu: f64,
}

/// A stopwatch that runs from its making.
#[derive(Debug)]
pub struct Stopwatch {
    of: Of,
    wall: Instant,
    cpu: Option<Duration>,
}

impl Stopwatch {
    /// Starts; ask it again from the same thread.
    pub fn start(of: Of) -> Self {
        Self { of, wall: Instant::now(), cpu: cpu_time(of) }
    }

    /// Time since the start.
    pub fn elapsed(&self) -> Elapsed {
        let cpu = self.cpu.zip(cpu_time(self.of)).map(|(start, now)| now.saturating_sub(start).as_secs_f64());
        let wall = self.wall.elapsed().as_secs_f64();
        Elapsed { wall, cpu: cpu.unwrap_or(wall) }
    }
}

#[cfg(unix)]
fn cpu_time(of: Of) -> Option<Duration> {
    use rustix::time::{ClockId, clock_gettime};
    let time = clock_gettime(match of {
        Of::Thread => ClockId::ThreadCPUTime,
        Of::Process => ClockId::ProcessCPUTime,
    });
    Some(Duration::new(time.tv_sec.try_into().ok()?, time.tv_nsec.try_into().ok()?))
}

#[cfg(not(unix))]
fn cpu_time(_of: Of) -> Option<Duration> {
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
        let watch = Stopwatch::start(Of::Thread);
        std::thread::sleep(Duration::from_millis(60));
        let Elapsed { wall, cpu } = watch.elapsed();
        assert!(wall >= 0.06, "{wall}");
        assert!(cfg!(not(unix)) || cpu < 0.03, "{cpu}");
    }

    #[test]
    fn the_process_counts_what_its_threads_do_and_the_thread_does_not() {
        let (thread, process) = (Stopwatch::start(Of::Thread), Stopwatch::start(Of::Process));
        let busy = std::thread::spawn(|| {
            let watch = Stopwatch::start(Of::Thread);
            black_box(work());
            watch.elapsed().cpu
        });
        let busy = busy.join().unwrap();
        assert!(busy > 0.001 && process.elapsed().cpu >= busy * 0.9, "{busy}");
        assert!(cfg!(not(unix)) || thread.elapsed().cpu < busy * 0.5, "{busy}");
    }
}
