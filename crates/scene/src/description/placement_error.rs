//! Error of a transform or of instances.

/// Error of geometry that cannot be placed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct PlacementError {
    /// Path of the invalid field, as in the scene file; empty if several fields are involved.
    pub field: &'static str,
    /// Error message.
    pub message: String,
}

impl PlacementError {
    pub(super) fn new(field: &'static str, message: impl Into<String>) -> Self {
        Self { field, message: message.into() }
    }
}
