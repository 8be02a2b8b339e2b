//! Signals that ask the program to stop: remembered, so that the render can end in order.

use crate::failure::{Failure, plain};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
#[cfg(feature = "serve")]
use signal_hook::iterator::Signals;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};

const WATCHED: [i32; 2] = [SIGINT, SIGTERM];

/// The signals that came.
pub struct Interrupts {
    number: Arc<AtomicUsize>,
}

impl Interrupts {
    /// From now on SIGINT and SIGTERM are remembered; a second one ends the program at once.
    pub fn watch() -> Result<Self, Failure> {
        let number = Arc::new(AtomicUsize::new(0));
        let again = Arc::new(AtomicBool::new(false));
        for signal in WATCHED {
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

    /// Sleeps until a signal comes; it, as a failure.
    #[cfg(feature = "serve")]
    pub fn wait(&self) -> Failure {
        // One that came before these listen is remembered.
        let mut signals = match Signals::new(WATCHED) {
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
