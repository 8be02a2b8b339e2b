//! Exceptions, which the Python module `juggler._errors` defines.

use crate::arrays::is_name_of_arrays;
use crate::scene::UNNAMED;
use juggler::Error;
use juggler::film::{AddError, PartialRenderError, ResumeError};
use juggler::imaging::ImageError;
use juggler::scene::report::plain_io;
use juggler::scene::{Problem, Problems, SceneError, Severity};
use pyo3::call::PyCallArgs;
use pyo3::exceptions::{PyKeyError, PyRuntimeError};
use pyo3::prelude::*;
use std::io;

/// Makes an exception of the package.
fn exception<'py>(py: Python<'py>, name: &str, arguments: impl PyCallArgs<'py>) -> PyErr {
    let made = || py.import("juggler._errors")?.getattr(name)?.call1(arguments);
    made().map_or_else(|error| error, PyErr::from_value)
}

fn with_message(name: &str, message: &str) -> PyErr {
    Python::attach(|py| exception(py, name, (message,)))
}

/// Error of a setting or an argument of this name.
pub fn settings_error(setting: &str, message: impl AsRef<str>) -> PyErr {
    invalid(message.as_ref(), Some(setting), None)
}

/// Error of settings: its text, the setting at fault and a suggested fix.
fn invalid(text: &str, setting: Option<&str>, help: Option<&str>) -> PyErr {
    Python::attach(|py| exception(py, "SettingsError", (text, setting, help)))
}

/// Error of a scene, of which the message alone is known.
pub fn scene_error(message: &str) -> PyErr {
    with_message("SceneError", message)
}

/// Error of a render that needs more memory than it may use.
pub fn memory_error(message: &str) -> PyErr {
    with_message("MemoryBudgetError", message)
}

/// Error of a render that was cancelled.
pub fn cancelled() -> PyErr {
    with_message("Cancelled", "the render was cancelled")
}

/// Error of a panic of the renderer.
pub fn internal(message: &str) -> PyErr {
    with_message("InternalError", message)
}

/// Error of a render whose process was forked meanwhile.
pub fn forked() -> PyErr {
    PyRuntimeError::new_err("the process was forked while it rendered; render again in the child process")
}

/// Error of an unknown path or name.
pub fn key_error(message: &str) -> PyErr {
    PyKeyError::new_err(message.to_owned())
}

/// Error of a file, with the number of the system's error if there is one.
pub fn file_error(message: &str, cause: Option<&io::Error>) -> PyErr {
    let number = cause.and_then(|cause| cause.raw_os_error().or_else(|| number_of(cause.kind())));
    Python::attach(|py| match number {
        Some(number) => exception(py, "FileError", (number, message)),
        None => exception(py, "FileError", (message,)),
    })
}

/// Converts an error of the renderer.
pub fn convert(error: Error) -> PyErr {
    match error {
        Error::Scene(error) => of_scene(error),
        Error::Cancelled(_) => cancelled(),
        Error::Image(error) => of_image(&error),
        Error::PartialRender(error)
        | Error::Resume(ResumeError::PartialRender(error))
        | Error::Add(AddError::PartialRender(error)) => of_partial_render(&error),
        Error::Add(error) => with_message("MergeError", &error.to_string()),
        Error::Merge(error) if error.has_file_errors() => file_error(&error.to_string(), None),
        Error::Merge(error) => with_message("MergeError", &error.to_string()),
        Error::Resume(error) => with_message("MergeError", &error.to_string()),
        Error::Settings { ref setting, ref help, .. } => invalid(&error.to_string(), Some(setting), help.as_deref()),
        error => invalid(&error.to_string(), None, None),
    }
}

/// Converts an error of a scene.
pub fn of_scene(error: SceneError) -> PyErr {
    let message = error.to_string();
    match error {
        SceneError::Problems(problems) => of_problems(&problems),
        SceneError::Read { source, .. } | SceneError::Write { source, .. } => file_error(&message, Some(&source)),
        SceneError::Image(error) => of_image(&error),
        SceneError::NotText { .. } | SceneError::Foreign { .. } => file_error(&message, None),
        SceneError::Cancelled(_) => cancelled(),
        SceneError::Unknown(unknown) if unknown.is_file => {
            file_error(&message, Some(&io::Error::from_raw_os_error(NOT_FOUND)))
        }
        _ => with_message("SceneError", &message),
    }
}

