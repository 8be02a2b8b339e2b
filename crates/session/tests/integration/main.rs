//! An interactive session: edits, watched files, light groups, saved pictures.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a test fails by panicking and prints its figures"
)]

mod edits;
mod files;
mod lights;
mod pictures;
