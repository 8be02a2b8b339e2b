//! Why the program stops short, and the exit status that says so.

use juggler::Error;
use juggler::film::{MergeError, PartError, ResumeError};
use juggler::imaging::ImageError;
use juggler::math::message;
use juggler::scene::import::{Fault, ImportError};
use juggler::scene::named::Unknown;
use juggler::scene::{Problems, SceneError};
use std::fmt::Display;
use std::io::ErrorKind;
use std::path::Path;
use std::process::ExitCode;

/// Why the program stops short.
#[derive(Debug)]
pub enum Failure {
    /// A check or comparison says no; the answer has been given already.
    No,
    /// A comparison says no, for this reason.
    Different(String),
    /// The command line or the scene asks for what cannot be.
    Wrong(String),
    /// The scene has mistakes.
    Scene(Box<Problems>),
    /// A file or the system failed.
    System(String),
    /// A signal came.
    Interrupted {
        /// Its number.
        signal: u8,
        /// Where the work so far is kept.
        kept: Option<String>,
    },
}

impl Failure {
    /// What scripts see.
    pub fn status(&self) -> u8 {
        match self {
            Self::No | Self::Different(_) => 1,
            Self::Wrong(_) | Self::Scene(_) => 2,
            Self::System(_) => 3,
            Self::Interrupted { signal, .. } => 128_u8.saturating_add(*signal),
        }
    }

    /// What people see.
    pub fn message(&self, color: bool) -> Option<String> {
        let label = if color { "\x1b[1;31merror\x1b[0m" } else { "error" };
        match self {
            Self::No => None,
            Self::Different(message) => Some(message::lines(message)),
            Self::Wrong(message) | Self::System(message) => Some(format!("{label}: {}", message::lines(message))),
            Self::Scene(problems) => Some(problems.render(color)),
            Self::Interrupted { kept: None, .. } => Some("interrupted".into()),
            Self::Interrupted { kept: Some(file), .. } => {
                Some(format!("interrupted: the work so far is in `{file}`, the same command goes on with it"))
            }
        }
    }

    /// An interrupted render whose work is kept in a file.
    pub fn keeping(self, file: Option<String>) -> Self {
        match self {
            Self::Interrupted { signal, .. } => Self::Interrupted { signal, kept: file },
            other => other,
        }
    }

    /// A file that could not be read or written.
    pub fn file(what: &str, name: impl Display, error: &std::io::Error) -> Self {
        let name = name.to_string();
        match missing_folder(&name).filter(|_| error.kind() == ErrorKind::NotFound) {
            Some(folder) => Self::System(format!("cannot {what} `{name}`: there is no folder `{folder}`")),
            None => Self::System(format!("cannot {what} `{name}`: {}", plain(error))),
        }
    }
}

impl From<Failure> for ExitCode {
    fn from(failure: Failure) -> Self {
        Self::from(failure.status())
    }
}

impl From<ImportError> for Failure {
    fn from(error: ImportError) -> Self {
        match &error.fault {
            Fault::Read(cause) => Self::file("read", error.path.display(), cause),
            fault => Self::Wrong(format!("cannot read `{}`: {fault}", error.path.display())),
        }
    }
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        match error {
            SceneError::Problems(problems) => Self::Scene(Box::new(problems)),
            SceneError::Read { .. } => Self::System(error.to_string()),
            SceneError::Unknown(unknown) => unknown.into(),
            SceneError::NotText { .. }
            | SceneError::Foreign { .. }
            | SceneError::Mesh(_)
            | SceneError::UnknownBuiltIn { .. } => Self::Wrong(error.to_string()),
        }
    }
}

impl From<Unknown> for Failure {
    fn from(unknown: Unknown) -> Self {
        if unknown.is_file { Self::System(unknown.message) } else { Self::Wrong(unknown.message) }
    }
}

impl From<ImageError> for Failure {
    fn from(error: ImageError) -> Self {
        let message = error.to_string();
        match error {
            ImageError::Read { place, source } => Self::file("read", place, &source),
            ImageError::Write { place, source } => Self::file("write", place, &source),
            ImageError::UnknownFormat { .. } | ImageError::Dimensions { .. } | ImageError::Primaries { .. } => {
                Self::Wrong(message)
            }
            ImageError::SizesDiffer { .. } => Self::Different(message),
            _ => Self::System(message),
        }
    }
}

impl From<PartError> for Failure {
    fn from(error: PartError) -> Self {
        match &error {
            PartError::Read { file, source } => Self::file("read", file, source),
            PartError::Write { file, source } => Self::file("write", file, source),
            PartError::NotAPart { .. } | PartError::Unfit { .. } => Self::Wrong(error.to_string()),
            _ => Self::System(error.to_string()),
        }
    }
}

impl From<ResumeError> for Failure {
    fn from(error: ResumeError) -> Self {
        match error {
            ResumeError::Part(error) => error.into(),
            ResumeError::Foreign { .. } => Self::Wrong(format!(
                "{error}\nhelp: give another file for --checkpoint, or remove this one to begin anew"
            )),
            ResumeError::Beyond { .. } => Self::Wrong(error.to_string()),
            ResumeError::Tile { .. } => Self::System(error.to_string()),
        }
    }
}

impl From<MergeError> for Failure {
    fn from(error: MergeError) -> Self {
        let message = error.to_string();
        if error.is_of_files() { Self::System(message) } else { Self::Wrong(message) }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Scene(error) => error.into(),
            Error::Settings(message) => Self::Wrong(message),
            Error::Image(error) => error.into(),
            Error::Stopped(stopped) => Self::System(stopped.to_string()),
        }
    }
}

/// The first folder on the way to a file that is not there.
pub fn missing_folder(file: &str) -> Option<String> {
    let folders: Vec<&Path> = Path::new(file).ancestors().skip(1).filter(|path| !path.as_os_str().is_empty()).collect();
    folders.into_iter().rev().find(|path| !path.exists()).map(|path| path.display().to_string())
}

/// The system's error in plain words.
pub fn plain(error: &std::io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => "no such file or folder".into(),
        ErrorKind::PermissionDenied => "permission denied".into(),
        ErrorKind::IsADirectory => "it is a folder".into(),
        ErrorKind::NotADirectory => "a part of its path is no folder".into(),
        ErrorKind::StorageFull => "no space is left".into(),
        ErrorKind::QuotaExceeded => "the quota is used up".into(),
        ErrorKind::ReadOnlyFilesystem => "the disk cannot be written to".into(),
        ErrorKind::BrokenPipe => "nobody reads it any more".into(),
        _ => error.to_string(),
    }
}
