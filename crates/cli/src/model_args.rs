//! Flags that select what a model file shows.

use crate::failure::Failure;
use clap::Args;
use juggler::scene::model::NameOrIndex;
use juggler::scene::{Loader, Scene};

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

    /// Render a model although image files of its textures are missing or broken: gray, with a warning
    #[arg(long, hide_short_help = true)]
    pub lenient: bool,
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

    /// Selects what the model shows.
    ///
    /// # Errors
    ///
    /// A flag is given and the scene is not one model file, or has no models.
    pub fn apply(&self, name: &str, scene: &mut Scene) -> Result<(), Failure> {
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
