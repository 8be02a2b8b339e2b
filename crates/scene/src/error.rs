//! Why a scene cannot be read, built or compiled.

use crate::import::Foreign;
use crate::named::Unknown;
use crate::report::{Problems, plain_io};
use std::io;
use std::path::PathBuf;

/// Why there is no scene.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The file cannot be read.
    #[error("cannot read `{}`: {}", path.display(), plain_io(source))]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The file is not a scene file at all.
    #[error("`{}`: {message}", path.display())]
    NotText {
        /// The file.
        path: PathBuf,
        /// Why not.
        message: String,
    },
    /// The file is of a format that is known, but not read yet.
    #[error("`{}`: {format}", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// Its format.
        format: Foreign,
    },
    /// The file is a mesh, but no scene can be made around it.
    #[error("{0}")]
    Mesh(String),
    /// No built-in scene has this name.
    #[error("no built-in scene is called `{name}`{}", help.as_ref().map(|h| format!("; {h}")).unwrap_or_default())]
    UnknownBuiltIn {
        /// The name.
        name: String,
        /// What was probably meant.
        help: Option<String>,
    },
    /// No file has this name, nor has a built-in scene.
    #[error(transparent)]
    Unknown(#[from] Unknown),
    /// The scene has mistakes.
    #[error("{0}")]
    Problems(Problems),
}
