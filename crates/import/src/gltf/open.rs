//! Opening of a file: container, document and structure, without the contents of buffers.

use super::Files;
use super::check;
use super::container::Container;
use super::data::GltfData;
use super::document::Document;
use super::error::GltfError;
use super::json::{self, Json};
use super::limits::Limits;
use super::warning::Warnings;
use std::ops::Range;

/// A glTF file whose document is valid: all indices exist, all ranges are inside their buffers, and
/// the nodes are trees.
#[derive(Clone, Debug)]
pub struct Gltf {
    /// Name of the file in messages.
    pub name: String,
    /// The document.
    pub document: Document,
    /// Warnings about container and document.
    pub warnings: Warnings,
    /// Limits of the file.
    pub limits: Limits,
    /// Bytes of the file; empty if they are JSON only.
    pub(super) bytes: Vec<u8>,
    /// Chunk BIN of a `.glb`.
    pub(super) binary: Option<Range<usize>>,
    /// Length of the file in bytes.
    pub(super) length: u64,
    /// Length of its JSON in bytes.
    pub(super) json_length: u64,
}

impl Gltf {
    /// Opens a `.gltf` or `.glb`; the content determines which. The name is that of messages.
    ///
    /// # Errors
    ///
    /// The container, the JSON or the structure of the document is not valid, a limit is exceeded,
    /// or the document requires an unknown extension.
    pub fn open(name: impl Into<String>, bytes: Vec<u8>, limits: &Limits) -> Result<Self, GltfError> {
        let name = name.into();
        let container = match Container::parse(&name, &bytes, limits) {
            Ok(container) => container,
            Err(fault) => return Err(GltfError::new(name, fault)),
        };
        let text = bytes.get(container.json.clone()).unwrap_or_default();
        let offset = container.is_binary.then_some(container.json.start);
        let document = match json::parse(Json { text, offset }, limits) {
            Ok(document) => document,
            Err(fault) => return Err(GltfError::new(name, fault)),
        };
        let Container { binary, mut warnings, json, .. } = container;
        let binary_bytes = binary.as_ref().map(|range| range.len() as u64);
        warnings.append(check::check(&name, &document, binary_bytes, limits)?);
        let (length, json_length) = (bytes.len() as u64, json.len() as u64);
        let bytes = if binary.is_some() { bytes } else { Vec::new() };
        Ok(Self { name, document, warnings, limits: *limits, bytes, binary, length, json_length })
    }

    /// Loads the buffers.
    ///
    /// # Errors
    ///
    /// A buffer is missing, too large or too short, or its data URI is not valid. All faults are
    /// reported at once.
    pub fn load(self, files: &dyn Files) -> Result<GltfData, GltfError> {
        GltfData::load(self, files)
    }
}
