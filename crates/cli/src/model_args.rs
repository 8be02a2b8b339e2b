//! Flags that select what a model file shows, and how.

use crate::failure::Failure;
use crate::stage_args::{self, StageArgs};
use clap::Args;
use juggler::Stage;
use juggler::scene::model::NameOrIndex;
use juggler::scene::{Loader, Scene};

/// Flags that make a camera.
const CAMERA_FLAGS: [&str; 5] = ["--view", "--eye", "--look-at", "--fov", "--fit"];

/// Flags for model files (glTF).
#[derive(Clone, Debug, Default, Args)]
pub struct ModelArgs {
    /// Variant of a model's materials, by name or index
    #[arg(long, value_name = "NAME", hide_short_help = true)]
    pub variant: Option<String>,

    /// Animation clip of a model, by name or index; `none` for the rest pose
    #[arg(long, value_name = "NAME", hide_short_help = true)]
    pub animation: Option<String>,

    /// Scene of a model file, by name or index
    #[arg(long, value_name = "NAME", hide_short_help = true)]
    pub model_scene: Option<String>,

    /// Render a model although image files of its textures are missing or broken: gray, with a
    /// warning
    #[arg(long, hide_short_help = true)]
    pub lenient: bool,

    #[command(flatten)]
    pub stage: StageArgs,

    /// Size of the picture in pixels, for cameras that frame all objects; `None` is the size of the
    /// scene.
    #[arg(skip)]
    pub size: Option<[u32; 2]>,

    /// Whether a turntable keeps the cameras of the file.
    #[arg(skip)]
    pub keeps_camera: bool,
}

impl ModelArgs {
    /// Values of the scene by JSON pointer that select what the model shows, if any is given.
    #[cfg(any(feature = "view", feature = "serve"))]
    pub fn values(&self) -> Vec<(String, serde_json::Value)> {
        let flags = [("variant", &self.variant), ("animation", &self.animation), ("scene", &self.model_scene)];
        let value = |(key, value): (&str, &Option<String>)| {
            let value = serde_json::to_value(NameOrIndex::from(value.as_deref()?)).ok()?;
            Some((format!("/objects/0/model/{key}"), value))
        };
        flags.into_iter().filter_map(value).collect()
    }

    /// Loader of scenes.
    pub fn loader(&self) -> Loader {
        if self.lenient { juggler::loader().lenient() } else { juggler::loader() }
    }

    /// The same flags for pictures of a size that a camera of the scene shows, if one is chosen.
    ///
    /// # Errors
    ///
    /// Flags make a camera beside the chosen one.
    pub fn for_view(self, size: Option<[u32; 2]>, camera: Option<&str>) -> Result<Self, Failure> {
        let given = self.stage.words().into_iter();
        let mut of_camera = given.map(|(name, _)| name).filter(|name| CAMERA_FLAGS.contains(name));
        if let (Some(flag), Some(camera)) = (of_camera.next(), camera) {
            let message = format!("{flag} makes a camera, and --camera {camera} chooses another one: give one of them");
            return Err(Failure::Invalid(message));
        }
        Ok(Self { size, keeps_camera: camera.is_some(), ..self })
    }

    /// Selects what the model shows, and how.
    ///
    /// # Errors
    ///
    /// A flag is given and the scene is not one model file, or has no models.
    pub fn apply(&self, name: &str, scene: &mut Scene) -> Result<(), Failure> {
        self.choose(name, scene)?;
        if self.stage.is_given() {
            *scene = self.stage().apply(scene).map_err(stage_args::failure)?;
        }
        Ok(())
    }

    /// Light, backdrop, floor, turntable and camera.
    pub fn stage(&self) -> Stage {
        self.stage.stage(self.size, self.keeps_camera)
    }

    /// Selects what the model shows.
    pub fn choose(&self, name: &str, scene: &mut Scene) -> Result<(), Failure> {
        if self.lenient && !scene.has_models() {
            return Err(Failure::Invalid(format!("--lenient is for models; `{name}` has none")));
        }
        let flags =
            [("--variant", &self.variant), ("--animation", &self.animation), ("--model-scene", &self.model_scene)];
        let Some((flag, _)) = flags.into_iter().find(|(_, value)| value.is_some()) else { return Ok(()) };
        let chosen = |text: &Option<String>| text.as_deref().map(NameOrIndex::from);
        if !scene.choose_model(chosen(&self.variant), chosen(&self.animation), chosen(&self.model_scene)) {
            return Err(Failure::Invalid(format!(
                "{flag} is for model files (.gltf, .glb); `{name}` is another scene"
            )));
        }
        Ok(())
    }
}
