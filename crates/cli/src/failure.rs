//! Errors of the program and their exit statuses.

use juggler::Error;
use juggler::film::{MergeError, PartialRenderError, ResumeError};
use juggler::imaging::ImageError;
use juggler::math::message;
use juggler::mesh::{MeshError, MeshErrorKind};
use juggler::scene::named::UnknownName;
use juggler::scene::{Problems, SceneError};
use std::fmt::Display;
use std::io::ErrorKind;
use std::path::Path;

/// An error that ends the program.
#[derive(Debug)]
pub enum Failure {
    /// Negative result of a check or comparison, already printed.
    Negative,
    /// Failures of several scenes, already printed, with the exit status of the first.
    Several(u8),
    /// Negative result of a comparison, with the reason.
    Different(String),
    /// Invalid command line, or a scene that cannot be rendered as requested.
    Invalid(String),
    /// Mistakes in the scene.
    Scene(Box<Problems>),
    /// A file that is no valid scene, model or mesh.
    Unreadable(String),
    /// Failed file operation or system call.
    System(String),
    /// Interruption by a signal.
    Interrupted {
        /// Number of the signal.
        signal: u8,
        /// Checkpoint file or folder of frames to resume from.
        saved: Option<String>,
    },
}

impl Failure {
    /// Exit status: 1 negative result, 2 invalid input, 3 system error, 128 + n signal n.
    pub fn status(&self) -> u8 {
        match self {
            Self::Negative | Self::Different(_) => 1,
            Self::Several(status) => *status,
            Self::Invalid(_) | Self::Scene(_) | Self::Unreadable(_) => 2,
            Self::System(_) => 3,
            Self::Interrupted { signal, .. } => 128_u8.saturating_add(*signal),
        }
    }

    /// Message for standard error.
    pub fn message(&self, color: bool) -> Option<String> {
        let label = if color { "\x1b[1;31merror\x1b[0m" } else { "error" };
        match self {
            Self::Negative | Self::Several(_) => None,
            Self::Different(message) => Some(message::lines(message)),
            Self::Invalid(message) | Self::Unreadable(message) | Self::System(message) => {
                Some(format!("{label}: {}", message::lines(message)))
            }
            Self::Scene(problems) => Some(problems.render(color)),
            Self::Interrupted { saved: None, .. } => Some("interrupted".into()),
            Self::Interrupted { saved: Some(file), .. } => {
                Some(format!("interrupted: progress is saved in `{file}`; the same command resumes from it"))
            }
        }
    }

    /// Adds the file to resume from to an interruption.
    pub fn with_saved_work(self, file: Option<String>) -> Self {
        match self {
            Self::Interrupted { signal, .. } => Self::Interrupted { signal, saved: file },
            other => other,
        }
    }

    /// Error of reading or writing a file; `what` is the verb.
    pub fn file(what: &str, name: impl Display, error: &std::io::Error) -> Self {
        let name = name.to_string();
        match missing_folder(&name).filter(|_| error.kind() == ErrorKind::NotFound) {
            Some(folder) => Self::System(format!("cannot {what} `{name}`: there is no folder `{folder}`")),
            None => Self::System(format!("cannot {what} `{name}`: {}", plain(error))),
        }
    }
}

impl From<MeshError> for Failure {
    fn from(error: MeshError) -> Self {
        match &error.kind {
            MeshErrorKind::Read(cause) => Self::file("read", error.path.display(), cause),
            fault => Self::Invalid(format!("cannot read `{}`: {fault}", error.path.display())),
        }
    }
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        match error {
            SceneError::Problems(problems) => Self::Scene(Box::new(problems)),
            SceneError::Read { .. } | SceneError::Write { .. } | SceneError::Image(_) | SceneError::Cancelled(_) => {
                Self::System(error.to_string())
            }
            SceneError::Unknown(unknown) => unknown.into(),
            SceneError::NotText { .. }
            | SceneError::Foreign { .. }
            | SceneError::Mesh(_)
            | SceneError::Model { .. } => Self::Unreadable(error.to_string()),
            _ => Self::Invalid(error.to_string()),
        }
    }
}

impl From<UnknownName> for Failure {
    fn from(unknown: UnknownName) -> Self {
        if unknown.is_file { Self::System(unknown.message) } else { Self::Invalid(unknown.message) }
    }
}

impl From<ImageError> for Failure {
    fn from(error: ImageError) -> Self {
        let message = error.to_string();
        match error {
            ImageError::Read { file, source } => Self::file("read", file, &source),
            ImageError::Write { file, source } => Self::file("write", file, &source),
            ImageError::UnknownFormat { .. }
            | ImageError::ReadOnly { .. }
            | ImageError::Dimensions { .. }
            | ImageError::Primaries { .. }
            | ImageError::Transparency { .. } => Self::Invalid(message),
            ImageError::SizesDiffer { .. } => Self::Different(message),
            _ => Self::System(message),
        }
    }
}

impl From<PartialRenderError> for Failure {
    fn from(error: PartialRenderError) -> Self {
        match &error {
            PartialRenderError::Read { file, source } => Self::file("read", file, source),
            PartialRenderError::Write { file, source } => Self::file("write", file, source),
            PartialRenderError::NotAPartialRender { .. } | PartialRenderError::Invalid { .. } => {
                Self::Invalid(error.to_string())
            }
            _ => Self::System(error.to_string()),
        }
    }
}

impl From<ResumeError> for Failure {
    fn from(error: ResumeError) -> Self {
        match error {
            ResumeError::PartialRender(error) => error.into(),
            ResumeError::OtherImage { .. } => Self::Invalid(format!(
                "{error}\nhelp: give another file for --checkpoint, or remove this one to start over"
            )),
            ResumeError::Incompatible { .. } => Self::Invalid(error.to_string()),
            _ => Self::System(error.to_string()),
        }
    }
}

impl From<MergeError> for Failure {
    fn from(error: MergeError) -> Self {
        let message = error.to_string();
        if error.has_file_errors() { Self::System(message) } else { Self::Invalid(message) }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Scene(error) => error.into(),
            Error::Settings { .. } => Self::Invalid(error.to_string()),
            Error::Image(error) => error.into(),
            Error::PartialRender(error) => error.into(),
            Error::Merge(error) => error.into(),
            Error::Resume(error) => error.into(),
            _ => Self::System(error.to_string()),
        }
    }
}

/// First folder of a path that does not exist.
pub fn missing_folder(file: &str) -> Option<String> {
    let folders: Vec<&Path> = Path::new(file).ancestors().skip(1).filter(|path| !path.as_os_str().is_empty()).collect();
    folders.into_iter().rev().find(|path| !path.exists()).map(|path| path.display().to_string())
}

/// Description of a system error in plain words.
pub fn plain(error: &std::io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => "file or folder not found".into(),
        ErrorKind::PermissionDenied => "permission denied".into(),
        ErrorKind::IsADirectory => "it is a folder, not a file".into(),
        ErrorKind::NotADirectory => "a component of its path is not a folder".into(),
        ErrorKind::StorageFull => "no space left on the device".into(),
        ErrorKind::QuotaExceeded => "the disk quota is exhausted".into(),
        ErrorKind::ReadOnlyFilesystem => "the file system is read-only".into(),
        ErrorKind::BrokenPipe => "its reader has closed it".into(),
        _ => error.to_string(),
    }
}
