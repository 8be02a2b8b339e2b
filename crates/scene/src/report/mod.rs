//! Problems: what is wrong with a scene, where, and what was probably meant.

use crate::document::{Node, Place, Sources, parse};
use crate::path::Path;
use juggler_math::message;
use std::collections::BTreeSet;
use std::{fmt, io};

mod text;

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// There is no picture.
    Error,
    /// There is a picture, perhaps not the one that was meant.
    Warning,
}

/// Something wrong, as the step that notices it knows it: by path, by place, or both.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    severity: Severity,
    path: Option<Path>,
    place: Option<Place>,
    message: String,
    help: Option<String>,
}

impl Finding {
    /// Something that leaves no picture.
    pub fn error(message: impl Into<String>) -> Self {
        let message = message::line(&message.into());
        Self { severity: Severity::Error, path: None, place: None, message, help: None }
    }

    /// Something that people should know.
    pub fn warning(message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(message) }
    }

    /// At a path in the merged scene.
    #[must_use]
    pub fn at(mut self, path: impl Into<Path>) -> Self {
        self.path = Some(path.into());
        self
    }

    /// At a place in a file.
    #[must_use]
    pub fn on(mut self, place: Option<Place>) -> Self {
        self.place = place;
        self
    }

    /// What was probably meant.
    #[must_use]
    pub fn help(self, help: impl Into<String>) -> Self {
        self.maybe_help(Some(help.into()))
    }

    /// What was probably meant, when something was.
    #[must_use]
    pub fn maybe_help(mut self, help: Option<String>) -> Self {
        self.help = help.map(|help| message::line(&help)).or(self.help);
        self
    }

    /// Whether both are about the same value, or one about a part of the other's.
    pub fn covers(&self, other: &Self) -> bool {
        let (Some(a), Some(b)) = (&self.path, &other.path) else { return false };
        let shared = a.steps().len().min(b.steps().len());
        shared > 0 && a.steps().iter().zip(b.steps()).all(|(a, b)| a == b)
    }

    /// The value that it is about.
    pub(crate) fn path(&self) -> Option<&Path> {
        self.path.as_ref()
    }

    /// Whether there is no picture.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }

    /// Whether the message holds these words.
    #[cfg(test)]
    pub(crate) fn says(&self, words: &str) -> bool {
        self.message.contains(words)
    }
}

/// Something wrong with a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// How bad it is.
    pub severity: Severity,
    /// The value at fault: `objects[0].shape.sphere.radius`, counted in the file that holds it.
    pub path: String,
    /// Where it stands; nowhere for scenes made by programs.
    pub place: Option<Place>,
    /// What is wrong.
    pub message: String,
    /// What was probably meant.
    pub help: Option<String>,
}

/// All that is wrong with a scene, errors first, in the order of the files.
#[derive(Clone, Debug, PartialEq)]
pub struct Problems {
    list: Vec<Problem>,
    sources: Sources,
}

impl Problems {
    /// Works out places from paths and paths from places. `written` gives the place of the value at a path in the merged
    /// scene, or of the last value on the way to it, and how many steps lead there; nothing when there is no scene yet.
    pub(crate) fn new(findings: Vec<Finding>, sources: Sources, written: &Written<'_>) -> Self {
        let mut files: Vec<Option<Option<Node>>> = vec![None; sources.len()];
        let mut list: Vec<Problem> = Vec::with_capacity(findings.len());
        for finding in findings {
            let (place, path) = locate(&finding, &sources, written, &mut files);
            let Finding { severity, message, help, .. } = finding;
            list.push(Problem { severity, path, place, message, help });
        }
        list.sort_by_key(|problem| (problem.severity, problem.place));
        // Two steps may notice the same; the first knows better what was meant.
        let mut seen = BTreeSet::new();
        list.retain(|problem| seen.insert((problem.path.clone(), problem.message.clone())));
        Self { list, sources }
    }

    /// The problems.
    pub fn list(&self) -> &[Problem] {
        &self.list
    }

    /// The texts that their places lie in.
    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    /// How many leave no picture.
    pub fn errors(&self) -> usize {
        self.list.iter().filter(|problem| problem.severity == Severity::Error).count()
    }

    /// How many people should know about.
    pub fn warnings(&self) -> usize {
        self.list.len() - self.errors()
    }

    /// All of them for a terminal: file, line, column, the text with a caret, the path, what was meant.
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

/// Where values of a scene were written.
type Written<'w> = dyn Fn(&Path) -> Option<(Option<Place>, usize)> + 'w;

/// Where a finding is, and its path inside the file that holds it.
fn locate(
    finding: &Finding,
    sources: &Sources,
    written: &Written<'_>,
    files: &mut [Option<Option<Node>>],
) -> (Option<Place>, String) {
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
        // A file that cannot be parsed has no part in the merged scene: the path is its own.
        return (Some(place), finding.path.as_ref().map(Path::to_string).unwrap_or_default());
    };
    let mut path = local.path_of(place);
    if let (Some((_, depth)), Some(full)) = (found, &finding.path) {
        full.steps().iter().skip(depth).for_each(|step| path.push(step.clone()));
    }
    (Some(place), path.to_string())
}

/// The system's error in plain words.
pub(crate) fn plain_io(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".into(),
        io::ErrorKind::PermissionDenied => "permission denied".into(),
        io::ErrorKind::IsADirectory => "this is a folder, not a file".into(),
        io::ErrorKind::InvalidInput | io::ErrorKind::InvalidFilename => "this cannot be the name of a file".into(),
        _ => error.to_string(),
    }
}
