//! The web server: access rules, resource limits, invalid messages, the page.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a test fails by panicking and prints its figures"
)]

mod access;
mod common;
mod drops;
mod fuzz;
mod limits;
mod page;
mod protocol;
