//! What can be wrong with a material, and where.

use juggler_math::range;
use juggler_texture::UnknownTexture;

/// Why a material cannot be compiled.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MaterialError {
    /// A texture that the scene has not.
    #[error(transparent)]
    UnknownTexture(#[from] UnknownTexture),
    /// A material that the scene has not.
    #[error("no material is called `{name}`")]
    UnknownMaterial {
        /// The field that names it.
        field: &'static str,
        /// The name.
        name: String,
    },
    /// Checkerboards within checkerboards without end.
    #[error("the material `{name}` contains itself")]
    Cycle {
        /// The field that closes the circle.
        field: &'static str,
        /// The name.
        name: String,
    },
    /// Checkerboards within checkerboards, too many.
    #[error("materials lie more than {} deep in each other here", super::MAX_NESTING)]
    TooDeep,
    /// A number that cannot be.
    #[error("{message}")]
    Invalid {
        /// The field.
        field: &'static str,
        /// What is wrong, and what would be right.
        message: String,
    },
    /// An error inside a field.
    #[error("{error}")]
    Within {
        /// The field.
        field: &'static str,
        /// What is wrong there.
        error: Box<MaterialError>,
    },
}

impl MaterialError {
    /// Path of the field at fault, as in the scene file, from what was compiled: `even.phong.ior`.
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

    /// Whether all that is wrong is a name that the scene has not.
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

/// Refuses a number outside `low..=high`, and what is no number.
pub(super) fn in_range(field: &'static str, value: f32, low: f32, high: f32) -> Result<(), MaterialError> {
    let wrong = range::outside(field, value, low, high);
    wrong.map_or(Ok(()), |message| Err(MaterialError::Invalid { field, message }))
}
