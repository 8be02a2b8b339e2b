//! The rows after the header of a PLY, in any encoding.

use super::colors::ColorColumns;
use super::corners::{self, CornerVertices};
use super::header::{Element, Header, Property, Scalar};
use super::strips::read_strips;
use super::vertices::read_vertices;
use crate::assemble::{Colors, MeshParts};
use crate::error::{FilePosition, MeshErrorKind, quote};
use crate::faces::Faces;
use crate::pieces::read_pieces;
use crate::text::finite;
use crate::weld::WeldedPiece;
use crate::{MeshFile, MeshLimits};

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
    /// MeshLimits of the file's contents.
    pub limits: &'h MeshLimits,
    /// Number of rows of a piece.
    rows: u64,
}

impl<'h> Body<'h> {
    /// Creates a reader that works in pieces of about `piece` bytes.
    pub fn new(header: &'h Header, limits: &'h MeshLimits, piece: usize) -> Self {
        // A row usually takes about 16 bytes. Dividing by 256 gives smaller pieces, whose results
        // stay in the cache.
        const ROW: u64 = 256;
        Self { header, limits, rows: (piece as u64 / ROW).max(1) }
    }

    /// Reads all elements and assembles the mesh.
    pub fn read(&self, mut values: impl Values) -> Result<MeshFile, MeshErrorKind> {
        check_counts(self.header, &values)?;
        let warnings = self.header.warning.iter().cloned().collect();
        let mut parts = MeshParts { warnings, ..MeshParts::default() };
        let has_coordinates = |element: &Element| element.name == "face" && corners::column(element).is_some();
        let mut corners = self.header.elements.iter().any(has_coordinates).then(CornerVertices::default);
        for element in &self.header.elements {
            match element.name.as_str() {
                "vertex" => read_vertices(self, element, &mut values, &mut parts)?,
                "face" => self.read_faces(element, &mut values, &mut parts, &mut corners)?,
                "tristrips" => self.read_strips(element, &mut values, &mut parts, &mut corners)?,
                _ => skip_element(element, &mut values, &mut parts.warnings)?,
            }
        }
        values.end()?;
        corners.map_or(Ok(()), |corners| corners.replace(&mut parts, self.limits))?;
        let colors = &parts.face_colors;
        if colors.values.len() != colors.channels.saturating_mul(parts.faces.len()) {
            parts.warnings.push("colors of faces are ignored: triangle strips have none".to_owned());
            parts.face_colors = Colors::default();
        }
        parts.assemble()
    }

    /// Reads the rows of an element in pieces: `read` runs in parallel, `take` receives the results
    /// in order.
    pub fn read_rows<V: Values, R: Send>(
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
        read_pieces(&pieces, |(values, count)| read(Rows { values: values.clone(), count: *count }), take)?;
        passed
    }

    fn read_faces(
        &self,
        element: &Element,
        values: &mut impl Values,
        parts: &mut MeshParts,
        corners: &mut Option<CornerVertices>,
    ) -> Result<(), MeshErrorKind> {
        let columns = FaceColumns::of(element)?;
        note_ignored(element, |index| columns.has(index), &mut parts.warnings);
        let vertices = self.vertices()?;
        // All rows are known to fit into the file, and most faces are one triangle.
        let most = element.count.min(u64::from(self.limits.triangles));
        if corners.is_none() && parts.faces.len() == 0 {
            parts.faces = Faces::with_capacity(usize::try_from(most).unwrap_or(0));
        }
        self.read_rows(
            element,
            values,
            |rows| read_piece(element, &columns, rows, vertices, self.limits),
            |FacePiece { welded, colors, missing }| {
                parts.face_colors.extend(colors);
                match corners {
                    Some(corners) => {
                        corners.missing += missing;
                        corners.welded.append(welded, self.limits)
                    }
                    None => parts.faces.append(&welded.faces, 0, self.limits),
                }
            },
        )
    }

    /// Reads triangle strips; their corners have no surface coordinates of their own.
    fn read_strips(
        &self,
        element: &Element,
        values: &mut impl Values,
        parts: &mut MeshParts,
        corners: &mut Option<CornerVertices>,
    ) -> Result<(), MeshErrorKind> {
        let column = index_column(element)?;
        note_ignored(element, |index| index == column, &mut parts.warnings);
        let vertices = self.vertices()?;
        let Some(corners) = corners else {
            let add = |triangle| parts.faces.push_triangle(triangle, self.limits);
            return read_strips(element, column, values, vertices, add);
        };
        let mut piece = WeldedPiece::default();
        let mut add = |mut triangle: [u32; 3]| {
            corners.missing += 1;
            corners::push(&mut piece, &mut triangle, &[], self.limits).map(|_| ())
        };
        read_strips(element, column, values, vertices, &mut add)?;
        corners.welded.append(piece, self.limits)
    }

