//! Formatting of problems as text.

use super::{Problem, Problems, Severity};
use crate::document::Sources;
use annotate_snippets::{AnnotationKind, Element, Group, Level, Origin, Renderer, Snippet};
use juggler_math::message::{MAX_QUOTE, excerpt};
use std::fmt::Write;

/// Maximum number of problems that are written in full.
const MAX_SHOWN: usize = 50;
/// Maximum length of an excerpt on each side of the error, in bytes; terminals show less.
const MARGIN: usize = 500;

/// Formats the problems, followed by their number if there are several.
pub fn render(problems: &Problems, color: bool) -> String {
    let renderer = if color { Renderer::styled() } else { Renderer::plain() };
    let mut text = String::new();
    for problem in problems.list().iter().take(MAX_SHOWN) {
        let group = group(problem, problems.sources());
        text.push_str(renderer.render(&[group]).trim_end());
        text.push_str("\n\n");
    }
    let (errors, warnings) = (problems.errors(), problems.warnings());
    let hidden = problems.list().len().saturating_sub(MAX_SHOWN);
    if hidden > 0 {
        let _ = writeln!(text, "... and {hidden} more");
    }
    if errors + warnings > 1 {
        let counts = [(errors, "error"), (warnings, "warning")];
        let counts: Vec<String> = counts.into_iter().filter(|(n, _)| *n > 0).map(|(n, what)| count(n, what)).collect();
        let _ = writeln!(text, "{}", counts.join(", "));
    }
    text.trim_end().to_owned()
}

fn count(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

fn group<'p>(problem: &'p Problem, sources: &'p Sources) -> Group<'p> {
    let level = match problem.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let mut elements: Vec<Element<'p>> = Vec::new();
    if let Some(excerpt) = Excerpt::of(problem, sources) {
        let annotation = AnnotationKind::Primary.span(excerpt.start..excerpt.end);
        let snippet = Snippet::source(excerpt.text).line_start(excerpt.line).annotation(annotation);
        if excerpt.cut {
            // The column in the file differs from the column in the excerpt.
            elements.push(Origin::path(excerpt.file).line(excerpt.line).char_column(excerpt.column).into());
            elements.push(snippet.into());
        } else {
            elements.push(snippet.path(excerpt.file).into());
        }
    }
    if !problem.path.is_empty() {
        elements.push(Level::NOTE.with_name("at").message(excerpt(&problem.path, MAX_QUOTE)).into());
    }
    if let Some(help) = &problem.help {
        elements.push(Level::HELP.message(help.as_str()).into());
    }
    level.primary_title(problem.message.as_str()).elements(elements)
}

/// Excerpt of the line with the error.
struct Excerpt<'p> {
    file: &'p str,
    /// Line number, counted from 1.
    line: usize,
    /// Column in characters, counted from 1.
    column: usize,
    text: String,
    /// Whether the start of the line is cut off.
    cut: bool,
    /// Byte range of the error in `text`.
    start: usize,
    end: usize,
}

impl<'p> Excerpt<'p> {
    fn of(problem: &Problem, sources: &'p Sources) -> Option<Self> {
        let (place, line, column) = (problem.place?, problem.line?, problem.column?);
        let source = sources.get(place.file)?;
        let start = source.text.floor_char_boundary(place.start as usize);
        let (before, after) = source.text.split_at_checked(start)?;
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let left = before.get(line_start..)?;
        let right = after.lines().next().unwrap_or_default();
        let fault = right.floor_char_boundary(((place.end - place.start) as usize).clamp(0, MARGIN));
        let shown_left = left.get(left.ceil_char_boundary(left.len().saturating_sub(MARGIN))..)?;
        let shown_right = right.get(..right.floor_char_boundary((fault + MARGIN).min(right.len())))?;
        let cut = shown_left.len() < left.len();
        let head = if cut { "…" } else { "" };
        let tail = if shown_right.len() < right.len() { "…" } else { "" };
        let text = format!("{head}{shown_left}{shown_right}{tail}");
        let start = head.len() + shown_left.len();
        Some(Self { file: &source.name, line, column, text, cut, start, end: start + fault.min(shown_right.len()) })
    }
}
