//! Compiled expressions.

use crate::builder::Tape;
use crate::error::ExpressionResult;
use crate::parser::Parser;
use crate::{ExpressionError, MAX_LENGTH, Names, Op};
use std::ops::Range;

/// Compiled expression: a tape of operations in static single assignment form.
///
/// A program depends on the text only. [`Names`] give the values of its inputs at each evaluation,
/// and names that do not fit the program are reported then, as if the text were compiled again.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    text_length: usize,
    inputs: Box<[ProgramInput]>,
    constants: Box<[f64]>,
    ops: Box<[Op]>,
}

/// Number that a program reads from outside: a name, or a component of a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProgramInput {
    /// Name.
    pub name: Box<str>,
    /// Component of a vector, as written after the name.
    pub component: Option<Box<str>>,
    /// Byte range of its first use in the text.
    pub at: Range<usize>,
}

impl Program {
    /// Compiles an expression. Names are checked against `names`, so that the first error in the
    /// text is the one that is reported, whatever its kind.
    ///
    /// # Errors
    /// The text is not an expression, exceeds a limit, or uses a name that is unknown or of another
    /// kind.
    pub fn compile(text: &str, names: &Names) -> Result<Self, ExpressionError> {
        Self::read(text, Some(names))
    }

    /// Compiles an expression whose names are checked at evaluation only.
    ///
    /// # Errors
    /// The text is not an expression or exceeds a limit.
    pub fn parse(text: &str) -> Result<Self, ExpressionError> {
        Self::read(text, None)
    }

    fn read(text: &str, names: Option<&Names>) -> ExpressionResult<Self> {
        if text.len() > MAX_LENGTH {
            let message = format!("an expression has at most {MAX_LENGTH} characters, this one has {}", text.len());
            return Err(ExpressionError::new(0..text.len(), message));
        }
        let Tape { inputs, constants, ops } = Parser::new(text, names).parse()?;
        Ok(Self { text_length: text.len(), inputs: inputs.into(), constants: constants.into(), ops: ops.into() })
    }

    /// Inputs in the order of their first use. Inputs that the result does not depend on are among
    /// them.
    pub fn inputs(&self) -> &[ProgramInput] {
        &self.inputs
    }

    /// Constants that operations refer to.
    pub fn constants(&self) -> &[f64] {
        &self.constants
    }

    /// Operations in order of evaluation. The last one gives the result.
    pub fn ops(&self) -> &[Op] {
        &self.ops
    }

    /// Length of the text in bytes.
    pub(crate) fn text_length(&self) -> usize {
        self.text_length
    }
}
