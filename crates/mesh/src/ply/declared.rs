//! Counts that the header of a PLY declares, for estimates made without reading the rest.

use super::attributes::AttributeColumns;
use super::colors::ColorColumns;
use super::corners;
use super::header::{Element, Encoding, Header};
use super::vertices::bytes_of_vertex;
use crate::text::Scanner;
use crate::weld::Key;

/// Declared counts of a file.
pub(crate) struct DeclaredCounts {
    /// Number of rows of the element `vertex`.
    pub vertices: u64,
    /// Bytes of a vertex in the mesh.
    pub vertex_bytes: u64,
    /// Bytes of the color and the attributes of a triangle in the mesh.
    pub face_bytes: u64,
    /// Number of rows of the element `face`.
    pub faces: u64,
    /// Upper bound of the number of corners of all faces, from the length of a binary file; `None`
    /// for a text.
    pub corners: Option<u64>,
}

/// Reads the counts from the first bytes of a file of `size` bytes. `None` if they are no PLY
/// header or declare more rows than the file has bytes.
pub(crate) fn declared(head: &[u8], size: u64) -> Option<DeclaredCounts> {
    let mut scanner = Scanner::new(head);
    let header = Header::read(&mut scanner).ok()?;
    let element = |name: &str| header.elements.iter().find(|element| element.name == name);
    let (vertex, strips) = (element("vertex")?, element("tristrips"));
    let face = element("face").or(strips)?;
    if vertex.count > size || face.count > size {
        return None;
    }
    let corners = match header.encoding {
        // Each index of a strip takes a digit and a blank, and may be a triangle.
        Encoding::Ascii if strips.is_some() => Some(size / 2),
        Encoding::Ascii => None,
        Encoding::Binary(_) => {
            let rows: u64 =
                header.elements.iter().map(least_bytes).fold(scanner.position() as u64, u64::saturating_add);
            let lists = face.properties.iter().chain(strips.iter().flat_map(|strips| &strips.properties));
            let lists = lists.filter(|property| property.length.is_some());
            let index = lists.map(|property| property.item.size()).min().unwrap_or(4);
            Some(size.saturating_sub(rows) / index)
        }
    };
    let face_bytes = ColorColumns::of(face).map_or(0, |color| color.bytes()) + AttributeColumns::of(face).bytes();
    let vertex_bytes = bytes_of_vertex(vertex);
    // Corners with surface coordinates may all become vertices of their own.
    let (mut vertices, mut vertex_bytes) = (vertex.count, vertex_bytes);
    if corners::column(face).is_some() {
        vertices = vertices.max(corners.unwrap_or(face.count.saturating_mul(3)));
        vertex_bytes += 8 + size_of::<Key>() as u64;
    }
    // A strip is no face: its triangles follow from its corners.
    let faces = if face.name == "face" { face.count } else { 0 };
    Some(DeclaredCounts { vertices, vertex_bytes, face_bytes, faces, corners })
}

/// Bytes of all rows of an element in a binary file if its lists were empty.
fn least_bytes(element: &Element) -> u64 {
    let row: u64 = element.properties.iter().map(|property| property.length.unwrap_or(property.item).size()).sum();
    row.saturating_mul(element.count)
}
