//! Points of a PLY, for instances: the rows of its element `vertex`, all of whose numbers are kept.
//!
//! The columns `x y z` are positions, `qx qy qz qw` rotations as quaternions, `scale` or `scale_x
//! scale_y scale_z` scale factors, and `m00` to `m23`, row by row, 3 rows of a matrix in place of all
//! of these. `red green blue` and perhaps `alpha` are colors, decoded as those of a mesh, and
//! `end_red end_green end_blue end_alpha` linear colors too. Columns `attribute.NAME` are attributes as
//! those of a mesh. Every other column of numbers is an attribute of its name, in floats of its own
//! unit. Lists and other elements are ignored with a warning.

use super::ascii::{AsciiValues, read_text};
use super::attributes::{self, AttributeColumns, NamedAttributes};
use super::binary::BinaryValues;
use super::body::{check_counts, skip_element};
use super::colors::ColorColumns;
use super::header::{Element, Encoding, Header};
use super::rows::{RowReader, Rows, note_ignored};
use super::values::{Values, skip};
use crate::assemble::distinct;
use crate::error::{FilePosition, MeshErrorKind};
use crate::limits::MeshLimits;
use crate::pieces::{PIECE, PieceReader};
use crate::text::{Scanner, finite, without_byte_order_mark};
use juggler_math::BuildControl;
use juggler_shape::attribute::{AttributeData, AttributeDomain, MeshAttribute};
use std::collections::BTreeMap;
use std::ops::Range;

/// Names of the columns of positions.
pub(super) const POSITION: [&str; 3] = ["x", "y", "z"];
/// Names of the columns of rotations.
pub(super) const ROTATION: [&str; 4] = ["qx", "qy", "qz", "qw"];
/// Name of the column of scale factors along all axes.
pub(super) const SCALE: [&str; 1] = ["scale"];
/// Names of the columns of scale factors along each axis.
pub(super) const SCALES: [&str; 3] = ["scale_x", "scale_y", "scale_z"];
/// Names of the columns of matrices.
pub(super) const MATRIX: [&str; 12] =
    ["m00", "m01", "m02", "m03", "m10", "m11", "m12", "m13", "m20", "m21", "m22", "m23"];
/// Names of the columns of colors as they are written.
pub(super) const COLOR: [&str; 4] = ["red", "green", "blue", "alpha"];
/// Names of the columns of the second colors.
pub(super) const END_COLOR: [&str; 4] = ["end_red", "end_green", "end_blue", "end_alpha"];

/// Points of a PLY file. Arrays are empty, or have the numbers of one point after the other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointFile {
    /// Number of points.
    pub count: usize,
    /// Positions: x, y and z. Empty if there are matrices.
    pub positions: Vec<f32>,
    /// Rotations: the quaternion's x, y, z and w.
    pub rotations: Vec<f32>,
    /// Scale factors along all axes.
    pub uniform_scales: Vec<f32>,
    /// Scale factors along x, y and z.
    pub scales: Vec<f32>,
    /// 12 numbers of 3 rows of a matrix that multiplies column vectors.
    pub matrices: Vec<f32>,
    /// Colors: red, green, blue and alpha in linear light.
    pub colors: Vec<f32>,
    /// Second colors, as `colors`.
    pub end_colors: Vec<f32>,
    /// Attributes by name, in addition to colors.
    pub attributes: BTreeMap<String, MeshAttribute>,
    /// Warnings about ignored content.
    pub warnings: Vec<String>,
}

