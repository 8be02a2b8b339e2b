//! Descriptions: to JSON and back, and validation.

use super::*;
use crate::{Cuboid, Cylinder, Disk, Mesh, MeshData, Polygon, Rectangle, Sphere, Triangle, Tube};

#[test]
fn json_round_trips() {
    for shape in AnyShape::examples() {
        let text = serde_json::to_string(&shape).unwrap();
        assert_eq!(serde_json::from_str::<AnyShape>(&text).unwrap(), shape, "{text}");
    }
}

#[test]
fn defaults_are_sound() {
    for kind in ["sphere", "plane", "disk", "rectangle", "cuboid", "cylinder", "tube"] {
        let mut shape: AnyShape = serde_json::from_str(&format!("{{\"{kind}\": {{}}}}")).unwrap();
        shape.prepare().unwrap();
    }
}

fn refused(shape: impl Into<AnyShape>, field: &str) {
    let mut shape = shape.into();
    let error = shape.prepare().expect_err(&format!("{shape:?}"));
    assert_eq!(error.field, field, "{shape:?}: {error}");
    let root = field.split(['[', '.']).next().unwrap_or_default();
    assert!(error.message.contains(root), "{error}");
}

#[test]
fn numbers_out_of_range_are_refused_by_field() {
    for bad in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e30, 1e-30] {
        refused(Sphere { radius: bad }, "radius");
        refused(Tube { radius: bad }, "radius");
        refused(Disk { radius: bad, inner_radius: 0.0 }, "radius");
        refused(Cylinder { radius: bad, ..Cylinder::default() }, "radius");
        refused(Rectangle { size: [1.0, bad] }, "size[1]");
    }
    for bad in [-0.1, 1.0, 2.0, f32::NAN] {
        refused(Disk { radius: 1.0, inner_radius: bad }, "inner_radius");
    }
    for bad in [f32::NAN, f32::NEG_INFINITY, 1e30] {
        refused(Cylinder { y_min: bad, ..Cylinder::default() }, "y_min");
        refused(Cuboid { min: Vec3::new(0.0, bad, 0.0), ..Cuboid::default() }, "min[1]");
        refused(Triangle::new([Vec3::X, Vec3::Y, Vec3::new(0.0, 0.0, bad)]), "vertices[2][2]");
        refused(Polygon::new([Vec3::X, Vec3::new(bad, 0.0, 0.0), Vec3::Y]), "vertices[1][0]");
    }
    refused(Cylinder { y_min: 2.0, ..Cylinder::default() }, "y_max");
    refused(Cuboid { min: Vec3::ZERO, max: Vec3::new(1.0, 1.0, 0.0) }, "max[2]");
    refused(Triangle::new([Vec3::ZERO, Vec3::X, Vec3::X * 2.0]), "vertices");
    refused(
        Triangle { normals: Some([Vec3::X, Vec3::ZERO, Vec3::X]), ..Triangle::new([Vec3::X, Vec3::Y, Vec3::Z]) },
        "normals[1]",
    );
}

#[test]
fn polygons_say_which_vertex_is_at_fault() {
    let polygon =
        |points: &[[f32; 2]]| Polygon::new(points.iter().map(|p| Vec3::new(p[0], p[1], 0.0)).collect::<Vec<_>>());
    refused(polygon(&[[0.0, 0.0], [1.0, 0.0]]), "vertices");
    refused(polygon(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]), "vertices");
    refused(polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), "vertices[2]");
    refused(polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0]]), "vertices[3]");
    // A dent, a star, a spike, a bow tie.
    refused(polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.5, 0.5]]), "vertices[3]");
    let star: Vec<[f32; 2]> =
        (0..5u8).map(|i| juggler_math::portable::sin_cos_turns(f32::from(i) * 0.4).into()).collect();
    refused(polygon(&star), "vertices[2]");
    refused(polygon(&[[0.0, 0.0], [4.0, 0.0], [2.0, 0.0], [2.0, 2.0]]), "vertices[1]");
    refused(polygon(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]]), "vertices");
    let mut warped = polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 3.0], [0.0, 2.0]]);
    warped.vertices[3].z = 0.25;
    let error = warped.prepare().unwrap_err();
    assert_eq!(error.field, "vertices[3]");
    assert!(error.message.contains("0.25"), "{error}");
}

