//! Models: scenes of other formats, whole or as objects of a scene.

mod cache;
mod camera_names;
mod choice;
mod expand;
mod files;
mod format;
mod instance;
mod model_light;
mod model_scene;
mod parts;
mod scene;
mod summary;

pub(crate) use cache::{ModelCache, OpenedModel};
pub use camera_names::find_camera;
pub use choice::{AnimationChoice, ModelChoice, ModelRepeat, NameOrIndex};
pub(crate) use expand::{Expansion, ModelIdentity, SceneTime, expand, expand_heads, has_instance_files, has_models};
pub use files::{FileError, Files};
pub use format::{FileDigest, ModelError, ModelFile, ModelFormat, ModelNeeds};
pub use model_light::illuminance;
pub(crate) use model_scene::{describe_model_scene, frames_of};
pub use parts::ModelParts;
pub(crate) use scene::ExpansionMemo;
pub use scene::SceneModel;
pub use summary::{ExtensionSupport, ModelClip, ModelExtension, ModelSummary};
