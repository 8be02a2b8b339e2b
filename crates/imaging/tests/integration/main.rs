//! Picture and movie files: every format written and read back, tone curves, hostile input.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a test fails by panicking and prints its figures"
)]

mod animations;
mod claims;
mod common;
mod exr_files;
mod formats;
mod hostile;
mod mp4;
mod rasters;
mod read_only;
mod tones;
mod transparency;
