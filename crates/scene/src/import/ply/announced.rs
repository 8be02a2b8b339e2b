//! What the header of a PLY announces, for who has not read more of it.

use super::super::text::Scanner;
use super::header::{Element, Encoding, Header};
use super::vertices::bytes_of_vertex;

/// What a file will be.
pub(in super::super) struct Announced {
    /// Rows of the element `vertex`.
    pub vertices: u64,
    /// Bytes that a vertex takes in the mesh.
    pub vertex: u64,
    /// Rows of the element `face`.
    pub faces: u64,
    /// Corners of all faces, or more, as far as the file's length says it: that of a text does not.
    pub corners: Option<u64>,
}

/// By the first bytes of a file of `size` bytes; nothing where they are no header, or announce more than fits.
pub(in super::super) fn announced(head: &[u8], size: u64) -> Option<Announced> {
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
    Some(Announced { vertices: vertex.count, vertex: bytes_of_vertex(vertex), faces: face.count, corners })
}

/// Bytes of all rows of an element in a binary file if its lists were empty.
fn least_bytes(element: &Element) -> u64 {
    let row: u64 = element.properties.iter().map(|property| property.length.unwrap_or(property.item).size()).sum();
    row.saturating_mul(element.count)
}
