//! The facade as a Rust program uses it: AOVs, denoising, motion vectors, the probe.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a test fails by panicking and prints its figures"
)]

mod aovs;
mod area_lights;
mod assets;
mod building;
mod cancelling;
mod changes;
mod cryptomatte;
mod docs;
mod edits;
mod gallery;
mod instances;
mod models;
mod motion;
mod noise;
mod prelude;
mod probe;
mod rendered_image;
mod splitting;
mod stage;
mod transparency;
mod viewpoint;
