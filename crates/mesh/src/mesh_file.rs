//! Contents of a mesh file.

use juggler_shape::MeshData;

/// Maximum number of solids of an STL that [`MeshFile::solids`] tells apart.
pub const MAX_SOLIDS: usize = 65_536;

/// Contents of a mesh file: its mesh, and the warnings of its reader.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshFile {
    /// Mesh of at least one triangle, with indices in range, finite positions and texture
    /// coordinates, and finite normals of any length (zero: no normal). Degenerate triangles are
    /// kept.
    pub mesh: MeshData,
    /// Solids of an STL, in the order of the file; none in other formats. Of a file with more than
    /// [`MAX_SOLIDS`], only the first [`MAX_SOLIDS`] + 1.
    pub solids: Vec<StlSolid>,
    /// Warnings about ignored and repaired content, one per kind with a count.
    pub warnings: Vec<String>,
}

/// Solid of an STL. Its triangles end where the next solid begins; it may have none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StlSolid {
    /// Index of the first triangle.
    pub first: usize,
    /// Name of the solid: the rest of the line of its keyword. `None` without a name, or if it has
    /// more than 1024 bytes or a zero byte.
    pub name: Option<String>,
}
