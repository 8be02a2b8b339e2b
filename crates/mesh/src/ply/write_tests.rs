//! Tests of the writer: what it writes is read again.

use super::*;
use crate::{MeshLimits, parse};
use juggler_math::{Vec2, Vec3};
use juggler_shape::attribute::AttributeData;
use std::path::Path;

fn read(mesh: &MeshData) -> MeshData {
    let bytes = ply_bytes(mesh).unwrap();
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
    let bytes = AttributeData::U8((0..15).collect());
    let colors = MeshAttribute { channels: 3, data: bytes, ..MeshAttribute::default() };
    let from_bytes = read(&MeshData { attributes: [("color".to_owned(), colors.clone())].into(), ..plain.clone() });
    let numbers = |attribute: &MeshAttribute| (0..5).flat_map(|i| attribute.numbers(i)).collect::<Vec<_>>();
    assert_eq!(numbers(&from_bytes.attributes["color"]), numbers(&colors));
    for (name, domain) in [("heat", AttributeDomain::Vertex), ("color", AttributeDomain::Face)] {
        let other = MeshAttribute { domain, ..color.clone() };
        assert!(ply_bytes(&MeshData { attributes: [(name.to_owned(), other)].into(), ..plain.clone() }).is_none());
    }
}
