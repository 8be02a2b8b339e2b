//! The rows after the header of a PLY, in any encoding.

use super::super::assemble::{Colors, MeshParts};
use super::super::error::{FilePosition, ImportErrorKind, quote};
use super::super::faces::Faces;
use super::super::pieces::read_pieces;
use super::super::text::finite;
use super::super::{Imported, Limits};
use super::colors::ColorColumns;
use super::header::{Element, Header, Property, Scalar};
use super::vertices::read_vertices;

/// Reads a sequence of numbers. A clone continues from the same position.
pub(super) trait Values: Clone + Sync {
    /// Position of the next value; in a text, the line of the last value.
    fn place(&self) -> FilePosition;
    /// Advances to the start of the next row.
    fn begin_row(&mut self) -> Result<(), ImportErrorKind>;
    /// Checks that the row has no more values.
    fn end_row(&mut self) -> Result<(), ImportErrorKind>;
    /// Reads the next value, rounded once to `f32`. `what` names it in errors.
    fn real(&mut self, kind: Scalar, what: &str) -> Result<f32, ImportErrorKind>;
    /// Reads the next `count` values, which must be integers, and passes each with its position to
    /// `take`.
    fn integers(
        &mut self,
        kind: Scalar,
        count: u64,
        what: &str,
        take: impl FnMut(FilePosition, i64) -> Result<(), ImportErrorKind>,
    ) -> Result<(), ImportErrorKind>;
    /// Skips `count` values.
    fn skip(&mut self, kind: Scalar, count: u64) -> Result<(), ImportErrorKind>;
    /// Skips `count` rows of an element and parses only as much as is needed to find their end.
    fn skip_rows(&mut self, element: &Element, count: u64) -> Result<(), ImportErrorKind>;
    /// Checks the end after the last row.
    fn end(&mut self) -> Result<(), ImportErrorKind> {
        Ok(())
    }
    /// Minimum size of a value, in bytes.
    fn min_size(&self, kind: Scalar) -> u64;
    /// Number of bytes left.
    fn remaining(&self) -> u64;
}

/// A run of rows of an element.
pub(super) struct Rows<V> {
    /// Reader at the first value of the first row.
    pub values: V,
    /// Number of rows.
    pub count: u64,
}

/// Reader of the elements that the header declares.
pub(super) struct Body<'h> {
    header: &'h Header,
    /// Limits of the file's contents.
    pub limits: &'h Limits,
    /// Number of rows of a piece.
    rows: u64,
}

impl<'h> Body<'h> {
    /// Creates a reader that works in pieces of about `piece` bytes.
    pub fn new(header: &'h Header, limits: &'h Limits, piece: usize) -> Self {
        // A row usually takes about 16 bytes. Dividing by 256 gives smaller pieces, whose results
        // stay in the cache.
        const ROW: u64 = 256;
        Self { header, limits, rows: (piece as u64 / ROW).max(1) }
    }

    /// Reads all elements and assembles the mesh.
    pub fn read(&self, mut values: impl Values) -> Result<Imported, ImportErrorKind> {
        check_counts(self.header, &values)?;
        let warnings = self.header.warning.iter().cloned().collect();
        let mut parts = MeshParts { warnings, ..MeshParts::default() };
        for element in &self.header.elements {
            match element.name.as_str() {
                "vertex" => read_vertices(self, element, &mut values, &mut parts)?,
                "face" => self.read_faces(element, &mut values, &mut parts)?,
                _ => skip_element(element, &mut values, &mut parts.warnings)?,
            }
        }
        values.end()?;
        parts.assemble()
    }

    /// Reads the rows of an element in pieces: `read` runs in parallel, `take` receives the results
    /// in order.
    pub fn read_rows<V: Values, R: Send>(
        &self,
        element: &Element,
        values: &mut V,
        read: impl Fn(Rows<V>) -> Result<R, ImportErrorKind> + Sync,
        take: impl FnMut(R) -> Result<(), ImportErrorKind>,
    ) -> Result<(), ImportErrorKind> {
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
        read_pieces(&pieces, |(values, count)| read(Rows { values: values.clone(), count: *count }), take)?;
        passed
    }

