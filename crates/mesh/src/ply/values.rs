//! Values of a PLY in any encoding, and lists of values.

use super::header::{Element, Property, Scalar};
use crate::error::{FilePosition, MeshErrorKind};

/// Reads a sequence of numbers. A clone continues from the same position.
pub(super) trait Values: Clone + Sync {
    /// Position of the next value; in a text, the line of the last value.
    fn place(&self) -> FilePosition;
    /// Advances to the start of the next row.
    fn begin_row(&mut self) -> Result<(), MeshErrorKind>;
    /// Checks that the row has no more values.
    fn end_row(&mut self) -> Result<(), MeshErrorKind>;
    /// Reads the next value, rounded once to `f32`. `what` names it in errors.
    fn real(&mut self, kind: Scalar, what: &str) -> Result<f32, MeshErrorKind>;
    /// Reads the next `count` values, which must be integers, and passes each with its position to
    /// `take`.
    fn integers(
        &mut self,
        kind: Scalar,
        count: u64,
        what: &str,
        take: impl FnMut(FilePosition, i64) -> Result<(), MeshErrorKind>,
    ) -> Result<(), MeshErrorKind>;
    /// Skips `count` values.
    fn skip(&mut self, kind: Scalar, count: u64) -> Result<(), MeshErrorKind>;
    /// Skips `count` rows of an element and parses only as much as is needed to find their end.
    fn skip_rows(&mut self, element: &Element, count: u64) -> Result<(), MeshErrorKind>;
    /// Checks the end after the last row.
    fn end(&mut self) -> Result<(), MeshErrorKind> {
        Ok(())
    }
    /// Minimum size of a value, in bytes.
    fn min_size(&self, kind: Scalar) -> u64;
    /// Number of bytes left.
    fn remaining(&self) -> u64;
}

/// Error about a vertex index.
pub(super) fn out_of_range(place: FilePosition, index: i64, vertices: u64) -> MeshErrorKind {
    place.error(format!("vertex index {index} is out of range: there are {vertices} vertices, starting at 0"))
}

/// Reads the length of a list.
pub(super) fn list_length(values: &mut impl Values, kind: Scalar) -> Result<u64, MeshErrorKind> {
    let mut length = 0;
    values.integers(kind, 1, "the length of a list", |place, found| {
        length =
            u64::try_from(found).map_err(|_| place.error(format!("expected the length of a list, found {found}")))?;
        Ok(())
    })?;
    Ok(length)
}

/// Skips one value or list.
pub(super) fn skip(property: &Property, values: &mut impl Values) -> Result<(), MeshErrorKind> {
    let count = property.length.map_or(Ok(1), |kind| list_length(values, kind))?;
    values.skip(property.item, count)
}
