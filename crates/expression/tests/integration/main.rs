//! Tests of expressions through the public interface.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a test fails by panicking and prints its figures"
)]

mod expressions;
mod reference;
mod tape;
