//! The rows after the header of a PLY, in any encoding.

use super::attributes::{self, AttributeColumns, NamedAttributes};
use super::colors::ColorColumns;
use super::corners::{self, CornerVertices};
use super::header::{Element, Header, Property, Scalar};
use super::rows::{RowReader, Rows, note_ignored};
use super::strips::read_strips;
use super::values::{Values, list_length, out_of_range, skip};
use super::vertices::read_vertices;
use crate::assemble::{Colors, MeshParts};
use crate::error::{MeshErrorKind, quote};
use crate::faces::Faces;
use crate::limits::MeshLimits;
use crate::mesh_file::MeshFile;
use crate::pieces::PieceReader;
use crate::text::finite;
use crate::weld::WeldedPiece;
use juggler_shape::attribute::{AttributeDomain, MeshAttribute};

/// Reader of the elements that the header declares.
pub(super) struct Body<'h> {
    header: &'h Header,
    reader: RowReader<'h>,
}

impl<'h> Body<'h> {
    /// Creates a reader that works in pieces.
    pub fn new(header: &'h Header, limits: &'h MeshLimits, pieces: PieceReader<'h>) -> Self {
        Self { header, reader: RowReader::new(limits, pieces) }
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
                "vertex" => read_vertices(&self.reader, element, &mut values, &mut parts)?,
                "face" => self.read_faces(element, &mut values, &mut parts, &mut corners)?,
                "tristrips" => self.read_strips(element, &mut values, &mut parts, &mut corners)?,
                _ => skip_element(element, &mut values, &mut parts.warnings)?,
            }
        }
        values.end()?;
        corners
            .map_or(Ok(()), |corners| corners.replace(&mut parts, self.reader.limits, self.reader.pieces.control))?;
        drop_short_arrays(&mut parts);
        parts.assemble()
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
        parts.warnings.extend(columns.attributes.warning.clone());
        let vertices = self.vertices()?;
        // All rows are known to fit into the file, and most faces are one triangle.
        let most = element.count.min(u64::from(self.reader.limits.triangles));
        if corners.is_none() && parts.faces.len() == 0 {
            parts.faces = Faces::with_capacity(usize::try_from(most).unwrap_or(0));
        }
        parts.face_attributes = columns.attributes.empty(AttributeDomain::Face, usize::try_from(most).unwrap_or(0));
        self.reader.read(
            element,
            values,
            |rows| read_piece(element, &columns, rows, vertices, self.reader.limits),
            |FacePiece { welded, colors, attributes, missing }| {
                parts.face_colors.extend(colors);
                attributes::append(&mut parts.face_attributes, attributes);
                match corners {
                    Some(corners) => {
                        corners.missing += missing;
                        corners.welded.append(welded, self.reader.limits)
                    }
                    None => parts.faces.append(&welded.faces, 0, self.reader.limits),
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
            let add = |triangle| parts.faces.push_triangle(triangle, self.reader.limits);
            return read_strips(element, column, values, vertices, add);
        };
        let mut piece = WeldedPiece::default();
        let mut add = |mut triangle: [u32; 3]| {
            corners.missing += 1;
            corners::push(&mut piece, &mut triangle, &[], self.reader.limits).map(|_| ())
        };
        read_strips(element, column, values, vertices, &mut add)?;
        corners.welded.append(piece, self.reader.limits)
    }

    /// Number of vertices that the header declares, within the limits.
    fn vertices(&self) -> Result<u64, MeshErrorKind> {
        let element = self.header.elements.iter().find(|element| element.name == "vertex");
        let count = element.map_or(0, |element| element.count);
        self.reader.limits.check_vertices(count).map(|()| count)
    }
}

/// Drops colors and attributes of faces if strips added triangles without them.
fn drop_short_arrays(parts: &mut MeshParts) {
    let triangles = parts.faces.len();
    let colors = &parts.face_colors;
    if colors.values.len() != colors.channels.saturating_mul(triangles) {
        parts.warnings.push("colors of faces are ignored: triangle strips have none".to_owned());
        parts.face_colors = Colors::default();
    }
    let fits =
        |attribute: &MeshAttribute| attribute.data.len() == (attribute.channels as usize).saturating_mul(triangles);
    if !parts.face_attributes.iter().all(|(_, attribute)| fits(attribute)) {
        parts.warnings.push("attributes of faces are ignored: triangle strips have none".to_owned());
        parts.face_attributes.clear();
    }
}

