//! Binary container: a header of 12 bytes, then chunks of a length, a type and data, padded to
//! multiples of 4 bytes (glTF 2.0, section 4.4). All numbers are little-endian.
//!
//! | bytes | header | chunk |
//! |---|---|---|
//! | 0..4 | `glTF` | length of the data |
//! | 4..8 | version | type: `JSON`, `BIN` or another, which is skipped |
//! | 8..12 | length of the file | data |

use super::Container;
use crate::gltf::error::{Fault, Place};
use crate::gltf::warning::Warnings;
use std::ops::Range;

/// First bytes of a file.
pub(super) const MAGIC: &[u8] = b"glTF";
/// Type of the chunk of the JSON text.
const JSON: &[u8] = b"JSON";
/// Type of the chunk of the first buffer.
const BIN: &[u8] = b"BIN\0";
/// Length of the header of the file.
const HEADER: usize = 12;
/// Length of the header of a chunk.
const CHUNK_HEADER: usize = 8;

/// A chunk of a file.
struct Chunk<'b> {
    /// The four characters of the type.
    kind: &'b [u8],
    data: Range<usize>,
}

/// Finds the chunks of a file that begins with [`MAGIC`].
pub(super) fn parse(bytes: &[u8]) -> Result<Container, Fault> {
    let mut warnings = Warnings::default();
    let length = header(bytes, &mut warnings)?;
    let json = chunk(bytes, HEADER)?;
    if json.kind != JSON {
        let text = format!("the first chunk is {}, expected JSON", name(json.kind));
        return Err(fault(HEADER + 4, text));
    }
    let mut binary = None;
    let mut position = json.data.end;
    while position < length {
        let chunk = chunk(bytes, position)?;
        if !chunk.data.len().is_multiple_of(4) {
            let text = "the length of a chunk is no multiple of 4";
            warnings.add_at(Place::Byte(position as u64), text);
        }
        match chunk.kind {
            BIN if binary.is_none() => binary = Some(chunk.data.clone()),
            BIN | JSON => {
                warnings.add_at(Place::Byte(position as u64), "a chunk is ignored: it is not the first of its type");
            }
            // The specification requires that chunks of unknown types are ignored.
            _ => {}
        }
        position = chunk.data.end;
    }
    Ok(Container { is_binary: true, json: unpadded(bytes, json.data), binary, warnings })
}

/// Checks the header; returns the length of the file.
fn header(bytes: &[u8], warnings: &mut Warnings) -> Result<usize, Fault> {
    let (Some(version), Some(length)) = (number(bytes, 4), number(bytes, 8)) else {
        return Err(fault(0, format!("the header has {HEADER} bytes, the file has {}", bytes.len())));
    };
    match version {
        2 => {}
        1 => return Err(fault(4, "glTF 1.0; convert it first")),
        _ => return Err(fault(4, format!("version {version} of the container cannot be read, expected 2"))),
    }
    if length > bytes.len() {
        return Err(fault(8, format!("the header says {length} bytes, the file has {}", bytes.len())));
    }
    if length < bytes.len() {
        let text = format!("the header says {length} bytes, the file has {}; the rest is ignored", bytes.len());
        warnings.add_at(Place::Byte(8), text);
    }
    Ok(length)
}

/// The chunk at a position.
fn chunk(bytes: &[u8], position: usize) -> Result<Chunk<'_>, Fault> {
    let after = position.saturating_add(CHUNK_HEADER);
    let kind = bytes.get(position.saturating_add(4)..after);
    let (Some(length), Some(kind)) = (number(bytes, position), kind) else {
        let left = bytes.len().saturating_sub(position);
        return Err(fault(position, format!("the header of a chunk has {CHUNK_HEADER} bytes, {left} are left")));
    };
    let end = after.checked_add(length).filter(|end| *end <= bytes.len());
    let Some(end) = end else {
        let text = format!("the {} chunk says {length} bytes, the file has {}", name(kind), bytes.len());
        return Err(fault(position, text));
    };
    Ok(Chunk { kind, data: after..end })
}

/// The JSON text without zeros at its end: some writers pad with them instead of spaces.
fn unpadded(bytes: &[u8], mut json: Range<usize>) -> Range<usize> {
    while json.end > json.start && bytes.get(json.end - 1) == Some(&0) {
        json.end -= 1;
    }
    json
}

/// The 32-bit number at a position.
fn number(bytes: &[u8], position: usize) -> Option<usize> {
    let (four, _) = bytes.get(position..)?.split_first_chunk::<4>()?;
    usize::try_from(u32::from_le_bytes(*four)).ok()
}

/// Name of a type of chunks in a message.
fn name(kind: &[u8]) -> String {
    let kind = kind.strip_suffix(b"\0").unwrap_or(kind);
    match kind.iter().all(u8::is_ascii_graphic) {
        true => String::from_utf8_lossy(kind).into_owned(),
        false => format!("{kind:02x?}"),
    }
}

