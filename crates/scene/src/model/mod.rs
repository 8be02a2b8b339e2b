//! Models: scenes of other formats, whole or as objects of a scene.

mod choice;
mod files;
mod format;
mod parts;
mod summary;

pub use choice::{AnimationChoice, ModelChoice, ModelRepeat, NameOrIndex};
pub use files::{FileError, Files};
pub use format::{ModelError, ModelFile, ModelFormat};
pub use parts::ModelParts;
pub use summary::{ExtensionSupport, ModelClip, ModelExtension, ModelSummary};
