//! Errors with their place in the text.

use std::ops::Range;

/// Error in an expression: what is wrong, and where.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct ExpressionError {
    /// Byte range of the text at fault.
    pub at: Range<usize>,
    /// What is wrong.
    pub message: String,
    /// Suggested correction.
    pub help: Option<String>,
}

impl ExpressionError {
    /// Error without a suggestion.
    pub(crate) fn new(at: Range<usize>, message: impl Into<String>) -> Self {
        Self { at, message: message.into(), help: None }
    }
}

/// Result of a step that may find the expression wrong.
pub(crate) type ExpressionResult<T> = Result<T, ExpressionError>;

/// Fails with an error without a suggestion.
pub(crate) fn fail<T>(at: Range<usize>, message: impl Into<String>) -> ExpressionResult<T> {
    Err(ExpressionError::new(at, message))
}
