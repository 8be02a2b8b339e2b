//! `juggler check`: reports all mistakes of a scene at once, without rendering.

use crate::console;
use crate::failure::Failure;
use crate::model_args::ModelArgs;
use crate::source;
use clap::Args;
use juggler::scene::{Illuminance, Problems};

/// Flags of `juggler check`.
#[derive(Debug, Args)]
pub struct Check {
    /// Scene file, model (glTF), mesh (PLY, OBJ, STL), built-in scene, or `-` for standard input
    scene: String,
    #[command(flatten)]
    model: ModelArgs,
}

impl Check {
    /// Prints mistakes and warnings; warnings alone are no failure. A file that is no scene at all is a
    /// mistake as well.
    pub fn run(self) -> Result<(), Failure> {
        match source::load_outline(&self.scene, &self.model) {
            Ok(scene) => {
                let (problems, light) = scene.check_with_light();
                self.answer(&problems, light.as_ref())
            }
            Err(Failure::Scene(problems)) => self.answer(&problems, None),
            Err(failure @ Failure::Unreadable(_)) => {
                failure.message(console::color()).iter().for_each(|message| console::print_message(message));
                Err(Failure::Negative)
            }
            Err(failure) => Err(failure),
        }
    }

    fn answer(&self, problems: &Problems, light: Option<&Illuminance>) -> Result<(), Failure> {
        if !problems.list().is_empty() {
            console::print_message(&problems.render(console::color()));
        }
        if problems.errors() > 0 {
            return Err(Failure::Negative);
        }
        let light = light.map(|light| format!("; {light}")).unwrap_or_default();
        console::print_result(&format!("{}: no mistakes{light}", self.scene))
    }
}
