//! Tests of the writer: what it writes is read again.

use super::*;
use crate::{MeshLimits, parse};
use juggler_math::{Vec2, Vec3};
use juggler_shape::attribute::AttributeData;
use std::path::Path;

fn read(mesh: &MeshData) -> MeshData {
    let bytes = ply_bytes(mesh);
    let file = parse(Path::new("a.ply"), &bytes, &MeshLimits::default()).unwrap();
    assert!(file.warnings.is_empty(), "{:?}", file.warnings);
    file.mesh
}

#[test]
fn meshes_are_read_as_they_were_written() {
    let positions: Vec<Vec3> = (0..5).map(|i| Vec3::new(i as f32 / 3.0, (i * i) as f32, -0.0)).collect();
    let triangles = vec![[0, 1, 2], [2, 1, 3], [4, 0, 3]];
    let plain = MeshData { positions: positions.clone(), triangles, ..MeshData::default() };
    assert_eq!(read(&plain), plain);
    let color = MeshAttribute {
        channels: 4,
        data: AttributeData::F32((0..20).map(|i| i as f32 / 19.0).collect()),
        ..MeshAttribute::default()
    };
    let full = MeshData {
        normals: positions.iter().map(|p| Vec3::ONE + *p).collect(),
        uvs: positions.iter().map(|p| Vec2::new(p.x, 1.0 - p.y)).collect(),
        uvs1: positions.iter().map(|p| Vec2::new(-p.y, p.x)).collect(),
        tangents: positions.iter().map(|p| [1.0, p.x, 0.0, if p.x > 0.5 { -1.0 } else { 1.0 }]).collect(),
        attributes: [("color".to_owned(), color.clone())].into(),
        ..plain.clone()
    };
    assert_eq!(read(&full), full);
}

#[test]
fn attributes_of_every_type_and_domain_are_read_as_they_were_written() {
    let count = |domain| if domain == AttributeDomain::Vertex { 4 } else { 2 };
    let mut mesh = MeshData {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE],
        triangles: vec![[0, 1, 2], [2, 1, 3]],
        ..MeshData::default()
    };
    for (domain, channels) in
        [AttributeDomain::Vertex, AttributeDomain::Face].into_iter().flat_map(|d| [1, 2, 3, 4].map(|c| (d, c)))
    {
        let numbers = 0..count(domain) * channels;
        let name = |kind: &str| format!("{kind} {channels} {domain:?}");
        let data = [
            (name("bytes"), AttributeData::U8(numbers.clone().map(|i| 255 - 16 * i as u8).collect())),
            (name("words"), AttributeData::U16(numbers.clone().map(|i| 65535 - 4001 * i as u16).collect())),
            (name("floats"), AttributeData::F32(numbers.map(|i| 1e-3 - i as f32 / 7.0).collect())),
        ];
        let all = data.map(|(name, data)| (name, MeshAttribute { domain, channels, data }));
        mesh.attributes.extend(all);
    }
    assert_eq!(mesh.attributes.len(), 24);
    // Colors of every type and domain, beside the others.
    let bytes = AttributeData::U8((0..12).collect());
    let faces = AttributeData::F32((0..6).map(|i| i as f32).collect());
    for (domain, channels, data) in [
        (AttributeDomain::Vertex, 3, bytes),
        (AttributeDomain::Face, 3, faces.clone()),
        (AttributeDomain::Face, 3, AttributeData::U16((0..6).collect())),
        (AttributeDomain::Vertex, 1, AttributeData::F32(vec![0.5; 4])),
        (AttributeDomain::Vertex, 3, AttributeData::F32(vec![0.5; 12])),
    ] {
        mesh.attributes.insert("color".to_owned(), MeshAttribute { domain, channels, data });
        assert_eq!(read(&mesh), mesh);
    }
    // Other programs find colors of floats.
    assert!(String::from_utf8_lossy(&ply_bytes(&mesh)).contains("property float red\nproperty float green\n"));
}