/// Number of the error "no such file".
const NOT_FOUND: i32 = 2;

/// Number of an error whose number is lost, the same on all systems.
fn number_of(kind: io::ErrorKind) -> Option<i32> {
    match kind {
        io::ErrorKind::NotFound => Some(NOT_FOUND),
        io::ErrorKind::PermissionDenied => Some(13),
        io::ErrorKind::AlreadyExists => Some(17),
        io::ErrorKind::NotADirectory => Some(20),
        io::ErrorKind::IsADirectory => Some(21),
        _ => None,
    }
}

/// Error of a scene with these mistakes.
pub fn of_problems(problems: &Problems) -> PyErr {
    Python::attach(|py| match list(py, problems) {
        Ok(list) => exception(py, "SceneError", (text(problems), list)),
        Err(error) => error,
    })
}

/// Error of reading or writing a file; `verb` says which.
pub fn of_file(verb: &str, file: &str, source: &io::Error) -> PyErr {
    file_error(&format!("cannot {verb} `{file}`: {}", plain_io(source)), Some(source))
}

/// Converts an error of an image file.
pub fn of_image(error: &ImageError) -> PyErr {
    let message = error.to_string();
    match error {
        ImageError::Read { file, source } => of_file("read", file, source),
        ImageError::Write { file, source } => of_file("write", file, source),
        ImageError::UnknownFormat { .. } | ImageError::ReadOnly { .. } => settings_error("path", message),
        ImageError::Dimensions { .. } | ImageError::SizesDiffer { .. } => settings_error("size", message),
        ImageError::Primaries { .. } => settings_error("primaries", message),
        ImageError::Transparency { .. } => settings_error("transparent", message),
        _ => file_error(&message, None),
    }
}

/// Converts an error of a partial render.
pub fn of_partial_render(error: &PartialRenderError) -> PyErr {
    let message = error.to_string();
    match error {
        PartialRenderError::Read { file, source } => of_file("read", file, source),
        PartialRenderError::Write { file, source } => of_file("write", file, source),
        _ => file_error(&message, None),
    }
}

/// Text of the problems: that of `juggler check` for scenes that were read from files, otherwise a
/// line for each path.
fn text(problems: &Problems) -> String {
    if problems.list().iter().any(is_of_file) {
        return problems.render(false);
    }
    problems.list().iter().map(|problem| line(&own(problem))).collect::<Vec<_>>().join("\n")
}

/// A problem without an excerpt of the scene's text.
pub fn line(problem: &Problem) -> String {
    let Problem { path, message, help, severity, .. } = problem;
    let path = if path.is_empty() { String::new() } else { format!("{path}: ") };
    let warning = if *severity == Severity::Warning { "warning: " } else { "" };
    let help = help.as_ref().map(|help| format!("; {help}")).unwrap_or_default();
    format!("{warning}{path}{message}{help}")
}

/// Whether a problem lies in a file: other texts end with this name.
fn is_of_file(problem: &Problem) -> bool {
    problem.file.as_ref().is_some_and(|file| !file.ends_with(UNNAMED))
}

/// The problem as it concerns the package: without a place in text that nobody wrote, and without the
/// name under which the package keeps the arrays of a mesh.
fn own(problem: &Problem) -> Problem {
    let mut own = match is_of_file(problem) {
        true => problem.clone(),
        false => Problem { file: None, line: None, column: None, ..problem.clone() },
    };
    let parts =
        problem.message.strip_prefix('`').and_then(|message| message.split_once("` contains an invalid mesh: "));
    if let Some((path, (_, wrong))) =
        problem.path.strip_suffix(".file").zip(parts.filter(|(name, _)| is_name_of_arrays(name)))
    {
        (own.path, own.message) = (path.to_owned(), format!("the mesh is invalid: {wrong}"));
    }
    own
}

/// The problems as a list of `juggler.Problem`.
fn list<'py>(py: Python<'py>, problems: &Problems) -> PyResult<Bound<'py, PyAny>> {
    let problems: Vec<Problem> = problems.list().iter().map(own).collect();
    let json = serde_json::to_string(&problems).unwrap_or_default();
    py.import("juggler._errors")?.getattr("problems_from_json")?.call1((json,))
}
