//! Errors in materials, with the path of the field at fault.

use juggler_math::range;
use juggler_texture::{InputError, UnknownTexture};

/// Error in a material's description.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MaterialError {
    /// The scene has no texture of this name.
    #[error(transparent)]
    UnknownTexture(UnknownTexture),
    /// The scene has no material of this name.
    #[error("no material is called `{name}`")]
    UnknownMaterial {
        /// Field that contains the name.
        field: &'static str,
        /// The name.
        name: String,
    },
    /// A material contains itself.
    #[error("the material `{name}` contains itself")]
    Cycle {
        /// Field that closes the cycle.
        field: &'static str,
        /// The name.
        name: String,
    },
    /// Materials are nested deeper than [`MAX_NESTING`](super::MAX_NESTING).
    #[error("materials are nested more than {} deep here", super::MAX_NESTING)]
    TooDeep,
    /// A value is invalid.
    #[error("{message}")]
    Invalid {
        /// The field.
        field: &'static str,
        /// Message about the error and the valid values.
        message: String,
    },
    /// An error inside a field.
    #[error("{error}")]
    Within {
        /// The field.
        field: &'static str,
        /// Error in the field.
        error: Box<MaterialError>,
    },
}

impl From<InputError> for MaterialError {
    fn from(error: InputError) -> Self {
        match error {
            InputError::Unknown(unknown) => Self::UnknownTexture(unknown),
            InputError::Incomplete { field, message } => Self::Invalid { field, message },
        }
    }
}

impl MaterialError {
    /// Path of the field at fault, relative to the compiled material, as in the scene file:
    /// `even.phong.ior`.
    pub fn path(&self) -> String {
        match self {
            Self::UnknownTexture(UnknownTexture { field, .. })
            | Self::UnknownMaterial { field, .. }
            | Self::Cycle { field, .. }
            | Self::Invalid { field, .. } => (*field).to_owned(),
            Self::TooDeep => String::new(),
            Self::Within { field, error } => {
                let inner = error.path();
                if inner.is_empty() { (*field).to_owned() } else { format!("{field}.{inner}") }
            }
        }
    }

    /// Whether the error is an unknown name.
    pub fn is_unknown_name(&self) -> bool {
        match self {
            Self::UnknownTexture(_) | Self::UnknownMaterial { .. } => true,
            Self::Within { error, .. } => error.is_unknown_name(),
            Self::Cycle { .. } | Self::TooDeep | Self::Invalid { .. } => false,
        }
    }

    pub(super) fn within(self, field: &'static str) -> Self {
        Self::Within { field, error: Box::new(self) }
    }
}

/// Rejects a number outside `low..=high`, and NaN.
pub(super) fn in_range(field: &'static str, value: f32, low: f32, high: f32) -> Result<(), MaterialError> {
    let wrong = range::range_error(field, value, low, high);
    wrong.map_or(Ok(()), |message| Err(MaterialError::Invalid { field, message }))
}
