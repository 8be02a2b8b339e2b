//! `juggler bench`: what this machine does.

use crate::failure::Failure;
use clap::{Args, Subcommand};

mod rays;
mod schedulers;

/// Flags of `juggler bench`.
#[derive(Debug, Args)]
pub struct Bench {
    #[command(subcommand)]
    what: What,
}

/// Everything that is measured.
#[derive(Debug, Subcommand)]
enum What {
    /// How fast rays find their triangles: built-in meshes or files, six kinds of rays, all kernels
    Rays(rays::Rays),
    /// Compare ways to hand out pixels to threads: blocks of rows, a queue of rows, tiles that idle threads steal
    Schedulers(schedulers::Schedulers),
}

impl Bench {
    /// Measures and prints a table.
    pub fn run(self) -> Result<(), Failure> {
        match self.what {
            What::Rays(rays) => rays.run(),
            What::Schedulers(schedulers) => schedulers.run(),
        }
    }
}
