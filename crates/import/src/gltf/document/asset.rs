//! Version and origin of a document.

use serde::Deserialize;

/// Version and origin of a document (glTF 2.0, section 3.2).
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Asset {
    /// Version of glTF, `2.0`.
    pub version: String,
    /// Lowest version that a reader must support.
    pub min_version: Option<String>,
    /// Program that wrote the document.
    pub generator: Option<String>,
    /// Copyright message.
    pub copyright: Option<String>,
}
