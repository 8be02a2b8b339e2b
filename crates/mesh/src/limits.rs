//! Limits on the sizes of mesh files.

use crate::error::MeshErrorKind;

/// Maximum sizes of a mesh file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshLimits {
    /// Size of the file, in bytes.
    pub file_bytes: u64,
    /// Number of vertices in the file or in the mesh, whichever is larger.
    pub vertices: u32,
    /// Number of triangles after triangulation of polygons.
    pub triangles: u32,
}

impl Default for MeshLimits {
    /// 4 GiB, and 2^28 (268 million) vertices and triangles.
    fn default() -> Self {
        Self { file_bytes: 1 << 32, vertices: 1 << 28, triangles: 1 << 28 }
    }
}

impl MeshLimits {
    pub(crate) fn check_bytes(&self, found: u64) -> Result<(), MeshErrorKind> {
        check("bytes", found, self.file_bytes)
    }

    pub(crate) fn check_vertices(&self, found: u64) -> Result<(), MeshErrorKind> {
        check("vertices", found, u64::from(self.vertices))
    }

    pub(crate) fn check_triangles(&self, found: usize) -> Result<(), MeshErrorKind> {
        check("triangles", found as u64, u64::from(self.triangles))
    }

    /// Returns the index of the next vertex after `count` vertices, or an error beyond the limit.
    pub(crate) fn next_vertex(&self, count: usize) -> Result<u32, MeshErrorKind> {
        match u32::try_from(count) {
            Ok(index) if index < self.vertices => Ok(index),
            _ => Err(too_many("vertices", (count as u64).saturating_add(1), u64::from(self.vertices))),
        }
    }
}

fn check(quantity: &'static str, found: u64, limit: u64) -> Result<(), MeshErrorKind> {
    if found > limit { Err(too_many(quantity, found, limit)) } else { Ok(()) }
}

/// Error about a quantity beyond its limit.
pub(crate) fn too_many(quantity: &'static str, found: u64, limit: u64) -> MeshErrorKind {
    MeshErrorKind::TooMany { quantity, found, limit }
}
