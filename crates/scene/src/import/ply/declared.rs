//! Counts that the header of a PLY declares, for estimates made without reading the rest.

use super::super::text::Scanner;
use super::colors::ColorColumns;
use super::header::{Element, Encoding, Header};
use super::vertices::bytes_of_vertex;

/// Declared counts of a file.
pub(in super::super) struct DeclaredCounts {
    /// Number of rows of the element `vertex`.
    pub vertices: u64,
    /// Bytes of a vertex in the mesh.
    pub vertex_bytes: u64,
    /// Bytes of the color of a triangle in the mesh.
    pub face_bytes: u64,
    /// Number of rows of the element `face`.
    pub faces: u64,
    /// Upper bound of the number of corners of all faces, from the length of a binary file; `None`
    /// for a text.
    pub corners: Option<u64>,
}

/// Reads the counts from the first bytes of a file of `size` bytes. `None` if they are no PLY
/// header or declare more rows than the file has bytes.
pub(in super::super) fn declared(head: &[u8], size: u64) -> Option<DeclaredCounts> {
    let mut scanner = Scanner::new(head);
    let header = Header::read(&mut scanner).ok()?;
    let element = |name: &str| header.elements.iter().find(|element| element.name == name);
    let (vertex, face) = (element("vertex")?, element("face")?);
    if vertex.count > size || face.count > size {
        return None;
    }
    let corners = match header.encoding {
        Encoding::Ascii => None,
        Encoding::Binary(_) => {
            let rows: u64 =
                header.elements.iter().map(least_bytes).fold(scanner.position() as u64, u64::saturating_add);
            let lists = face.properties.iter().filter(|property| property.length.is_some());
            let index = lists.map(|property| property.item.size()).min().unwrap_or(4);
            Some(size.saturating_sub(rows) / index)
        }
    };
    let face_bytes = ColorColumns::of(face).map_or(0, |color| color.bytes());
    let vertex_bytes = bytes_of_vertex(vertex);
    Some(DeclaredCounts { vertices: vertex.count, vertex_bytes, face_bytes, faces: face.count, corners })
}

/// Bytes of all rows of an element in a binary file if its lists were empty.
fn least_bytes(element: &Element) -> u64 {
    let row: u64 = element.properties.iter().map(|property| property.length.unwrap_or(property.item).size()).sum();
    row.saturating_mul(element.count)
}
