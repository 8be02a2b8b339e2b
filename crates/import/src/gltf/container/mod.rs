//! Containers: the JSON text `.gltf`, and the binary `.glb`, which holds a JSON text and a buffer
//! (glTF 2.0, section 4). The content of a file determines its container, not its name.

mod glb;

use super::error::{Fault, Place};
use super::limits::Limits;
use super::warning::Warnings;
use std::ops::Range;

/// Byte order mark of UTF-8.
const BYTE_ORDER_MARK: &[u8] = &[0xef, 0xbb, 0xbf];

/// Parts of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Container {
    /// Whether the file is a `.glb`.
    pub is_binary: bool,
    /// Bytes of the JSON text.
    pub json: Range<usize>,
    /// Bytes of the chunk BIN.
    pub binary: Option<Range<usize>>,
    /// Warnings about the container.
    pub warnings: Warnings,
}

/// Whether the content is that of a `.glb`.
pub fn is_binary(bytes: &[u8]) -> bool {
    bytes.starts_with(glb::MAGIC)
}

impl Container {
    /// Finds the parts of a file.
    ///
    /// # Errors
    ///
    /// The file or its JSON text exceeds its limit, or the chunks of a `.glb` violate the format.
    pub fn parse(name: &str, bytes: &[u8], limits: &Limits) -> Result<Self, Fault> {
        if bytes.len() as u64 > limits.file_bytes {
            let text = format!("the file has {} bytes, the limit is {}", bytes.len(), limits.file_bytes);
            return Err(Fault::new(Place::Byte(0), text));
        }
        let mut container = if is_binary(bytes) { glb::parse(bytes)? } else { text(bytes)? };
        if container.json.len() as u64 > limits.json_bytes {
            let text = format!("the JSON text has {} bytes, the limit is {}", container.json.len(), limits.json_bytes);
            return Err(Fault::new(Place::Byte(container.json.start as u64), text));
        }
        container.warn_of_name(name);
        Ok(container)
    }

    /// Warns if the ending of the name is that of the other container.
    fn warn_of_name(&mut self, name: &str) {
        let ending = name.rsplit_once('.').map(|(_, ending)| ending.to_ascii_lowercase());
        let text = match (self.is_binary, ending.as_deref()) {
            (true, Some("gltf")) => "the file is named .gltf; its content is that of a .glb",
            (false, Some("glb")) => "the file is named .glb; its content is that of a .gltf",
            _ => return,
        };
        self.warnings.add_at(Place::Byte(0), text);
    }
}

/// A JSON text, without its byte order mark.
fn text(bytes: &[u8]) -> Result<Container, Fault> {
    let mut warnings = Warnings::default();
    let has_mark = bytes.starts_with(BYTE_ORDER_MARK);
    if has_mark {
        warnings.add_at(Place::Byte(0), "the text begins with a byte order mark, which glTF forbids");
    }
    let start = if has_mark { BYTE_ORDER_MARK.len() } else { 0 };
    let first = bytes.iter().skip(start).find(|byte| !byte.is_ascii_whitespace());
    if first.is_some_and(|byte| *byte != b'{') {
        let text = "this is no glTF file: a binary one begins with `glTF`, a text with `{`";
        return Err(Fault::new(Place::Byte(0), text));
    }
    Ok(Container { is_binary: false, json: start..bytes.len(), binary: None, warnings })
}
