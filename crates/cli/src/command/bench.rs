//! `juggler bench`: benchmarks.

use crate::failure::Failure;
use clap::{Args, Subcommand};

mod rays;
mod scenes;
mod schedulers;

/// Flags of `juggler bench`.
#[derive(Debug, Args)]
pub struct Bench {
    #[command(subcommand)]
    benchmark: Benchmark,
}

/// Benchmarks.
#[derive(Debug, Subcommand)]
enum Benchmark {
    /// Ray casting: rays per second on meshes, for six kinds of rays and all kernels
    Rays(rays::Rays),
    /// Rendering: instructions or CPU time of seven scenes, also beside another program
    Scenes(scenes::Scenes),
    /// Load balancing: blocks of rows, a queue of rows, and work stealing by tiles
    Schedulers(schedulers::Schedulers),
}

impl Bench {
    /// Runs the benchmark and prints a table.
    pub fn run(self) -> Result<(), Failure> {
        match self.benchmark {
            Benchmark::Rays(rays) => rays.run(),
            Benchmark::Scenes(scenes) => scenes.run(),
            Benchmark::Schedulers(schedulers) => schedulers.run(),
        }
    }
}
