//! Reading the element `vertex` of a PLY: roles of its columns, and its rows.

use super::attributes::{self, AttributeColumns};
use super::colors::ColorColumns;
use super::header::Element;
use super::rows::{RowReader, Rows, note_ignored};
use super::values::{Values, skip};
use crate::assemble::MeshParts;
use crate::error::MeshErrorKind;
use crate::text::finite;
use juggler_math::{vec2, vec3};
use juggler_shape::attribute::AttributeDomain;
use std::ops::Range;

const POSITION: [&str; 3] = ["x", "y", "z"];
const NORMAL: [&str; 3] = ["nx", "ny", "nz"];
const SURFACE: [[&str; 2]; 3] = [["u", "v"], ["s", "t"], ["texture_u", "texture_v"]];
const SECOND_SURFACE: [&str; 2] = ["u1", "v1"];
const TANGENT: [&str; 4] = ["tx", "ty", "tz", "tw"];
/// Number of values of a row: position, normal, two sets of surface coordinates, tangent, color.
const SLOTS: usize = 18;
const NORMAL_SLOTS: Range<usize> = 3..6;
const TANGENT_SLOTS: Range<usize> = 10..14;
/// First value of the color.
const COLOR: usize = 14;

/// Slot of each column's value in a row; `None` if the column is ignored. Slots from [`SLOTS`] on
/// belong to attributes.
struct Columns {
    slots: Vec<Option<usize>>,
    normals: bool,
    uvs: bool,
    uvs1: bool,
    tangents: bool,
    color: Option<ColorColumns>,
    attributes: AttributeColumns,
}

impl Columns {
    fn of(element: &Element) -> Result<Self, MeshErrorKind> {
        let mut slots = vec![None; element.properties.len()];
        if !assign(&mut slots, element, &POSITION, 0) {
            return Err(element.place.error("expected scalar properties x, y and z of the element 'vertex'"));
        }
        let normals = assign(&mut slots, element, &NORMAL, NORMAL_SLOTS.start);
        let uvs = SURFACE.iter().any(|names| assign(&mut slots, element, names, 6));
        let uvs1 = assign(&mut slots, element, &SECOND_SURFACE, 8);
        let tangents = assign(&mut slots, element, &TANGENT, TANGENT_SLOTS.start);
        let color = ColorColumns::of(element);
        let attributes = AttributeColumns::of(element);
        for (column, slot) in slots.iter_mut().enumerate().filter(|(_, slot)| slot.is_none()) {
            let channel = color.as_ref().and_then(|color| color.channel(column));
            let attribute = attributes.slot(column).map(|slot| SLOTS + slot);
            *slot = channel.map(|channel| COLOR + channel).or(attribute);
        }
        Ok(Self { slots, normals, uvs, uvs1, tangents, color, attributes })
    }
}

/// Assigns the slots from `first` on to the columns of these names. Returns false and assigns
/// nothing unless all of them exist.
fn assign(slots: &mut [Option<usize>], element: &Element, names: &[&str], first: usize) -> bool {
    let is_number = |column: &usize| element.properties.get(*column).is_some_and(|property| property.length.is_none());
    let columns: Vec<usize> = names.iter().filter_map(|name| element.column(name).filter(is_number)).collect();
    if columns.len() < names.len() {
        return false;
    }
    for (slot, column) in (first..).zip(columns) {
        if let Some(entry) = slots.get_mut(column) {
            *entry = Some(slot);
        }
    }
    true
}

/// Bytes of a vertex in the mesh.
pub(super) fn bytes_of_vertex(element: &Element) -> u64 {
    Columns::of(element).map_or(12, |columns| {
        let color = columns.color.map_or(0, |color| color.bytes());
        let bytes = |exists: bool, bytes: u64| if exists { bytes } else { 0 };
        let surface = bytes(columns.uvs, 8) + bytes(columns.uvs1, 8);
        12 + bytes(columns.normals, 12) + surface + bytes(columns.tangents, 16) + color + columns.attributes.bytes()
    })
}

