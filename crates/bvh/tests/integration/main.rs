//! Hierarchies against brute force: scenes, adversarial soups, closed meshes, motion, refitting.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a test fails by panicking and prints its figures"
)]

mod closed;
mod common;
mod degenerate;
mod moving;
mod oracle;
mod pinhole;
mod refit;
mod scenes;
mod soups;