/// Parses the bytes of a PLY file as points.
///
/// # Errors
///
/// The file is no PLY, is malformed, or has no vertices with positions or matrices.
pub fn parse_points(bytes: &[u8], limits: &MeshLimits) -> Result<PointFile, MeshErrorKind> {
    limits.check_bytes(bytes.len() as u64)?;
    let bytes = without_byte_order_mark(bytes);
    let mut scanner = Scanner::new(bytes);
    let header = Header::read(&mut scanner)?;
    // Points are read fast, and nothing cancels this control.
    let control = BuildControl::new();
    let reader = RowReader::new(limits, PieceReader { size: PIECE, control: &control });
    match header.encoding {
        Encoding::Ascii => {
            let values = AsciiValues::new(scanner);
            read_text(&values, |values| read(&header, &reader, values), |file| &mut file.warnings)
        }
        Encoding::Binary(order) => read(&header, &reader, BinaryValues::new(bytes, scanner.position(), order)),
    }
}

/// Number of points that the header at the start of a file of `size` bytes declares, and the bytes of
/// each in memory; `None` if the file cannot hold them.
pub(crate) fn declared_points(head: &[u8], size: u64) -> Option<(u64, u64)> {
    let header = Header::read(&mut Scanner::new(without_byte_order_mark(head))).ok()?;
    let element = header.elements.iter().find(|element| element.name == "vertex")?;
    let columns = PointColumns::of(element).ok()?;
    (element.count <= size).then(|| (element.count, columns.bytes()))
}

fn read(header: &Header, reader: &RowReader<'_>, mut values: impl Values) -> Result<PointFile, MeshErrorKind> {
    check_counts(header, &values)?;
    let mut warnings: Vec<String> = header.warning.iter().cloned().collect();
    let mut found = None;
    for element in &header.elements {
        if element.name == "vertex" && found.is_none() {
            found = Some(read_points(element, reader, &mut values, &mut warnings)?);
        } else {
            skip_element(element, &mut values, &mut warnings)?;
        }
    }
    values.end()?;
    let Some((columns, points)) = found else {
        return Err(FilePosition::Line(1).error("expected an element 'vertex' with properties x, y and z"));
    };
    Ok(points.into_file(&columns, warnings))
}

fn read_points(
    element: &Element,
    reader: &RowReader<'_>,
    values: &mut impl Values,
    warnings: &mut Vec<String>,
) -> Result<(PointColumns, Points), MeshErrorKind> {
    let columns = PointColumns::of(element)?;
    let is_repeated =
        |index: usize| columns.has_matrices() && POSITION.iter().any(|n| element.column(n) == Some(index));
    note_ignored(element, |index| columns.slot(index).is_some() || is_repeated(index), warnings);
    warnings.extend(columns.attributes.warning.clone());
    reader.limits.check_vertices(element.count)?;
    let mut points = Points::with_capacity(&columns, element.count);
    reader.read(
        element,
        values,
        |rows| read_piece(element, &columns, rows),
        |piece| {
            points.append(piece);
            Ok(())
        },
    )?;
    Ok((columns, points))
}

/// Columns of points, and the slot of each in the numbers of a row.
struct PointColumns {
    /// Slot of each column of the element; `None` if the column is not read.
    slots: Vec<Option<usize>>,
    /// Slots of the groups of columns that exist; `None` for a group that is missing.
    groups: [Option<Range<usize>>; GROUPS.len()],
    color: Option<(ColorColumns, Range<usize>)>,
    /// Names of other columns, and the slot of the first.
    others: (Vec<String>, usize),
    /// Attributes, and the slot of the first number.
    attributes: AttributeColumns,
    first_attribute: usize,
}

/// Groups of columns, in the order of [`Points::groups`].
const GROUPS: [&[&str]; 6] = [&POSITION, &ROTATION, &SCALE, &SCALES, &MATRIX, &END_COLOR];
/// Index of the group of matrices.
const MATRICES: usize = 4;

