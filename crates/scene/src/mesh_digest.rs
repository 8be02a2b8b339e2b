//! Hash of the arrays of a mesh, without a copy of them.

use crate::array_hasher::ArrayHasher;
use juggler_shape::MeshData;

/// BLAKE3 hash of all arrays of a mesh.
pub fn digest(mesh: &MeshData) -> [u8; 32] {
    let MeshData { positions, triangles, normals, uvs, uvs1, tangents, attributes } = mesh;
    // No file begins like this, so a file and a mesh never have the same hash.
    let mut hasher = ArrayHasher::new(b"mesh in memory\0");
    hasher.array(positions, |position| position.to_array().map(f32::to_le_bytes));
    hasher.array(triangles, |triangle| triangle.map(u32::to_le_bytes));
    hasher.array(normals, |normal| normal.to_array().map(f32::to_le_bytes));
    hasher.array(uvs, |uv| uv.to_array().map(f32::to_le_bytes));
    hasher.array(uvs1, |uv| uv.to_array().map(f32::to_le_bytes));
    hasher.array(tangents, |tangent| tangent.map(f32::to_le_bytes));
    for (name, attribute) in attributes {
        hasher.attribute(name, attribute);
    }
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::{Vec2, Vec3};
    use juggler_shape::attribute::{AttributeData, AttributeDomain, MeshAttribute};
    use std::collections::BTreeSet;

    #[test]
    fn every_array_and_every_number_counts() {
        let attribute = |channels, data| MeshAttribute { channels, data, domain: AttributeDomain::Vertex };
        let plain = MeshData { positions: vec![Vec3::ZERO, Vec3::X], ..MeshData::default() };
        let with = |name: &str, attribute: MeshAttribute| MeshData {
            attributes: [(name.to_owned(), attribute)].into(),
            ..plain.clone()
        };
        let bytes = attribute(1, AttributeData::U8(vec![1, 0]));
        let face = MeshAttribute { domain: AttributeDomain::Face, ..bytes.clone() };
        let meshes = [
            MeshData::default(),
            plain.clone(),
            MeshData { positions: vec![Vec3::ZERO, Vec3::new(1.0, -0.0, 0.0)], ..MeshData::default() },
            MeshData { normals: plain.positions.clone(), ..MeshData::default() },
            MeshData { positions: plain.positions[..1].to_vec(), normals: vec![Vec3::X], ..MeshData::default() },
            MeshData { triangles: vec![[0, 1, 1]], ..plain.clone() },
            MeshData { uvs: vec![Vec2::ZERO, Vec2::X], ..plain.clone() },
            MeshData { uvs1: vec![Vec2::ZERO, Vec2::X], ..plain.clone() },
            MeshData { tangents: vec![[0.0, 0.0, 1.0, 1.0]], ..plain.clone() },
            with("a", bytes.clone()),
            with("b", bytes.clone()),
            with("a", face),
            with("a", attribute(2, bytes.data)),
            with("a", attribute(1, AttributeData::U16(vec![1]))),
            with("a", attribute(1, AttributeData::U16(vec![256]))),
            with("a", attribute(1, AttributeData::F32(vec![1.0]))),
        ];
        let digests: BTreeSet<[u8; 32]> = meshes.iter().map(digest).collect();
        assert_eq!(digests.len(), meshes.len());
    }
}
