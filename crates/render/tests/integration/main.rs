//! The path tracer as a whole against closed forms, against two plain path tracers without multiple importance
//! sampling, and against itself on other threads; the JSON snippets of the documentation.

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
mod rooms;
mod skies;
mod snippets;
mod strategies;
mod threads;
mod views;
mod white_kinds;
mod white_worlds;
