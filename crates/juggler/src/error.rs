//! Why there is no picture.

use juggler_imaging::ImageError;
use juggler_render::Stopped;
use juggler_scene::SceneError;

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The scene has mistakes, or cannot be read.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The settings ask for what cannot be.
    #[error("{0}")]
    Settings(String),
    /// The picture cannot be written.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// Somebody cancelled.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}
