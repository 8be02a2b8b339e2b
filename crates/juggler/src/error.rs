//! Errors of rendering.

use juggler_film::{AddError, MergeError, PartialRenderError, ResumeError};
use juggler_imaging::ImageError;
use juggler_render::Cancelled;
use juggler_scene::SceneError;

/// Error that prevented an image.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene has errors, or cannot be read.
    #[error(transparent)]
    Scene(SceneError),
    /// The settings are invalid.
    #[error("{message}{}", help.as_ref().map(|help| format!("; {help}")).unwrap_or_default())]
    Settings {
        /// Name of the setting as users write it, such as `crop` or `max_depth`.
        setting: String,
        /// The mistake, and the values that are allowed.
        message: String,
        /// Suggested fix.
        help: Option<String>,
    },
    /// The image cannot be encoded or written.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// A partial render cannot be read or written.
    #[error(transparent)]
    PartialRender(#[from] PartialRenderError),
    /// A render cannot go on from a partial render.
    #[error(transparent)]
    Resume(#[from] ResumeError),
    /// A partial render cannot be added to a film.
    #[error(transparent)]
    Add(#[from] AddError),
    /// Partial renders cannot be merged.
    #[error(transparent)]
    Merge(#[from] MergeError),
    /// The render, or the build before it, was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<SceneError> for Error {
    fn from(error: SceneError) -> Self {
        match error {
            SceneError::Cancelled(cancelled) => Self::Cancelled(cancelled),
            error => Self::Scene(error),
        }
    }
}

impl Error {
    /// Creates the error of an invalid setting.
    pub fn setting(setting: &str, message: impl Into<String>) -> Self {
        Self::Settings { setting: setting.to_owned(), message: message.into(), help: None }
    }

    /// The same error for the setting that has this name; other errors stay as they are.
    #[must_use]
    pub fn for_setting(self, setting: &str) -> Self {
        match self {
            Self::Settings { message, help, .. } => Self::Settings { setting: setting.to_owned(), message, help },
            other => other,
        }
    }
}