/// Reads all rows. The caller has checked that the file is long enough for them.
pub(super) fn read_vertices(
    reader: &RowReader<'_>,
    element: &Element,
    values: &mut impl Values,
    parts: &mut MeshParts,
) -> Result<(), MeshErrorKind> {
    let columns = Columns::of(element)?;
    note_ignored(element, |index| columns.slots.get(index).is_some_and(Option::is_some), &mut parts.warnings);
    parts.warnings.extend(columns.attributes.warning.clone());
    reader.limits.check_vertices(element.count)?;
    reserve(parts, &columns, element.count);
    reader.read(
        element,
        values,
        |rows| read_piece(element, &columns, rows),
        |piece| {
            parts.positions.extend(piece.positions);
            parts.normals.extend(piece.normals);
            parts.uvs.extend(piece.uvs);
            parts.uvs1.extend(piece.uvs1);
            parts.tangents.extend(piece.tangents);
            parts.vertex_colors.extend(piece.vertex_colors);
            attributes::append(&mut parts.vertex_attributes, piece.vertex_attributes);
            Ok(())
        },
    )
}

fn reserve(parts: &mut MeshParts, columns: &Columns, count: u64) {
    let count = usize::try_from(count).unwrap_or(0);
    parts.positions.reserve_exact(count);
    parts.normals.reserve_exact(if columns.normals { count } else { 0 });
    parts.uvs.reserve_exact(if columns.uvs { count } else { 0 });
    parts.uvs1.reserve_exact(if columns.uvs1 { count } else { 0 });
    parts.tangents.reserve_exact(if columns.tangents { count } else { 0 });
    let channels = columns.color.as_ref().map_or(0, ColorColumns::channels);
    parts.vertex_colors.channels = channels;
    parts.vertex_colors.values.reserve_exact(count.saturating_mul(channels));
    parts.vertex_attributes = columns.attributes.empty(AttributeDomain::Vertex, count);
}

fn read_piece(element: &Element, columns: &Columns, mut rows: Rows<impl Values>) -> Result<MeshParts, MeshErrorKind> {
    let mut parts = MeshParts::default();
    reserve(&mut parts, columns, rows.count);
    let mut numbers = vec![0.0; columns.attributes.slots()];
    for _ in 0..rows.count {
        let [x, y, z, nx, ny, nz, u, v, u1, v1, tx, ty, tz, tw, color @ ..] =
            read_row(element, columns, &mut rows.values, &mut numbers)?;
        parts.positions.push(vec3(x, y, z));
        if columns.normals {
            parts.normals.push(vec3(nx, ny, nz));
        }
        if columns.uvs {
            parts.uvs.push(vec2(u, v));
        }
        if columns.uvs1 {
            parts.uvs1.push(vec2(u1, v1));
        }
        if columns.tangents {
            parts.tangents.push([tx, ty, tz, tw]);
        }
        if let Some(columns) = &columns.color {
            let color = color.into_iter().take(columns.channels()).enumerate();
            parts.vertex_colors.values.extend(color.map(|(channel, number)| columns.linear(channel, number)));
        }
        attributes::push_row(&mut parts.vertex_attributes, &numbers);
    }
    Ok(parts)
}

/// Reads a row; the numbers of its attributes go to `numbers`.
fn read_row(
    element: &Element,
    columns: &Columns,
    values: &mut impl Values,
    numbers: &mut [f32],
) -> Result<[f32; SLOTS], MeshErrorKind> {
    let mut row = [0.0; SLOTS];
    values.begin_row()?;
    for (property, slot) in element.properties.iter().zip(&columns.slots) {
        let Some(entry) = slot.and_then(|slot| row.get_mut(slot)) else {
            match slot.and_then(|slot| numbers.get_mut(slot - SLOTS)) {
                Some(number) => *number = attributes::read_number(values, property)?,
                None => skip(property, values)?,
            }
            continue;
        };
        let place = values.place();
        *entry = values.real(property.item, &property.name)?;
        // `MeshParts::assemble` repairs normals and tangents that are not finite.
        if !slot.is_some_and(|slot| NORMAL_SLOTS.contains(&slot) || TANGENT_SLOTS.contains(&slot)) {
            finite(*entry, place, &property.name)?;
        }
    }
    values.end_row()?;
    Ok(row)
}