impl PointColumns {
    fn of(element: &Element) -> Result<Self, MeshErrorKind> {
        let attributes = AttributeColumns::of(element);
        let mut columns = Self {
            slots: vec![None; element.properties.len()],
            groups: Default::default(),
            color: None,
            others: (Vec::new(), 0),
            attributes,
            first_attribute: 0,
        };
        let mut next = 0;
        let has_matrices = column_indices(element, &MATRIX).is_some();
        for (group, names) in columns.groups.iter_mut().zip(GROUPS) {
            // Matrices stand in place of the groups before them.
            let is_replaced = has_matrices && names != MATRIX.as_slice() && names != END_COLOR.as_slice();
            let Some(indices) = column_indices(element, names).filter(|_| !is_replaced) else { continue };
            *group = Some(assign(&mut columns.slots, &indices, &mut next));
        }
        if columns.groups.first().is_some_and(Option::is_none) && !has_matrices {
            return Err(element.place.error("expected scalar properties x, y and z of the element 'vertex'"));
        }
        if let Some(color) = ColorColumns::of(element) {
            let indices: Vec<usize> = (0..element.properties.len()).filter(|c| color.channel(*c).is_some()).collect();
            let first = next;
            for index in indices {
                if let (Some(slot), Some(channel)) = (columns.slots.get_mut(index), color.channel(index)) {
                    *slot = Some(first + channel);
                }
            }
            next += color.channels();
            columns.color = Some((color, first..next));
        }
        columns.assign_others(element, &mut next, has_matrices);
        columns.first_attribute = next;
        Ok(columns)
    }

    /// Assigns slots to all columns of numbers that have no meaning of their own.
    fn assign_others(&mut self, element: &Element, next: &mut usize, has_matrices: bool) {
        self.others.1 = *next;
        for (index, property) in element.properties.iter().enumerate() {
            let replaced = [POSITION.as_slice(), &ROTATION, &SCALE, &SCALES];
            let is_replaced = has_matrices && replaced.iter().any(|names| names.contains(&property.name.as_str()));
            let is_read = self.slot(index).is_some() || attributes::is_attribute(&property.name);
            if let Some(slot) = self.slots.get_mut(index)
                && !(is_read || is_replaced || property.length.is_some())
            {
                *slot = Some(*next);
                *next += 1;
                self.others.0.push(property.name.clone());
            }
        }
    }

    fn has_matrices(&self) -> bool {
        self.groups.get(MATRICES).is_some_and(Option::is_some)
    }

    /// Slot of a column in the numbers of a row; `None` if the column is not read.
    fn slot(&self, column: usize) -> Option<usize> {
        let attribute = || self.attributes.slot(column).map(|slot| self.first_attribute + slot);
        self.slots.get(column).copied().flatten().or_else(attribute)
    }

    /// Number of numbers of a row.
    fn width(&self) -> usize {
        self.first_attribute + self.attributes.slots()
    }

    /// Bytes of a point in memory.
    fn bytes(&self) -> u64 {
        let numbers: usize = self.groups.iter().flatten().map(ExactSizeIterator::len).sum();
        let colors = if self.color.is_some() { COLOR.len() } else { 0 };
        4 * (numbers + colors + self.others.0.len()) as u64 + self.attributes.bytes()
    }
}

/// Columns of these names; `None` unless all of them are numbers.
fn column_indices(element: &Element, names: &[&str]) -> Option<Vec<usize>> {
    let is_number = |column: &usize| element.properties.get(*column).is_some_and(|property| property.length.is_none());
    names.iter().map(|name| element.column(name).filter(is_number)).collect()
}

/// Assigns the next slots to columns.
fn assign(slots: &mut [Option<usize>], columns: &[usize], next: &mut usize) -> Range<usize> {
    let first = *next;
    for column in columns {
        if let Some(slot) = slots.get_mut(*column) {
            *slot = Some(*next);
        }
        *next += 1;
    }
    first..*next
}

/// Points of a piece of the file.
#[derive(Default)]
struct Points {
    /// Numbers of each group of [`GROUPS`].
    groups: [Vec<f32>; GROUPS.len()],
    colors: Vec<f32>,
    /// Numbers of each other column.
    others: Vec<Vec<f32>>,
    attributes: NamedAttributes,
    count: usize,
}