#[test]
fn meshes_say_which_index_is_at_fault() {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X * 2.0];
    let data = |triangles: &[[u32; 3]]| MeshData {
        positions: positions.clone(),
        triangles: triangles.to_vec(),
        ..MeshData::default()
    };
    refused(Mesh::from(data(&[[0, 1, 2], [0, 4, 1]])), "triangles[1][1]");
    refused(Mesh::from(data(&[[0, 1, 3], [1, 1, 2]])), "triangles");
    refused(Mesh::from(data(&[])), "triangles");
    refused(Mesh::from_file("cow.ply"), "file");
    let whole = data(&[[0, 1, 2]]);
    refused(Mesh::from(MeshData { normals: vec![Vec3::X; 3], ..whole.clone() }), "normals");
    refused(Mesh::from(MeshData { uvs: vec![juggler_math::Vec2::NAN; 4], ..whole.clone() }), "uvs[0][0]");
    refused(Mesh::from(MeshData { uvs1: vec![juggler_math::Vec2::X; 3], ..whole.clone() }), "uvs1");
    refused(Mesh::from(MeshData { tangents: vec![[1.0, 0.0, 0.0, 0.5]; 4], ..whole.clone() }), "tangents[0][3]");
    let attribute = |channels, numbers: &[f32]| {
        let data = crate::attribute::AttributeData::F32(numbers.to_vec());
        let attribute = crate::attribute::MeshAttribute { channels, data, ..Default::default() };
        Mesh::from(whole.clone()).with_attribute("heat", attribute)
    };
    refused(attribute(5, &[0.0; 20]), "attributes.heat.channels");
    refused(attribute(2, &[0.0; 9]), "attributes.heat.data");
    refused(attribute(1, &[0.0, 1.0, f32::NAN, 0.0]), "attributes.heat.data.f32[2]");
    let mut broken = whole.clone();
    broken.positions[2].y = f32::NAN;
    refused(Mesh::from(broken), "positions[2][1]");
    let mut both = Mesh::from(whole.clone());
    both.file = Some("cow.ply".to_owned());
    assert_eq!(both.load(whole.clone()).unwrap_err().field, "file");
    let file = Mesh::from_file("cow.ply");
    for mut both in [file.clone().with_normals([Vec3::X; 4]), file.with_uvs([juggler_math::Vec2::ZERO; 4])] {
        let error = both.load(whole.clone()).unwrap_err();
        assert!(error.field == "file" && error.message.contains("`normals`, `uvs`"), "{error}");
    }
}

/// Shapes do not panic when they are used before `prepare`, or with numbers that it would refuse.
#[test]
fn unprepared_shapes_do_not_panic() {
    let mut shapes = AnyShape::examples();
    shapes.push(Polygon::new([]).into());
    shapes.push(Mesh::default().into());
    shapes.push(Sphere { radius: f32::NAN }.into());
    for shape in shapes {
        let ray = Ray::new(Vec3::new(0.1, 5.0, 0.2), Vec3::NEG_Y);
        let hit = shape.intersect(&ray).unwrap_or(crate::Hit { t: 1.0, uv: juggler_math::Vec2::ZERO, primitive: 77 });
        let _ =
            (shape.surface(&ray, &hit), shape.bounds(), shape.area(), shape.sample(Vec3::Y, juggler_math::Vec2::ZERO));
        let at = crate::SurfacePoint { point: Vec3::X, normal: Vec3::X, primitive: 77 };
        let _ = (shape.pdf(Vec3::Y, &at), shape.triangles(), shape.heap_bytes(), shape.occludes(&ray));
    }
}
