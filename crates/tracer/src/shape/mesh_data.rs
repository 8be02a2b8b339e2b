//! Triangles as importers bring them: bare arrays, not yet checked.

use juggler_math::{Vec2, Vec3};

/// The arrays of a triangle mesh. Importers fill it in, the mesh shape takes it and checks it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshData {
    /// Corner positions, object space, scene units.
    pub positions: Vec<Vec3>,
    /// Index triples into `positions`; the front is where the corners run counter-clockwise.
    pub triangles: Vec<[u32; 3]>,
    /// Shading normals, object space, of any length but zero: none at all, or one per position.
    pub normals: Vec<Vec3>,
    /// Surface coordinates: none at all, or one per position.
    pub uvs: Vec<Vec2>,
}