    /// Number of vertices that the header declares, within the limits.
    fn vertices(&self) -> Result<u64, MeshErrorKind> {
        let element = self.header.elements.iter().find(|element| element.name == "vertex");
        let count = element.map_or(0, |element| element.count);
        self.limits.check_vertices(count).map(|()| count)
    }
}

/// Rejects row counts for which the file is too short, before memory is allocated for them.
fn check_counts(header: &Header, values: &impl Values) -> Result<(), MeshErrorKind> {
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

/// Columns of faces.
struct FaceColumns {
    /// List of vertex indices.
    indices: usize,
    color: Option<ColorColumns>,
    /// List of the surface coordinates of corners.
    coordinates: Option<usize>,
}

/// Column of the list of vertex indices.
fn index_column(element: &Element) -> Result<usize, MeshErrorKind> {
    let is_indices = |property: &Property| matches!(property.name.as_str(), "vertex_indices" | "vertex_index");
    let Some(column) = element.properties.iter().position(is_indices) else {
        let message = format!("expected a property 'vertex_indices' of the element '{}'", element.name);
        return Err(element.place.error(message));
    };
    if element.properties.get(column).is_none_or(|property| property.length.is_none()) {
        return Err(element.place.error("expected the property 'vertex_indices' to be a list"));
    }
    Ok(column)
}

impl FaceColumns {
    fn of(element: &Element) -> Result<Self, MeshErrorKind> {
        let (indices, color) = (index_column(element)?, ColorColumns::of(element));
        Ok(Self { indices, color, coordinates: corners::column(element) })
    }

    /// Whether a column is read.
    fn has(&self, column: usize) -> bool {
        column == self.indices || self.coordinates == Some(column) || self.channel(column).is_some()
    }

    /// Color columns, and the channel of a column.
    fn channel(&self, column: usize) -> Option<(&ColorColumns, usize)> {
        let color = self.color.as_ref()?;
        color.channel(column).map(|channel| (color, channel))
    }
}

/// Faces of a piece.
#[derive(Default)]
struct FacePiece {
    /// The faces; with surface coordinates of corners, these welded.
    welded: WeldedPiece,
    /// Colors of the triangles.
    colors: Colors,
    /// Number of faces whose surface coordinates do not fit their corners.
    missing: u64,
}

/// Reads rows as faces.
fn read_piece(
    element: &Element,
    columns: &FaceColumns,
    mut rows: Rows<impl Values>,
    vertices: u64,
    limits: &MeshLimits,
) -> Result<FacePiece, MeshErrorKind> {
    let values = &mut rows.values;
    let channels = columns.color.as_ref().map_or(0, ColorColumns::channels);
    let mut piece = FacePiece { colors: Colors { channels, values: Vec::new() }, ..FacePiece::default() };
    piece.welded.faces = Faces::with_capacity(usize::try_from(rows.count).unwrap_or(0));
    let (mut face_color, mut corners, mut coordinates) = ([0.0; 4], Vec::new(), Vec::new());
    for _ in 0..rows.count {
        values.begin_row()?;
        for (index, property) in element.properties.iter().enumerate() {
            match (property.length, columns.channel(index)) {
                (Some(length), _) if index == columns.indices => {
                    read_corners(values, length, property.item, vertices, &mut corners)?;
                }
                (Some(length), _) if columns.coordinates == Some(index) => {
                    corners::read_coordinates(values, (length, property.item), &mut coordinates)?;
                }
                (None, Some((color, channel))) => {
                    let number = finite_number(values, property)?;
                    if let Some(entry) = face_color.get_mut(channel) {
                        *entry = color.linear(channel, number);
                    }
                }
                _ => skip(property, values)?,
            }
        }
        values.end_row()?;
        match columns.coordinates {
            Some(_) => {
                let fits = corners::push(&mut piece.welded, &mut corners, &coordinates, limits)?;
                piece.missing += u64::from(!fits);
            }
            None => piece.welded.faces.push(&corners, limits)?,
        }
        // A polygon of n corners becomes n - 2 triangles, all of its color.
        for _ in 2..corners.len() {
            piece.colors.values.extend(face_color.iter().take(channels));
        }
    }
    Ok(piece)
}

fn finite_number(values: &mut impl Values, property: &Property) -> Result<f32, MeshErrorKind> {
    let place = values.place();
    let number = values.real(property.item, &property.name)?;
    finite(number, place, &property.name)?;
    Ok(number)
}

fn read_corners(
    values: &mut impl Values,
    length: Scalar,
    item: Scalar,
    vertices: u64,
    corners: &mut Vec<u32>,
) -> Result<(), MeshErrorKind> {
    corners.clear();
    let count = list_length(values, length)?;
    values.integers(item, count, "a vertex index", |place, index| match u32::try_from(index) {
        Ok(corner) if u64::from(corner) < vertices => {
            corners.push(corner);
            Ok(())
        }
        _ => Err(out_of_range(place, index, vertices)),
    })
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

fn skip_element(element: &Element, values: &mut impl Values, warnings: &mut Vec<String>) -> Result<(), MeshErrorKind> {
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
