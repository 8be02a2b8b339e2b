//! Tests of the readers on real, large and hostile files.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stderr,
    reason = "a test fails by panicking and prints its figures"
)]

mod files;
mod hostile;
