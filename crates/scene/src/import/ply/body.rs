//! The rows of a PLY, whichever way they are written.

use super::super::assemble::Parts;
use super::super::error::{Fault, Place, quote};
use super::super::faces::Faces;
use super::super::{Imported, Limits};
use super::header::{Element, Header, Property, Scalar};
use super::vertices::read_vertices;

/// Numbers one after the other.
pub(super) trait Values {
    /// Where the next value stands (in a text: the line of the last one).
    fn place(&self) -> Place;
    /// Goes to the start of the next row.
    fn begin_row(&mut self) -> Result<(), Fault>;
    /// Makes sure that the row has no more values.
    fn end_row(&mut self) -> Result<(), Fault>;
    /// The next value, rounded once.
    fn real(&mut self, kind: Scalar, what: &str) -> Result<f32, Fault>;
    /// The next value, which must be a whole number.
    fn integer(&mut self, kind: Scalar, what: &str) -> Result<i64, Fault>;
    /// Passes over values.
    fn skip(&mut self, kind: Scalar, count: u64) -> Result<(), Fault>;
    /// The least number of bytes that a value takes up.
    fn least_size(&self, kind: Scalar) -> u64;
    /// Bytes that are left.
    fn remaining(&self) -> u64;
}

/// Reads what the header promises.
pub(super) fn read(header: &Header, mut values: impl Values, limits: &Limits) -> Result<Imported, Fault> {
    let vertices = header.elements.iter().find(|element| element.name == "vertex").map_or(0, |element| element.count);
    check_counts(header, &values)?;
    let mut parts = Parts::default();
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => read_vertices(element, &mut values, limits, &mut parts)?,
            "face" => read_faces(element, &mut values, vertices, limits, &mut parts)?,
            _ => skip_element(element, &mut values, &mut parts.warnings)?,
        }
    }
    parts.assemble()
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

fn read_faces(
    element: &Element,
    values: &mut impl Values,
    vertices: u64,
    limits: &Limits,
    parts: &mut Parts,
) -> Result<(), Fault> {
    let is_indices = |property: &Property| matches!(property.name.as_str(), "vertex_indices" | "vertex_index");
    let Some(column) = element.properties.iter().position(is_indices) else {
        return Err(element.place.fault("expected a property 'vertex_indices' of the element 'face'"));
    };
    if element.properties.get(column).is_none_or(|property| property.length.is_none()) {
        return Err(element.place.fault("expected the property 'vertex_indices' to be a list"));
    }
    note_ignored(element, |index| index == column, &mut parts.warnings);
    limits.check_vertices(vertices)?;
    // Every row has been found to have its bytes, and most are one triangle.
    let mut faces = Faces::with_capacity(usize::try_from(element.count.min(u64::from(limits.triangles))).unwrap_or(0));
    let mut corners = Vec::new();
    for _ in 0..element.count {
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
    parts.faces = faces;
    Ok(())
}

fn read_corners(
    values: &mut impl Values,
    length: Scalar,
    item: Scalar,
    vertices: u64,
    corners: &mut Vec<u32>,
) -> Result<(), Fault> {
    corners.clear();
    for _ in 0..list_length(values, length)? {
        let place = values.place();
        let index = values.integer(item, "a vertex index")?;
        match u32::try_from(index) {
            Ok(corner) if u64::from(corner) < vertices => corners.push(corner),
            _ => return Err(place.fault(format!("vertex index {index}: there are {vertices} vertices, from 0"))),
        }
    }
    Ok(())
}

fn list_length(values: &mut impl Values, kind: Scalar) -> Result<u64, Fault> {
    let place = values.place();
    let length = values.integer(kind, "the length of a list")?;
    u64::try_from(length).map_err(|_| place.fault(format!("expected the length of a list, found {length}")))
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
