//! Tests of the program from outside, each in a temporary folder.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod answers;
mod aovs;
mod before;
mod comparing;
mod errors;
mod harness;
mod inputs;
mod memory;
mod merging;
mod meshes;
mod model_memory;
mod models;
mod movies;
mod parts;
mod pictures;
mod probing;
mod readme;
mod scene_costs;
mod series;
mod serving;
mod signals;
mod staging;
mod statistics;
mod transparency;
