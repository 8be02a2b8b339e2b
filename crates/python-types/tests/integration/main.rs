//! Tests of the generator, and of the generated files in the repository.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod classes;
mod fresh;
