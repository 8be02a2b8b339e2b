//! Tests on real glTF and OBJ files, and the speed of decoding.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stderr,
    reason = "a test fails by panicking and prints its figures"
)]

mod assets;
mod obj;
mod speed;
