//! Buffers and buffer views (glTF 2.0, sections 3.6.1 and 3.6.1.2), and their compression
//! (EXT_meshopt_compression, KHR_meshopt_compression).

use super::number::{Index, Size};
use crate::gltf::meshopt::{Filter, Mode};
use serde::Deserialize;

/// Binary data in a file, in a data URI or in the chunk BIN.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Buffer {
    /// Name of the file or data. The first buffer of a `.glb` without URI is the chunk BIN.
    pub uri: Option<String>,
    /// Length in bytes.
    pub byte_length: Size,
    /// Name for people.
    pub name: Option<String>,
    /// Extensions.
    #[serde(default)]
    pub extensions: BufferExtensions,
}

/// Extensions of a buffer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub struct BufferExtensions {
    /// Content for readers without the decoder.
    #[serde(rename = "EXT_meshopt_compression")]
    pub ext_meshopt: Option<FallbackBuffer>,
    /// Content for readers without the decoder.
    #[serde(rename = "KHR_meshopt_compression")]
    pub khr_meshopt: Option<FallbackBuffer>,
}

/// Marks a buffer that only readers without the decoder need.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub struct FallbackBuffer {
    /// Whether the buffer is such a one; it may have no data.
    #[serde(default)]
    pub fallback: bool,
}

impl Buffer {
    /// Whether only readers without the decoder of compressed buffer views need the buffer.
    pub fn is_fallback(&self) -> bool {
        [self.extensions.ext_meshopt, self.extensions.khr_meshopt].iter().flatten().any(|extension| extension.fallback)
    }
}

/// Range of a buffer.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct BufferView {
    /// Index of the buffer.
    pub buffer: Index,
    /// Position of the first byte in the buffer.
    #[serde(default)]
    pub byte_offset: Size,
    /// Length in bytes; that of the decoded data if the view is compressed.
    pub byte_length: Size,
    /// Distance between elements of vertex attributes in bytes; `None` if they are packed.
    pub byte_stride: Option<Index>,
    /// Hint on the use: 34962 for vertex attributes, 34963 for indices.
    pub target: Option<Index>,
    /// Name for people.
    pub name: Option<String>,
    /// Extensions.
    #[serde(default)]
    pub extensions: BufferViewExtensions,
}

/// Extensions of a buffer view.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct BufferViewExtensions {
    /// Compressed data, version 0.
    #[serde(rename = "EXT_meshopt_compression")]
    pub ext_meshopt: Option<Box<CompressedView>>,
    /// Compressed data, versions 0 and 1.
    #[serde(rename = "KHR_meshopt_compression")]
    pub khr_meshopt: Option<Box<CompressedView>>,
}

impl BufferView {
    /// Compressed data that replaces the range, with the name of the extension.
    pub fn compressed(&self) -> Option<(&'static str, &CompressedView)> {
        let khr = self.extensions.khr_meshopt.as_deref().map(|view| ("KHR_meshopt_compression", view));
        khr.or_else(|| Some(("EXT_meshopt_compression", self.extensions.ext_meshopt.as_deref()?)))
    }
}

/// Compressed data of a buffer view.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct CompressedView {
    /// Index of the buffer.
    pub buffer: Index,
    /// Position of the first byte in the buffer.
    #[serde(default)]
    pub byte_offset: Size,
    /// Length in bytes.
    pub byte_length: Size,
    /// Bytes of a decoded element.
    pub byte_stride: Index,
    /// Number of decoded elements.
    pub count: Size,
    /// Codec.
    pub mode: ModeName,
    /// Conversion of the decoded elements.
    #[serde(default)]
    pub filter: FilterName,
}

/// Codec of a compressed buffer view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub struct ModeName(pub Mode);

impl TryFrom<String> for ModeName {
    type Error = String;

    fn try_from(name: String) -> Result<Self, String> {
        let unknown = || format!("unknown mode `{name}`, expected `ATTRIBUTES`, `TRIANGLES` or `INDICES`");
        Mode::from_name(&name).map(Self).ok_or_else(unknown)
    }
}

/// Conversion of decoded elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub struct FilterName(pub Filter);

impl Default for FilterName {
    fn default() -> Self {
        Self(Filter::None)
    }
}

impl TryFrom<String> for FilterName {
    type Error = String;

    fn try_from(name: String) -> Result<Self, String> {
        let known = "`NONE`, `OCTAHEDRAL`, `QUATERNION`, `EXPONENTIAL` or `COLOR`";
        Filter::from_name(&name).map(Self).ok_or_else(|| format!("unknown filter `{name}`, expected {known}"))
    }
}
