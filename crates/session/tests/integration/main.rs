//! An interactive session: edits, watched files, light groups, saved pictures.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a test fails by panicking and prints its figures"
)]

mod bookmarks;
mod edits;
mod files;
mod lights;
mod pictures;
mod preview;
mod protocol;
mod thumbnails;
mod transparency;

use juggler_session::{Session, Status};
use std::sync::Arc;
use std::time::{Duration, Instant};

const PATIENCE: Duration = Duration::from_secs(30);

/// Waits for a status that meets a condition, and returns it.
fn until(session: &Session, condition: impl Fn(&Status) -> bool) -> Arc<Status> {
    let end = Instant::now() + PATIENCE;
    while Instant::now() < end {
        let status = session.status();
        if condition(&status) {
            return status;
        }
        session.wait(u64::MAX, status.number, Duration::from_millis(50));
    }
    panic!("never came: {:?}", session.status());
}