    fn read_faces(
        &self,
        element: &Element,
        values: &mut impl Values,
        parts: &mut MeshParts,
    ) -> Result<(), ImportErrorKind> {
        let is_indices = |property: &Property| matches!(property.name.as_str(), "vertex_indices" | "vertex_index");
        let Some(column) = element.properties.iter().position(is_indices) else {
            return Err(element.place.error("expected a property 'vertex_indices' of the element 'face'"));
        };
        if element.properties.get(column).is_none_or(|property| property.length.is_none()) {
            return Err(element.place.error("expected the property 'vertex_indices' to be a list"));
        }
        let color = ColorColumns::of(element);
        let color = color.as_ref();
        let is_color = |index: usize| color.is_some_and(|color| color.channel(index).is_some());
        note_ignored(element, |index| index == column || is_color(index), &mut parts.warnings);
        let vertices = self.header.elements.iter().find(|element| element.name == "vertex").map_or(0, |e| e.count);
        self.limits.check_vertices(vertices)?;
        // All rows are known to fit into the file, and most faces are one triangle.
        let most = element.count.min(u64::from(self.limits.triangles));
        let mut faces = Faces::with_capacity(usize::try_from(most).unwrap_or(0));
        self.read_rows(
            element,
            values,
            |rows| read_piece(element, (column, color), rows, vertices, self.limits),
            |(piece, colors)| {
                parts.face_colors.extend(colors);
                faces.append(&piece, 0, self.limits)
            },
        )?;
        parts.faces = faces;
        Ok(())
    }
}

/// Rejects row counts for which the file is too short, before memory is allocated for them.
fn check_counts(header: &Header, values: &impl Values) -> Result<(), ImportErrorKind> {
    let mut left = values.remaining();
    for element in &header.elements {
        let needed = element.count.saturating_mul(row_size(element, values));
        // The last value of a text needs no separator.
        if needed > left.saturating_add(1) {
            let (count, name) = (element.count, quote(element.name.as_bytes()));
            let message = format!("the header declares {count} elements {name} of at least {needed} bytes");
            return Err(element.place.error(format!("{message}, but only {left} remain")));
        }
        left = left.saturating_sub(needed);
    }
    Ok(())
}

/// Minimum size of a row, in bytes.
fn row_size(element: &Element, values: &impl Values) -> u64 {
    element.properties.iter().map(|property| values.min_size(property.length.unwrap_or(property.item))).sum()
}

/// Reads rows as faces whose corners are the list in this column, and the colors of their
/// triangles.
fn read_piece(
    element: &Element,
    (column, color): (usize, Option<&ColorColumns>),
    mut rows: Rows<impl Values>,
    vertices: u64,
    limits: &Limits,
) -> Result<(Faces, Colors), ImportErrorKind> {
    let values = &mut rows.values;
    let channels = color.map_or(0, ColorColumns::channels);
    let mut colors = Colors { channels, values: Vec::new() };
    let mut face_color = [0.0; 4];
    let mut faces = Faces::with_capacity(usize::try_from(rows.count).unwrap_or(0));
    let mut corners = Vec::new();
    for _ in 0..rows.count {
        values.begin_row()?;
        for (index, property) in element.properties.iter().enumerate() {
            match property.length {
                Some(length) if index == column => read_corners(values, length, property.item, vertices, &mut corners)?,
                _ => match color.and_then(|color| Some((color, color.channel(index)?))) {
                    Some((color, channel)) => {
                        let place = values.place();
                        let number = values.real(property.item, &property.name)?;
                        finite(number, place, &property.name)?;
                        if let Some(entry) = face_color.get_mut(channel) {
                            *entry = color.linear(channel, number);
                        }
                    }
                    None => skip(property, values)?,
                },
            }
        }
        values.end_row()?;
        faces.push(&corners, limits)?;
        // A polygon of n corners becomes n - 2 triangles, all of its color.
        for _ in 2..corners.len() {
            colors.values.extend(face_color.iter().take(channels));
        }
    }
    Ok((faces, colors))
}

fn read_corners(
    values: &mut impl Values,
    length: Scalar,
    item: Scalar,
    vertices: u64,
    corners: &mut Vec<u32>,
) -> Result<(), ImportErrorKind> {
    corners.clear();
    let count = list_length(values, length)?;
    values.integers(item, count, "a vertex index", |place, index| match u32::try_from(index) {
        Ok(corner) if u64::from(corner) < vertices => {
            corners.push(corner);
            Ok(())
        }
        _ => {
            Err(place
                .error(format!("vertex index {index} is out of range: there are {vertices} vertices, starting at 0")))
        }
    })
}

fn list_length(values: &mut impl Values, kind: Scalar) -> Result<u64, ImportErrorKind> {
    let mut length = 0;
    values.integers(kind, 1, "the length of a list", |place, found| {
        length =
            u64::try_from(found).map_err(|_| place.error(format!("expected the length of a list, found {found}")))?;
        Ok(())
    })?;
    Ok(length)
}

/// Skips one value or list.
pub(super) fn skip(property: &Property, values: &mut impl Values) -> Result<(), ImportErrorKind> {
    let count = property.length.map_or(Ok(1), |kind| list_length(values, kind))?;
    values.skip(property.item, count)
}

fn skip_element(
    element: &Element,
    values: &mut impl Values,
    warnings: &mut Vec<String>,
) -> Result<(), ImportErrorKind> {
    warnings.push(format!("ignored: {} elements {}", element.count, quote(element.name.as_bytes())));
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
