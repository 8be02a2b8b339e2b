//! The element `vertex` of a PLY: which columns are what, and reading them.

use super::super::assemble::Parts;
use super::super::error::Fault;
use super::super::text::finite;
use super::body::{Body, Rows, Values, note_ignored, skip};
use super::header::Element;
use juggler_math::{vec2, vec3};

const POSITION: [&str; 3] = ["x", "y", "z"];
const NORMAL: [&str; 3] = ["nx", "ny", "nz"];
const SURFACE: [[&str; 2]; 3] = [["u", "v"], ["s", "t"], ["texture_u", "texture_v"]];
/// A row's values: position, normal, surface coordinates.
const SLOTS: usize = 8;

/// What becomes of each column: the slot of its value, or nothing.
struct Columns {
    slots: Vec<Option<usize>>,
    normals: bool,
    uvs: bool,
}

impl Columns {
    fn of(element: &Element) -> Result<Self, Fault> {
        let mut slots = vec![None; element.properties.len()];
        if !assign(&mut slots, element, &POSITION, 0) {
            return Err(element.place.fault("expected properties x, y and z of the element 'vertex', each one number"));
        }
        let normals = assign(&mut slots, element, &NORMAL, 3);
        let uvs = SURFACE.iter().any(|names| assign(&mut slots, element, names, 6));
        Ok(Self { slots, normals, uvs })
    }
}

/// Gives the columns of these names the slots from `first` on, if all are there.
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

/// Bytes that a vertex takes in the mesh.
pub(super) fn bytes_of_vertex(element: &Element) -> u64 {
    Columns::of(element)
        .map_or(12, |columns| 12 + if columns.normals { 12 } else { 0 } + if columns.uvs { 8 } else { 0 })
}

/// Reads all rows. The caller has made sure that the file is long enough for them.
pub(super) fn read_vertices(
    body: &Body<'_>,
    element: &Element,
    values: &mut impl Values,
    parts: &mut Parts,
) -> Result<(), Fault> {
    let columns = Columns::of(element)?;
    note_ignored(element, |index| columns.slots.get(index).is_some_and(Option::is_some), &mut parts.warnings);
    body.limits.check_vertices(element.count)?;
    reserve(parts, &columns, element.count);
    body.read_rows(
        element,
        values,
        |rows| read_piece(element, &columns, rows),
        |piece| {
            parts.positions.extend(piece.positions);
            parts.normals.extend(piece.normals);
            parts.uvs.extend(piece.uvs);
            Ok(())
        },
    )
}

fn reserve(parts: &mut Parts, columns: &Columns, count: u64) {
    let count = usize::try_from(count).unwrap_or(0);
    parts.positions.reserve_exact(count);
    parts.normals.reserve_exact(if columns.normals { count } else { 0 });
    parts.uvs.reserve_exact(if columns.uvs { count } else { 0 });
}

fn read_piece(element: &Element, columns: &Columns, mut rows: Rows<impl Values>) -> Result<Parts, Fault> {
    let mut parts = Parts::default();
    reserve(&mut parts, columns, rows.count);
    for _ in 0..rows.count {
        let [x, y, z, nx, ny, nz, u, v] = read_row(element, columns, &mut rows.values)?;
        parts.positions.push(vec3(x, y, z));
        if columns.normals {
            parts.normals.push(vec3(nx, ny, nz));
        }
        if columns.uvs {
            parts.uvs.push(vec2(u, v));
        }
    }
    Ok(parts)
}

fn read_row(element: &Element, columns: &Columns, values: &mut impl Values) -> Result<[f32; SLOTS], Fault> {
    let mut row = [0.0; SLOTS];
    values.begin_row()?;
    for (property, slot) in element.properties.iter().zip(&columns.slots) {
        let Some(entry) = slot.and_then(|slot| row.get_mut(slot)) else {
            skip(property, values)?;
            continue;
        };
        let place = values.place();
        *entry = values.real(property.item, &property.name)?;
        // A normal that is no direction is repaired later.
        if !matches!(slot, Some(3..6)) {
            finite(*entry, place, &property.name)?;
        }
    }
    values.end_row()?;
    Ok(row)
}
