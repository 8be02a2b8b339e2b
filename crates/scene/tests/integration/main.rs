//! Tests of scene files: format, imports, and error reports.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a test fails by panicking and prints its figures"
)]

mod advice;
mod animation;
mod around;
mod assets;
mod built_in;
mod colors;
mod defaults;
mod flat_objects;
mod focus;
mod format;
mod images;
mod inline_textures;
mod instance_files;
mod juggler;
mod lighting;
mod limits;
mod model_cameras;
mod model_files;
mod models;
mod mutations;
mod placing;
mod posed;
mod units;
mod values;
mod wrong_animations;
mod wrong_scenes;
