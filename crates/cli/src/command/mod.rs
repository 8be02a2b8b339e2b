//! The commands: one file each, with its flags and its implementation.

use crate::failure::Failure;
use clap::Subcommand;

mod bench;
mod check;
mod compare;
mod completions;
mod convert;
mod info;
mod man;
mod merge;
mod probe;
mod relight;
mod render;
mod scenes;
mod schema;
#[cfg(feature = "serve")]
mod serve;
#[cfg(feature = "view")]
mod view;

/// All commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a picture or the frames of an animation
    #[command(after_help = render::MORE, after_long_help = render::EXAMPLES)]
    Render(Box<crate::args::RenderArgs>),
    /// Open a scene in an interactive window
    #[cfg(feature = "view")]
    View(view::View),
    /// Report all mistakes in a scene without rendering it
    Check(check::Check),
    /// Show the contents of a scene, mesh, picture or partial render
    Info(info::Info),
    /// Join partial renders into a picture or a larger partial render
    ///
    /// The picture is identical to that of a single render, byte by byte.
    Merge(merge::Merge),
    /// Change the brightness and color of lights after rendering
    ///
    /// Combines the light groups of a finished render with new factors, without tracing rays.
    Relight(relight::Relight),
    /// Print the JSON Schema of the scene format
    Schema,
    /// Convert a scene or a mesh to scene JSON
    Convert(convert::Convert),
    /// Explain a pixel by its paths and lights, or find fireflies
    #[command(after_long_help = probe::EXAMPLES)]
    Probe(Box<probe::Probe>),
    /// Measure the difference between two pictures
    Compare(compare::Compare),
    /// List the built-in scenes
    Scenes,
    /// Serve the interactive viewer to a web browser
    #[cfg(feature = "serve")]
    Serve(serve::Serve),
    /// Run benchmarks on this machine
    Bench(bench::Bench),
    /// Print a completion script for a shell
    #[command(after_help = completions::EXAMPLES)]
    Completions(completions::Completions),
    /// Print a manual page, or write the pages of all commands
    Man(man::Manual),
}

impl Command {
    /// Runs the command; `program` makes the definition of all commands and flags.
    pub fn run(self, program: fn() -> clap::Command) -> Result<(), Failure> {
        match self {
            Self::Render(args) => render::run(*args),
            #[cfg(feature = "view")]
            Self::View(view) => view.run(),
            Self::Check(check) => check.run(),
            Self::Info(info) => info.run(),
            Self::Merge(merge) => merge.run(),
            Self::Relight(relight) => relight.run(),
            Self::Schema => schema::run(),
            Self::Convert(convert) => convert.run(),
            Self::Probe(probe) => probe.run(),
            Self::Compare(compare) => compare.run(),
            Self::Scenes => scenes::run(),
            #[cfg(feature = "serve")]
            Self::Serve(serve) => serve.run(),
            Self::Bench(bench) => bench.run(),
            Self::Completions(completions) => completions.run(program()),
            Self::Man(manual) => manual.run(program()),
        }
    }
}
