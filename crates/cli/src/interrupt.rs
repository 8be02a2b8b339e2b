//! Signals that ask the program to stop: remembered, so that the render can end in order.

use crate::failure::{Failure, plain};
#[cfg(unix)]
use signal_hook::consts::SIGHUP;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
#[cfg(feature = "serve")]
use signal_hook::iterator::Signals;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};

/// The signals that end a render in order: Ctrl-C, the end that a system or cluster asks for, and a
/// terminal that goes away, unless `nohup` has the program outlive that.
fn watched() -> Vec<i32> {
    #[allow(unused_mut, reason = "only Unix has a third")]
    let mut signals = vec![SIGINT, SIGTERM];
    #[cfg(unix)]
    if std::fs::read_to_string("/proc/self/status").is_ok_and(|status| !is_ignored(&status, SIGHUP)) {
        signals.push(SIGHUP);
    }
    signals
}

/// Whether a process that has this status ignores a signal. A status that does not say it counts as
/// one that does: then the signal keeps the effect that it has.
#[cfg(unix)]
fn is_ignored(status: &str, signal: i32) -> bool {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_none_or(|mask| (mask >> (signal - 1)) & 1 == 1)
}

/// The signals that came.
pub struct Interrupts {
    number: Arc<AtomicUsize>,
}

impl Interrupts {
    /// From now on SIGINT, SIGTERM and SIGHUP are remembered; a second one ends the program at
    /// once.
    pub fn watch() -> Result<Self, Failure> {
        let number = Arc::new(AtomicUsize::new(0));
        let again = Arc::new(AtomicBool::new(false));
        for signal in watched() {
            flag::register_conditional_shutdown(signal, 128 + signal, Arc::clone(&again))
                .and_then(|_| flag::register(signal, Arc::clone(&again)))
                .and_then(|_| flag::register_usize(signal, Arc::clone(&number), signal.unsigned_abs() as usize))
                .map_err(|error| cannot_watch(&error))?;
        }
        Ok(Self { number })
    }

    /// The signal that came, as a failure.
    pub fn caught(&self) -> Option<Failure> {
        let number = self.number.load(Relaxed);
        let signal = u8::try_from(number).unwrap_or(u8::MAX);
        (number != 0).then_some(Failure::Interrupted { signal, kept: None })
    }

    /// An error as soon as a signal has come.
    pub fn check(&self) -> Result<(), Failure> {
        self.caught().map_or(Ok(()), Err)
    }

    /// Sleeps until a signal comes; it, as a failure.
    #[cfg(feature = "serve")]
    pub fn wait(&self) -> Failure {
        // One that came before these listen is remembered.
        let mut signals = match Signals::new(watched()) {
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
    fn ignored_signals_stay_ignored() {
        let status = |mask: &str| format!("Name:\tjuggler\nSigIgn:\t{mask}\nSigCgt:\t0000000000000000\n");
        assert!(is_ignored(&status("0000000000000001"), SIGHUP) && !is_ignored(&status("0000000000001000"), SIGHUP));
        assert!(is_ignored(&status("0000000000004000"), SIGTERM) && is_ignored("Name:\tjuggler\n", SIGHUP));
    }
}
