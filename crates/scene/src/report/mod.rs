//! Problems of a scene: description, location and suggested fix.

use crate::document::{Node, SourceSpan, Sources, parse};
use crate::path::Path;
use juggler_math::message;
use position::Cursor;
use serde::Serialize;
use std::collections::BTreeSet;
use std::{fmt, io};

mod position;
mod text;

/// Severity of a problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Severity {
    /// The scene cannot be rendered.
    Error,
    /// The scene can be rendered, but the result may not be the intended one.
    Warning,
}

/// A problem as the check that detects it reports it: located by path, by place, or by both.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    severity: Severity,
    path: Option<Path>,
    place: Option<SourceSpan>,
    message: String,
    help: Option<String>,
}

impl Finding {
    /// Creates an error, which prevents rendering.
    pub fn error(message: impl Into<String>) -> Self {
        let message = message::line(&message.into());
        Self { severity: Severity::Error, path: None, place: None, message, help: None }
    }

    /// Creates a warning.
    pub fn warning(message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(message) }
    }

    /// Sets the path in the merged scene.
    #[must_use]
    pub fn at(mut self, path: impl Into<Path>) -> Self {
        self.path = Some(path.into());
        self
    }

    /// Sets the place in a file.
    #[must_use]
    pub fn on(mut self, place: Option<SourceSpan>) -> Self {
        self.place = place;
        self
    }

    /// Sets the suggested fix.
    #[must_use]
    pub fn help(self, help: impl Into<String>) -> Self {
        self.maybe_help(Some(help.into()))
    }

    /// Sets the suggested fix, if there is one.
    #[must_use]
    pub fn maybe_help(mut self, help: Option<String>) -> Self {
        self.help = help.map(|help| message::line(&help)).or(self.help);
        self
    }

    /// Whether the paths of both are equal or one path contains the other.
    pub fn concerns_same_value(&self, other: &Self) -> bool {
        let (Some(a), Some(b)) = (&self.path, &other.path) else { return false };
        let shared = a.steps().len().min(b.steps().len());
        shared > 0 && a.steps().iter().zip(b.steps()).all(|(a, b)| a == b)
    }

    /// Path of the value that the finding is about.
    pub(crate) fn path(&self) -> Option<&Path> {
        self.path.as_ref()
    }

    /// Whether the finding is an error.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }

    /// Whether the message contains `words`.
    pub(crate) fn message_contains(&self, words: &str) -> bool {
        self.message.contains(words)
    }
}

/// A located problem of a scene. Its JSON form has all fields except the range of bytes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Problem {
    /// Path of the value, such as `objects[0].shape.sphere.radius`, relative to the file that
    /// contains it.
    pub path: String,
    /// Severity of the problem.
    pub severity: Severity,
    /// Description of the problem.
    pub message: String,
    /// Suggested fix.
    pub help: Option<String>,
    /// Range of bytes in a file; `None` for scenes that were not read from a file.
    #[serde(skip)]
    pub place: Option<SourceSpan>,
    /// Name of the file, `None` without a place.
    pub file: Option<String>,
    /// Line in the file, counted from 1.
    pub line: Option<usize>,
    /// Column in the line, in characters, counted from 1.
    pub column: Option<usize>,
}

/// All problems of a scene, errors first, in the order of the files.
#[derive(Clone, Debug, PartialEq)]
pub struct Problems {
    list: Vec<Problem>,
    sources: Sources,
}

impl Problems {
    /// Locates findings: derives places from paths and paths from places. `written` returns the
    /// place of the value at a path in the merged scene, or of its innermost existing ancestor, and
    /// the number of steps that lead there; `None` if there is no scene.
    pub(crate) fn new(findings: Vec<Finding>, sources: Sources, written: &SpanLookup<'_>) -> Self {
        let mut files: Vec<Option<Option<Node>>> = vec![None; sources.len()];
        let mut list: Vec<Problem> = Vec::with_capacity(findings.len());
        for finding in findings {
            let (place, path) = locate(&finding, &sources, written, &mut files);
            let Finding { severity, message, help, .. } = finding;
            list.push(Problem { path, severity, message, help, place, file: None, line: None, column: None });
        }
        list.sort_by_key(|problem| (problem.severity, problem.place));
        // Two checks may report the same problem; keep the first, which has the better suggestion.
        let mut seen = BTreeSet::new();
        list.retain(|problem| seen.insert((problem.path.clone(), problem.message.clone())));
        // In the order of the places, this is one pass over the texts.
        let mut cursor = Cursor::new();
        for problem in &mut list {
            let Some((place, source)) = problem.place.and_then(|place| Some((place, sources.get(place.file)?))) else {
                continue;
            };
            cursor = cursor.moved_to(&place, &source.text);
            problem.file = Some(source.name.clone());
            (problem.line, problem.column) = (Some(cursor.line), Some(cursor.column));
        }
        Self { list, sources }
    }

    /// All problems.
    pub fn list(&self) -> &[Problem] {
        &self.list
    }

    /// The texts that the places refer to.
    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    /// Number of errors.
    pub fn errors(&self) -> usize {
        self.list.iter().filter(|problem| problem.severity == Severity::Error).count()
    }

    /// Number of warnings.
    pub fn warnings(&self) -> usize {
        self.list.len() - self.errors()
    }

    /// The errors alone.
    #[must_use]
    pub fn without_warnings(mut self) -> Self {
        self.list.retain(|problem| problem.severity == Severity::Error);
        self
    }

    /// Formats the problems for a terminal: file, line, column, excerpt with a caret, path and
    /// suggested fix.
    pub fn render(&self, color: bool) -> String {
        text::render(self, color)
    }
}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Problems {}

/// Returns the place of a path in the merged scene, as [`Problems::new`] describes.
type SpanLookup<'w> = dyn Fn(&Path) -> Option<(Option<SourceSpan>, usize)> + 'w;

/// Place of a finding, and its path relative to the file that contains it.
fn locate(
    finding: &Finding,
    sources: &Sources,
    written: &SpanLookup<'_>,
    files: &mut [Option<Option<Node>>],
) -> (Option<SourceSpan>, String) {
    let found = finding.path.as_ref().and_then(written);
    let place = finding.place.or(found.and_then(|(place, _)| place));
    let own_file = sources.len() <= 1;
    let (Some(place), false) = (place, own_file && finding.path.is_some()) else {
        return (place, finding.path.as_ref().map(Path::to_string).unwrap_or_default());
    };
    let index = place.file.index();
    let text = sources.get(place.file).map(|source| source.text.as_str()).unwrap_or_default();
    let local = match files.get_mut(index) {
        Some(file) => file.get_or_insert_with(|| parse(text, place.file).ok().map(|(tree, _)| tree)).as_ref(),
        None => None,
    };
    let Some(local) = local else {
        // A file that cannot be parsed is not part of the merged scene, so the path is already
        // relative to it.
        return (Some(place), finding.path.as_ref().map(Path::to_string).unwrap_or_default());
    };
    let mut path = local.path_of(place);
    if let (Some((_, depth)), Some(full)) = (found, &finding.path) {
        full.steps().iter().skip(depth).for_each(|step| path.push(step.clone()));
    }
    (Some(place), path.to_string())
}

/// Describes an I/O error in plain words.
pub fn plain_io(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "file not found".into(),
        io::ErrorKind::PermissionDenied => "permission denied".into(),
        io::ErrorKind::IsADirectory => "this is a folder, not a file".into(),
        io::ErrorKind::InvalidInput | io::ErrorKind::InvalidFilename => "this is not a valid file name".into(),
        _ => error.to_string(),
    }
}
