//! Contents of a mesh file.

use juggler_shape::MeshData;

/// Contents of a mesh file: its mesh, and the warnings of its reader.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    /// Mesh of at least one triangle, with indices in range, finite positions and texture
    /// coordinates, and finite normals of any length (zero: no normal). Degenerate triangles are
    /// kept.
    pub mesh: MeshData,
    /// Warnings about ignored and repaired content, one per kind with a count.
    pub warnings: Vec<String>,
}
