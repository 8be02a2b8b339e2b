//! The rows of a PLY, whichever way they are written.

use super::super::assemble::Parts;
use super::super::error::{Fault, Place, quote};
use super::super::faces::Faces;
use super::super::pieces::read_pieces;
use super::super::{Imported, Limits};
use super::header::{Element, Header, Property, Scalar};
use super::vertices::read_vertices;

/// Numbers one after the other. A copy goes on from the same place.
pub(super) trait Values: Clone + Sync {
    /// Where the next value stands (in a text: the line of the last one).
    fn place(&self) -> Place;
    /// Goes to the start of the next row.
    fn begin_row(&mut self) -> Result<(), Fault>;
    /// Makes sure that the row has no more values.
    fn end_row(&mut self) -> Result<(), Fault>;
    /// The next value, rounded once.
    fn real(&mut self, kind: Scalar, what: &str) -> Result<f32, Fault>;
    /// The next values, which must be whole numbers, each with its place.
    fn integers(
        &mut self,
        kind: Scalar,
        count: u64,
        what: &str,
        take: impl FnMut(Place, i64) -> Result<(), Fault>,
    ) -> Result<(), Fault>;
    /// Passes over values.
    fn skip(&mut self, kind: Scalar, count: u64) -> Result<(), Fault>;
    /// Passes over rows of an element without a look at more than it takes to find their end.
    fn pass_rows(&mut self, element: &Element, count: u64) -> Result<(), Fault>;
    /// The least number of bytes that a value takes up.
    fn least_size(&self, kind: Scalar) -> u64;
    /// Bytes that are left.
    fn remaining(&self) -> u64;
}

/// Rows of an element, from where these values stand.
pub(super) struct Rows<V> {
    /// The first value.
    pub values: V,
    /// How many rows.
    pub count: u64,
}

/// What the header promises, and how to read it.
pub(super) struct Body<'h> {
    header: &'h Header,
    /// The most that a file may hold.
    pub limits: &'h Limits,
    /// Rows that are read in one piece.
    rows: u64,
}

impl<'h> Body<'h> {
    /// To be read in pieces of about this many bytes.
    pub fn new(header: &'h Header, limits: &'h Limits, piece: usize) -> Self {
        // Rows have some sixteen bytes; pieces whose results stay in the cache are faster than large ones.
        const ROW: u64 = 256;
        Self { header, limits, rows: (piece as u64 / ROW).max(1) }
    }

    /// Reads it.
    pub fn read(&self, mut values: impl Values) -> Result<Imported, Fault> {
        check_counts(self.header, &values)?;
        let warnings = self.header.warning.iter().cloned().collect();
        let mut parts = Parts { warnings, ..Parts::default() };
        for element in &self.header.elements {
            match element.name.as_str() {
                "vertex" => read_vertices(self, element, &mut values, &mut parts)?,
                "face" => self.read_faces(element, &mut values, &mut parts)?,
                _ => skip_element(element, &mut values, &mut parts.warnings)?,
            }
        }
        parts.assemble()
    }

    /// Reads the rows of an element in pieces.
    pub fn read_rows<V: Values, R: Send>(
        &self,
        element: &Element,
        values: &mut V,
        read: impl Fn(Rows<V>) -> Result<R, Fault> + Sync,
        take: impl FnMut(R) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        let mut pieces = Vec::new();
        let mut left = element.count;
        let mut passed = Ok(());
        // Rows that have no end are the last that are read, and the reader knows better what is wrong with them.
        while left > 0 && passed.is_ok() {
            let count = left.min(self.rows);
            pieces.push((values.clone(), count));
            passed = values.pass_rows(element, count);
            left -= count;
        }
        read_pieces(&pieces, |(values, count)| read(Rows { values: values.clone(), count: *count }), take)?;
        passed
    }

