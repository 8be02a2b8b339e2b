//! Data that few meshes have: attributes, a second set of surface coordinates, tangents.

use super::*;
use crate::AnyShape;
use crate::attribute::{AttributeData, AttributeDomain};
use juggler_math::testing::{close, close3};

/// Two triangles over a square in the plane y = 0, folded by 90 degrees at their common edge.
fn folded() -> MeshData {
    let heat = MeshAttribute { channels: 1, data: AttributeData::F32(vec![0.0, 1.0, 2.0, 3.0]), ..Default::default() };
    let face = MeshAttribute { domain: AttributeDomain::Face, channels: 1, data: AttributeData::U8(vec![51, 255]) };
    MeshData {
        positions: vec![Vec3::ZERO, Vec3::Z, Vec3::X, Vec3::new(0.5, 1.0, 0.5)],
        triangles: vec![[0, 1, 2], [1, 3, 2]],
        uvs1: [[0.0, 0.0], [0.0, 2.0], [4.0, 0.0], [1.0, 1.0]].map(Vec2::from).to_vec(),
        tangents: vec![[3.0, 0.0, 0.0, -1.0]; 4],
        attributes: [("heat".to_owned(), heat), ("face".to_owned(), face)].into(),
        ..MeshData::default()
    }
}

fn point(mesh: &MeshData, triangle: u32) -> MeshPoint<'_> {
    MeshPoint::new(mesh, triangle, Vec2::new(0.25, 0.5))
}

fn assert_values(mesh: &MeshData) {
    mesh.check().unwrap();
    let (first, second) = (point(mesh, 0), point(mesh, 1));
    assert_eq!(first.attribute("heat"), Some([1.25, 1.25, 1.25, 1.0]));
    assert_eq!(first.attribute("face"), Some([0.2, 0.2, 0.2, 1.0]));
    assert_eq!((second.attribute("face"), second.attribute("cold")), (Some([1.0; 4]), None));
    assert_eq!(first.uv1(), Some(Vec2::new(2.0, 0.5)));
    assert_eq!(first.uv1_area_ratio(), Some(8.0));
    assert_eq!(first.moved(Vec2::new(0.25, -0.5)).uv1(), Some(Vec2::new(0.0, 1.0)));
    assert_eq!(mesh.tangent(0, Vec2::splat(0.25)), Some((Vec3::X, -1.0)));
}

#[test]
fn rare_arrays_follow_creases_and_morphs() {
    let data = folded();
    assert_values(&data);
    let mut mesh = Mesh { crease_angle_degrees: Some(30.0), ..data.clone().into() };
    let positions = data.positions.iter().map(|p| *p * 3.0).collect();
    mesh.morphs = vec![MorphTarget { positions, weight: 0.5, ..MorphTarget::default() }];
    mesh.prepare().unwrap();
    assert_eq!(mesh.arrays().positions.len(), 6, "the edge is split");
    assert_values(mesh.arrays());
    let json = serde_json::to_string(&mesh).unwrap();
    assert_eq!(**serde_json::from_str::<Mesh>(&json).unwrap().arrays(), **mesh.arrays());
    let plain = MeshData { uvs1: Vec::new(), tangents: Vec::new(), attributes: Default::default(), ..data.clone() };
    assert_eq!(data.bytes() - plain.bytes(), 4 * (8 + 16 + 4) + 2);
}

#[test]
fn moving_meshes_keep_attributes_and_blend_tangents() {
    let later = MeshData { tangents: vec![[0.0, 0.0, -2.0, -1.0]; 4], ..folded() };
    let later = MeshData { positions: later.positions.iter().map(|p| *p + Vec3::Y * 9.0).collect(), ..later };
    let mesh = Mesh::from_keyframes(vec![folded(), later], None).unwrap();
    let ray = Ray { time: 0.5, ..Ray::new(Vec3::new(0.2, 9.0, 0.2), Vec3::NEG_Y) };
    let surface = mesh.surface(&ray, &mesh.intersect(&ray).unwrap());
    let shape = AnyShape::from(mesh);
    let found = shape.mesh_point(0, &surface).unwrap().attribute("heat").unwrap();
    assert!(close(found[0], 0.2 + 2.0 * 0.2, 1e-5), "{found:?}");
    let frame = shape.tangent_frame(0, &surface, 0.5).unwrap();
    assert!(close3(frame.u, Vec3::new(0.5, 0.0, -0.5), 1e-5), "{frame:?}");
    assert!(close3(frame.v, -surface.local_normal.cross(frame.u), 1e-5), "{frame:?}");
}

/// Without surface coordinates, the tangents of a sphere of triangles are those of the exact sphere,
/// on both sides of every edge; with them, the triangles' derivatives stay.
#[test]
fn meshes_without_coordinates_have_tangents_about_the_axis() {
    let corner = |turn: u32, y: f32| {
        let (sin, cos) = (turn as f32 * std::f32::consts::TAU / 6.0).sin_cos();
        Vec3::new(cos, y, -sin)
    };
    let positions: Vec<Vec3> = (0..6).flat_map(|turn| [corner(turn, -1.0), corner(turn, 1.0)]).collect();
    let side = |i: u32| [[2 * i, (2 * i + 2) % 12, (2 * i + 3) % 12], [2 * i, (2 * i + 3) % 12, 2 * i + 1]];
    let data = MeshData { positions, triangles: (0..6).flat_map(side).collect(), ..MeshData::default() };
    let mut mesh = Mesh { crease_angle_degrees: Some(180.0), ..data.clone().into() };
    mesh.prepare().unwrap();
    assert!(mesh.lacks_surface_coordinates());
    let shape = AnyShape::from(mesh);
    for step in 0..360u16 {
        let (sin, cos) = f32::from(step).to_radians().sin_cos();
        let ray = Ray::new(Vec3::new(3.0 * cos, 0.1, -3.0 * sin), Vec3::new(-cos, 0.0, sin));
        let hit = shape.intersect(&ray).unwrap();
        let surface = shape.surface(&ray, &hit);
        let frame = shape.tangent_frame(hit.primitive, &surface, 0.0).unwrap();
        // The radius turns by the azimuth, so the tangent is the azimuth's derivative.
        assert!(close3(frame.u.normalize(), Vec3::new(-sin, 0.0, -cos), 1e-4), "{step}: {frame:?}");
        assert!(frame.v.normalize().y > 0.8, "{step}: {frame:?}");
    }
    let uvs = data.positions.iter().map(|p| Vec2::new(p.x, p.y)).collect();
    let mut mesh = Mesh::from(MeshData { uvs, ..data });
    mesh.prepare().unwrap();
    let ray = Ray::new(Vec3::new(3.0, 0.1, 0.2), Vec3::NEG_X);
    let surface = mesh.surface(&ray, &mesh.intersect(&ray).unwrap());
    assert!(AnyShape::from(mesh).tangent_frame(0, &surface, 0.0).is_none());
}
