//! Errors of reading, building and compiling a scene.

use crate::named::UnknownName;
use crate::report::{Problems, plain_io};
use juggler_math::Cancelled;
use juggler_mesh::UnsupportedFormat;
use std::io;
use std::path::PathBuf;

/// Error of reading, building, compiling or saving a scene.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The file cannot be read.
    #[error("cannot read `{}`: {}", path.display(), plain_io(source))]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The file is not a text file.
    #[error("`{}`: {message}", path.display())]
    NotText {
        /// The file.
        path: PathBuf,
        /// Reason in words.
        message: String,
    },
    /// The file is of a known format that is not supported yet.
    #[error("`{}`: {format}", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// Format of the file.
        format: UnsupportedFormat,
    },
    /// The mesh file cannot be loaded, so no scene can be made around it.
    #[error("{0}")]
    Mesh(String),
    /// The model file cannot be opened, so no scene can be made around it.
    #[error("{}", faults.join("\n"))]
    Model {
        /// Messages, each with its place in the file.
        faults: Vec<String>,
    },
    /// The file cannot be written.
    #[error("cannot write `{}`: {}", path.display(), plain_io(source))]
    Write {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// An image cannot be written.
    #[error(transparent)]
    Image(#[from] juggler_imaging::ImageError),
    /// The name of an asset cannot be the name of a file in the scene's folder.
    #[error("the asset `{0}` cannot be saved: its name must be a relative path inside the folder of the scene file")]
    AssetName(String),
    /// No built-in scene has this name.
    #[error("no built-in scene is called `{name}`{}", help.as_ref().map(|h| format!("; {h}")).unwrap_or_default())]
    UnknownBuiltIn {
        /// The unknown name.
        name: String,
        /// Suggested name.
        help: Option<String>,
    },
    /// Neither a file nor a built-in scene has this name.
    #[error(transparent)]
    Unknown(#[from] UnknownName),
    /// The scene has errors.
    #[error("{0}")]
    Problems(Problems),
    /// Reading or compiling was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