impl Points {
    fn with_capacity(columns: &PointColumns, count: u64) -> Self {
        let count = usize::try_from(count).unwrap_or(0);
        let mut points = Self::default();
        for (group, slots) in points.groups.iter_mut().zip(&columns.groups) {
            group.reserve_exact(count.saturating_mul(slots.as_ref().map_or(0, ExactSizeIterator::len)));
        }
        points.colors.reserve_exact(if columns.color.is_some() { count.saturating_mul(COLOR.len()) } else { 0 });
        points.others = columns.others.0.iter().map(|_| Vec::with_capacity(count)).collect();
        points.attributes = columns.attributes.empty(AttributeDomain::Vertex, count);
        points
    }

    fn push(&mut self, columns: &PointColumns, row: &[f32]) {
        let numbers = |slots: &Range<usize>| row.get(slots.clone()).unwrap_or_default();
        for (group, slots) in self.groups.iter_mut().zip(&columns.groups) {
            slots.iter().for_each(|slots| group.extend(numbers(slots)));
        }
        if let Some((color, slots)) = &columns.color {
            let linear = numbers(slots).iter().enumerate().map(|(channel, number)| color.linear(channel, *number));
            self.colors.extend(linear.chain([1.0]).take(COLOR.len()));
        }
        let others = row.get(columns.others.1..columns.first_attribute).unwrap_or_default();
        self.others.iter_mut().zip(others).for_each(|(values, number)| values.push(*number));
        attributes::push_row(&mut self.attributes, row.get(columns.first_attribute..).unwrap_or_default());
        self.count += 1;
    }

    fn append(&mut self, piece: Self) {
        self.groups.iter_mut().zip(piece.groups).for_each(|(group, next)| group.extend(next));
        self.colors.extend(piece.colors);
        self.others.iter_mut().zip(piece.others).for_each(|(values, next)| values.extend(next));
        attributes::append(&mut self.attributes, piece.attributes);
        self.count += piece.count;
    }

    fn into_file(self, columns: &PointColumns, mut warnings: Vec<String>) -> PointFile {
        let Self { groups, colors, others, attributes, count } = self;
        let [positions, rotations, uniform_scales, scales, matrices, end_colors] = groups;
        let other =
            |(name, numbers): (&String, Vec<f32>)| (name.clone(), MeshAttribute::new(1, AttributeData::F32(numbers)));
        let others = columns.others.0.iter().zip(others).map(other);
        let mut attributes = distinct(attributes.into_iter().chain(others), &mut warnings);
        if !colors.is_empty() && attributes.remove("color").is_some() {
            warnings.push("ignored a second attribute 'color'".to_owned());
        }
        PointFile {
            count,
            positions,
            rotations,
            uniform_scales,
            scales,
            matrices,
            colors,
            end_colors,
            attributes,
            warnings,
        }
    }
}

fn read_piece(element: &Element, columns: &PointColumns, mut rows: Rows<impl Values>) -> Result<Points, MeshErrorKind> {
    let mut points = Points::with_capacity(columns, rows.count);
    let mut row = vec![0.0; columns.width()];
    for _ in 0..rows.count {
        rows.values.begin_row()?;
        for (index, property) in element.properties.iter().enumerate() {
            let Some(slot) = columns.slot(index) else {
                skip(property, &mut rows.values)?;
                continue;
            };
            let number = if slot < columns.first_attribute {
                let place = rows.values.place();
                let number = rows.values.real(property.item, &property.name)?;
                finite(number, place, &property.name)?;
                number
            } else {
                attributes::read_number(&mut rows.values, property)?
            };
            if let Some(entry) = row.get_mut(slot) {
                *entry = number;
            }
        }
        rows.values.end_row()?;
        points.push(columns, &row);
    }
    Ok(points)
}

#[cfg(test)]
#[path = "points_tests.rs"]
mod tests;
