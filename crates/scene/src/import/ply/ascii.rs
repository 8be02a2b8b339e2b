//! The values of a text PLY: one row a line. Empty lines are skipped.

use super::super::error::{FilePosition, ImportErrorKind};
use super::super::text::{self, Scanner};
use super::body::Values;
use super::header::{Element, Scalar};

/// Reader of the text after the header.
#[derive(Clone)]
pub(super) struct AsciiValues<'a>(Scanner<'a>);

impl<'a> AsciiValues<'a> {
    /// Creates a reader that starts at the scanner's position.
    pub fn new(scanner: Scanner<'a>) -> Self {
        Self(scanner)
    }

    fn double(&mut self, what: &str) -> Result<f64, ImportErrorKind> {
        let word = self.0.word();
        let value = word.and_then(|word| std::str::from_utf8(word).ok()?.parse().ok());
        value.ok_or_else(|| self.0.expected(&format!("a number for {what}"), word))
    }
}

impl Values for AsciiValues<'_> {
    fn place(&self) -> FilePosition {
        self.0.place()
    }

    fn begin_row(&mut self) -> Result<(), ImportErrorKind> {
        if self.0.skip_empty_lines() { Ok(()) } else { Err(self.0.expected("one more element", None)) }
    }

    fn end_row(&mut self) -> Result<(), ImportErrorKind> {
        match self.0.word() {
            None => {
                self.0.next_line();
                Ok(())
            }
            word => Err(self.0.expected("the end of the line, as the header declares", word)),
        }
    }

    fn real(&mut self, kind: Scalar, what: &str) -> Result<f32, ImportErrorKind> {
        if kind == Scalar::F32 {
            return self.0.real(what);
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
        mut take: impl FnMut(FilePosition, i64) -> Result<(), ImportErrorKind>,
    ) -> Result<(), ImportErrorKind> {
        for _ in 0..count {
            let value = if matches!(kind, Scalar::F32 | Scalar::F64) {
                text::whole(self.double(what)?, self.place(), what)?
            } else {
                let word = self.0.word();
                word.and_then(text::integer).ok_or_else(|| self.0.expected(what, word))?
            };
            take(self.place(), value)?;
        }
        Ok(())
    }

    fn skip(&mut self, _kind: Scalar, count: u64) -> Result<(), ImportErrorKind> {
        for _ in 0..count {
            if self.0.word().is_none() {
                return Err(self.0.expected("one more value, as the header declares", None));
            }
        }
        Ok(())
    }

    fn skip_rows(&mut self, _element: &Element, count: u64) -> Result<(), ImportErrorKind> {
        for _ in 0..count {
            self.begin_row()?;
            self.0.next_line();
        }
        Ok(())
    }

    fn min_size(&self, _kind: Scalar) -> u64 {
        // A digit and a separator.
        2
    }

    fn remaining(&self) -> u64 {
        self.0.rest().len() as u64
    }
}