/// Rejects row counts for which the file is too short, before memory is allocated for them.
pub(super) fn check_counts(header: &Header, values: &impl Values) -> Result<(), MeshErrorKind> {
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
    attributes: AttributeColumns,
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
        let (coordinates, attributes) = (corners::column(element), AttributeColumns::of(element));
        Ok(Self { indices, color, coordinates, attributes })
    }

    /// Whether a column is read.
    fn has(&self, column: usize) -> bool {
        let is_list = column == self.indices || self.coordinates == Some(column);
        is_list || self.channel(column).is_some() || self.attributes.slot(column).is_some()
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
    /// Attributes of the triangles.
    attributes: NamedAttributes,
    /// Number of faces whose surface coordinates do not fit their corners.
    missing: u64,
}

/// Values of a row, whose memory the next row uses again.
#[derive(Default)]
struct FaceRow {
    corners: Vec<u32>,
    coordinates: Vec<f32>,
    color: [f32; 4],
    /// Numbers of the attributes.
    numbers: Vec<f32>,
}

impl FaceRow {
    fn read(
        &mut self,
        element: &Element,
        columns: &FaceColumns,
        values: &mut impl Values,
        vertices: u64,
    ) -> Result<(), MeshErrorKind> {
        values.begin_row()?;
        for (index, property) in element.properties.iter().enumerate() {
            match (property.length, columns.channel(index)) {
                (Some(length), _) if index == columns.indices => {
                    read_corners(values, length, property.item, vertices, &mut self.corners)?;
                }
                (Some(length), _) if columns.coordinates == Some(index) => {
                    corners::read_coordinates(values, (length, property.item), &mut self.coordinates)?;
                }
                (None, Some((color, channel))) => {
                    let number = finite_number(values, property)?;
                    if let Some(entry) = self.color.get_mut(channel) {
                        *entry = color.linear(channel, number);
                    }
                }
                _ => match columns.attributes.slot(index).and_then(|slot| self.numbers.get_mut(slot)) {
                    Some(number) => *number = attributes::read_number(values, property)?,
                    None => skip(property, values)?,
                },
            }
        }
        values.end_row()
    }
}

/// Reads rows as faces.
fn read_piece(
    element: &Element,
    columns: &FaceColumns,
    mut rows: Rows<impl Values>,
    vertices: u64,
    limits: &MeshLimits,
) -> Result<FacePiece, MeshErrorKind> {
    let channels = columns.color.as_ref().map_or(0, ColorColumns::channels);
    let count = usize::try_from(rows.count).unwrap_or(0);
    let mut piece = FacePiece { colors: Colors { channels, values: Vec::new() }, ..FacePiece::default() };
    piece.welded.faces = Faces::with_capacity(count);
    piece.attributes = columns.attributes.empty(AttributeDomain::Face, count);
    let mut row = FaceRow { numbers: vec![0.0; columns.attributes.slots()], ..FaceRow::default() };
    for _ in 0..rows.count {
        row.read(element, columns, &mut rows.values, vertices)?;
        match columns.coordinates {
            Some(_) => {
                let fits = corners::push(&mut piece.welded, &mut row.corners, &row.coordinates, limits)?;
                piece.missing += u64::from(!fits);
            }
            None => piece.welded.faces.push(&row.corners, limits)?,
        }
        // A polygon of n corners becomes n - 2 triangles, all of its color and attributes.
        for _ in 2..row.corners.len() {
            piece.colors.values.extend(row.color.iter().take(channels));
            attributes::push_row(&mut piece.attributes, &row.numbers);
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

/// Skips the rows of an element, with a warning.
pub(super) fn skip_element(
    element: &Element,
    values: &mut impl Values,
    warnings: &mut Vec<String>,
) -> Result<(), MeshErrorKind> {
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
