//! Rows of the elements of a PLY, in pieces on all threads.

use super::header::Element;
use super::values::Values;
use crate::error::{MeshErrorKind, quote};
use crate::limits::MeshLimits;
use crate::pieces::PieceReader;

/// A run of rows of an element.
pub(super) struct Rows<V> {
    /// Reader at the first value of the first row.
    pub values: V,
    /// Number of rows.
    pub count: u64,
}

/// Reader of rows in pieces.
pub(super) struct RowReader<'l> {
    /// Limits of the file's contents.
    pub limits: &'l MeshLimits,
    /// Reader of the pieces.
    pub pieces: PieceReader<'l>,
    /// Number of rows of a piece.
    rows: u64,
}

impl<'l> RowReader<'l> {
    /// Creates a reader that works in pieces.
    pub fn new(limits: &'l MeshLimits, pieces: PieceReader<'l>) -> Self {
        // A row usually takes about 16 bytes. Dividing by 256 gives smaller pieces, whose results
        // stay in the cache.
        const ROW: u64 = 256;
        Self { limits, rows: (pieces.size as u64 / ROW).max(1), pieces }
    }

    /// Reads the rows of an element in pieces: `read` runs in parallel, `take` receives the results
    /// in order.
    pub fn read<V: Values, R: Send>(
        &self,
        element: &Element,
        values: &mut V,
        read: impl Fn(Rows<V>) -> Result<R, MeshErrorKind> + Sync,
        take: impl FnMut(R) -> Result<(), MeshErrorKind>,
    ) -> Result<(), MeshErrorKind> {
        let mut pieces = Vec::new();
        let mut left = element.count;
        let mut passed = Ok(());
        // If the end of a row is not found, stop after this piece: its reader gives the better
        // error.
        while left > 0 && passed.is_ok() {
            let count = left.min(self.rows);
            pieces.push((values.clone(), count));
            passed = values.skip_rows(element, count);
            left -= count;
        }
        self.pieces.read(&pieces, |(values, count)| read(Rows { values: values.clone(), count: *count }), take)?;
        passed
    }
}

/// Adds one warning that names all columns that are not read.
pub(super) fn note_ignored(element: &Element, is_read: impl Fn(usize) -> bool, warnings: &mut Vec<String>) {
    const NAMED: usize = 16;
    let columns = element.properties.iter().enumerate().filter(|(index, _)| !is_read(*index));
    let mut names: Vec<String> = columns.map(|(_, property)| quote(property.name.as_bytes())).collect();
    if names.is_empty() {
        return;
    }
    let more = names.len().saturating_sub(NAMED);
    names.truncate(NAMED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    warnings.push(format!("ignored properties of {}: {}{more}", quote(element.name.as_bytes()), names.join(", ")));
}
