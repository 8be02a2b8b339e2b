//! Arrays of vertices and of displacements that morph targets add to them.

use juggler_math::{Vec2, Vec3};

/// Vertices of a mesh in object space. Arrays have one element per vertex, or none where the mesh
/// lacks the attribute.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Vertices {
    /// Positions.
    pub positions: Vec<Vec3>,
    /// Unit shading normals; a zero vector stands for a missing normal.
    pub normals: Vec<Vec3>,
    /// Unit tangents x, y, z, and the sign of the bitangent.
    pub tangents: Vec<[f32; 4]>,
    /// Sets of texture coordinates.
    pub texcoords: Vec<Vec<Vec2>>,
    /// Linear colors with alpha.
    pub colors: Vec<[f32; 4]>,
}

impl Vertices {
    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        let Self { positions, normals, tangents, texcoords, colors } = self;
        let vectors = size_of_val(&**positions) + size_of_val(&**normals) + size_of_val(&**tangents);
        vectors + size_of_val(&**colors) + texcoords.iter().map(|set| size_of_val(&**set)).sum::<usize>()
    }
}

impl MorphDeltas {
    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        let Self { positions, normals, tangents, texcoords, colors } = self;
        let vectors = size_of_val(&**positions) + size_of_val(&**normals) + size_of_val(&**tangents);
        vectors + size_of_val(&**colors) + texcoords.iter().map(|set| size_of_val(&**set)).sum::<usize>()
    }
}

/// Displacements of a morph target. Arrays have one element per vertex, or none where the target
/// lacks the attribute. Displacements of attributes that the mesh lacks have no effect.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MorphDeltas {
    /// Displacements of positions.
    pub positions: Vec<Vec3>,
    /// Displacements of normals.
    pub normals: Vec<Vec3>,
    /// Displacements of the tangents' x, y and z.
    pub tangents: Vec<Vec3>,
    /// Displacements of texture coordinates, in the sets of the mesh and their orientation: where
    /// the mesh has 1 - v, these have -v.
    pub texcoords: Vec<Vec<Vec2>>,
    /// Displacements of colors with alpha.
    pub colors: Vec<[f32; 4]>,
}
