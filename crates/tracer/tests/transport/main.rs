//! The path tracer as a whole against closed forms, against two plain path tracers that know nothing of multiple
//! importance sampling, and against itself on other threads.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, reason = "a test")]

mod balls;
mod closed_forms;
mod furnaces;
mod glass;
mod glowing;
mod lights;
mod limits;
mod media;
mod probe;
mod skies;
mod strategies;
mod threads;
mod views;