fn fault(position: usize, text: impl std::fmt::Display) -> Fault {
    Fault::new(Place::Byte(position as u64), text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gltf::limits::Limits;

    fn glb(version: u32, chunks: &[(&[u8], &[u8])]) -> Vec<u8> {
        let body: Vec<u8> = chunks
            .iter()
            .flat_map(|(kind, data)| [&(data.len() as u32).to_le_bytes(), *kind, *data].concat())
            .collect();
        let length = (HEADER + body.len()) as u32;
        [MAGIC, &version.to_le_bytes(), &length.to_le_bytes(), &body].concat()
    }

    fn message(bytes: &[u8]) -> String {
        Container::parse("a.glb", bytes, &Limits::default()).unwrap_err().to_string()
    }

    #[test]
    fn finds_json_and_the_buffer_and_skips_unknown_chunks() {
        let bytes = glb(2, &[(JSON, b"{}  "), (b"ABCD", b"1234"), (BIN, b"5678"), (BIN, b"9999")]);
        let container = Container::parse("a.glb", &bytes, &Limits::default()).unwrap();
        assert!(container.is_binary);
        assert_eq!(bytes[container.json.clone()], *b"{}  ");
        assert_eq!(bytes[container.binary.clone().unwrap()], *b"5678");
        assert_eq!(container.warnings.list().len(), 1, "{:?}", container.warnings);
        let zeros = glb(2, &[(JSON, b"{}\0\0")]);
        assert_eq!(zeros[parse(&zeros).unwrap().json], *b"{}");
    }

    #[test]
    fn lengths_are_checked() {
        let mut bytes = glb(2, &[(JSON, b"{}  "), (BIN, b"5678")]);
        bytes.push(7);
        let container = parse(&bytes).unwrap();
        let text = "byte 8: the header says 36 bytes, the file has 37; the rest is ignored";
        assert_eq!(container.warnings.list()[0].to_string(), text);
        bytes.truncate(30);
        assert_eq!(message(&bytes), "byte 8: the header says 36 bytes, the file has 30");
        bytes[8] = 30;
        assert_eq!(message(&bytes), "byte 24: the header of a chunk has 8 bytes, 6 are left");
        bytes[12] = 100;
        assert_eq!(message(&bytes), "byte 12: the JSON chunk says 100 bytes, the file has 30");
        assert_eq!(message(b"glTF\x02"), "byte 0: the header has 12 bytes, the file has 5");
    }

    #[test]
    fn other_versions_and_types_are_refused() {
        assert_eq!(message(&glb(1, &[])), "byte 4: glTF 1.0; convert it first");
        assert_eq!(message(&glb(3, &[])), "byte 4: version 3 of the container cannot be read, expected 2");
        assert_eq!(message(&glb(2, &[(BIN, b"1234")])), "byte 16: the first chunk is BIN, expected JSON");
        assert_eq!(message(&glb(2, &[])), "byte 12: the header of a chunk has 8 bytes, 0 are left");
    }

    #[test]
    fn the_content_determines_the_container() {
        let bytes = glb(2, &[(JSON, b"{}  ")]);
        let limits = Limits::default();
        let container = Container::parse("a.GLTF", &bytes, &limits).unwrap();
        assert!(container.is_binary && container.warnings.list().len() == 1);
        let container = Container::parse("a.glb", b"\xef\xbb\xbf{}", &limits).unwrap();
        assert!(!container.is_binary && container.json == (3..5) && container.warnings.list().len() == 2);
        assert!(Container::parse("a.gltf", b"{}", &limits).unwrap().warnings.list().is_empty());
        for text in [&b"no model"[..], b" <html>", b"v 0 0 0\n", b"\x00{"] {
            let expected = "byte 0: this is no glTF file: a binary one begins with `glTF`, a text with `{`";
            assert_eq!(Container::parse("a.glb", text, &limits).unwrap_err().to_string(), expected);
        }
        assert!(Container::parse("a.gltf", b"\n {", &limits).is_ok());
    }

    #[test]
    fn sizes_are_limited() {
        let bytes = glb(2, &[(JSON, b"{}  ")]);
        let limits = Limits { json_bytes: 3, ..Limits::default() };
        let error = Container::parse("a.glb", &bytes, &limits).unwrap_err().to_string();
        assert_eq!(error, "byte 20: the JSON text has 4 bytes, the limit is 3");
        let limits = Limits { file_bytes: 20, ..Limits::default() };
        let error = Container::parse("a.glb", &bytes, &limits).unwrap_err().to_string();
        assert_eq!(error, "byte 0: the file has 24 bytes, the limit is 20");
    }
}
