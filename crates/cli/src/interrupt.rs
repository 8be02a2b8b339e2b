//! Signals that end a render in an orderly way, and a signal that must not end the program.

use crate::failure::{Failure, plain};
use juggler::BuildControl;
#[cfg(unix)]
use signal_hook::consts::{SIGHUP, SIGXFSZ};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
#[cfg(feature = "serve")]
use signal_hook::iterator::Signals;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

/// Interval between checks for signals.
pub const TICK: Duration = Duration::from_millis(20);

/// Signals to watch: SIGINT, SIGTERM and, unless ignored as under `nohup`, SIGHUP.
fn watched_signals() -> Vec<i32> {
    #[allow(unused_mut, reason = "only Unix has a third")]
    let mut signals = vec![SIGINT, SIGTERM];
    #[cfg(unix)]
    if std::fs::read_to_string("/proc/self/status").is_ok_and(|status| !is_ignored(&status, SIGHUP)) {
        signals.push(SIGHUP);
    }
    signals
}

/// Whether a process with this `/proc` status ignores a signal. If the status does not tell, the
/// signal counts as ignored and keeps its default effect.
#[cfg(unix)]
fn is_ignored(status: &str, signal: i32) -> bool {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_none_or(|mask| (mask >> (signal - 1)) & 1 == 1)
}

/// Ignores the signal SIGXFSZ, so that a write beyond the limit of file sizes fails like one to a
/// full disk: with a message, and without the incomplete file.
pub fn ignore_file_size_signal() {
    // A signal that cannot be watched keeps its default effect.
    #[cfg(unix)]
    drop(flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false))));
}

/// Record of received signals.
pub struct Interrupts {
    number: Arc<AtomicUsize>,
}

impl Interrupts {
    /// Records SIGINT, SIGTERM and SIGHUP from now on; a second signal ends the program
    /// immediately.
    pub fn watch() -> Result<Self, Failure> {
        let number = Arc::new(AtomicUsize::new(0));
        let again = Arc::new(AtomicBool::new(false));
        for signal in watched_signals() {
            flag::register_conditional_shutdown(signal, 128 + signal, Arc::clone(&again))
                .and_then(|_| flag::register(signal, Arc::clone(&again)))
                .and_then(|_| flag::register_usize(signal, Arc::clone(&number), signal.unsigned_abs() as usize))
                .map_err(|error| cannot_watch(&error))?;
        }
        Ok(Self { number })
    }

    /// Received signal as a [`Failure`], if any.
    pub fn caught(&self) -> Option<Failure> {
        let number = self.number.load(Relaxed);
        let signal = u8::try_from(number).unwrap_or(u8::MAX);
        (number != 0).then_some(Failure::Interrupted { signal, saved: None })
    }

    /// Runs a build while another thread watches for signals, which cancel its control.
    pub fn cancelling<T>(&self, build: impl FnOnce(&BuildControl) -> T) -> T {
        let control = BuildControl::default();
        std::thread::scope(|scope| {
            let (running, ended) = mpsc::channel::<()>();
            let control = &control;
            scope.spawn(move || {
                while ended.recv_timeout(TICK) == Err(RecvTimeoutError::Timeout) {
                    if self.caught().is_some() {
                        control.cancel();
                    }
                }
            });
            let result = build(control);
            drop(running);
            result
        })
    }

    /// Fails if a signal was received.
    pub fn check(&self) -> Result<(), Failure> {
        self.caught().map_or(Ok(()), Err)
    }

    /// Blocks until a signal arrives, and returns it.
    #[cfg(feature = "serve")]
    pub fn wait(&self) -> Failure {
        // A signal received before this point is in `caught`.
        let mut signals = match Signals::new(watched_signals()) {
            Ok(signals) => signals,
            Err(error) => return cannot_watch(&error),
        };
        loop {
            if let Some(signal) = self.caught() {
                return signal;
            }
            drop(signals.wait());
        }
    }
}

fn cannot_watch(error: &std::io::Error) -> Failure {
    Failure::System(format!("cannot watch for signals: {}", plain(error)))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_signal_cancels_a_build() {
        let interrupts = Interrupts { number: Arc::default() };
        assert!(interrupts.cancelling(|control| !control.is_cancelled()));
        interrupts.number.store(2, Relaxed);
        interrupts.cancelling(|control| {
            while !control.is_cancelled() {
                std::thread::yield_now();
            }
        });
    }

    #[test]
    fn ignored_signals_stay_ignored() {
        let status = |mask: &str| format!("Name:\tjuggler\nSigIgn:\t{mask}\nSigCgt:\t0000000000000000\n");
        assert!(is_ignored(&status("0000000000000001"), SIGHUP) && !is_ignored(&status("0000000000001000"), SIGHUP));
        assert!(is_ignored(&status("0000000000004000"), SIGTERM) && is_ignored("Name:\tjuggler\n", SIGHUP));
    }
}
