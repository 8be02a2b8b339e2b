//! Meshes of the extension `KHR_draco_mesh_compression`, by the crate `draco-core` (feature
//! `draco`).
//!
//! The decoder runs behind [`DracoLimits`], which the caller takes from the document. The length of
//! the stream is no limit: a flat grid has no information but its size, and a million triangles fit
//! into 44 kB. The result is checked before it is used. Without the feature, [`decode`] refuses every
//! stream with [`DracoError::Disabled`].

use super::document::ComponentType;

/// Limits of a decoded mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DracoLimits {
    /// Maximum number of triangles: that of the primitive's accessors.
    pub triangles: u64,
    /// Maximum number of bytes of indices and requested attributes.
    pub bytes: u64,
}

/// An attribute of a primitive that the stream holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DracoAttribute<'a> {
    /// Name in the primitive, such as `POSITION`.
    pub name: &'a str,
    /// Identifier in the stream, from the extension's `attributes`.
    pub unique_id: u32,
    /// Component type of the accessor.
    pub component: ComponentType,
    /// Number of components per vertex, from the accessor's `type`.
    pub components: usize,
}

/// Decoded mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DracoMesh {
    /// Vertices of the triangles, three per triangle, all below `vertices`.
    pub indices: Vec<u32>,
    /// Number of vertices. It can differ from the `count` of the accessors, because Draco splits
    /// vertices where attributes are discontinuous.
    pub vertices: usize,
    /// Values of each requested attribute, in the order of the request: little-endian, without
    /// padding.
    pub attributes: Vec<Vec<u8>>,
}

/// Why a stream cannot be decoded.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DracoError {
    /// This build has no decoder.
    #[error("KHR_draco_mesh_compression cannot be read: this program was built without the feature `draco`")]
    Disabled,
    /// The stream is not a Draco mesh of version 2.
    #[error("the stream is no Draco mesh of version 2")]
    NotAMesh,
    /// The decoder refused the stream.
    #[error("the Draco stream cannot be decoded: {message}")]
    Decoder {
        /// Message of the decoder.
        message: String,
    },
    /// The stream has no triangles.
    #[error("the Draco stream has no triangles")]
    NoTriangles,
    /// A triangle refers to a vertex that does not exist.
    #[error("triangle {triangle} has vertex {index}, there are {vertices} vertices")]
    Index {
        /// Number of the triangle.
        triangle: usize,
        /// Index of the vertex.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// The stream has no attribute of this identifier.
    #[error("{name} is attribute {unique_id}, which the Draco stream does not have")]
    NoAttribute {
        /// Name in the primitive.
        name: String,
        /// Identifier in the stream.
        unique_id: u32,
    },
    /// The stream and the accessor have different numbers of components.
    #[error("{name} has {found} components in the Draco stream, its accessor has {expected}")]
    Components {
        /// Name in the primitive.
        name: String,
        /// Number of components in the stream.
        found: usize,
        /// Number of components of the accessor.
        expected: usize,
    },
    /// The values in the stream do not fit the accessor's component type.
    #[error("{name} is stored as {found} in the Draco stream, which does not fit its accessor ({})", expected.name())]
    ComponentType {
        /// Name in the primitive.
        name: String,
        /// Type in the stream.
        found: String,
        /// Type of the accessor.
        expected: ComponentType,
    },
    /// A vertex has no value of an attribute.
    #[error("vertex {vertex} has no {name} in the Draco stream")]
    NoValue {
        /// Name in the primitive.
        name: String,
        /// Number of the vertex.
        vertex: usize,
    },
    /// The stream has more triangles than the limit of the caller.
    #[error("the Draco stream has more triangles than the accessors of the primitive, which have {limit}")]
    Triangles {
        /// Maximum number of triangles.
        limit: u64,
    },
    /// The decoded mesh exceeds the limit of the caller.
    #[error("the Draco stream has more than {limit} bytes when decoded; export the model without Draco compression")]
    TooLarge {
        /// Maximum number of decoded bytes.
        limit: u64,
    },
}

/// Decodes a stream, with the values of these attributes, within limits.
///
/// # Errors
///
/// Always [`DracoError::Disabled`]: this build has no decoder.
#[cfg(not(feature = "draco"))]
pub fn decode(
    _stream: &[u8],
    _attributes: &[DracoAttribute<'_>],
    _limits: &DracoLimits,
) -> Result<DracoMesh, DracoError> {
    Err(DracoError::Disabled)
}

#[cfg(feature = "draco")]
pub use decoder::decode;

#[cfg(feature = "draco")]
mod decoder;

#[cfg(test)]
#[cfg(feature = "draco")]
mod tests;
