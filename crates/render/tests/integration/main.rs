//! Tests of the whole path tracer: against closed forms, against two simple path tracers without
//! multiple importance sampling, and against itself on other numbers of threads; and the JSON
//! snippets of the documentation.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, reason = "a test")]

mod caustics;
mod closed_forms;
mod dispersion;
mod emissive_shapes;
mod furnaces;
mod glass;
mod lights;
mod limits;
mod media;
mod one_sided;
mod probe;
mod rooms;
mod skies;
mod snippets;
mod splitting;
mod strategies;
mod terminator;
mod threads;
mod touching;
mod touching_sheets;
mod views;
mod white_kinds;
mod white_worlds;
