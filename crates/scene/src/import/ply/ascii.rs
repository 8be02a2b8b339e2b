//! The numbers of a text PLY: one row a line, empty lines between them passed over.

use super::super::error::{Fault, Place};
use super::super::text::{self, Scanner};
use super::body::Values;
use super::header::{Element, Scalar};

/// A text after its header.
#[derive(Clone)]
pub(super) struct AsciiValues<'a>(Scanner<'a>);

impl<'a> AsciiValues<'a> {
    /// From here on.
    pub fn new(scanner: Scanner<'a>) -> Self {
        Self(scanner)
    }

    fn double(&mut self, what: &str) -> Result<f64, Fault> {
        let word = self.0.word();
        let value = word.and_then(|word| std::str::from_utf8(word).ok()?.parse().ok());
        value.ok_or_else(|| self.0.expected(&format!("a number for {what}"), word))
    }
}

impl Values for AsciiValues<'_> {
    fn place(&self) -> Place {
        self.0.place()
    }

    fn begin_row(&mut self) -> Result<(), Fault> {
        if self.0.skip_empty_lines() { Ok(()) } else { Err(self.0.expected("one more row", None)) }
    }

    fn end_row(&mut self) -> Result<(), Fault> {
        match self.0.word() {
            None => {
                self.0.next_line();
                Ok(())
            }
            word => Err(self.0.expected("the end of the line, as the header says", word)),
        }
    }

    fn real(&mut self, kind: Scalar, what: &str) -> Result<f32, Fault> {
        if kind == Scalar::F32 {
            return self.0.real(what);
        }
        // As the binary forms do it: to the type of the property first, to single precision then.
        self.double(what).map(|value| value as f32)
    }

    fn integers(
        &mut self,
        kind: Scalar,
        count: u64,
        what: &str,
        mut take: impl FnMut(Place, i64) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
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

    fn skip(&mut self, _kind: Scalar, count: u64) -> Result<(), Fault> {
        for _ in 0..count {
            if self.0.word().is_none() {
                return Err(self.0.expected("one more value, as the header says", None));
            }
        }
        Ok(())
    }

    fn pass_rows(&mut self, _element: &Element, count: u64) -> Result<(), Fault> {
        for _ in 0..count {
            self.begin_row()?;
            self.0.next_line();
        }
        Ok(())
    }

    fn least_size(&self, _kind: Scalar) -> u64 {
        // A digit and what separates it from the next one.
        2
    }

    fn remaining(&self) -> u64 {
        self.0.rest().len() as u64
    }
}
