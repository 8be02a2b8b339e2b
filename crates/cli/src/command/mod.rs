//! The commands: one file each, with its flags and what it does.

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

/// Every command.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a picture, or the pictures of an animation
    #[command(after_help = render::MORE, after_long_help = render::EXAMPLES)]
    Render(Box<crate::args::RenderArgs>),
    /// Walk around in a scene, in a window
    #[cfg(feature = "view")]
    View(view::View),
    /// Say all that is wrong with a scene, without rendering it
    Check(check::Check),
    /// Say what is in a scene, or what a picture or a part of one says about itself
    Info(info::Info),
    /// Join parts of a picture: to the picture, with the bytes of a single render, or to a larger part
    Merge(merge::Merge),
    /// Mix the lights of a rendered film anew: brighter, darker, of another colour, without tracing a ray
    Relight(relight::Relight),
    /// Write the JSON Schema of the scene format
    Schema,
    /// Write any readable scene as scene JSON
    Convert(convert::Convert),
    /// Say why a pixel is as it is, or which pixels are fireflies and why
    #[command(after_long_help = probe::EXAMPLES)]
    Probe(Box<probe::Probe>),
    /// Say how different two pictures are
    Compare(compare::Compare),
    /// List the built-in scenes
    Scenes,
    /// Look at a scene in a browser, fly through it, change it
    #[cfg(feature = "serve")]
    Serve(serve::Serve),
    /// Measure this machine
    Bench(bench::Bench),
    /// Print what a shell needs to complete commands and flags
    #[command(after_help = completions::EXAMPLES)]
    Completions(completions::Completions),
    /// Print a manual page, or write those of all commands
    Man(man::Manual),
}

impl Command {
    /// Does it.
    pub fn run(self) -> Result<(), Failure> {
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
            Self::Completions(completions) => completions.run(),
            Self::Man(manual) => manual.run(),
        }
    }
}