    fn read_faces(&self, element: &Element, values: &mut impl Values, parts: &mut Parts) -> Result<(), Fault> {
        let is_indices = |property: &Property| matches!(property.name.as_str(), "vertex_indices" | "vertex_index");
        let Some(column) = element.properties.iter().position(is_indices) else {
            return Err(element.place.fault("expected a property 'vertex_indices' of the element 'face'"));
        };
        if element.properties.get(column).is_none_or(|property| property.length.is_none()) {
            return Err(element.place.fault("expected the property 'vertex_indices' to be a list"));
        }
        note_ignored(element, |index| index == column, &mut parts.warnings);
        let vertices = self.header.elements.iter().find(|element| element.name == "vertex").map_or(0, |e| e.count);
        self.limits.check_vertices(vertices)?;
        // Every row has been found to have its bytes, and most are one triangle.
        let most = element.count.min(u64::from(self.limits.triangles));
        let mut faces = Faces::with_capacity(usize::try_from(most).unwrap_or(0));
        self.read_rows(
            element,
            values,
            |rows| read_piece(element, column, rows, vertices, self.limits),
            |piece| faces.append(&piece, 0, self.limits),
        )?;
        parts.faces = faces;
        Ok(())
    }
}

/// Refuses counts of rows for which the file is too short, before anything is reserved for them.
fn check_counts(header: &Header, values: &impl Values) -> Result<(), Fault> {
    let mut left = values.remaining();
    for element in &header.elements {
        let needed = element.count.saturating_mul(row_size(element, values));
        // The last value of a text may go without a separator.
        if needed > left.saturating_add(1) {
            let (count, name) = (element.count, quote(element.name.as_bytes()));
            let message = format!("{count} rows of {name} are announced, which need at least {needed} bytes");
            return Err(element.place.fault(format!("{message}, but only {left} are left for them")));
        }
        left = left.saturating_sub(needed);
    }
    Ok(())
}

/// The least number of bytes that a row can have.
fn row_size(element: &Element, values: &impl Values) -> u64 {
    element.properties.iter().map(|property| values.least_size(property.length.unwrap_or(property.item))).sum()
}

/// Faces whose corners are in this column.
fn read_piece(
    element: &Element,
    column: usize,
    mut rows: Rows<impl Values>,
    vertices: u64,
    limits: &Limits,
) -> Result<Faces, Fault> {
    let values = &mut rows.values;
    let mut faces = Faces::with_capacity(usize::try_from(rows.count).unwrap_or(0));
    let mut corners = Vec::new();
    for _ in 0..rows.count {
        values.begin_row()?;
        for (index, property) in element.properties.iter().enumerate() {
            match property.length {
                Some(length) if index == column => read_corners(values, length, property.item, vertices, &mut corners)?,
                _ => skip(property, values)?,
            }
        }
        values.end_row()?;
        faces.push(&corners, limits)?;
    }
    Ok(faces)
}

fn read_corners(
    values: &mut impl Values,
    length: Scalar,
    item: Scalar,
    vertices: u64,
    corners: &mut Vec<u32>,
) -> Result<(), Fault> {
    corners.clear();
    let count = list_length(values, length)?;
    values.integers(item, count, "a vertex index", |place, index| match u32::try_from(index) {
        Ok(corner) if u64::from(corner) < vertices => {
            corners.push(corner);
            Ok(())
        }
        _ => Err(place.fault(format!("vertex index {index}: there are {vertices} vertices, from 0"))),
    })
}

fn list_length(values: &mut impl Values, kind: Scalar) -> Result<u64, Fault> {
    let mut length = 0;
    values.integers(kind, 1, "the length of a list", |place, found| {
        length =
            u64::try_from(found).map_err(|_| place.fault(format!("expected the length of a list, found {found}")))?;
        Ok(())
    })?;
    Ok(length)
}

/// Passes over one value or list.
pub(super) fn skip(property: &Property, values: &mut impl Values) -> Result<(), Fault> {
    let count = property.length.map_or(Ok(1), |kind| list_length(values, kind))?;
    values.skip(property.item, count)
}

fn skip_element(element: &Element, values: &mut impl Values, warnings: &mut Vec<String>) -> Result<(), Fault> {
    warnings.push(format!("ignored: {} rows of {}", element.count, quote(element.name.as_bytes())));
    if element.properties.is_empty() {
        return Ok(());
    }
    for _ in 0..element.count {
        values.begin_row()?;
        element.properties.iter().try_for_each(|property| skip(property, values))?;
        values.end_row()?;
    }
    Ok(())
}

/// One warning for all columns that are not read.
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
