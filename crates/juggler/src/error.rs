//! Errors of rendering.

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
    /// The render was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
