//! `juggler convert`: writes any readable scene as scene JSON, with its animation or at one frame;
//! a mesh becomes a scene around it.

use crate::failure::Failure;
use crate::model_args::ModelArgs;
use crate::output;
use crate::source;
use clap::Args;
use std::path::Path;

/// Flags of `juggler convert`.
#[derive(Debug, Args)]
pub struct Convert {
    /// Scene file, model (glTF), mesh (PLY, OBJ, STL), built-in scene, or `-` for standard input
    scene: String,
    /// Output file, or `-` for standard output
    output: String,
    /// Evaluate the scene at this frame, without expressions and animations
    #[arg(long, value_name = "N")]
    frame: Option<u32>,
    #[command(flatten)]
    model: ModelArgs,
}

impl Convert {
    /// Writes the scene.
    pub fn run(self) -> Result<(), Failure> {
        let scene = source::load_model(&self.scene, &self.model, None)?;
        let scene = match self.frame {
            Some(frame) => scene.at_frame(f64::from(frame))?.still(),
            None => scene,
        };
        let folder = Path::new(&self.output).parent().filter(|_| self.output != output::STANDARD_OUTPUT);
        output::write_text(&self.output, &folder.map_or_else(|| scene.to_json(), |folder| scene.to_json_in(folder)))
    }
}
