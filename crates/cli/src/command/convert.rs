//! `juggler convert`: writes any readable scene as scene JSON, with its animation or at one frame;
//! a mesh becomes a scene around it, and a model a scene that refers to it or consists of its
//! parts.

use crate::console;
use crate::failure::Failure;
use crate::model_args::ModelArgs;
use crate::output;
use crate::source;
use clap::Args;
use juggler::scene::{Scene, camera_json};
use std::path::Path;

/// Flags of `juggler convert`.
#[derive(Debug, Args)]
pub struct Convert {
    /// Scene file, model (glTF), mesh (PLY, OBJ, STL), built-in scene, or `-` for standard input
    scene: String,
    /// Output file, or `-` for standard output
    #[arg(required_unless_present = "unpack")]
    output: Option<String>,
    /// Write the scene to this folder with its models as objects and materials, their meshes as PLY
    /// files and their pictures as files. Animations end: the scene is that of one frame
    #[arg(long, value_name = "DIR", conflicts_with = "output")]
    unpack: Option<String>,
    /// Evaluate the scene at this frame, without expressions and animations
    #[arg(long, value_name = "N")]
    frame: Option<u32>,
    /// Replace a scene file that exists and contains another scene
    #[arg(long)]
    force: bool,
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
        let scene = with_shown_camera(scene)?;
        if let Some(folder) = &self.unpack {
            return self.unpack(&scene, folder);
        }
        let output = self.output.as_deref().unwrap_or(output::STANDARD_OUTPUT);
        let folder = Path::new(output).parent().filter(|_| output != output::STANDARD_OUTPUT);
        let text = folder.map_or_else(|| scene.to_json(), |folder| scene.to_json_in(folder));
        if output != output::STANDARD_OUTPUT {
            self.check_replaced(Path::new(output), &text)?;
        }
        output::write_text(output, &text)
    }

    /// Fails if a file contains another scene than `text`, which may have been edited, unless
    /// `--force` is given.
    fn check_replaced(&self, path: &Path, text: &str) -> Result<(), Failure> {
        if self.force || !output::differs(path, text) {
            return Ok(());
        }
        Err(Failure::Invalid(format!(
            "`{}` exists and contains another scene: --force replaces it, another name keeps it",
            path.display()
        )))
    }

    /// Writes the scene and all that its models contain to a folder.
    fn unpack(&self, scene: &Scene, folder: &str) -> Result<(), Failure> {
        let unpacked = scene.unpacked()?;
        if self.frame.is_none() && scene.depends_on_time() {
            console::print_message("note: the scene moves; this is frame 0, `--frame N` selects another");
        }
        std::fs::create_dir_all(folder).map_err(|error| Failure::file("create", folder, &error))?;
        let stem = Path::new(&self.scene).file_stem().and_then(|stem| stem.to_str()).filter(|stem| *stem != "-");
        let path = Path::new(folder).join(format!("{}.json", stem.unwrap_or("scene")));
        self.check_replaced(&path, &unpacked.to_json_in(Path::new(folder)))?;
        unpacked.save(&path)?;
        console::print_result(&path.display().to_string())
    }
}

/// The scene with the camera that frames its model or mesh, if the scene was made for one that has
/// no camera.
fn with_shown_camera(scene: Scene) -> Result<Scene, Failure> {
    if !scene.is_around_file() || scene.description.camera.is_some() {
        return Ok(scene);
    }
    match juggler::stage::default_camera(&scene) {
        Ok(Some(camera)) => Ok(scene.with_value("/camera", camera_json(&camera))?),
        Ok(None) => Ok(scene),
        Err(error) => {
            console::print_message(
                "note: no camera is written, since the scene has mistakes; `juggler check` names them",
            );
            console::print_message(&error.to_string());
            Ok(scene)
        }
    }
}
