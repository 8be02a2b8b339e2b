//! `juggler check`: all mistakes of a scene at once, nothing rendered.

use crate::console;
use crate::failure::Failure;
use crate::source;
use clap::Args;
use juggler::scene::Problems;

/// Flags of `juggler check`.
#[derive(Debug, Args)]
pub struct Check {
    /// A scene file, a mesh (PLY, OBJ, STL), the name of a built-in scene, or `-` for standard input
    scene: String,
}

impl Check {
    /// Prints what is wrong; warnings alone are no reason to say no.
    pub fn run(self) -> Result<(), Failure> {
        match source::load(&self.scene, None) {
            Ok(scene) => self.answer(&scene.check()),
            Err(Failure::Scene(problems)) => self.answer(&problems),
            Err(failure) => Err(failure),
        }
    }

    fn answer(&self, problems: &Problems) -> Result<(), Failure> {
        if !problems.list().is_empty() {
            console::say(&problems.render(console::color()));
        }
        if problems.errors() > 0 {
            return Err(Failure::No);
        }
        console::print(&format!("{}: no mistakes", self.scene))
    }
}
