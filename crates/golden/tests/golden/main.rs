//! End-to-end tests: picture hashes, scales, motion blur, noise limits, and the rules of the source
//! tree.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a test fails by panicking and prints its figures"
)]

mod arithmetic;
mod blur;
mod chess;
mod circles;
mod extra;
mod hashes;
mod hits;
mod instances;
mod kinds;
mod matrix;
mod model;
mod moving_emitters;
mod moving_parts;
mod noise;
mod pages;
mod scales;
mod tree;
mod words;
