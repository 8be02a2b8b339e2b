//! The values of a text PLY: one row a line, or rows anywhere. Empty lines are skipped.

use super::header::{Element, Scalar};
use super::values::{Values, skip};
use crate::error::{FilePosition, MeshErrorKind};
use crate::text::{self, Scanner};

/// Reader of the text after the header.
#[derive(Clone)]
pub(super) struct AsciiValues<'a> {
    scanner: Scanner<'a>,
    /// Whether a row is one line. Otherwise line ends are blanks.
    has_lines: bool,
}

impl<'a> AsciiValues<'a> {
    /// Creates a reader that starts at the scanner's position.
    pub fn new(scanner: Scanner<'a>) -> Self {
        Self { scanner, has_lines: true }
    }

    /// The same text with line ends as blanks, so that a line may hold several rows.
    pub fn without_lines(self) -> Self {
        Self { has_lines: false, ..self }
    }

    /// Next value of the row.
    fn word(&mut self) -> Option<&'a [u8]> {
        if self.has_lines { self.scanner.word() } else { self.scanner.word_anywhere() }
    }

    fn double(&mut self, what: &str) -> Result<f64, MeshErrorKind> {
        let word = self.word();
        let value = word.and_then(|word| std::str::from_utf8(word).ok()?.parse().ok());
        value.ok_or_else(|| self.scanner.expected(&format!("a number for {what}"), word))
    }
}

impl Values for AsciiValues<'_> {
    fn place(&self) -> FilePosition {
        self.scanner.place()
    }

    fn begin_row(&mut self) -> Result<(), MeshErrorKind> {
        if self.scanner.skip_empty_lines() { Ok(()) } else { Err(self.scanner.expected("one more element", None)) }
    }

    fn end_row(&mut self) -> Result<(), MeshErrorKind> {
        if !self.has_lines {
            return Ok(());
        }
        match self.word() {
            None => {
                self.scanner.next_line();
                Ok(())
            }
            word => Err(self.scanner.expected("the end of the line, as the header declares", word)),
        }
    }

    fn real(&mut self, kind: Scalar, what: &str) -> Result<f32, MeshErrorKind> {
        if kind == Scalar::F32 {
            let word = self.word();
            return word
                .and_then(text::real)
                .ok_or_else(|| self.scanner.expected(&format!("a number for {what}"), word));
        }
        // Round as for the binary forms: first to the type of the property, then to single
        // precision.
        self.double(what).map(|value| value as f32)
    }

    fn integers(
        &mut self,
        kind: Scalar,
        count: u64,
        what: &str,
        mut take: impl FnMut(FilePosition, i64) -> Result<(), MeshErrorKind>,
    ) -> Result<(), MeshErrorKind> {
        for _ in 0..count {
            let value = if matches!(kind, Scalar::F32 | Scalar::F64) {
                text::whole(self.double(what)?, self.place(), what)?
            } else {
                let word = self.word();
                word.and_then(text::integer).ok_or_else(|| self.scanner.expected(what, word))?
            };
            take(self.place(), value)?;
        }
        Ok(())
    }

    fn skip(&mut self, _kind: Scalar, count: u64) -> Result<(), MeshErrorKind> {
        for _ in 0..count {
            if self.word().is_none() {
                return Err(self.scanner.expected("one more value, as the header declares", None));
            }
        }
        Ok(())
    }

    fn skip_rows(&mut self, element: &Element, count: u64) -> Result<(), MeshErrorKind> {
        for _ in 0..count {
            self.begin_row()?;
            if self.has_lines {
                self.scanner.next_line();
            } else {
                element.properties.iter().try_for_each(|property| skip(property, self))?;
            }
        }
        Ok(())
    }

    fn end(&mut self) -> Result<(), MeshErrorKind> {
        match self.scanner.word_anywhere().filter(|_| !self.has_lines) {
            None => Ok(()),
            word => Err(self.scanner.expected("the end of the file, as the header declares", word)),
        }
    }

    fn min_size(&self, _kind: Scalar) -> u64 {
        // A digit and a separator.
        2
    }

    fn remaining(&self) -> u64 {
        self.scanner.rest().len() as u64
    }
}

/// Reads the rows of a text. If its lines do not hold one row each, reads it as a sequence of numbers,
/// with one of the `warnings`; the error is that of the lines unless the sequence fits the header
/// exactly.
pub(super) fn read_text<'t, T>(
    values: &AsciiValues<'t>,
    read: impl Fn(AsciiValues<'t>) -> Result<T, MeshErrorKind>,
    warnings: impl Fn(&mut T) -> &mut Vec<String>,
) -> Result<T, MeshErrorKind> {
    let strict = read(values.clone());
    if !matches!(strict, Err(MeshErrorKind::Malformed { .. })) {
        return strict;
    }
    let Ok(mut found) = read(values.clone().without_lines()) else { return strict };
    warnings(&mut found).push("lines do not hold one element each: read as a sequence of numbers".to_owned());
    Ok(found)
}
