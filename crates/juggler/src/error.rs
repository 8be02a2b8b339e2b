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
    Scene(#[from] SceneError),
    /// The settings are invalid.
    #[error("{0}")]
    Settings(String),
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
    /// The render was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
